// The sampler and Algorithm 1 as a whole: Eq. 5, 9, 14, 15.
#include "lrsm/sample.h"

#include "apps/validate/equations/algorithm1_twin.h"
#include "apps/validate/equations/check_run.h"
#include "apps/validate/equations/oracle.h"
#include "apps/validate/equations/synthetic_maps.h"

namespace lrsm {
namespace {

/// Eq. 9's weights: each texel's share of the lookup, taps of one texel added up, against tents; in parts of the largest resolution's rounding.
double footprintError(const Lrsm& lrsm, float u, float v, float level, FilterFraction fraction)
{
    const LrsmFootprint footprint = makeFootprint(lrsm, u, v, level, fraction);
    const double last = lrsm.levels() - 1, lod = std::min(std::max(double(level), 0.0), last);
    double worst = 0.0;
    for (int offsetLevel = -1; offsetLevel <= 2; ++offsetLevel) {
        const int fine = static_cast<int>(lod) + offsetLevel;
        if (fine < 0 || fine > static_cast<int>(last)) continue;
        const int n = lrsm.resolutionAt(fine);
        const int x0 = static_cast<int>(std::floor(double(u) * n - 0.5)), y0 = static_cast<int>(std::floor(double(v) * n - 0.5));
        for (int y = y0 - 1; y <= y0 + 2; ++y)
            for (int x = x0 - 1; x <= x0 + 2; ++x) {
                if (x < 0 || y < 0 || x >= n || y >= n) continue;
                double got = 0.0;
                const std::size_t index = lrsm.levelOffset[std::size_t(fine)] + std::size_t(y) * std::size_t(n) + std::size_t(x);
                for (int tap = 0; tap < footprint.taps; ++tap) got += footprint.texel[tap] == index ? double(footprint.weight[tap]) : 0.0;
                worst = std::max(worst, std::abs(got - twin::weight(lrsm, fine, x, y, double(u), double(v), lod)));
            }
    }
    // No weight elsewhere.
    double total = 0.0, near = 0.0;
    for (int tap = 0; tap < footprint.taps; ++tap) total += double(footprint.weight[tap]);
    for (int fine = static_cast<int>(lod); fine <= std::min(static_cast<int>(lod) + 1, static_cast<int>(last)); ++fine) {
        const int n = lrsm.resolutionAt(fine), x0 = static_cast<int>(std::floor(double(u) * n - 0.5)), y0 = static_cast<int>(std::floor(double(v) * n - 0.5));
        for (int y = std::max(0, y0 - 1); y <= std::min(n - 1, y0 + 2); ++y)
            for (int x = std::max(0, x0 - 1); x <= std::min(n - 1, x0 + 2); ++x) near += twin::weight(lrsm, fine, x, y, double(u), double(v), lod);
    }
    return std::max(worst, 0.25 * std::abs(total - near));
}

void checkFootprint(CheckRun& run)
{
    Lrsm lrsm;
    lrsm.baseResolution = 512;
    for (int n = 512; n >= 1; n /= 2) {
        lrsm.levelOffset.push_back(lrsm.texelsPerLayer);
        lrsm.texelsPerLayer += std::size_t(n) * std::size_t(n);
    }
    SearchSpace<float, 3> space{{{{-0.01f, 1.01f}, {-0.01f, 1.01f}, {-1.0f, 10.5f}}}, {}};
    for (int lod = 0; lod <= 9; ++lod)
        for (const float cell : {0.0f, 0.5f, 1.0f, 1.5f, 7.5f, 8.0f}) {
            const float u = cell / float(512 >> lod);
            space.planted.insert(space.planted.end(), {{u, 0.3f, float(lod)}, {1.0f - u, u, float(lod)}, {u, 1.0f - u, float(lod) + 0.5f}});
        }
    const auto exact = findWorst(
        space, run.budget(60000), [&](const auto& in) { return footprintError(lrsm, in[0], in[1], in[2], FilterFraction::exact); }, 407);
    run.add(
        {.equation = "9",
         .function = "makeFootprint, exact fractions",
         .oracle = "tents about texel centres and levels, in double",
         .domain = "maps of 512 .. 1 texels, u, v in [-0.01, 1.01], level -1 .. 10.5",
         .errorKind = "absolute, of a weight",
         .bound = {"kFootprintWeightMaxError", double(kFootprintWeightMaxError)},
         .nanoseconds = run.time(4096, [&](std::size_t i) { return makeFootprint(lrsm, float(i) / 4096.0f, 0.4f, 2.5f, FilterFraction::exact).weight[0]; })},
        exact, inputText<float, 3>({"u", "v", "level"}, exact.input));

    // Fractions in 1/256: on that lattice the weights are exact products; off it, they are those of a lattice point within half a step.
    const SearchSpace<float, 3> lattice{{{{0.0f, 1.0f}, {0.0f, 1.0f}, {0.0f, 9.0f}}}, {{0.5f, 0.5f, 0.5f}}};
    const auto snapped = findWorst(
        lattice, run.budget(30000),
        [&](const std::array<float, 3>& in) {
            const int lod = static_cast<int>(in[2]), n = 512 >> lod;
            const float u = std::floor(in[0] * float(n) * 256.0f) / (256.0f * float(n)), v = std::floor(in[1] * float(n) * 256.0f) / (256.0f * float(n));
            double worst = footprintError(lrsm, u, v, float(lod), FilterFraction::fixed8);
            // Less than half a step aside changes nothing: the fraction is rounded to the nearest.
            const LrsmFootprint on = makeFootprint(lrsm, u, v, float(lod), FilterFraction::fixed8);
            for (const float aside : {-0.33f, n <= 64 ? 0.497f : 0.33f}) {
                const LrsmFootprint beside =
                    makeFootprint(lrsm, u + aside / (256.0f * float(n)), v + aside / (256.0f * float(n)), float(lod), FilterFraction::fixed8);
                for (int tap = 0; tap < 4; ++tap)
                    worst = std::max(worst, beside.texel[tap] != on.texel[tap] ? 1.0 : std::abs(double(on.weight[tap]) - double(beside.weight[tap])));
            }
            // The level's own fraction.
            const float level = std::floor(in[2] * 256.0f) / 256.0f;
            const LrsmFootprint atLevel = makeFootprint(lrsm, 0.4f, 0.6f, level, FilterFraction::fixed8);
            for (const float aside : {-0.497f, 0.497f}) {
                const LrsmFootprint nearLevel = makeFootprint(lrsm, 0.4f, 0.6f, level + aside / 256.0f, FilterFraction::fixed8);
                for (int tap = 0; tap < atLevel.taps; ++tap) worst = std::max(worst, std::abs(double(atLevel.weight[tap]) - double(nearLevel.weight[tap])));
            }
            return std::max(worst, footprintError(lrsm, (std::floor(u * 8.0f) + 0.5f) / 8.0f, 0.5f, std::min(level, 9.0f), FilterFraction::fixed8));
        },
        408);
    run.add({.equation = "9",
             .function = "makeFootprint, fractions in 1/256",
             .oracle = "tents on the lattice of 1/256 texel, in double",
             .domain = "lattice points of maps of 512 .. 1 texels, and up to 0.497 of a step beside them",
             .errorKind = "absolute, of a weight",
             .bound = {"exact", 0.0}},
            snapped, inputText<float, 3>({"u", "v", "level"}, snapped.input));
}

/// One set of choices of Algorithm 1.
struct Choice {
    int depthLayers, normalLayers;
    bool spot;
    Storage storage;
    ConeSettings cones;
};
std::vector<Choice> choicesOf(LayerSelection selection)
{
    std::vector<Choice> choices;
    constexpr GaussianMethod kMethods[3] = {GaussianMethod::table, GaussianMethod::polynomial, GaussianMethod::exact};
    for (int i = 0; i < 6; ++i) {
        Choice c{1 + i % 3, 1 + i % 2, i % 2 == 1, i % 3 ? Storage::gpu : Storage::float32, {}};
        c.cones.gather.layerSelection = selection;
        c.cones.gather.backface = i < 3 ? Backface::cosine : Backface::step;
        c.cones.gather.gaussian = kMethods[(i / 2) % 3];
        c.cones.gather.gaussianTableSize = 4096;
        c.cones.gather.vRadiusScale = i % 2 ? 1.5f : 1.0f;
        c.cones.gather.rsmLevelBias = i == 2 ? -0.5f : 0.0f;
        c.cones.gather.rsmMinLevel = i == 3 ? 1.25f : 0.0f;
        c.cones.march.filterFraction = i == 4 ? FilterFraction::fixed8 : FilterFraction::exact;
        choices.push_back(c);
    }
    return choices;
}

void checkAlgorithm1(CheckRun& run, const char* equation, LayerSelection selection, const char* function)
{
    Worst<float, 6> worst;
    std::string at;
    int index = 0;
    for (const Choice& choice : choicesOf(selection)) {
        const LayerSettings layers = layersOf(choice.depthLayers, choice.normalLayers, selection == LayerSelection::centre ? 0.2f : 0.0f, choice.storage);
        Rsm rsm = syntheticRsm(64, 420);
        rsm.projection = choice.spot ? spotOverCube(64) : sunOverCube(64);
        const Lrsm lrsm = buildLrsm(rsm, layers);
        const NormalCdf phi(choice.cones.gather.gaussian, choice.cones.gather.gaussianTableSize);
        const auto coneOf = [](const std::array<float, 6>& in) {
            const float sine = std::sqrt(std::max(0.0f, 1.0f - in[4] * in[4]));
            return ConeSample{Vec3(in[0], in[1], in[2]), in[3], Vec3(sine * std::cos(in[5]), sine * std::sin(in[5]), in[4])};
        };
        const SearchSpace<float, 6> space{
            {{{-2.3f, 2.3f}, {-2.0f, 2.0f}, {-2.3f, 2.3f}, {0.01f, 1.0f, Spacing::logarithmic}, {-1.0f, 1.0f}, {0.0f, 6.2831853f}}}, {}};
        const auto found = findWorst(
            space, run.budget(20000),
            [&](const auto& in) {
                const ConeSample cone = coneOf(in);
                const LightSpacePoint p = projectToLight(lrsm.projection, cone.centre);
                const twin::Outgoing exact =
                    twin::algorithm1(lrsm, {double(p.u), double(p.v), double(p.depth), double(p.texelSize), p.valid}, cone, choice.cones);
                if (exact.toJump < 1e-5) return -1.0;
                const Vec3 got = sampleLrsm(lrsm, cone, choice.cones, phi);
                double error = 0.0;
                for (int c = 0; c < 3; ++c) error = std::max(error, std::abs(double(got[c]) - exact.radiance[c]) / kSyntheticRadiance);
                return error;
            },
            421 + static_cast<std::uint32_t>(index));
        if (found.error > worst.error)
            at = "choice " + std::to_string(index) + ", " + inputText<float, 6>({"x", "y", "z", "radius", "v.z", "azimuth"}, found.input);
        worst.include(found);
        ++index;
    }
    run.add({.equation = equation,
             .function = function,
             .oracle = "Algorithm 1 in double, straight from the paper",
             .domain = "random maps of 64^2 under sun and spot, 6 sets of choices; radii 1 cm .. 1 m of a 4 m cube",
             .errorKind = "relative to the map's largest radiance",
             .bound = {"kSampleLrsmMaxError", double(kSampleLrsmMaxError)}},
            worst, at);
}

/// Eq. 5 on a wall of one texel value: R, V, N multiply.
void checkProduct(CheckRun& run)
{
    const Lrsm lrsm = buildLrsm(flatMap(sunOverCube(32), {.radiance = Vec3(2.0f, 1.0f, 0.5f), .normal = Vec3(0.0f, 1.0f, 0.0f)}), oneLayer());
    ConeSettings cones;
    cones.gather.backface = Backface::cosine;
    const NormalCdf phi;
    // Depth 1/2 of a range of 4 m from y = 2: the wall is y = 0.
    const SearchSpace<float, 3> space{{{{-0.3f, 0.3f}, {0.01f, 0.4f, Spacing::logarithmic}, {-1.0f, 1.0f}}},
                                      {{0.0f, 0.02f, 1.0f}, {0.1f, 0.1f, 0.5f}, {-0.1f, 0.1f, 0.5f}}};
    const auto worst = findWorst(
        space, run.budget(60000),
        [&](const std::array<float, 3>& in) {
            const ConeSample cone{Vec3(0.1f, in[0], 0.2f), in[1], Vec3(std::sqrt(std::max(0.0f, 1.0f - in[2] * in[2])), in[2], 0.0f)};
            const double v =
                static_cast<double>(oracle::visibility(0.5L, 2.5e-5L, (2.0L - static_cast<long double>(in[0])) / 4.0L, static_cast<long double>(in[1]) / 4.0L));
            const double expected = 2.0 * v * std::max(0.0, double(in[2]));
            return std::abs(double(sampleLrsm(lrsm, cone, cones, phi).x) - expected) / 2.0;
        },
        431);
    run.add({.equation = "5",
             .function = "sampleLrsm, a wall facing the light",
             .oracle = "R V N in closed form",
             .domain = "samples within 0.3 m of the wall, radii 1 cm .. 0.4 m",
             .errorKind = "relative to R",
             .bound = {"kSampleLrsmFlatMaxError", double(kSampleLrsmFlatMaxError)},
             .nanoseconds = run.time(2048,
                                     [&](std::size_t i) {
                                         return sampleLrsm(lrsm, {Vec3(float(i % 64) * 0.05f - 1.6f, 0.02f, 0.2f), 0.1f, Vec3(0.0f, 1.0f, 0.0f)}, cones, phi).x;
                                     })},
            worst, inputText<float, 3>({"height", "radius", "v.y"}, worst.input));
}

/// The map's own edge belongs to it; a hundredth of it beyond does not, nor does anything behind a spot.
void checkMapEdges(CheckRun& run)
{
    const MapTexel floor{.normal = Vec3(0.0f, 1.0f, 0.0f)};
    const Lrsm sun = buildLrsm(flatMap(sunOverCube(32), floor), oneLayer()), spot = buildLrsm(flatMap(spotOverCube(32), floor), oneLayer());
    const NormalCdf phi;
    const auto wrong = exhaust(13, [&](std::uint64_t i) {
        if (i == 12)
            return sampleLrsm(spot, {spot.projection.position - 0.5f * spot.projection.forward, 9.0f, Vec3(0.0f, 1.0f, 0.0f)}, ConeSettings{}, phi).x == 0.0f
                       ? 0.0
                       : 1.0;
        const float reach = (i / 4 == 0 ? 1.0f : i / 4 == 1 ? 1.002f : 0.998f) * sun.projection.halfWidth * (i % 2 ? -1.0f : 1.0f);
        const Vec3 centre = i / 2 % 2 ? Vec3(reach, 0.0f, 0.0f) : Vec3(0.0f, 0.0f, reach);
        return (sampleLrsm(sun, {centre, 0.1f, Vec3(0.0f, 1.0f, 0.0f)}, ConeSettings{}, phi).x > 0.0f) == (i / 4 != 1) ? 0.0 : 1.0;
    });
    run.add(
        exactCheck("5", "sampleLrsm, the map's edges", "lit on the edge and inside, 0 beyond and behind the light", "all four edges, and 1/500 to either side"),
        wrong, "case " + exactText(wrong.input[0]));
}

}  // namespace

void checkSample(CheckRun& run)
{
    checkFootprint(run);
    checkProduct(run);
    checkMapEdges(run);
    checkAlgorithm1(run, "14", LayerSelection::touched, "sampleLrsm, every layer touched");
    checkAlgorithm1(run, "15", LayerSelection::centre, "sampleLrsm, layers that hold z_c");
}

}  // namespace lrsm
