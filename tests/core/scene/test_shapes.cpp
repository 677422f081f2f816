#include "core/scene/builtin_scenes.h"
#include "core/scene/light.h"
#include "core/scene/shapes.h"

#include "catch.h"

#include <random>

using namespace lrsm;

namespace {

/// Signed volume by the divergence theorem: positive when all faces look outward.
double signedVolume(const Mesh& mesh)
{
    double volume = 0;
    for (const auto& [a, b, c] : mesh.triangles) volume += double(glm::dot(glm::cross(mesh.positions[a], mesh.positions[b]), mesh.positions[c])) / 6;
    return volume;
}

void checkNormalsAgreeWithWinding(const Mesh& mesh)
{
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 face = glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
        for (const std::uint32_t v : {a, b, c}) REQUIRE(glm::dot(face, mesh.normals[v]) > 0.0f);
    }
}

}  // namespace

TEST_CASE("shapes: closed ones enclose their volume, outward or inward", "[core][shapes]")
{
    const bool inward = GENERATE(false, true);
    const double sign = inward ? -1 : 1;
    Mesh box, sphere;
    addBox(box, Vec3(1, 2, 3), Vec3(2, 4, 6), inward);
    addSphere(sphere, Vec3(3, -1, 2), 2.0f, 5, inward);
    CHECK(signedVolume(box) == Approx(sign * 6));
    CHECK(signedVolume(sphere) == Approx(sign * 4.0 / 3.0 * 3.14159265 * 8).epsilon(0.002));
    checkNormalsAgreeWithWinding(box);
    checkNormalsAgreeWithWinding(sphere);

    if (!inward) {
        Mesh prism, column;
        const std::array<Vec2, 3> outline = {Vec2(0, 0), Vec2(0, 2), Vec2(3, 0)};
        addPrism(prism, outline, 1.0f, 5.0f);
        addColumn(column, Vec3(1, 0, 1), 0.5f, 2.0f, 12);
        CHECK(signedVolume(prism) == Approx(12));
        checkNormalsAgreeWithWinding(prism);
        checkNormalsAgreeWithWinding(column);
    }
}

TEST_CASE("built-in scenes are well-formed", "[core][builtin]")
{
    for (const auto& info : builtinScenes()) {
        CAPTURE(info.name);
        const auto scene = makeBuiltinScene(info.name);
        REQUIRE(scene);
        CHECK(!scene->lights.empty());
        CHECK(scene->cameras.size() == 1);
        CHECK(!scene->bounds.empty());
        for (const Mesh& mesh : scene->meshes) {
            REQUIRE(mesh.normals.size() == mesh.positions.size());
            REQUIRE(std::size_t(mesh.material) < scene->materials.size());
            checkNormalsAgreeWithWinding(mesh);
        }
    }
    CHECK(!makeBuiltinScene("no-such-scene"));
}

TEST_CASE("light: the six faces of a point light are exactly the point light, each direction in one face", "[core][light]")
{
    std::mt19937 random(3);
    std::uniform_int_distribution<int> coordinate(-3, 3);  // small integers: many ties between axes
    const auto faces = splitPointLight(Vec3(0.5f, 1.0f, -2.0f), Vec3(3, 2, 1), kInfinity, "point");
    for (int i = 0; i < 2000; ++i) {
        const Vec3 d(coordinate(random), coordinate(random), coordinate(random));
        if (d == Vec3(0.0f)) continue;
        int lit = 0;
        for (const Light& face : faces) {
            const LightSample s = sampleLight(face, face.position + d);
            if (s.irradiance == Vec3(0.0f)) continue;
            ++lit;
            CHECK(s.irradiance.x == Approx(3.0f / glm::dot(d, d)));
            // Inside the 90-degree frustum: the forward component is not below the others.
            CHECK(glm::dot(d, face.direction) >= std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}));
        }
        REQUIRE(lit == 1);
    }
}

TEST_CASE("light: spot falls off as KHR_lights_punctual says, by inverse square, and stops at its range", "[core][light]")
{
    Light spot = spotLight(Vec3(0), Vec3(0, -1, 0), Vec3(8), 0.3f, 0.6f);
    CHECK(sampleLight(spot, Vec3(0, -2, 0)).irradiance.x == Approx(2.0f));
    for (const double angle : {0.0, 0.29, 0.35, 0.45, 0.59, 0.61, 1.5}) {
        const Vec3 p(float(std::sin(angle)), -float(std::cos(angle)), 0);
        const double t = std::clamp((std::cos(angle) - std::cos(0.6)) / (std::cos(0.3) - std::cos(0.6)), 0.0, 1.0);
        CHECK(sampleLight(spot, p).irradiance.y == Approx(8 * t * t).margin(2e-5));
    }
    spot.range = 2.0f;
    CHECK(sampleLight(spot, Vec3(0, -1, 0)).irradiance.x == Approx(8.0f * (1 - 1.0f / 16)));
    CHECK(sampleLight(spot, Vec3(0, -2.5f, 0)).irradiance.x == 0.0f);
    CHECK(sampleLight(spot, Vec3(0)).irradiance == Vec3(0.0f));
    const LightSample sun = sampleLight(directionalLight(Vec3(0, -2, 0), Vec3(5)), Vec3(1e6f));
    CHECK(sun.toLight == Vec3(0, 1, 0));
    CHECK(sun.irradiance == Vec3(5));
}
