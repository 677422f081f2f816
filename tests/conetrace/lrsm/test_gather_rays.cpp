#include "conetrace/lrsm/gather_rays.h"

#include "conetrace/lrsm/hit_radiance.h"
#include "conetrace/render.h"
#include "core/base/parallel.h"
#include "core/scene/builtin_scenes.h"
#include "voxel/voxelize.h"

#include "catch.h"

using namespace lrsm;

namespace {

constexpr double kPiExact = 3.14159265358979;

Settings raySettings(Visibility visibility)
{
    Settings s;
    s.voxel.resolution = 128;
    s.rsm.resolution = 512;
    s.cones.march.visibility = visibility;
    s.cones.march.startVoxels = 1.5f;
    s.cones.set.count = 64;
    s.cones.set.setsPerPixel = 16;
    s.cones.set.apertureScale = 0.05f;
    return s;
}

Mesh sheet(const Vec3& corner, const Vec3& a, const Vec3& b)
{
    Mesh mesh;
    mesh.positions = {corner, corner + a, corner + a + b, corner + b};
    mesh.normals.assign(4, glm::normalize(glm::cross(a, b)));
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

/// Form factor from a point to a rectangle a x b parallel to its plane, at distance c, with one corner on the point's normal (Siegel and Howell).
double parallelCorner(double a, double b, double c)
{
    const double x = a / c, y = b / c;
    return (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) + y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y))) / (2 * kPiExact);
}

/// A diffuse ceiling lit from below by the sun, and a receiver too small to shade it.
Scene litCeiling()
{
    Scene scene;
    Material white;
    white.name = "white";
    white.baseColor = Vec4(0.8f, 0.8f, 0.8f, 1.0f);
    white.metallic = 0.0f;
    white.doubleSided = true;
    scene.materials = {white};
    scene.meshes = {sheet({-0.5f, 1, -0.4f}, {2, 0, 0}, {0, 0, 1.1f})};
    for (const Mesh& mesh : scene.meshes)
        for (const Vec3& p : mesh.positions) scene.bounds.include(p);
    scene.bounds.include(Vec3(-0.6f, -0.1f, -0.6f));
    scene.reach = scene.bounds;
    Light sun;
    sun.type = LightType::directional;
    sun.direction = Vec3(0, 1, 0);
    sun.up = Vec3(1, 0, 0);
    sun.intensity = Vec3(2.0f);
    scene.lights = {sun};
    return scene;
}

GBuffer onePoint(const Vec3& position, const Vec3& normal)
{
    GBuffer g;
    g.width = g.height = 1;
    g.position = Image<Vec3>(1, 1, position);
    g.geometricNormal = g.normal = Image<Vec3>(1, 1, normal);
    g.objectId = Image<std::uint32_t>(1, 1, 1u);
    return g;
}

}  // namespace

TEST_CASE("rays: a point facing a parallel lit rectangle collects its form factor", "[rays][closed-form]")
{
    const Scene scene = litCeiling();
    const bool voxels = GENERATE(false, true);
    Settings settings = raySettings(voxels ? Visibility::voxelRays : Visibility::rays);
    settings.voxel.resolution = 256;
    const Requirements needs = analyseRequirements(scene, {});
    const PassWatch nobody{.hashPasses = false, .progress = {}, .observe = {}};
    PassLog log(nobody);
    const std::vector<Lrsm> lrsms = buildLrsms({renderRsm(scene, scene.lights[0], needs, settings.rsm)}, settings.layers, log);
    const GBuffer receiver = onePoint(Vec3(0.0f), Vec3(0, 1, 0));
    const Gathered gathered = voxels ? traceVoxelRays(receiver, {}, buildPyramid(voxelize(scene, settings.voxel), settings.voxel), lrsms, needs, settings.cones)
                                     : traceRays(receiver, {}, EmbreeScene(scene, RayKinds::bounces), lrsms, needs, settings.cones);
    const double radiance = 0.8 * 2.0 / kPiExact;
    const double factor = parallelCorner(1.5, 0.7, 1) + parallelCorner(1.5, 0.4, 1) + parallelCorner(0.5, 0.7, 1) + parallelCorner(0.5, 0.4, 1);
    CHECK(double(gathered.irradiance.texels[0].y) == Approx(kPiExact * radiance * factor).epsilon(voxels ? 0.04 : 0.03));  // less: lookups over the rim
    CHECK(double(gathered.opacity.texels[0]) == Approx(factor).epsilon(voxels ? 0.04 : 0.01));
}

