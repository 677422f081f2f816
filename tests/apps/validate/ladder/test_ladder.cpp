#include "apps/validate/ladder/cone_samples.h"
#include "apps/validate/ladder/ladder.h"
#include "apps/validate/ladder/ladder_statistics.h"
#include "catch.h"
#include "conetrace/render.h"
#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "core/scene/builtin_scenes.h"
#include "voxel/voxelize.h"

#include <cmath>
#include <map>
#include <sstream>

using namespace lrsm;

namespace {

/// Small, and with something for every rung: two depth slices that overlap, gpu storage, a table.
Settings smallSettings()
{
    Settings settings;
    settings.voxel.resolution = 64;
    settings.voxel.axes = OpacityAxes::isotropic;
    settings.rsm.resolution = 128;
    settings.layers.overlap = 0.1f;
    settings.cones.march.estimator = Estimator::paper;
    settings.cones.set.apertureScale = 1.0f;
    settings.cones.set.rotation = Rotation::none;
    settings.cones.gather.layerSelection = LayerSelection::centre;
    settings.cones.gather.backface = Backface::cosine;
    settings.cones.gather.gaussian = GaussianMethod::table;
    settings.cones.march.voxelLevelBias = -1.0f;
    return settings;
}

LadderScene climb(const std::string& name, const Settings& settings, int samples = 200, int rays = 36, std::uint64_t seed = 1)
{
    const Scene scene = *makeBuiltinScene(name);
    LadderOptions options;
    options.width = 48;
    options.height = 36;
    options.samples = samples;
    options.raysPerSample = rays;
    options.seed = seed;
    return climbLadder(scene, scene.cameras[0], analyseRequirements(scene, {}), settings, options);
}

/// A frame that can be sampled over and over.
struct SmallFrame {
    Scene scene = *makeBuiltinScene("cornell-box");
    Settings settings;
    Requirements needs = analyseRequirements(scene, {});
    OpacityPyramid opacity;
    std::vector<Lrsm> lrsms;
    GBuffer gbuffer;
    GatherPlan plan;
    NormalCdf phi;

    explicit SmallFrame(const Settings& s)
        : settings(s),
          opacity(buildPyramid(voxelize(scene, s.voxel), s.voxel)),
          gbuffer(renderGBuffer(scene, scene.cameras[0], needs, {16, 12})),
          plan(planGather(settings.cones, needs, settings.voxel.resolution)),
          phi(settings.cones.gather.gaussian, settings.cones.gather.gaussianTableSize)
    {
        for (const Light& light : scene.lights) lrsms.push_back(buildLrsm(renderRsm(scene, light, needs, s.rsm), s.layers));
    }
    SampledFrame draw(std::size_t count, std::uint64_t seed) const
    {
        return sampleGather(gbuffer, scene.cameras[0], {opacity, lrsms, settings.cones, phi}, plan, count, seed);
    }
};

bool sameSamples(const LadderScene& a, const LadderScene& b)
{
    if (a.samples.size() != b.samples.size()) return false;
    for (std::size_t i = 0; i < a.samples.size(); ++i) {
        const LadderSample &s = a.samples[i], &t = b.samples[i];
        if (s.x != t.x || s.y != t.y || s.cone != t.cone || s.step != t.step) return false;
        for (int r = 0; r < kRadianceRungs; ++r)
            if (s.radiance[r] != t.radiance[r]) return false;
        for (int r = 0; r < kVisibilityRungs; ++r)
            if (s.opacity[r] != t.opacity[r]) return false;
        for (int r = 0; r < kEmissionRungs; ++r)
            if (s.emission[r] != t.emission[r]) return false;
        if (s.noise != t.noise || s.level != t.level || s.slope != t.slope || s.weight != t.weight) return false;
    }
    return true;
}

/// Mean over the channels of what --pixel prints as one step's outgoing radiance, all lights and layers; where it was, and how opaque.
struct PrintedStep {
    double radiance = 0.0, alpha = 0.0, transmittance = 0.0;
    double clear = 0.0;  ///< slab: sum of w A R, without transmittance
    int layers = 0;
    Vec3 position{0.0f};
    bool found = false;
};
PrintedStep printedStep(const std::string& text, int cone, int step)
{
    std::istringstream lines(text);
    std::string line;
    PrintedStep printed;
    int currentCone = -1, currentStep = -1;
    while (std::getline(lines, line)) {
        if (line.rfind("cone ", 0) == 0) {
            currentCone = std::stoi(line.substr(5));
            currentStep = -1;
            std::getline(lines, line);  // column heads
        } else if (line.rfind("        light", 0) == 0) {
            if (currentCone != cone || currentStep != step) continue;
            double r = 0.0, g = 0.0, b = 0.0;
            std::istringstream(line.substr(line.find("->") + 2)) >> r >> g >> b;
            printed.radiance += (r + g + b) / 3.0;
            std::istringstream(line.substr(line.find("  R ") + 4)) >> r >> g >> b;
            printed.clear += (r + g + b) / 3.0 * std::stod(line.substr(line.find("  V ") + 4));
            ++printed.layers;
        } else if (line.rfind("  ", 0) == 0 && line.find("I = ") == std::string::npos && currentCone == cone) {
            double distance = 0.0, diameter = 0.0, level = 0.0, density = 0.0;
            PrintedStep row;
            std::istringstream(line) >> currentStep >> distance >> diameter >> level >> density >> row.alpha >> row.transmittance >> row.position.x >>
                row.position.y >> row.position.z;
            row.found = true;
            if (currentStep == step) printed = row;
        }
    }
    return printed;
}

}  // namespace

