// Poses against closed forms worked out here, with the C library's trigonometry.
#include "core/scene/animate.h"

#include "catch.h"
#include "gltf_builder.h"
#include "scenes.h"

#include <random>

using namespace lrsm;
using gltf::Channel;
using gltf::Interpolation;
using gltf::Property;

namespace {

constexpr double kTolerance = 2e-6;

Channel channel(Property property, Interpolation interpolation, std::vector<float> times, int width, std::vector<float> values)
{
    return {0, property, interpolation, std::move(times), width, std::move(values)};
}

double sample1(const Channel& c, float time)
{
    std::vector<double> value(std::size_t(c.width));
    gltf::sampleChannel(c, time, value);
    return value[0];
}

Vec3 centroid(const Mesh& mesh)
{
    glm::dvec3 sum(0.0);
    for (const Vec3& p : mesh.positions) sum += glm::dvec3(p);
    return Vec3(sum / double(mesh.positions.size()));
}

/// Adds an animation of one channel to node `node`.
void animate(GltfBuilder& b, int node, const std::string& path, const std::string& interpolation, const std::vector<float>& times,
             const std::vector<float>& values, const std::string& type)
{
    const int input = b.add(times, "SCALAR", 5126), output = b.add(values, type, 5126);
    b.json["animations"].push_back({{"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}},
                                    {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}}});
}

}  // namespace

TEST_CASE("STEP holds the earlier key, LINEAR is linear, both clamp outside the range", "[scene][animate]")
{
    const std::vector<float> times = {1, 2, 4}, values = {10, 20, 0};
    const Channel step = channel(Property::weights, Interpolation::step, times, 1, values);
    const Channel linear = channel(Property::weights, Interpolation::linear, times, 1, values);
    for (const auto& [time, held, between] : {std::tuple{0.0f, 10.0, 10.0},
                                              {1.0f, 10.0, 10.0},
                                              {1.5f, 10.0, 15.0},
                                              {2.0f, 20.0, 20.0},
                                              {3.5f, 20.0, 5.0},
                                              {4.0f, 0.0, 0.0},
                                              {99.0f, 0.0, 0.0},
                                              {-5.0f, 10.0, 10.0}}) {
        CAPTURE(time);
        CHECK(sample1(step, time) == held);
        CHECK(sample1(linear, time) == between);
    }
    CHECK(sample1(channel(Property::weights, Interpolation::linear, {3}, 1, {7}), 5.0f) == 7.0);
}

TEST_CASE("CUBICSPLINE is the Hermite cubic with tangents scaled by the interval", "[scene][animate]")
{
    // The cubic p(x) = x^3 - 2x + 1 itself, sampled at two keys with its derivative, comes back exactly.
    const auto p = [](double x) { return x * x * x - 2 * x + 1; };
    const auto dp = [](double x) { return 3 * x * x - 2; };
    const double a = 1, b = 3.5;
    const Channel c = channel(Property::weights, Interpolation::cubicSpline, {float(a), float(b)}, 1,
                              {99, float(p(a)), float(dp(a)), float(dp(b)), float(p(b)), -99});  // outermost tangents are not used
    for (double x = a; x <= b; x += 0.25) CHECK(sample1(c, float(x)) == Approx(p(x)).margin(1e-5));
    CHECK(sample1(c, 0.0f) == Approx(p(a)));
    CHECK(sample1(c, 9.0f) == Approx(p(b)));
}