TEST_CASE("rays: in the furnace everything is lit alike, at any footprint", "[rays][furnace]")
{
    const Scene scene = *makeBuiltinScene("furnace");  // E = 0.5 W/m^2 on the inside of the sphere
    const Visibility visibility = GENERATE(Visibility::rays, Visibility::voxelRays);
    Settings settings = raySettings(visibility);
    settings.rsm.resolution = 256;  // six maps
    settings.cones.set.count = 16;
    settings.cones.set.apertureScale = GENERATE(0.02f, 0.2f);
    RenderOptions options{.width = 16, .height = 9, .lanes = 0, .watch = {.hashPasses = false, .progress = {}, .observe = {}}, .method = {}};
    const Frame frame = renderFrame(scene, scene.cameras.at(0), settings, options);
    CAPTURE(int(visibility), settings.cones.set.apertureScale);
    for (const Vec3& e : frame.irradiance.texels) CHECK(double(e.y) == Approx(0.5).epsilon(0.1));
}

TEST_CASE("rays: what lies deeper than the lit depths is in shadow, what faces away is dark, and a lit plane keeps all of its light", "[rays]")
{
    Scene scene = litCeiling();
    scene.meshes = {sheet({-2, 0, 0}, {0, 0, 4}, {4, 0, 0}), sheet({-0.5f, 1, 1.5f}, {0, 0, 1}, {1, 0, 0})};  // a table over a floor
    scene.bounds = {};
    for (const Mesh& mesh : scene.meshes)
        for (const Vec3& p : mesh.positions) scene.bounds.include(p);
    scene.reach = scene.bounds;
    scene.lights[0].direction = Vec3(0, -1, 0);
    const Settings settings = raySettings(Visibility::rays);
    const Requirements needs = analyseRequirements(scene, {});
    const PassWatch nobody{.hashPasses = false, .progress = {}, .observe = {}};
    PassLog log(nobody);
    const std::vector<Lrsm> lrsms = buildLrsms({renderRsm(scene, scene.lights[0], needs, settings.rsm)}, settings.layers, log);
    const MapView map(lrsms[0]);
    const NormalCdf phi;
    std::uint64_t samples = 0;
    const auto light = [&](const Vec3& position, const Vec3& direction, float footprint) {
        const LrsmProbe probe{.position = position, .direction = glm::normalize(direction), .footprint = footprint};
        return lrsmRadiance(map, probe, settings.cones, phi, samples).y;
    };
    const float lit = 0.8f * 2.0f / float(kPiExact);
    for (const float footprint : {0.0f, 0.1f, 0.3f}) {
        CHECK(light({-1.2f, 0, 2}, {1, -1, 0}, footprint) == Approx(lit).epsilon(0.02));
        CHECK(light({0, 1, 2}, {1, -1, 0}, footprint) == Approx(lit).epsilon(0.02));
        CHECK(light({0, 0, 2}, {1, -1, 0}, footprint) < 0.01f * lit);
        CHECK(light({0, 1, 2}, {1, 1, 0}, footprint) == 0.0f);
    }
}

TEST_CASE("rays: the same bits with 1 and 2 threads, specular too", "[rays][determinism]")
{
    const auto scene = makeBuiltinScene("cornell-glossy");
    Settings settings = raySettings(GENERATE(Visibility::rays, Visibility::voxelRays));
    settings.cones.set.count = 6;
    settings.cones.set.setsPerPixel = 1;
    RenderOptions options{.width = 40, .height = 30, .lanes = 0, .watch = {.hashPasses = true, .progress = {}, .observe = {}}, .method = {}};
    std::vector<std::string> first;
    for (const int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        std::vector<std::string> hashes;
        for (const PassReport& pass : renderFrame(*scene, scene->cameras.at(0), settings, options).passes) hashes.push_back(pass.sha256);
        if (first.empty()) first = hashes;
        CHECK(hashes == first);
    }
}