TEST_CASE("samples are drawn without bias: every lookup as often as any other, over many seeds", "[ladder][sampling]")
{
    Settings settings = smallSettings();
    settings.voxel.resolution = 32;
    settings.cones.march.estimator = GENERATE(Estimator::paper, Estimator::slab);
    const SmallFrame frame(settings);
    const SampledFrame all = frame.draw(1u << 24, 1);
    REQUIRE(all.samples.size() == all.lookups);
    REQUIRE(all.lookups > 2000);

    // How often each group of lookups is drawn, against its share of all: by step, by cone and by pixel row.
    constexpr std::size_t kDraw = 100;
    constexpr int kSeeds = 60;
    std::map<int, double> expected[3], drawn[3];
    const auto count = [](std::map<int, double>(&into)[3], const RecordedSample& s, double weight) {
        into[0][std::min(s.step, 12)] += weight;
        into[1][s.cone] += weight;
        into[2][s.y] += weight;
    };
    const double perLookup = double(kDraw * kSeeds) / double(all.lookups);
    for (const RecordedSample& s : all.samples) count(expected, s, perLookup);
    for (int seed = 0; seed < kSeeds; ++seed) {
        const SampledFrame draw = frame.draw(kDraw, 1000 + std::uint64_t(seed));
        REQUIRE(draw.samples.size() == kDraw);
        REQUIRE(draw.lookups == all.lookups);
        for (const RecordedSample& s : draw.samples) count(drawn, s, 1.0);
    }
    for (int grouping = 0; grouping < 3; ++grouping)
        for (const auto& [group, e] : expected[grouping]) {
            CAPTURE(grouping, group, e);
            CHECK(std::abs(drawn[grouping][group] - e) < 4.0 * std::sqrt(e) + 1.0);  // 4 sigma; fixed seeds
        }
}