TEST_CASE("slerp turns evenly, along the shorter arc, and keeps unit length", "[scene][animate]")
{
    const auto about = [](glm::dvec3 axis, double angle) {
        axis = glm::normalize(axis);
        return glm::dvec4(axis * std::sin(angle / 2), std::cos(angle / 2));
    };
    std::mt19937 random(3);
    std::uniform_real_distribution<> any(-1, 1);
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 axis(any(random), any(random), any(random));
        const double from = 3 * any(random), turn = 3.1 * any(random), t = 0.5 + 0.5 * any(random);
        const glm::dvec4 a = about(axis, from), b = about(axis, from + turn) * (i % 2 ? 1.0 : -1.0);  // q and -q are one rotation
        const glm::dvec4 q = gltf::slerp(a, b, t), expected = about(axis, from + t * turn);
        CHECK(std::abs(glm::length(q) - 1) < 1e-14);
        CHECK(std::abs(std::abs(glm::dot(q, expected)) - 1) < 1e-14);
        CHECK(glm::dot(q, a) > 0);  // starts where `a` is, not at -a
    }
    const glm::dvec4 a = about({1, 2, 3}, 1);
    CHECK(glm::length(gltf::slerp(a, a, 0.3) - a) < 1e-15);
    CHECK(glm::length(gltf::slerp(a, about({1, 2, 3}, 1 + 1e-10), 0.5) - about({1, 2, 3}, 1 + 5e-11)) < 1e-15);
    CHECK(glm::length(gltf::slerp({0, 0, 0, -1}, {1, 0, 0, 0}, 0.5) - glm::dvec4(std::sqrt(0.5), 0, 0, -std::sqrt(0.5))) < 1e-15);
}

TEST_CASE("animated nodes move their children, in each animation's own way", "[scene][animate]")
{
    GltfBuilder b;
    b.json["nodes"] = {{{"children", {1}}}, {{"mesh", 0}, {"translation", {1, 0, 0}}}};
    const float h = float(std::sqrt(0.5));
    animate(b, 0, "rotation", "LINEAR", {0, 2}, {0, 0, 0, 1, 0, 0, h, h}, "VEC4");  // a quarter turn about z in 2 s
    animate(b, 0, "scale", "STEP", {0, 1}, {1, 1, 1, 3, 3, 3}, "VEC3");
    for (const float time : {0.0f, 0.5f, 1.0f, 2.0f, 7.0f}) {
        const double angle = std::min(double(time), 2.0) * 3.14159265358979 / 4;
        const Vec3 origin = b.load({time, 0}).meshes.at(0).positions[0];
        CHECK(origin.x == Approx(std::cos(angle)).margin(kTolerance));
        CHECK(origin.y == Approx(std::sin(angle)).margin(kTolerance));
        CHECK(b.load({time, 1}).meshes.at(0).positions[0].x == (time < 1 ? 1.0f : 3.0f));
        CHECK(b.load({time, -1}).meshes.at(0).positions[0] == Vec3(1, 0, 0));
    }
    CHECK(b.error({.animation = 2}).find("there is no animation 2") != std::string::npos);
    CHECK(b.error({.animation = -2}).find("animation") != std::string::npos);
    CHECK(b.error({.time = std::nanf("")}).find("time") != std::string::npos);
    CHECK(GltfBuilder().error({.time = 3}) == "");  // nothing to animate is no error
    CHECK(GltfBuilder().error({.time = 3, .animation = 1}) != "");
}

TEST_CASE("a skinned vertex is the weighted sum of its joints' motions, its own node's transform is ignored", "[scene][animate][skin]")
{
    GltfBuilder b;
    b.attributes()["POSITION"] = b.add<float>({0, 0, 0, 2, 0, 0, 0, 1, 0}, "VEC3", 5126);
    b.attributes()["JOINTS_0"] = b.add<std::uint8_t>({0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC4", 5121);
    b.attributes()["WEIGHTS_0"] = b.add<float>({1, 0, 0, 0, 0.25f, 0.75f, 0, 0, 3, 0, 0, 0}, "VEC4", 5126);  // the last sum to 3
    // Joint 1 sits at x = 1 in the bind pose, and is turned by a quarter about z and moved up by 5.
    const double h = std::sqrt(0.5);
    b.json["nodes"] = {
        {{"mesh", 0}, {"skin", 0}, {"translation", {100, 100, 100}}}, {{"children", {2}}}, {{"translation", {1, 5, 0}}, {"rotation", {0, 0, h, h}}}};
    b.json["scenes"][0]["nodes"] = {0, 1};
    const int bind = b.add<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1}, "MAT4", 5126);
    b.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", bind}}};
    const Mesh mesh = b.load().meshes.at(0);
    CHECK(glm::distance(mesh.positions[0], Vec3(0, 0, 0)) < kTolerance);
    // (2, 0, 0): joint 0 leaves it; joint 1 takes (1, 0, 0) about its place to (1, 5, 0) + (0, 1, 0).
    CHECK(glm::distance(mesh.positions[1], 0.25f * Vec3(2, 0, 0) + 0.75f * Vec3(1, 6, 0)) < kTolerance);
    CHECK(glm::distance(mesh.positions[2], Vec3(0, 4, 0)) < kTolerance);  // (0, 1, 0) - (1, 0, 0), turned, plus (1, 5, 0)

    b.json["skins"][0]["joints"] = {1};
    CHECK(b.error().find("nodes[0].skin") != std::string::npos);
}

