// One cone through a world made of numbers: the telescoping sum for `slab`, closed forms of Eq. 1 for `paper`. Both marches are held against twins in double
// in apps/validate/equations/march_checks.cpp.
#include "conetrace/lrsm/march_paper.h"
#include "conetrace/lrsm/march_slab.h"
#include "voxel/voxelize.h"

#include "apps/validate/equations/synthetic_maps.h"

#include "catch.h"

#include <cmath>

using namespace lrsm;

namespace {

using DVec3 = glm::dvec3;

constexpr float kVoxelSize = 0.25f;  // not 1: metres and voxels must not be mistaken for each other
constexpr int kResolution = 128;
const VoxelGrid kFrame{Vec3(-0.5f * kVoxelSize * kResolution), kVoxelSize, kResolution};

/// Unit vector at an angle from z.
Vec3 tilted(double cosine, double azimuth)
{
    const double sine = std::sqrt(1 - cosine * cosine);
    return Vec3(float(sine * std::cos(azimuth)), float(sine * std::sin(azimuth)), float(cosine));
}

/// The plane z = 0 of the world, lit from above by a sun whose map is large enough to have no borders near the grid.
/// Each texel is what the plane is at its centre.
Rsm litPlane(const Vec3& toLight, const Vec3& radiance, int resolution = 512)
{
    LightProjection q;
    const Mat3 axes = basisFromNormal(toLight);
    q.right = axes[0];
    q.up = axes[1];
    q.forward = -toLight;
    q.halfWidth = 64.0f;
    q.position = toLight * 200.0f;
    q.depthFar = 400.0f;
    q.resolution = resolution;
    return syntheticMap(q, [&](int x, int y) {
        const double across = (2.0 * (x + 0.5) / resolution - 1) * 64, up = (1 - 2.0 * (y + 0.5) / resolution) * 64;
        const DVec3 start = DVec3(q.position) + DVec3(q.right) * across + DVec3(q.up) * up;
        return MapTexel{.depth = float(start.z / double(toLight.z) / 400.0), .radiance = radiance, .normal = Vec3(0, 0, 1), .nDotL = toLight.z};
    });
}

struct MarchedWorld {
    OpacityPyramid opacity;
    std::vector<Lrsm> lrsms;
    ConeSettings settings;
    NormalCdf phi;

    MarchedWorld(const Rsm& rsm, const LayerSettings& layers, const ConeSettings& cones) : lrsms{buildLrsm(rsm, layers)}, settings(cones)
    {
        opacity.base.grid = kFrame;
        opacity.axes = cones.march.estimator == Estimator::slab ? OpacityAxes::directional : OpacityAxes::isotropic;
    }
    ConeWorld view() const { return {opacity, lrsms, settings, phi}; }

    template <class Sampler, class Recorder>
    ConeResult march(const Sampler& sampler, const ConeRay& ray, float tanHalf, ConeCounts& counts, Recorder& recorder) const
    {
        const MarchSchedule schedule = makeSchedule(settings, tanHalf, 1.74f * kResolution);
        MarchScratch scratch;
        return settings.march.estimator == Estimator::slab ? marchSlab(view(), sampler, ray, schedule, scratch, counts, recorder)
                                                           : marchPaper(view(), sampler, ray, schedule, scratch, counts, recorder);
    }
    template <class Sampler>
    ConeResult march(const Sampler& sampler, const ConeRay& ray, float tanHalf) const
    {
        NoRecorder recorder;
        ConeCounts counts;
        return march(sampler, ray, tanHalf, counts, recorder);
    }
};

ConeRay rayFrom(const Vec3& origin, const Vec3& direction)
{
    return {origin, kFrame.voxelsFromWorld(origin), direction, direction};
}

/// A ray that meets the plane z = 0 after `distance` metres, at (x, y).
ConeRay rayToPlane(const Vec3& toReceiver, float distance, float x = 0.3f, float y = -0.2f)
{
    return rayFrom(Vec3(x, y, 0) + distance * toReceiver, -toReceiver);
}

/// Occupied everywhere, yet too thin to dim anything: T stays 1 and every segment emits.
struct Mist {
    Vec3 operator()(const Vec3&, float) const { return Vec3(1e-20f); }
};

ConeSettings slabSettings(float step)
{
    ConeSettings settings;
    settings.march.step = step;
    return settings;
}

/// What float positions (ulp of 200 m in depth) over the tap's sigma, and the errors of two Phi a segment, can add up to.
constexpr double kTelescopeMaxError = 2e-4;
/// With fitted layers the tails beyond 3 sigma of a segment are skipped: 2 Phi(-3).
constexpr double kSkippedTails = 2.7e-3;

}  // namespace