TEST_CASE("samples are the march's own: found again, in order, with the transmittance that Eq. 1 has there", "[ladder][sampling]")
{
    const SmallFrame frame(smallSettings());
    const SampledFrame few = frame.draw(50, 7), many = frame.draw(500, 7);
    REQUIRE(few.samples.size() == 50);
    std::size_t found = 0;
    for (const RecordedSample& a : few.samples)
        for (const RecordedSample& b : many.samples)
            if (a.key == b.key && a.x == b.x && a.y == b.y && a.cone == b.cone && a.step == b.step) ++found;
    CHECK(found == 50);  // a larger draw holds the smaller
    for (const RecordedSample& s : many.samples) {
        CHECK(s.steps[s.step].middle > 0.0f);
        CHECK(s.before >= s.after);
        const Vec3 along = s.ray.originWorld + s.ray.direction * (s.steps[s.step].middle * frame.opacity.base.grid.voxelSize);
        CHECK(glm::length(along - s.sphere.centre) < 1e-5f);
        CHECK(s.sphere.radius == Approx(0.5f * s.steps[s.step].diameter * frame.opacity.base.grid.voxelSize));
    }
}

TEST_CASE("the shipped rung is what --pixel prints for that step, to the digits printed", "[ladder][pixel]")
{
    const Settings settings = smallSettings();
    const LadderScene ladder = climb("cornell-box", settings, 100);
    const Scene scene = *makeBuiltinScene("cornell-box");
    RenderOptions options;
    options.width = ladder.width;
    options.height = ladder.height;
    int lit = 0;
    for (const LadderSample& s : ladder.samples) {
        if (lit >= 6) break;
        if (s.radiance[int(RadianceRung::algorithm1)] == 0.0) continue;
        ++lit;
        const std::string text = explainPixel(scene, scene.cameras[0], settings, options, s.x, s.y);
        const PrintedStep printed = printedStep(text, s.cone, s.step);
        CAPTURE(s.x, s.y, s.cone, s.step);
        REQUIRE(printed.found);
        CHECK(printed.radiance == Approx(s.radiance[int(RadianceRung::algorithm1)]).epsilon(1e-3));
        CHECK(double(glm::length(printed.position - s.centre)) < 2e-4);
        CHECK(1.0 - printed.transmittance * (1.0 - printed.alpha) == Approx(s.opacity[int(VisibilityRung::cone)]).margin(1e-3));
    }
    CHECK(lit == 6);
}

TEST_CASE("slab: the shipped segment is what --pixel prints for that step, texels and rays agree in the mean", "[ladder][pixel][emission]")
{
    Settings settings = smallSettings();
    settings.layers.overlap = 0.0f;
    settings.cones = ConeSettings{};
    const LadderScene ladder = climb("cornell-box", settings, 300, 144);
    REQUIRE(ladder.emission.rungs.size() == std::size_t(kEmissionRungs));
    CHECK(climb("cornell-box", smallSettings(), 10).emission.rungs.empty());
    const Scene scene = *makeBuiltinScene("cornell-box");
    RenderOptions options;
    options.width = ladder.width;
    options.height = ladder.height;
    int lit = 0, complete = 0;
    for (const LadderSample& s : ladder.samples) {
        if (lit >= 6) break;
        if (s.emission[int(EmissionRung::segment)] < 1e-3) continue;
        const std::string text = explainPixel(scene, scene.cameras[0], settings, options, s.x, s.y);
        const PrintedStep printed = printedStep(text, s.cone, s.step);
        CAPTURE(s.x, s.y, s.cone, s.step);
        REQUIRE(printed.found);
        CHECK(double(glm::length(printed.position - s.centre)) < 2e-4);
        if (printed.layers == 0) continue;  // no transmittance left in front of it
        ++lit;
        CHECK(printed.clear <= s.emission[int(EmissionRung::segment)] * 1.002 + 1e-5);  // layers without transmittance are not printed
        complete += printed.clear == Approx(s.emission[int(EmissionRung::segment)]).epsilon(2e-3).margin(1e-5) ? 1 : 0;
    }
    CHECK(lit == 6);
    CHECK(complete >= 4);
    const std::vector<RungStatistics>& rungs = ladder.emission.rungs;
    CHECK(rungs[1].mean == Approx(rungs[0].mean).epsilon(0.1));
}