TEST_CASE("morph targets add to positions and normals by weight: the node's, else the mesh's, else the animation's", "[scene][animate][morph]")
{
    GltfBuilder b;
    b.attributes()["NORMAL"] = b.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
    const int up = b.add<float>({0, 0, 1, 0, 0, 0, 0, 0, 0}, "VEC3", 5126), tilt = b.add<float>({1, 0, -1, 0, 0, 0, 0, 0, 0}, "VEC3", 5126);
    b.primitive()["targets"] = {{{"POSITION", up}}, {{"POSITION", up}, {"NORMAL", tilt}}};
    CHECK(b.load().meshes[0].positions[0].z == 0.0f);
    b.json["meshes"][0]["weights"] = {0.5, 0};
    CHECK(b.load().meshes[0].positions[0].z == 0.5f);
    b.node()["weights"] = {0.25, 0.5};
    CHECK(b.load().meshes[0].positions[0].z == 0.75f);
    CHECK(glm::distance(b.load().meshes[0].normals[0], glm::normalize(Vec3(0.5f, 0, 0.5f))) < kTolerance);
    animate(b, 0, "weights", "LINEAR", {0, 1}, {0, 0, 2, 4}, "SCALAR");
    CHECK(b.load({0.5f, 0}).meshes[0].positions[0].z == 3.0f);
    CHECK(b.load({0.5f, -1}).meshes[0].positions[0].z == 0.75f);
}

TEST_CASE("BoxAnimated: the inner box rises, turns over about x, and sinks", "[scene][animate][files]")
{
    LRSM_NEED_SCENES();
    const std::string file = (scenesFolder() / "samples" / "BoxAnimated.glb").string();
    const Scene rest = loadGltf(file, {0, 0});  // the file lists the outer box first
    for (const float time : {0.0f, 0.4f, 1.25f, 1.6f, 2.5f, 3.0f, 3.708329916f, 9.0f}) {
        CAPTURE(time);
        const double height = time < 1.25f ? 2.52 * time / 1.25 : time < 2.5f ? 2.52 : std::max(0.0, 2.52 * (1 - (time - 2.5) / 1.208329916));
        // A half turn has two ways; the keys' w of -1 and +4e-11 make the positive one the shorter.
        const double turn = 3.14159265358979 * std::min(1.0, std::max(0.0, (time - 1.25) / 1.25));
        const Scene scene = loadGltf(file, {time, 0});
        double worst = 0;
        for (std::size_t i = 0; i < scene.meshes[1].positions.size(); ++i) {
            const Vec3 p = rest.meshes[1].positions[i];
            const glm::dvec3 expected(p.x, height + std::cos(turn) * p.y - std::sin(turn) * p.z, std::sin(turn) * p.y + std::cos(turn) * p.z);
            worst = std::max(worst, glm::distance(expected, glm::dvec3(scene.meshes[1].positions[i])));
        }
        CHECK(worst < kTolerance);
        CHECK((scene.meshes[0].positions == rest.meshes[0].positions));
    }
}

