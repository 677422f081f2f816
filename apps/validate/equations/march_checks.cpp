// Eq. 1: the sum along a cone by both estimators, and what it stands on: schedule, step opacity, transmittance.
#include "conetrace/lrsm/march_paper.h"
#include "conetrace/lrsm/march_slab.h"

#include "apps/validate/equations/check_run.h"
#include "apps/validate/equations/equation_inputs.h"
#include "apps/validate/equations/march_twin.h"
#include "apps/validate/equations/synthetic_maps.h"

namespace lrsm {
namespace {

constexpr float kVoxelSize = 0.25f;  // not 1: metres and voxels must not be mistaken for each other
constexpr int kResolution = 64;
constexpr double kLargestRadiance = 3.0;

/// A wavy lit surface about y = 0, smooth in every attribute: nothing but the march's own arithmetic is under test.
Rsm wavyMap(const LightProjection& projection)
{
    const int n = projection.resolution;
    return syntheticMap(projection, [n](int x, int y) {
        const double a = 6.2831853 * x / n, b = 6.2831853 * y / n;
        const Vec3 normal = glm::normalize(Vec3(float(0.3 * std::cos(a)), 1.0f, float(0.3 * std::sin(b))));
        return MapTexel{.depth = static_cast<float>(0.5 + 0.03 * std::sin(a) + 0.02 * std::cos(b)),
                        .radiance = Vec3(float(2.0 + std::sin(a)), float(1.0 + 0.5 * std::cos(b)), 1.0f),
                        .normal = normal,
                        .nDotL = normal.y};
    });
}

/// The map's middle and reach are those of the grid: 16 m about the origin.
LightProjection lightOf(bool spot)
{
    LightProjection p = spot ? spotOverCube(64) : sunOverCube(64);
    p.position = spot ? Vec3(3.0f, 20.0f, 2.0f) : Vec3(0.0f, 10.0f, 0.0f);
    if (spot) {
        p.forward = glm::normalize(-p.position);
        p.right = glm::normalize(glm::cross(p.forward, Vec3(0.0f, 0.0f, 1.0f)));
        p.up = glm::cross(p.right, p.forward);
        p.depthNear = 10.0f, p.depthFar = 30.0f;
    } else {
        p.halfWidth = 16.0f, p.depthFar = 20.0f;
    }
    return p;
}

struct MarchCase {
    ConeSettings cones;
    OpacityAxes axes = OpacityAxes::directional;
    bool spot = false;
    int depthLayers = 1;
    bool fitRanges = true;
};

std::vector<MarchCase> casesOf(Estimator estimator)
{
    std::vector<MarchCase> cases;
    for (int i = 0; i < 6; ++i) {
        MarchCase c;
        ConeSettings& s = c.cones;
        s.march.estimator = estimator;
        s.march.step = i % 2 ? 0.5f : 0.25f;
        s.march.transmittanceCutoff = i == 2 ? 0.0f : 0.01f;
        s.march.transmittance = i % 3 == 1 ? TransmittanceModel::exponential : TransmittanceModel::linear;
        s.march.densityK = 1.5f;
        c.spot = i % 2 == 1;
        c.depthLayers = 1 + i % 3;
        c.axes = i % 3 == 2 ? OpacityAxes::isotropic : OpacityAxes::directional;
        if (estimator == Estimator::slab) {
            s.gather.emitterDelayTaps = i == 3 ? 4.5f : 3.0f;
            s.gather.emitterSlantCap = i == 3 ? 0.25f : 0.5f;
        } else {
            s.march.opacity = i % 2 ? OpacityModel::density : OpacityModel::none;
            s.march.voxelLevelBias = -1.0f;
            s.march.push = i == 4 ? 0.75f : 0.0f;
            s.gather.backface = Backface::cosine;
            s.gather.layerSelection = LayerSelection::touched;
            s.march.minDiameterVoxels = 2.0f;
        }
        cases.push_back(c);
    }
    return cases;
}

/// The kernel's and the twin's cone from one random ray of a case.
struct MarchWorld {
    OpacityPyramid opacity;
    std::vector<Lrsm> lrsms;
    ConeSettings settings;
    NormalCdf phi;
    twin::OpacityField field;

