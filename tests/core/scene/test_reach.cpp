#include "core/scene/reach.h"

#include "core/scene/builtin_scenes.h"
#include "core/scene/coarse_view.h"
#include "core/scene/exposure.h"
#include "core/scene/invisible.h"
#include "core/scene/light.h"
#include "core/scene/load_scene.h"
#include "core/scene/shapes.h"
#include "core/scene/view_file.h"
#include "gltf_builder.h"

#include "catch.h"

using namespace lrsm;

namespace {

Mesh& addMesh(Scene& scene, bool doubleSided = false)
{
    scene.materials.push_back(diffuseMaterial("added", Vec3(0.5f), doubleSided));
    scene.meshes.emplace_back().material = int(scene.materials.size()) - 1;
    return scene.meshes.back();
}

void addGround(Scene& scene, float y, float half)
{
    addQuad(addMesh(scene, true), Vec3(-half, y, half), Vec3(half, y, half), Vec3(half, y, -half), Vec3(-half, y, -half));
}

void addStray(Scene& scene, const Vec3& at)
{
    addQuad(addMesh(scene, true), at, at + Vec3(1, 0, 0), at + Vec3(1, 1, 0), at + Vec3(0, 1, 0));
}

Aabb reachAfter(Scene& scene)
{
    updateBounds(scene);
    return measureReach(scene, scene.cameras.at(0));
}

/// A floor, a crate, a spot and a camera, all at `translation` by node, and `inVertices` by vertex.
Scene loadAt(const glm::dvec3& translation, const Vec3& inVertices = Vec3(0.0f))
{
    GltfBuilder file;
    Mesh shapes;
    addQuad(shapes, Vec3(-2, 0, 2), Vec3(2, 0, 2), Vec3(2, 0, -2), Vec3(-2, 0, -2));
    addBox(shapes, Vec3(-0.5f, 0, -0.5f), Vec3(0.5f, 1, 0.375f));
    std::vector<float> positions;
    for (const auto& triangle : shapes.triangles)
        for (const std::uint32_t v : triangle)
            for (int k = 0; k < 3; ++k) positions.push_back(shapes.positions[v][k] + inVertices[k]);
    file.attributes()["POSITION"] = file.add(positions, "VEC3", 5126);
    const glm::dvec3 placed = translation + glm::dvec3(inVertices);
    const auto place = [](const glm::dvec3& p) { return nlohmann::json{p.x, p.y, p.z}; };
    file.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.01}}}}};
    file.json["extensionsUsed"] = {"KHR_lights_punctual"};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"intensity", 60}, {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.7}}}}};
    file.json["nodes"] = {{{"mesh", 0}, {"translation", place(translation)}},
                          {{"camera", 0}, {"translation", place(placed + glm::dvec3(0.5, 1.25, 5.0))}},
                          {{"rotation", {-0.5, 0, 0, 0.8660254037844386}},
                           {"translation", place(placed + glm::dvec3(0.25, 3.0, 1.5))},
                           {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
    file.json["scenes"][0]["nodes"] = {0, 1, 2};
    return file.load();
}

bool sameBits(const Scene& a, const Scene& b)
{
    return a.meshes.at(0).positions == b.meshes.at(0).positions && a.meshes[0].normals == b.meshes[0].normals && a.bounds == b.bounds &&
           a.lights.at(0).position == b.lights.at(0).position && a.lights[0].direction == b.lights[0].direction &&
           a.cameras.at(0).position == b.cameras.at(0).position && a.cameras[0].forward == b.cameras[0].forward;
}

}  // namespace

TEST_CASE("coarse view: a wall ahead is met by every ray, where its plane is", "[scene][reach]")
{
    const bool front = GENERATE(true, false);
    Scene scene;
    Mesh& wall = addMesh(scene);
    const float d = 3.0f, w = 100.0f;
    if (front)
        addQuad(wall, Vec3(-w, -w, -d), Vec3(w, -w, -d), Vec3(w, w, -d), Vec3(-w, w, -d));
    else
        addQuad(wall, Vec3(-w, w, -d), Vec3(w, w, -d), Vec3(w, -w, -d), Vec3(-w, -w, -d));
    addQuad(addMesh(scene, true), Vec3(-w, -w, -2 * d), Vec3(w, -w, -2 * d), Vec3(w, w, -2 * d), Vec3(-w, w, -2 * d));
    const CoarseView view = coarseView(scene, viewpointOf(lookAt(Vec3(0), Vec3(0, 0, -1), Vec3(0, 1, 0), 1.0f)));
    REQUIRE(view.hits.size() == std::size_t(kCoarseEdge) * kCoarseEdge);
    REQUIRE(view.rays == view.hits.size());
    for (const CoarseHit& hit : view.hits) {
        CHECK(hit.position.z == Approx(front ? -d : -2 * d));  // the back of a single-sided wall is looked through
        CHECK(hit.distance == Approx(glm::length(glm::dvec3(hit.position))).epsilon(1e-6));
    }
}

TEST_CASE("coarse view: parallel rays meet what stands before their square, as far as it is from there", "[scene][reach]")
{
    Scene scene;
    const float d = 3.0f, quarter = 0.5f;  // a wall over a quarter of the picture's width and all its height, seen along -x from (5, 1, 2)
    addQuad(addMesh(scene, true), Vec3(5 - d, -9, 2 - quarter), Vec3(5 - d, 9, 2 - quarter), Vec3(5 - d, 9, 2 + quarter), Vec3(5 - d, -9, 2 + quarter));
    Camera camera = lookAt(Vec3(5, 1, 2), Vec3(0, 1, 2), Vec3(0, 1, 0), 1.0f);
    camera.perspective = false;
    camera.verticalExtent = 4.0f * (2.0f * quarter) * 9.0f / 16.0f;
    const CoarseView view = coarseView(scene, viewpointOf(camera));
    CHECK(view.rays == std::size_t(kCoarseEdge) * kCoarseEdge);
    CHECK(view.hits.size() == view.rays / 4);
    for (const CoarseHit& hit : view.hits) {
        CHECK(hit.distance == Approx(d));
        CHECK(std::abs(hit.position.z - 2) <= quarter);
        CHECK(std::abs(hit.position.y - 1) <= 0.5f * camera.verticalExtent);
        CHECK(hit.front);
    }
}

TEST_CASE("coarse view: as many rays meet a sphere as its solid angle says", "[scene][reach]")
{
    Scene scene;
    addSphere(addMesh(scene), Vec3(0, 0, -10), 2.0f, 5);
    Light face;
    face.type = LightType::cubeFace;
    face.direction = Vec3(0, 0, -1);
    face.up = Vec3(0, 1, 0);
    const CoarseView view = coarseView(scene, viewpointOf(face));
    // Its silhouette is a circle of tangent 2 / sqrt(100 - 4) in a square of half side 1.
    const double share = 3.14159265 * (4.0 / 96.0) / 4.0;
    CHECK(double(view.hits.size()) / double(view.rays) == Approx(share).epsilon(0.12));
    for (const CoarseHit& hit : view.hits) CHECK((hit.distance > 7.99 && hit.distance < 9.9));
}

TEST_CASE("reach: the whole of an ordinary scene", "[scene][reach]")
{
    for (const BuiltinSceneInfo& info : builtinScenes()) {
        INFO(info.name);
        const Scene scene = loadScene(info.name, {});
        CHECK(scene.reach == scene.bounds);
        CHECK(scene.origin == glm::dvec3(0.0));
        CHECK(preExposureOf(scene) == 1.0f);
    }
}

TEST_CASE("reach: ground, sky and stray triangles far away add nothing, in any unit", "[scene][reach]")
{
    const std::string name = GENERATE("cornell-box", "atrium", "two-rooms");
    const float scale = GENERATE(1e-3f, 1.0f, 1024.0f);
    Scene scene = *makeBuiltinScene(name);
    for (Mesh& mesh : scene.meshes)
        for (Vec3& p : mesh.positions) p *= scale;
    for (Light& light : scene.lights) light.position *= scale;
    scene.cameras[0].position *= scale;
    const Aabb alone = reachAfter(scene);
    CHECK(alone == scene.bounds);
    const Vec3 size = scene.bounds.extent();
    const float largest = std::max({size.x, size.y, size.z});
    Scene stray = scene, ground = scene, sky = scene;
    addStray(stray, Vec3(2000.0f * largest, 5.0f, 0.0f));
    CHECK(reachAfter(stray) == alone);
    addSphere(addMesh(sky), alone.centre(), 1000.0f * largest, 4, true);
    CHECK(reachAfter(sky) == alone);
    if (name != "atrium") {
        addGround(ground, alone.min.y - 0.01f * largest, 1000.0f * largest);
        const Aabb onGround = reachAfter(ground);
        CHECK(onGround.extent().x < 3.0f * largest);  // a spot beside a wall also strikes the ground
    }
}

TEST_CASE("reach: a lamp far away widens it only where its light matters to what is seen", "[scene][reach]")
{
    const float away = GENERATE(1e3f, 1e4f), height = GENERATE(2.0f, 20.0f);
    const bool point = GENERATE(false, true);
    Scene scene = *makeBuiltinScene("cornell-box");
    addGround(scene, scene.bounds.min.y - 0.01f, 2e4f);
    const Aabb own = reachAfter(scene);
    CHECK(own.longestSide() < 10.0f);
    const Vec3 lamp(away, height, 0.0f), home = scene.lights.at(0).intensity;
    const auto reachWith = [&](float times) {
        Scene lit = scene;
        const std::vector<Light> lamps =
            point ? splitPointLight(lamp, times * home, kInfinity, "lamp") : std::vector<Light>{spotLight(lamp, Vec3(away, 0, 0), times * home, 0.5f, 0.7f)};
        lit.lights.insert(lit.lights.end(), lamps.begin(), lamps.end());
        return reachAfter(lit);
    };
    CHECK(reachWith(1.0f) == own);
    // A spot that looks down reaches the room by what it strikes alone: its flux over pi d^2, against the room's own I / d^2 at some metres.
    CHECK(reachWith(away * away).longestSide() > away);
}

TEST_CASE("reach: an orthographic camera has that of what it meets, wherever it stands", "[scene][reach]")
{
    const float distance = GENERATE(3.0f, 3000.0f);
    Scene scene = *makeBuiltinScene("cornell-box");
    Camera& camera = scene.cameras[0];
    camera.perspective = false;
    camera.verticalExtent = scene.bounds.extent().y;
    camera.position = scene.bounds.centre() - distance * camera.forward;
    const Aabb alone = reachAfter(scene);
    CHECK(alone == scene.bounds);
    const float largest = scene.bounds.longestSide();
    Scene stray = scene, ground = scene;
    addStray(stray, Vec3(2000.0f * largest, 5.0f, 0.0f));
    CHECK(reachAfter(stray) == alone);
    addGround(ground, alone.min.y - 0.01f * largest, 1000.0f * largest);
    CHECK(reachAfter(ground).extent().x < 3.0f * largest);
}

TEST_CASE("reach: with a sun, the ground that reflects to what is seen", "[scene][reach]")
{
    // A wall on a ground without end: at height h, 1 - h / sqrt(h^2 + d^2) of what the ground sends comes from within d.
    Scene scene;
    addBox(addMesh(scene), Vec3(-2, 0, -0.2f), Vec3(2, 3, 0));
    addGround(scene, 0.0f, 1e4f);
    scene.lights.push_back(directionalLight(Vec3(-0.3f, -1, -0.5f), Vec3(3.0f)));
    scene.cameras.push_back(lookAt(Vec3(0, 1.5f, 5), Vec3(0, 1.2f, 0), Vec3(0, 1, 0), 0.8f));
    const Aabb sunlit = reachAfter(scene);
    const float h = 1.5f, d = sunlit.max.z;
    CHECK(1.0f - h / std::sqrt(h * h + d * d) > 0.88f);
    CHECK(sunlit.max.y == 3.0f);
    CHECK(sunlit.longestSide() < 100.0f);
    scene.lights[0].intensity = Vec3(0.0f);
    scene.lights.push_back(spotLight(Vec3(0, 3, 3), Vec3(0, 0, 0), Vec3(60.0f), 0.5f, 0.7f));
    CHECK(reachAfter(scene).longestSide() < 0.5f * sunlit.longestSide());
}

TEST_CASE("reach: what a camera sees far away is part of it when nothing nearer is", "[scene][reach]")
{
    // A leaf beside the camera, a house a hundred metres on, a sun.
    Scene scene;
    addQuad(addMesh(scene, true), Vec3(0.2f, 0.2f, -1), Vec3(0.4f, 0.2f, -1), Vec3(0.4f, 0.4f, -1), Vec3(0.2f, 0.4f, -1));
    addBox(addMesh(scene), Vec3(-30, -10, -130), Vec3(30, 30, -100));
    scene.lights.push_back(directionalLight(Vec3(0.3f, -1, -0.4f), Vec3(3.0f)));
    scene.cameras.push_back(lookAt(Vec3(0), Vec3(0, 0, -1), Vec3(0, 1, 0), 0.7f));
    CHECK(reachAfter(scene) == scene.bounds);
}

TEST_CASE("origin: translations that float32 holds exactly give the scene at 0, bit for bit", "[scene][reach][origin]")
{
    const Scene home = loadAt(glm::dvec3(0.0));
    CHECK(home.origin == glm::dvec3(0.0));
    CHECK(sameBits(loadAt({1.0, 2.0, -4.0}), home) == false);  // near 0: it keeps its own bits
    for (int power = 7; power <= 20; ++power) {
        const double far = std::ldexp(1.0, power);
        for (const glm::dvec3& there : {glm::dvec3(far, 0, 0), glm::dvec3(-far, 0, far), glm::dvec3(0, far, 2 * far)}) {
            INFO("2^" << power);
            const Scene scene = loadAt(there);
            CHECK(scene.origin == there);
            CHECK(sameBits(scene, home));
            if (power > 18) continue;  // 0.375 at 2^20 has its last bit at 2^-3
            const Scene byVertex = loadAt(glm::dvec3(0.0), Vec3(there));
            CHECK(byVertex.origin == there);
            CHECK(sameBits(byVertex, home));
        }
    }
}

TEST_CASE("origin: anywhere within 1e6 m no more is lost than a float at some reaches of the camera", "[scene][reach][origin]")
{
    const Scene home = loadAt(glm::dvec3(0.0));
    for (const double far : {1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6}) {
        const glm::dvec3 there(far + 0.3, -0.7 * far, 0.9 * far);
        const Scene scene = loadAt(there);
        for (std::size_t i = 0; i < home.meshes[0].positions.size(); ++i) {
            const glm::dvec3 error = worldPlace(scene, scene.meshes[0].positions[i]) - there - glm::dvec3(home.meshes[0].positions[i]);
            CHECK(glm::length(error) < 1e-5);
        }
    }
}

TEST_CASE("origin: what the file's own float32 has lost is said", "[scene][reach][origin]")
{
    const auto saysLost = [](const Scene& scene) {
        return std::any_of(scene.notes.begin(), scene.notes.end(),
                           [](const std::string& note) { return note.find("what was finer is lost") != std::string::npos; });
    };
    CHECK_FALSE(saysLost(loadAt({1e6, 0, 0})));
    CHECK_FALSE(saysLost(loadAt(glm::dvec3(0.0))));
    CHECK(saysLost(loadAt(glm::dvec3(0.0), Vec3(1e4f, 0, 0))));
}

TEST_CASE("origin: a view file's places are subtracted before they are rounded", "[scene][reach][origin]")
{
    const std::string text = R"({"camera": {"eye": [1000000.1, 2, 3], "target": [1000000.1, 2, 2]},
                                 "lights": [{"type": "point", "position": [1000000.3, 0.5, 0]}]})";
    const View view = parseView(text, "view.json", {1e6, 0, 0});
    CHECK(view.camera->position.x == Approx(0.1f).epsilon(1e-6));
    CHECK(view.lights->at(0).position.x == Approx(0.3f).epsilon(1e-6));
}

