#include "../reference/reference_scenes.h"
#include "apps/validate/ladder/cone_opacity.h"
#include "apps/validate/ladder/surface_integral.h"
#include "catch.h"
#include "voxel/voxelize.h"

#include <cmath>

using namespace lrsm;
using namespace lrsm::test;

namespace {

SurfaceIntegral integrate(const Scene& scene, const ConeSample& sphere, int side = 64)
{
    const EmbreeScene embree(scene);
    std::vector<LightSampler> lights;
    for (const Light& light : scene.lights) lights.emplace_back(light);
    Tracer tracer(embree, lights);
    return integrateSurface(tracer, sphere, side, {1, 2, 3});
}

Mesh floorTo(float x0, float x1, int material)
{
    return rectangle({x0, 0.0f, -10.0f}, {0.0f, 0.0f, 20.0f}, {x1 - x0, 0.0f, 0.0f}, material);
}

}  // namespace

TEST_CASE("Eq. 2: an infinite lit plane gives rho E <n.l> / pi from any side and height, all lights added", "[ladder][eq2]")
{
    const Vec3 toLight = glm::normalize(Vec3(0.3f, 1.0f, 0.2f));
    const Scene scene = makeScene({floorTo(-10, 10, 0)}, {diffuse(Vec3(0.6f, 0.3f, 0.1f))}, {sun(-toLight, 5.0f), sun({0, -1, 0}, 2.0f)});
    const Vec3 toReceiver = glm::normalize(GENERATE(Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(0.2f, 0.1f, -1.0f)));
    const float height = GENERATE(0.0f, 0.3f, -0.4f);
    const SurfaceIntegral at = integrate(scene, {Vec3(0.1f, height, 0.4f), 0.5f, toReceiver}, 16);
    const double expected = 0.6 / 3.14159265358979 * (5.0 * double(toLight.y) + 2.0);
    CHECK(double(at.radiance.x) == Approx(expected).epsilon(1e-5));
    CHECK(double(at.radiance.z) == Approx(expected / 6.0).epsilon(1e-5));
    CHECK(at.coverage > 0.0);
    CHECK(at.noise < 1e-5 * expected);
}

TEST_CASE("Eq. 2: surfaces share by projected area <n.v> dA, hidden and shadowed ones as Eq. 2 says", "[ladder][eq2]")
{
    // Floor and wall meet at x = 0 in the sphere's centre; seen from (-sin, cos).
    const double angle = GENERATE(0.4, 0.8, 1.2);
    const Vec3 toReceiver(static_cast<float>(-std::sin(angle)), static_cast<float>(std::cos(angle)), 0.0f);
    const Mesh wall = rectangle({0.0f, 0.0f, -10.0f}, {0.0f, 0.0f, 20.0f}, {0.0f, 10.0f, 0.0f}, 1);
    const Vec3 toLight = glm::normalize(Vec3(-1.0f, 1.0f, 0.0f));
    const Scene corner = makeScene({floorTo(-10, 0, 0), wall}, {diffuse(Vec3(0.8f)), diffuse(Vec3(0.2f))}, {sun(-toLight, 3.0f)});
    const SurfaceIntegral at = integrate(corner, {Vec3(0.0f), 0.5f, toReceiver});
    const double lit = 3.0 / 3.14159265358979 * std::sqrt(0.5), f = std::cos(angle), w = std::sin(angle);
    CHECK(double(at.radiance.x) == Approx(lit * (0.8 * f + 0.2 * w) / (f + w)).epsilon(0.01));
    CHECK(at.noise < 0.01 * lit);

    // A shelf well inside the sphere hides the floor below it and shades it: what is seen is the shelf.
    const Mesh shelf = rectangle({-10.0f, 0.2f, -10.0f}, {0.0f, 0.0f, 20.0f}, {20.0f, 0.0f, 0.0f}, 1);
    const Scene stacked = makeScene({floorTo(-10, 10, 0), shelf}, {diffuse(Vec3(0.8f)), diffuse(Vec3(0.2f))}, {sun({0, -1, 0}, 3.0f)});
    const SurfaceIntegral above = integrate(stacked, {Vec3(0.0f), 1.0f, Vec3(0, 1, 0)}), below = integrate(stacked, {Vec3(0.0f), 1.0f, Vec3(0, -1, 0)});
    // At the rim, beyond radius sqrt(1 - 0.2^2), the sphere holds floor but no shelf: there it is the floor in the shelf's shade.
    CHECK(double(above.radiance.x) == Approx(0.96 * 0.2 * 3.0 / 3.14159265358979).epsilon(0.005));
    CHECK(above.coverage == 1.0);
    CHECK(below.radiance.x == 0.0f);  // the floor's underside
    CHECK(below.coverage == 1.0);
}

TEST_CASE("Eq. 2: no surface in the sphere is told apart from a dark one, backs of single-sided surfaces are none", "[ladder][eq2]")
{
    const Scene scene = makeScene({floorTo(-10, 10, 0)}, {diffuse(Vec3(0.5f), false)}, {sun({0, -1, 0}, 1.0f)});
    CHECK(integrate(scene, {Vec3(0.0f, 1.0f, 0.0f), 0.9f, Vec3(0, 1, 0)}).coverage == 0.0);
    CHECK(integrate(scene, {Vec3(0.0f, 0.5f, 0.0f), 0.9f, Vec3(0, -1, 0)}).coverage == 0.0);
    CHECK(integrate(scene, {Vec3(0.0f, 0.5f, 0.0f), 0.9f, Vec3(0, 1, 0)}).coverage == Approx(1.0 - 0.25 / 0.81).margin(0.01));
}