TEST_CASE("each setting moves its own rung and those below it, none above", "[ladder]")
{
    constexpr int kSamples = 120;
    const LadderScene base = climb("cornell-box", smallSettings(), kSamples);
    const auto firstChanged = [&base](const auto& change) {
        Settings settings = smallSettings();
        change(settings);
        const LadderScene other = climb("cornell-box", settings, kSamples);
        REQUIRE(other.samples.size() == base.samples.size());
        int first = kRadianceRungs;
        for (std::size_t i = 0; i < base.samples.size(); ++i) {
            REQUIRE(other.samples[i].step == base.samples[i].step);
            for (int r = 0; r < first; ++r)
                if (std::abs(other.samples[i].radiance[r] - base.samples[i].radiance[r]) > 1e-12) first = r;  // the order of sums may change
        }
        return first;
    };
    CHECK(firstChanged([](Settings&) {}) == kRadianceRungs);
    CHECK(firstChanged([](Settings& s) { s.rsm.resolution = 64; }) == int(RadianceRung::eq3));
    CHECK(firstChanged([](Settings& s) { s.cones.gather.backface = Backface::step; }) == int(RadianceRung::eq5));
    CHECK(firstChanged([](Settings& s) { s.cones.gather.vRadiusScale = 2.0f; }) == int(RadianceRung::eq12));
    CHECK(firstChanged([](Settings& s) { s.layers.depthLayers = 3; }) == int(RadianceRung::eq14));
    CHECK(firstChanged([](Settings& s) { s.layers.overlap = 0.3f; }) == int(RadianceRung::eq15));
    CHECK(firstChanged([](Settings& s) { s.layers.outermostDecay = true; }) == int(RadianceRung::eq15));
    CHECK(firstChanged([](Settings& s) { s.cones.gather.rsmLevelBias = 1.0f; }) == int(RadianceRung::mips));
    CHECK(firstChanged([](Settings& s) { s.rsm.storage = Storage::float32; }) == int(RadianceRung::table1));
    CHECK(firstChanged([](Settings& s) { s.layers.halfRounding = HalfRounding::nearestEven; }) == int(RadianceRung::table1));
    CHECK(firstChanged([](Settings& s) { s.cones.gather.gaussianTableSize = 16; }) == int(RadianceRung::algorithm1));
    CHECK(firstChanged([](Settings& s) { s.cones.march.filterFraction = FilterFraction::fixed8; }) <= int(RadianceRung::algorithm1));
}

TEST_CASE("the furnace: Eq. 2 is the wall's radiance wherever a sphere meets the wall, exact rays close every cone", "[ladder][eq2][furnace]")
{
    const LadderScene ladder = climb("furnace", smallSettings(), 100);
    REQUIRE(ladder.radiance.samples > 10);
    for (const LadderSample& s : ladder.samples)
        if (s.hasSurface) CHECK(s.radiance[int(RadianceRung::eq2)] == Approx(0.5 / 3.14159265).epsilon(0.02));  // E = 0.5 on the inside
    CHECK(ladder.radiance.rungs[0].mean == Approx(0.5 / 3.14159265).epsilon(0.005));
}

TEST_CASE("ladder: the same bits with 1 and 2 threads, and other samples with another seed", "[ladder][determinism][threads]")
{
    const std::string name = GENERATE("cornell-box", "atrium");
    Settings settings = smallSettings();
    if (name == "atrium") settings.cones = ConeSettings{};
    if (name == "atrium") settings.layers.overlap = 0.0f;
    std::vector<LadderScene> runs;
    for (const int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        runs.push_back(climb(name, settings, 100, 16));
    }
    CHECK(sameSamples(runs[0], runs[1]));
    CHECK(runs[0].verdict == runs[1].verdict);
    CHECK(runs[0].lookups == runs[1].lookups);
    CHECK_FALSE(sameSamples(runs[0], climb(name, settings, 100, 16, 2)));
}