TEST_CASE("slab: an infinite wall in thin air gives exactly L, for any step and angle of a narrow cone", "[conetrace][march][slab]")
{
    // Light along the wall's normal: the depth's variance is the tap's own and the w of consecutive segments telescope exactly.
    const Vec3 radiance(2.0f, 0.5f, 8.0f);
    MarchedWorld world(litPlane(Vec3(0, 0, 1), radiance), oneLayer(), ConeSettings{});
    for (const float step : {0.25f, 0.5f, 1.0f, 2.0f})
        for (const double cosine : {1.0, 0.7, 0.3})
            for (int i = 0; i < 8; ++i) {
                CAPTURE(step, cosine, i);
                world.settings.march.step = step;
                const ConeResult cone = world.march(Mist{}, rayToPlane(tilted(cosine, 0.4 + i), 3.0f + 0.117f * float(i)), 1e-4f);
                for (int c = 0; c < 3; ++c) REQUIRE(double(cone.radiance[c] / radiance[c]) == Approx(1).margin(kTelescopeMaxError));
            }
}

TEST_CASE("slab: fitted layers lose no more than the tails they skip", "[conetrace][march][slab]")
{
    LayerSettings fitted = oneLayer();
    fitted.fitRanges = true;
    MarchedWorld world(litPlane(Vec3(0, 0, 1), Vec3(1.0f)), fitted, ConeSettings{});
    for (const float step : {0.25f, 0.5f, 1.0f})
        for (const double cosine : {1.0, 0.5, 0.3}) {
            world.settings.march.step = step;
            const double got = double(world.march(Mist{}, rayToPlane(tilted(cosine, 1.0), 3.1f), 1e-4f).radiance.x);
            CAPTURE(step, cosine, got);
            CHECK(got > 1 - kSkippedTails - kTelescopeMaxError);
            CHECK(got < 1 + kTelescopeMaxError);
        }
}

TEST_CASE("slab: under slanted light narrow cones still give L in the mean, one ray strays with the phase of its texels", "[conetrace][march][slab]")
{
    // The plane's depth varies within a texel, by how much depends on where between texel centres a ray is: sigma changes from segment to segment.
    const double lightCosine = GENERATE(0.6, 0.25);
    const float step = GENERATE(0.25f, 1.0f);
    const MarchedWorld world(litPlane(tilted(lightCosine, 0.3), Vec3(1.0f)), oneLayer(), slabSettings(step));
    double sum = 0;
    int count = 0;
    for (const double cosine : {1.0, 0.7, 0.3})
        for (int i = 0; i < 24; ++i, ++count) {
            const ConeRay ray = rayToPlane(tilted(cosine, 0.26 * i), 3.0f + 0.117f * float(i % 7), 0.31f * float(i), 0.05f * float(i));
            const double got = double(world.march(Mist{}, ray, 1e-4f).radiance.x);
            REQUIRE(got == Approx(1).margin(0.25));
            sum += got;
        }
    CAPTURE(lightCosine, step);
    CHECK(sum / count == Approx(1).margin(0.015));
}