TEST_CASE("alpha: a mesh below its cutoff everywhere is drawn nowhere, and said so", "[scene][gltf]")
{
    GltfBuilder file;
    const auto load = [&](double alpha, const char* mode, float colorAlpha) {
        file.json["materials"] = {{{"alphaMode", mode}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, alpha}}}}}};
        file.primitive()["material"] = 0;
        file.attributes()["COLOR_0"] = file.add<float>({1, 1, 1, 0, 1, 1, 1, 0, 1, 1, 1, colorAlpha}, "VEC4", 5126);
        const Scene scene = file.load();
        const bool nowhere = isDrawnNowhere(scene, scene.meshes.at(0));
        CHECK((scene.notes.back() == "1 triangle drawn nowhere, and no obstacle to cones: alpha is below its cutoff everywhere") == nowhere);
        return nowhere;
    };
    CHECK_FALSE(load(0.6, "BLEND", 1.0f));
    CHECK(load(0.4, "BLEND", 1.0f));
    CHECK(load(0.6, "BLEND", 0.7f));
    CHECK_FALSE(load(0.5, "MASK", 1.0f));
    CHECK_FALSE(load(0.1, "OPAQUE", 1.0f));
}

TEST_CASE("pre-exposure: a power of two, 1 where light is ordinary, inverse to it elsewhere", "[scene][exposure]")
{
    Scene scene = *makeBuiltinScene("cornell-box");
    const float size = scene.bounds.extent().z;
    for (int power = -60; power <= 60; ++power) {
        scene.lights[0].intensity = Vec3(std::ldexp(1.5f * size * size, power));
        const float exposure = preExposureOf(scene);
        INFO("2^" << power);
        CHECK(exposure == (power >= -6 && power < 8 ? 1.0f : std::ldexp(1.0f, power < 0 ? -6 - power : -power)));
    }
    scene.lights[0].intensity = Vec3(0.0f);
    CHECK(preExposureOf(scene) == 1.0f);
    scene.lights[0].position.y = 1e9f;  // far off and as bright as it must be
    scene.lights[0].intensity = Vec3(1e18f);
    CHECK(preExposureOf(scene) == 1.0f);
}