TEST_CASE("InterpolationTest: nine animations, each interpolated by its own rule", "[scene][animate][files]")
{
    LRSM_NEED_SCENES();
    const std::string file = (scenesFolder() / "samples" / "InterpolationTest.glb").string();
    const Scene rest = loadGltf(file, {0, -1});
    const auto smooth = [](double t) { return t * t * (3 - 2 * t); };  // Hermite with zero tangents
    for (const float time : {0.0f, 0.1f, 0.5f, 0.7f, 1.2f, 1.9f, 2.0f}) {
        CAPTURE(time);
        const int key = std::min(3, int(time / 0.5f));
        const double t = (time - 0.5 * key) / 0.5;
        const auto triangle = [&](double shape) { return key % 2 ? 1 - shape : shape; };  // 0, 1, 0, 1, 0 at the keys
        const double stepped = time >= 2.0f ? 0 : key % 2;
        const auto lift = [&](int animation, std::size_t mesh) {
            return double(centroid(loadGltf(file, {time, animation}).meshes[mesh]).y - centroid(rest.meshes[mesh]).y);
        };
        CHECK(lift(6, 6) == Approx(4 * stepped).margin(1e-5));
        CHECK(lift(8, 8) == Approx(4 * triangle(t)).margin(1e-5));
        CHECK(lift(7, 7) == Approx(4 * triangle(smooth(t))).margin(1e-5));
        const auto size = [&](int animation, std::size_t mesh) {
            const Mesh m = loadGltf(file, {time, animation}).meshes[mesh];
            return double(glm::distance(m.positions[0], centroid(m)) / glm::distance(rest.meshes[mesh].positions[0], centroid(rest.meshes[mesh])));
        };
        CHECK(size(0, 0) == Approx(1 - stepped).margin(1e-5));
        CHECK(size(1, 1) == Approx(1 - triangle(t)).margin(1e-5));
        CHECK(size(2, 2) == Approx(1 - triangle(smooth(t))).margin(1e-5));
        // Linear rotation: 45 degrees backwards about z every half second.
        const Mesh turned = loadGltf(file, {time, 5}).meshes[5];
        const Vec3 centre = centroid(rest.meshes[5]), p = rest.meshes[5].positions[0] - centre, q = turned.positions[0] - centre;
        const double angle = -double(time) / 0.5 * 3.14159265358979 / 4;
        CHECK(q.x == Approx(std::cos(angle) * p.x - std::sin(angle) * p.y).margin(1e-4));
        CHECK(q.y == Approx(std::sin(angle) * p.x + std::cos(angle) * p.y).margin(1e-4));
    }
}

TEST_CASE("AnimatedMorphCube: linear between keyframes, at rest where all weights are 0", "[scene][animate][files]")
{
    LRSM_NEED_SCENES();
    const std::string file = (scenesFolder() / "samples" / "AnimatedMorphCube.glb").string();
    const auto positions = [&](float time, int animation) { return loadGltf(file, {time, animation}).meshes.at(0).positions; };
    CHECK(positions(0, 0) == positions(0, -1));
    bool moved = false;
    for (const int k : {5, 40, 77, 110}) {
        const float t0 = float(k) / 30, t1 = float(k + 1) / 30;
        const auto p0 = positions(t0, 0), p1 = positions(t1, 0), half = positions(0.5f * (t0 + t1), 0);
        for (std::size_t i = 0; i < p0.size(); ++i) {
            CHECK(glm::distance(half[i], 0.5f * (p0[i] + p1[i])) < 1e-5f);
            moved |= glm::distance(p0[i], p1[i]) > 1e-3f;
        }
    }
    CHECK(moved);
}

TEST_CASE("skinned files move as a whole body: triangles change little in size over the animation", "[scene][animate][files]")
{
    LRSM_NEED_SCENES();
    const std::string file = (scenesFolder() / "samples" / "Fox.glb").string();
    const Scene rest = loadGltf(file, {0, -1});
    for (int animation = 0; animation < 3; ++animation) {
        const Scene scene = loadGltf(file, {0.35f, animation});
        double area = 0, restArea = 0, difference = 0;
        const Mesh &m = scene.meshes.at(0), &r = rest.meshes.at(0);
        const auto triangleArea = [](const Mesh& mesh, std::size_t t) {
            const auto& i = mesh.triangles[t];
            return 0.5 * double(glm::length(glm::cross(mesh.positions[i[1]] - mesh.positions[i[0]], mesh.positions[i[2]] - mesh.positions[i[0]])));
        };
        for (std::size_t t = 0; t < m.triangles.size(); ++t) area += triangleArea(m, t), restArea += triangleArea(r, t);
        for (std::size_t i = 0; i < m.positions.size(); ++i) difference = std::max(difference, double(glm::distance(m.positions[i], r.positions[i])));
        CHECK(area == Approx(restArea).epsilon(0.1));
        CHECK(difference > 3.0);
    }
}