TEST_CASE("slab: a cone that widens keeps L in the mean within a few percent, more under grazing light, whatever the step", "[conetrace][march][slab]")
{
    // sigma grows with the tap, so neighbouring Phi no longer cancel to the last digit: a few percent too much.
    const double lightCosine = GENERATE(1.0, 0.6, 0.25);
    MarchedWorld world(litPlane(tilted(lightCosine, 0.3), Vec3(1.0f)), oneLayer(), ConeSettings{});
    for (const float step : {0.25f, 0.5f, 1.0f}) {
        world.settings.march.step = step;
        double sum = 0;
        for (int i = 0; i < 72; ++i) {
            const double cosine = 0.3 + 0.7 * ((i * 5) % 72) / 71.0;
            sum += double(world.march(Mist{}, rayToPlane(tilted(cosine, 0.26 * i), 3.0f + 0.117f * float(i % 7), 0.11f * float(i)), 0.3f).radiance.x);
        }
        CAPTURE(lightCosine, step, sum / 72);
        CHECK(sum / 72 == Approx(1).margin(lightCosine < 0.5 ? 0.15 : 0.06));
    }
}

TEST_CASE("slab: two lights add, a wall seen from its unlit side emits nothing", "[conetrace][march][slab]")
{
    MarchedWorld world(litPlane(Vec3(0, 0, 1), Vec3(2, 0, 0)), oneLayer(), slabSettings(0.5f));
    world.lrsms.push_back(buildLrsm(litPlane(Vec3(0, 0, 1), Vec3(0, 3, 0)), oneLayer()));
    const Vec3 sum = world.march(Mist{}, rayToPlane(tilted(0.8, 1.0), 3.0f), 1e-4f).radiance;
    CHECK(double(sum.x) == Approx(2).epsilon(kTelescopeMaxError));
    CHECK(double(sum.y) == Approx(3).epsilon(kTelescopeMaxError));
    const Vec3 below = tilted(0.8, 1.0) * Vec3(1, 1, -1);
    CHECK(world.march(Mist{}, rayToPlane(below, 3.0f), 1e-4f).radiance == Vec3(0.0f));
}

TEST_CASE("slab: a wall's own voxels stop the cone, and do not dim its light", "[conetrace][march][slab]")
{
    // The whole of `balanced`: real voxels, real pyramid, layers in Table 1's formats.
    const Vec3 a(-15, -15, 0), b(15, -15, 0), c(15, 15, 0), d(-15, 15, 0);
    const float step = GENERATE(0.25f, 0.5f);
    MarchedWorld world(litPlane(Vec3(0, 0, 1), Vec3(1.0f)), LayerSettings{}, slabSettings(step));
    VoxelSettings voxels;
    voxels.resolution = kResolution;
    world.opacity = buildPyramid(voxelizeTriangles({a, b, c, a, c, d}, kFrame, voxels.mode), voxels);
    const GenericSampler sampler{world.opacity, FilterFraction::exact};
    for (const double cosine : {1.0, 0.8, 0.6})
        for (int i = 0; i < 8; ++i) {
            const ConeResult cone = world.march(sampler, rayToPlane(tilted(cosine, 0.8 * i), 4.0f + 0.1f * float(i)), 0.2f);
            CAPTURE(step, cosine, i, cone.radiance.x, cone.opacity);
            CHECK(double(cone.radiance.x) == Approx(1).margin(0.1));
            CHECK(cone.opacity > 0.99f);
            // Before a wall twice as near, light from behind it is gone.
            const ConeResult behind = world.march(sampler, rayToPlane(tilted(cosine, 0.8 * i) * Vec3(1, 1, -1), 4.0f), 0.2f);
            CHECK(behind.radiance == Vec3(0.0f));
        }
}

namespace {

/// Opacity by step: what the i-th lookup of a march returns.
struct ByStep {
    std::vector<float> alpha;
    mutable std::size_t next = 0;
    Vec3 operator()(const Vec3&, float) const { return Vec3(next < alpha.size() ? alpha[next++] : 0.0f); }
};

/// `paper` with every term but the opacity at rest: V = 1 (a window far wider than the plane is away), N = 1, no cut-off.
ConeSettings paperSettings()
{
    ConeSettings settings;
    settings.march.estimator = Estimator::paper;
    settings.march.opacity = OpacityModel::none;
    settings.march.transmittanceCutoff = 0.0f;
    settings.gather.vRadiusScale = 16.0f;
    settings.march.minDiameterVoxels = 8.0f;
    settings.march.voxelLevelBias = 0.0f;
    return settings;
}

/// What the recorder of --pixel sees.
struct Tape {
    static constexpr bool active = true;
    std::vector<StepRecord> steps;
    int layers = 0;
    void step(const StepRecord& record) { steps.push_back(record); }
    void layer(int, const LayerTerms&, float) { ++layers; }
};

constexpr double kPaperMaxError = 2e-5;  // float sums of about ten terms, radiances interpolated in float

}  // namespace