    explicit MarchWorld(const MarchCase& c) : settings(c.cones)
    {
        opacity.base.grid = {Vec3(-0.5f * kVoxelSize * kResolution), kVoxelSize, kResolution};
        opacity.axes = c.axes;
        LayerSettings layers = layersOf(c.depthLayers, 1);
        layers.fitRanges = c.fitRanges;
        lrsms.push_back(buildLrsm(wavyMap(lightOf(c.spot)), layers));
        if (c.depthLayers == 2) lrsms.push_back(buildLrsm(wavyMap(lightOf(false)), layers));
    }
    ConeWorld view() const { return {opacity, lrsms, settings, phi}; }
};

/// Start height and sideways place in metres, polar and azimuth of the way down, aperture.
struct Aim {
    ConeRay ray;
    float tanHalf;
};
Aim aimOf(const std::array<float, 5>& in)
{
    const float sine = std::sqrt(std::max(0.0f, 1.0f - in[2] * in[2]));
    const Vec3 direction = glm::normalize(Vec3(sine * std::cos(in[3]), -in[2], sine * std::sin(in[3])));
    const Vec3 origin(in[1], in[0], -0.3f * in[1]);
    return {{origin, (origin + Vec3(0.5f * kVoxelSize * kResolution)) / kVoxelSize, direction, glm::normalize(Vec3(0.2f, -1.0f, 0.1f))}, in[4]};
}

struct MarchRow {
    const char *function, *domain;
    NamedBound bound;
};

void checkMarch(CheckRun& run, Estimator estimator, const std::vector<MarchCase>& cases, const MarchRow& row)
{
    const bool slab = estimator == Estimator::slab;
    Worst<float, 5> worst;
    std::string at;
    int index = 0;
    double nanoseconds = 0.0;
    for (const MarchCase& c : cases) {
        const MarchWorld world(c);
        const twin::FieldSampler sampler{world.field};
        const float reach = 1.74f * kResolution;
        const auto kernel = [&](const Aim& aim, const MarchSchedule& schedule) {
            MarchScratch scratch;
            NoRecorder recorder;
            ConeCounts counts;
            return slab ? marchSlab(world.view(), sampler, aim.ray, schedule, scratch, counts, recorder)
                        : marchPaper(world.view(), sampler, aim.ray, schedule, scratch, counts, recorder);
        };
        const SearchSpace<float, 5> space{{{{0.5f, 5.0f}, {-4.0f, 4.0f}, {0.2f, 1.0f}, {0.0f, 6.2831853f}, {0.02f, 0.6f}}}, {}};
        const auto found = findWorst(
            space, run.budget(2500),
            [&](const auto& in) {
                const Aim aim = aimOf(in);
                const MarchSchedule schedule = makeSchedule(world.settings, aim.tanHalf, reach);
                const twin::March exact =
                    slab ? twin::marchSlab(world.view(), world.field, aim.ray, schedule) : twin::marchPaper(world.view(), world.field, aim.ray, schedule);
                if (exact.toJump < 1e-5) return -1.0;
                const ConeResult got = kernel(aim, schedule);
                double error = std::abs(double(got.opacity) - exact.opacity);
                for (int k = 0; k < 3; ++k) error = std::max(error, std::abs(double(got.radiance[k]) - exact.radiance[k]) / kLargestRadiance);
                return error;
            },
            710 + static_cast<std::uint32_t>(index) + (slab ? 20u : 0u));
        if (found.error > worst.error)
            at = "case " + std::to_string(index) + ", " + inputText<float, 5>({"height", "x", "cosine", "azimuth", "tanHalf"}, found.input);
        worst.include(found);
        if (index == 0) {
            const MarchSchedule schedule = makeSchedule(world.settings, 0.3f, reach);
            nanoseconds = run.time(16, [&](std::size_t i) { return kernel(aimOf({2.0f, float(i) * 0.2f, 0.8f, 1.0f, 0.3f}), schedule).radiance.x; });
        }
        ++index;
    }
    run.add({.equation = "1",
             .function = row.function,
             .oracle = slab ? "segments and emission integral in double (docs/pipeline.md)" : "the printed sum in double",
             .domain = row.domain,
             .errorKind = "absolute opacity; radiance relative to the largest",
             .bound = row.bound,
             .nanoseconds = nanoseconds},
            worst, at);
}

void checkStepOpacity(CheckRun& run)
{
    ConeSettings settings;
    settings.march.opacity = OpacityModel::density;
    const auto worst = findWorst(
        stepSpace(), run.budget(150000),
        [&](const auto& in) {
            ConeSettings s = settings;
            s.march.densityK = in[2];
            const double error = std::abs(double(stepOpacity(in[0], in[1], s)) - twin::stepOpacity(double(in[0]), double(in[1]), s));
            return error / std::max(1.0, double(in[1]) * double(in[2]) / 16.0);  // 1 - a has been rounded to float
        },
        741);
    run.add({.equation = "1",
             .function = "stepOpacity",
             .oracle = "1 - (1 - a)^(k length) by pow in double",
             .domain = "a 1e-6 .. 1.5, length 0.01 .. 64, k 0.25 .. 4",
             .errorKind = "absolute / max(1, k length / 16)",
             .bound = {"kStepOpacityMaxError", double(kStepOpacityMaxError)},
             .nanoseconds = run.time(4096, [&](std::size_t i) { return stepOpacity(float(i) / 8192.0f, 0.5f, settings); })},
            worst, inputText<float, 3>({"a", "length", "k"}, worst.input));
    settings.march.opacity = OpacityModel::none;
    const auto plain =
        exhaust(300, [&](std::uint64_t i) { return stepOpacity(float(i) / 200.0f, 7.0f, settings) == std::min(float(i) / 200.0f, 1.0f) ? 0.0 : 1.0; });
    run.add(exactCheck("1", "stepOpacity, opacity = none", "min(a, 1)", "a 0 .. 1.5"), plain, "i = " + exactText(plain.input[0]));

    ConeSettings exponential;
    exponential.march.transmittance = TransmittanceModel::exponential;
    const SearchSpace<float, 2> depths{{{{0.0f, 20.0f}, {0.25f, 4.0f}}}, {{0.0f, 1.0f}, {1.0f, 1.0f}}};
    const auto lost = findWorst(
        depths, run.budget(100000),
        [&](const auto& in) {
            ConeSettings s = exponential, linear = exponential;
            s.march.densityK = in[1];
            linear.march.transmittance = TransmittanceModel::linear;
            return std::max(std::abs(double(transmittanceOf(in[0], s)) - twin::transmittance(double(in[0]), s)),
                            std::abs(double(transmittanceOf(in[0], linear)) - twin::transmittance(double(in[0]), linear)));
        },
        742);
    run.add({.equation = "1",
             .function = "transmittanceOf",
             .oracle = "exp(-k F), max(0, 1 - F) in double",
             .domain = "F 0 .. 20, k 0.25 .. 4",
             .bound = {"kTransmittanceMaxError", double(kTransmittanceMaxError)}},
            lost, inputText<float, 2>({"F", "k"}, lost.input));
}

/// Voxel mip level, sphere diameter, and the places of the samples.
void checkSchedule(CheckRun& run)
{
    Worst<float, 4> levels, places;
    std::string levelAt, placeAt;
    for (const bool slab : {false, true}) {
        const SearchSpace<float, 4> space{{{{0.01f, 2.0f, Spacing::logarithmic}, {0.1f, 1.0f}, {-3.0f, 1.0f}, {0.5f, 4.0f}}},
                                          {{0.57735026f, 0.5f, 0.0f, 1.0f}}};
        const auto settingsOf = [slab](const std::array<float, 4>& in) {
            ConeSettings s;
            s.march.estimator = slab ? Estimator::slab : Estimator::paper;
            s.march.step = in[1], s.march.voxelLevelBias = in[2], s.march.startVoxels = in[3];
            s.march.minDiameterVoxels = 1.0f;
            s.march.maxSteps = 100000;
            return s;
        };
        const auto level = findWorst(
            space, run.budget(400),
            [&](const auto& in) {
                double worst = 0.0;
                for (const MarchStep& s : makeSchedule(settingsOf(in), in[0], 500.0f).steps) {
                    const bool whole = slab && s.readVoxels;
                    const double diameter = whole ? std::max(1.0, 2.0 * double(s.begin) * double(in[0])) : double(s.diameter);
                    double exact = std::max(0.0, std::log2(diameter) + double(in[2]));
                    if (whole && std::abs(exact - std::round(exact)) < 1e-5) continue;  // either level is right
                    if (whole) exact = std::floor(exact);
                    worst = std::max({worst, std::abs(double(s.level) - exact), std::abs(double(s.tapWidth) / std::exp2(exact) - 1.0)});
                }
                return worst;
            },
            751);
        if (level.error > levels.error) levelAt = inputText<float, 4>({"tanHalf", "step", "bias", "start"}, level.input);
        levels.include(level);
        const auto place = findWorst(
            space, run.budget(400),
            [&](const auto& in) {
                const ConeSettings settings = settingsOf(in);
                const auto diameterAt = [&](double t) { return std::max(1.0, 2.0 * t * double(in[0])); };
                double t = double(in[3]), worst = 0.0;
                const MarchSchedule schedule = makeSchedule(settings, in[0], 500.0f);
                std::size_t i = 0;
                if (slab) {
                    const MarchStep& first = schedule.steps.at(i++);
                    if (first.begin != 0.0f || first.end != in[3] || first.middle != 0.5f * in[3] || first.readVoxels) return 1.0;
                }
                for (; i < schedule.steps.size(); ++i) {
                    const MarchStep& s = schedule.steps[i];
                    double step = double(in[1]) * diameterAt(t);
                    if (slab) {
                        const double width = std::exp2(double(s.level)), taps = step / width;  // the level is held above
                        if (std::abs(s.taps - std::max(1.0, taps)) > 0.5 + 1e-5) return 1.0;
                        if (schedule.edges.at(std::size_t(s.firstTap)) != s.begin || schedule.edges.at(std::size_t(s.firstTap + s.taps)) != s.end) return 1.0;
                        step = s.taps * width;
                    }
                    const double middle = slab ? t + 0.5 * step : t;
                    // Roundings add up from step to step.
                    const double error = std::max({std::abs(double(s.begin) / t - 1.0), std::abs(double(s.end) / (t + step) - 1.0),
                                                   std::abs(double(s.middle) / middle - 1.0), std::abs(double(s.diameter) / diameterAt(middle) - 1.0)});
                    worst = std::max(worst, error / double(i + 2));
                    if (!s.readVoxels) return 1.0;
                    t += step;
                }
                return t < 499.0 || t > 500.0 + 2.0 * diameterAt(500.0) ? 1.0 : worst;
            },
            752);
        if (place.error > places.error) placeAt = inputText<float, 4>({"tanHalf", "step", "bias", "start"}, place.input);
        places.include(place);
    }
    run.add({.equation = "1",
             .function = "makeSchedule, mip level and tap width",
             .oracle = "log2 and exp2 in double",
             .domain = "tan of the half angle 0.01 .. 2, to 500 voxels",
             .errorKind = "levels; relative width",
             .bound = {"kVoxelLevelMaxError", double(kVoxelLevelMaxError)}},
            levels, levelAt);
    run.add({.equation = "1",
             .function = "makeSchedule, places and diameters",
             .oracle = "the recurrence in double",
             .domain = "as above, steps 0.1 .. 1 of the diameter",
             .errorKind = "relative / number of steps",
             .bound = {"kSchedulePlaceMaxError", double(kSchedulePlaceMaxError)}},
            places, placeAt);
}

}  // namespace

void checkCones(CheckRun& run)
{
    const char* const domain = "6 sets of choices, fitted layers, a smooth opacity field, wavy lit maps under sun and spot; any cone from above";
    checkMarch(run, Estimator::paper, casesOf(Estimator::paper), {"marchPaper", domain, {"kMarchPaperMaxError", double(kMarchPaperMaxError)}});
    checkMarch(run, Estimator::slab, casesOf(Estimator::slab), {"marchSlab", domain, {"kMarchSlabMaxError", double(kMarchSlabMaxError)}});
    MarchCase wide = casesOf(Estimator::slab).front();
    wide.fitRanges = false;
    checkMarch(run, Estimator::slab, {wide},
               {"marchSlab, one layer over 20 m",
                "as above; taps of 0.25 m and up: footprints a 160th of the layer",
                {"kMarchSlabWideMaxError", double(kMarchSlabWideMaxError)}});
    checkStepOpacity(run);
    checkSchedule(run);
}

}  // namespace lrsm