TEST_CASE("statistics: signed mean, percentiles, weights, histogram and shares of made-up rungs", "[ladder][statistics]")
{
    // Rung 1 adds i/100, i = 0..100; rung 2 takes 1 away from every fourth.
    std::vector<LadderSample> samples(101);
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i <= 100; ++i) {
        samples[i].opacity[1] = double(i) / 100.0;
        samples[i].opacity[2] = samples[i].opacity[3] = samples[i].opacity[1] - (i % 4 == 0 ? 1.0 : 0.0);
        samples[i].weight = i == 100 ? 3.0 : 0.0;
        samples[i].distance = static_cast<float>(i / 2);
        all.push_back(i);
    }
    const Ladder ladder = describeLadder(visibilityView(), samples, all, 2);
    const DifferenceStatistics& one = ladder.rungs[1].toAbove;
    CHECK(one.mean == Approx(0.5));
    CHECK(one.p50 == Approx(0.5));
    CHECK(one.p95 == Approx(0.95));
    CHECK(one.p99 == Approx(0.99));
    CHECK(one.max == Approx(1.0));
    CHECK(one.weightedMean == Approx(1.0));
    CHECK(one.quantiles.front() == 0.0);
    CHECK(one.rms == Approx(std::sqrt(338350.0 / 1e4 / 101.0)));
    CHECK(ladder.rungs[2].toAbove.mean == Approx(-26.0 / 101.0));
    CHECK(ladder.rungs[2].toAbove.p50 == 0.0);
    CHECK(ladder.rungs[2].toTop.mean == Approx(0.5 - 26.0 / 101.0));
    CHECK(ladder.rungs[3].toAbove.max == 0.0);
    const double squares = one.rms * one.rms + 26.0 / 101.0;
    CHECK(ladder.rungs[1].share == Approx(one.rms * one.rms / squares));
    CHECK(ladder.rungs[1].share + ladder.rungs[2].share == Approx(1.0));
    CHECK(ladder.verdict.find("\"voxel rays\"") != std::string::npos);
    for (const RungStatistics& rung : ladder.rungs)
        for (const auto& h : {rung.toAbove.histogram, rung.toTop.histogram}) {
            std::size_t counted = 0;
            for (const std::size_t c : h) counted += c;
            CHECK(counted == 101);
        }
    REQUIRE(ladder.worst.size() == 6);  // two for each of rungs 1 and 2, none for 3 where nothing differs, two of the whole way
    CHECK(ladder.worst[0].sample == 100);
    CHECK(ladder.worst[1].sample == 99);
    CHECK(ladder.worst.back().toTop);
    const LadderCurve& distance = ladder.curves[0];
    CHECK(distance.variable == "distance");
    std::size_t counted = 0;
    for (const CurveBin& bin : distance.bins) {
        counted += bin.count;
        CHECK(bin.low < bin.high);
        REQUIRE(bin.rmsToAbove.size() == 4);
        CHECK(bin.meanToAbove[1] == Approx((bin.low * 2 + std::ceil(bin.high) * 2 - 1) / 200.0).margin(0.011));
    }
    CHECK(counted == 101);
}

TEST_CASE("ladder: refuses what has no light or no lookup, in one line", "[ladder]")
{
    Scene dark = *makeBuiltinScene("cornell-box");
    dark.lights.clear();
    CHECK_THROWS_AS(climbLadder(dark, dark.cameras[0], analyseRequirements(dark, {}), smallSettings(), {}), InputError);
    Scene away = *makeBuiltinScene("cornell-box");
    away.cameras[0].position += 1000.0f * away.cameras[0].forward;
    LadderOptions options;
    options.width = options.height = 8;
    CHECK_THROWS_AS(climbLadder(away, away.cameras[0], analyseRequirements(away, {}), smallSettings(), options), InputError);
}