TEST_CASE("Eq. 1: --pixel tells the march's own story, an empty step samples no light, and without a recorder the same bits come out",
          "[conetrace][march][eq1]")
{
    const MarchedWorld world(litPlane(Vec3(0, 0, 1), Vec3(40.0f, 20.0f, 60.0f)), oneLayer(), paperSettings());
    const std::vector<float> alphas = {0.1f, 0.0f, 0.4f, 0.25f, 0.9f, 0.05f, 0.5f, 0.3f};
    const ConeRay ray = rayFrom(Vec3(-6, 1, 3), glm::normalize(Vec3(0.8f, 0.1f, -0.3f)));
    Tape tape;
    ConeCounts counts;
    const ConeResult cone = world.march(ByStep{alphas}, ray, 0.05f, counts, tape);
    REQUIRE(tape.steps.size() == counts.steps);
    CHECK(counts.voxelTaps == counts.steps);
    CHECK(counts.lrsmSamples == 7);
    CHECK(tape.layers == 7);
    CHECK(tape.steps[0].transmittance == 1.0f);
    CHECK(double(tape.steps[3].transmittance) == Approx(0.9 * 0.6));
    CHECK(tape.steps[4].alpha == 0.9f);
    CHECK(world.march(ByStep{alphas}, ray, 0.05f).radiance == cone.radiance);
}

TEST_CASE("Eq. 1: a uniform medium of opacity a takes 1 - (1 - a)^n of a constant radiance", "[conetrace][march][eq1]")
{
    const MarchedWorld world(litPlane(Vec3(0, 0, 1), Vec3(5.0f)), oneLayer(), paperSettings());
    const ConeRay ray = rayFrom(Vec3(-6, 1, 3), glm::normalize(Vec3(0.8f, 0.1f, -0.3f)));
    for (const float a : {0.02f, 0.2f, 0.7f, 1.0f})
        for (const int n : {1, 3, 9}) {
            const ConeResult cone = world.march(ByStep{std::vector<float>(std::size_t(n), a)}, ray, 0.05f);
            const double covered = 1 - std::pow(1 - double(a), n);
            CAPTURE(a, n);
            CHECK(double(cone.radiance.x) == Approx(5 * covered).epsilon(kPaperMaxError));
            CHECK(double(cone.opacity) == Approx(covered).epsilon(kPaperMaxError));
        }
}

TEST_CASE("Eq. 1: the cut-off ends a cone that has nothing left to gather, and loses less than it says", "[conetrace][march][eq1]")
{
    ConeSettings settings = paperSettings();
    settings.march.transmittanceCutoff = 0.01f;
    const MarchedWorld world(litPlane(Vec3(0, 0, 1), Vec3(1.0f)), oneLayer(), settings);
    NoRecorder recorder;
    ConeCounts counts;
    const ConeResult cone =
        world.march(ByStep{std::vector<float>(20, 0.7f)}, rayFrom(Vec3(-6, 1, 3), glm::normalize(Vec3(0.8f, 0.1f, -0.3f))), 0.05f, counts, recorder);
    CHECK(counts.steps == 4);  // 0.3^4 = 0.0081 is the first below 0.01
    CHECK(double(cone.radiance.x) == Approx(1 - std::pow(0.3, 4)).epsilon(kPaperMaxError));
}

TEST_CASE("density along a cone: the value itself, or area densities weighted by the direction, whatever its signs", "[conetrace][march]")
{
    OpacityPyramid pyramid;
    CHECK(sumOf(coveredAlong(pyramid, Vec3(0.3f), Vec3(0, -0.6f, 0.8f))) == 0.3f);
    pyramid.axes = OpacityAxes::directional;
    CHECK(double(sumOf(coveredAlong(pyramid, Vec3(0.5f, 0.25f, 1.0f), Vec3(0, -0.6f, 0.8f)))) == Approx(0.6 * 0.25 + 0.8));
}