TEST_CASE("a beam sees the first surface within its length: all of it, the part that is there, or nothing", "[ladder][emission]")
{
    const Scene scene = makeScene({floorTo(0, 10, 0)}, {diffuse(Vec3(0.5f))}, {sun({0, -1, 0}, 2.0f)});
    const EmbreeScene embree(scene);
    const std::vector<LightSampler> lights(1, LightSampler(scene.lights[0]));
    Tracer tracer(embree, lights);
    const double lit = 1.0 / 3.14159265358979;
    const auto emission = [&](const Beam& beam) { return double(integrateBeam(tracer, beam, 32, {1, 2, 3}).y); };
    CHECK(emission({Vec3(5, 1, 0), Vec3(0, -1, 0), 0.5f, 1.5f}) == Approx(lit).epsilon(1e-5));
    CHECK(emission({Vec3(5, 1, 0), Vec3(0, -1, 0), 0.5f, 0.9f}) == 0.0);
    CHECK(emission({Vec3(0, 1, 0), Vec3(0, -1, 0), 0.5f, 1.5f}) == Approx(0.5 * lit).epsilon(0.02));  // the floor begins at x = 0
    const float root = 0.70710678f;
    CHECK(emission({Vec3(5, 1, 0), Vec3(root, -root, 0), 0.3f, 1.0f / root}) == Approx(0.5 * lit).epsilon(0.02));  // ends on the floor in its middle
    CHECK(emission({Vec3(5, -1, 0), Vec3(0, 1, 0), 0.5f, 1.5f}) == 0.0);                                           // its underside is dark
}

TEST_CASE("opacity by rays: a cone that faces a wall is blocked by the solid angle that has reached it", "[ladder][eq1]")
{
    const Scene scene = makeScene({rectangle({-20, -20, 2}, {0, 40, 0}, {40, 0, 0}), rectangle({-20, -20, -2}, {0, 40, 0}, {40, 0, 0})}, {diffuse(Vec3(0.5f))},
                                  {sun({0, -1, 0}, 1.0f)});
    VoxelSettings voxels;
    voxels.resolution = 64;
    const OpacityPyramid opacity = buildPyramid(voxelize(scene, voxels), voxels);
    const float voxelSize = opacity.base.grid.voxelSize;
    ConeSettings cones;
    cones.march.estimator = Estimator::paper;
    const NormalCdf phi;
    const ConeWorld world{opacity, {}, cones, phi};
    RecordedSample sample;
    sample.ray = {Vec3(0.0f), opacity.base.grid.voxelsFromWorld(Vec3(0.0f)), Vec3(0, 0, 1), Vec3(0, 0, 1)};
    sample.tanHalf = 0.57735027f;
    sample.after = 0.25;
    const double reach = GENERATE(1.5, 2.1, 2.25, 4.0);  // metres; the wall is 2 m ahead, 2.31 m at the cone's rim
    MarchStep step;
    step.middle = step.begin = static_cast<float>(reach * 0.9) / voxelSize;
    step.end = static_cast<float>(reach) / voxelSize;
    sample.steps = &step;
    const EmbreeScene embree(scene);
    const ConeOpacity at = coneOpacity(world, embree, sample, 64, {1, 2, 3});
    const double cosHalf = std::sqrt(0.75), expected = std::clamp((1.0 - 2.0 / reach) / (1.0 - cosHalf), 0.0, 1.0);
    CHECK(at.rays == Approx(expected).margin(0.01));
    CHECK(at.voxelRays == Approx(expected).margin(2.0 * double(voxelSize)));  // the wall's voxels begin up to a voxel before it
    CHECK(at.cone == Approx(0.75));
}

TEST_CASE("a box is the mean of the voxels in it, by their exact share, a wall keeps its area density along each axis", "[ladder][eq1]")
{
    const Scene wall = makeScene({rectangle({-20, -20, 0.3f}, {0, 40, 0}, {40, 0, 0}), rectangle({-20, -20, -20}, {0, 1e-3f, 0}, {1e-3f, 0, 0}),
                                  rectangle({19, 19, 20}, {0, 1e-3f, 0}, {1e-3f, 0, 0})},
                                 {diffuse(Vec3(0.5f))}, {sun({0, -1, 0}, 1.0f)});
    VoxelSettings voxels;
    voxels.resolution = 64;
    voxels.storage = Storage::float32;
    voxels.axes = OpacityAxes::isotropic;
    const OpacityPyramid iso = buildPyramid(voxelize(wall, voxels), voxels);
    const Vec3 p = iso.base.grid.voxelsFromWorld(Vec3(0.7f, -1.1f, 0.3f));
    const double level = GENERATE(0.0, 0.4, 1.0, 2.3, 3.0, 4.6);
    const double edge = std::exp2(level);
    double mean = 0.0;  // by brute force over the bits
    for (int z = 0; z < 64; ++z) {
        const double share = std::max(0.0, std::min(double(p.z) + edge / 2, z + 1.0) - std::max(double(p.z) - edge / 2, double(z))) / edge;
        mean += iso.base.occupied(int(p.x), int(p.y), z) ? share : 0.0;
    }
    CHECK(mean > 0.0);
    CHECK(boxDensity(iso, p, level, Vec3(0, 0, 1)) == Approx(mean).epsilon(1e-6));

    voxels.axes = OpacityAxes::directional;
    const OpacityPyramid directional = buildPyramid(voxelize(wall, voxels), voxels);
    if (edge > 16.0)  // a wall across the box: area density 1 over its length, wherever in its block of 8 it is
        CHECK(boxDensity(directional, p, level, Vec3(0, 0, 1)) * edge == Approx(1.0).margin(0.05));
    CHECK(boxDensity(directional, p + Vec3(0, 0, 30), level, Vec3(0, 0, 1)) < 0.1);
}
