// Sec. 4.2 and 4.3: layers, their weights (Eq. 13-15), and the means that their mip chains hold (Eq. 6, 8, 10, 11).
#include "lrsm/layers.h"

#include "apps/validate/equations/check_run.h"
#include "apps/validate/equations/equation_inputs.h"
#include "apps/validate/equations/format_oracle.h"
#include "apps/validate/equations/layer_model.h"
#include "apps/validate/equations/synthetic_maps.h"

namespace lrsm {
namespace {

using MapWorst = Worst<double, 1>;

void include(MapWorst& worst, double error, std::string& at, const std::string& where)
{
    ++worst.evaluations;
    ++worst.swept;
    worst.sum += error;
    const double seen = error != error ? std::numeric_limits<double>::infinity() : error;
    if (seen > worst.error) worst.error = seen, at = where;
}

std::string text(const LayerSettings& s)
{
    return std::to_string(s.depthLayers) + " x " + std::to_string(s.normalLayers) + " layers, overlap " + exactText(s.overlap);
}

/// Sec. 4.3: where the ranges lie. Depths of the map by a plain loop; edges by equal slices in double.
void checkPartition(CheckRun& run)
{
    MapWorst worst, overlaps;
    std::string at, overlapAt;
    SearchRandom random(501);
    for (std::uint64_t draw = 0; draw < run.draws(600); ++draw) {
        LayerSettings settings =
            layersOf(1 + static_cast<int>(random.word() % 16), 1 + static_cast<int>(random.word() % 8), random.word() % 4 ? random.uniform(0.0f, 0.5f) : 0.0f);
        settings.fitRanges = random.word() % 4 != 0;
        settings.outermostDecay = random.word() % 3 == 0;
        const float a = random.uniform(0.0f, 1.0f), b = random.word() % 8 ? random.uniform(0.0f, 1.0f) : a;
        const Rsm rsm = syntheticRsm(8, 502 + static_cast<std::uint32_t>(draw), 1.0f, std::min(a, b), std::max(a, b));
        const LayerModel model(rsm, settings);
        const auto ranges = partition(rsm, settings);
        double error = ranges.size() == std::size_t(settings.depthLayers * settings.normalLayers) ? 0.0 : 1.0;
        for (std::size_t i = 0; i < ranges.size() && error < 1.0; ++i) {
            const int depth = static_cast<int>(i) / settings.normalLayers, normal = static_cast<int>(i) % settings.normalLayers;
            const bool last = depth == settings.depthLayers - 1;
            const LayerRange& r = ranges[i];
            const twin::Slice slice = model.slice(depth);
            error = std::max({error, std::abs(double(r.depthMin) - slice.depthMin), std::abs(double(r.depthMax) - slice.depthMax),
                              std::abs(double(r.delta) - slice.delta), std::abs(double(r.nDotLMin) - double(normal) / settings.normalLayers),
                              std::abs(double(r.nDotLMax) - double(normal + 1) / settings.normalLayers)});
            // In a map so flat that the overlap is below one ULP of its depths there is no width to decay over.
            const bool decays = r.delta > 0.0f;
            if (decays && (r.decayAtMin != slice.decayAtMin || r.decayAtMax != slice.decayAtMax)) error = 1.0;
            if (!last) {
                const LayerRange& next = ranges[i + std::size_t(settings.normalLayers)];
                include(overlaps, double(r.depthMax) - double(next.depthMin) == double(r.delta) ? 0.0 : 1.0, overlapAt, text(settings));
            }
        }
        include(worst, error, at, text(settings) + ", depths " + exactText(a) + ", " + exactText(b));
    }
    run.add({.equation = "13",
             .function = "partition, edges",
             .oracle = "equal slices of the map's depths in double",
             .domain = "1 .. 16 x 1 .. 8 layers, overlap 0 .. 0.5, depths fitted or not, flat maps",
             .errorKind = "absolute, linear depth",
             .bound = {"kPartitionMaxError", double(kPartitionMaxError)}},
            worst, at);
    run.add(exactCheck("15", "partition, overlap is delta", "zMax of one layer - zMin of the next, in double", "as above"), overlaps, overlapAt);
}

/// A map of one depth still gets a range to divide by, centred on it.
void checkFlatMap(CheckRun& run)
{
    const auto worst = exhaust(8, [](std::uint64_t i) {
        const float depth = std::ldexp(1.0f, -6 - static_cast<int>(i));
        const auto ranges = partition(syntheticRsm(4, 505, 1.0f, depth, depth), layersOf(1, 1, 0.0f));
        const double width = double(ranges.front().depthMax) - double(ranges.front().depthMin);
        return std::max(std::abs(width * 65536.0 - 1.0),
                        std::abs(0.5 * (double(ranges.front().depthMax) + double(ranges.front().depthMin)) - double(depth)) * 65536.0);
    });
    run.add({.equation = "13",
             .function = "partition, a map of one depth",
             .oracle = "2^-16 about it",
             .domain = "depths 2^-6 .. 2^-13",
             .errorKind = "over 2^-16",
             .bound = {"exact", 0.0}},
            worst, "depth = 2^(-6 - " + exactText(worst.input[0]) + ")");
}

/// Eq. 15 alone, on ranges and depths of any bits.
void checkDecay(CheckRun& run)
{
    const auto worst = findWorst(
        decaySpace(), run.budget(150000),
        [](const auto& in) {
            const auto [r, z] = decayOf(in);
            return std::abs(double(decay(r, z)) - twin::decay(twin::sliceOf(r), double(z)));
        },
        511);
    const LayerRange r = decayOf(worst.input).first;
    const float zAtWorst = decayOf(worst.input).second;
    run.add({.equation = "15",
             .function = "decay",
             .oracle = "smoothstep in double",
             .domain = "ranges of 1e-3 .. 1 in [0, 2], delta up to half of it, z_c in and beside it",
             .bound = {"kDecayMaxError", double(kDecayMaxError)},
             .nanoseconds = run.time(4096, [&](std::size_t i) { return decay(r, r.depthMin + float(i) / 4096.0f * (r.depthMax - r.depthMin)); })},
            worst, inputText<float, 4>({"zMin", "zMax", "delta", "z_c"}, {r.depthMin, r.depthMax, r.delta, zAtWorst}));

    // The ends that do not decay: 1 up to and with the last float, 0 beyond; half-open where a neighbour begins.
    const auto ends = exhaust(4 * 5 * 2, [](std::uint64_t i) {
        LayerRange e;
        e.depthMin = 0.25f, e.depthMax = 0.75f, e.delta = 0.0f;
        e.decayAtMin = i & 1, e.decayAtMax = i & 2;
        const int ulps = static_cast<int>(i / 4 % 5) - 2;
        const bool atMax = i >= 20;
        const float z = moveByUlps(atMax ? 0.75f : 0.25f, ulps);
        const bool inside = atMax ? ulps < 0 || (ulps == 0 && !e.decayAtMax) : ulps >= 0;
        return decay(e, z) == (inside ? 1.0f : 0.0f) ? 0.0 : 1.0;
    });
    run.add(exactCheck("15", "decay, ends without overlap", "half-open intervals, the last one closed", "z_c within 2 ULP of either end"), ends,
            "case " + exactText(ends.input[0]));
}

/// Eq. 15 over all layers: no light is lost or counted twice at any depth of the map.
void checkDecaySum(CheckRun& run)
{
    Worst<float, 1> worst;
    std::string at;
    SearchRandom random(521);
    for (std::uint64_t draw = 0; draw < run.draws(150); ++draw) {
        LayerSettings settings = layersOf(1 + static_cast<int>(random.word() % 16), 1, random.uniform(0.0f, 0.5f));
        settings.fitRanges = draw % 4 != 0;
        const Rsm rsm = syntheticRsm(8, 522 + static_cast<std::uint32_t>(draw), 1.0f, 0.5f * random.uniform(0.0f, 0.9f), random.uniform(0.5f, 1.0f));
        const auto ranges = partition(rsm, settings);
        float nearest = 1.0f, farthest = 0.0f;
        for (const float z : rsm.depthLinear.texels) nearest = std::min(nearest, z), farthest = std::max(farthest, z);
        if (!settings.fitRanges) nearest = 0.0f, farthest = 1.0f;
        SearchSpace<float, 1> space{{{{nearest, farthest}}}, {{nearest}, {farthest}}};
        for (const LayerRange& r : ranges)
            for (const float edge : {r.depthMin, r.depthMax, r.depthMin + r.delta, r.depthMax - r.delta}) space.planted.push_back({edge});
        const auto found = findWorst(
            space, run.budget(1500),
            [&](const auto& in) {
                double sum = 0.0;
                for (const LayerRange& r : ranges) sum += double(decay(r, in[0]));
                return std::abs(sum - 1.0);
            },
            523);
        if (found.error > worst.error) at = text(settings) + ", draw " + std::to_string(draw) + ", z_c = " + exactText(found.input[0]);
        worst.include(found);
    }
    run.add({.equation = "15",
             .function = "decay, sum over the layers",
             .oracle = "1",
             .domain = "1 .. 16 depth layers, overlap 0 .. 0.5, every depth of the map",
             .bound = {"kDecaySumMaxError", double(kDecaySumMaxError)}},
            worst, at);
}

template <class Visit>
void forEachTexel(const Lrsm& lrsm, const Visit& visit)
{
    for (int layer = 0; layer < lrsm.layers(); ++layer)
        for (int lod = 0; lod < lrsm.levels(); ++lod) {
            const int n = lrsm.resolutionAt(lod);
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x) visit(layer, lod, x, y, lrsm.level(layer, lod)[std::size_t(y) * std::size_t(n) + std::size_t(x)]);
        }
}

std::string texelText(const LayerSettings& s, int layer, int lod, int x, int y)
{
    return text(s) + ": layer " + std::to_string(layer) + ", level " + std::to_string(lod) + ", texel " + std::to_string(x) + ", " + std::to_string(y);
}

/// Eq. 6, 8, 10, 11, 13: float storage against sums in double.
void checkMeans(CheckRun& run)
{
    struct Row {
        const char *equation, *function;
        NamedBound bound;
        MapWorst worst = {};
        std::string at = {};
    } rows[5] = {{"6", "buildLrsm, A R of every level", {"kRadianceMeanMaxError", double(kRadianceMeanMaxError)}},
                 {"8", "buildLrsm, alpha n of every level", {"kLayerNormalMaxError", double(kLayerNormalMaxError)}},
                 {"10", "buildLrsm, alpha z of every level", {"kLayerDepthMaxError", double(kLayerDepthMaxError)}},
                 {"11", "buildLrsm, alpha z^2 of every level", {"kLayerDepthMaxError", double(kLayerDepthMaxError)}},
                 {"13", "buildLrsm, alpha of every level", {"exact", 0.0}}};
    MapWorst energy;
    std::string energyAt;
    SearchRandom random(531);
    for (std::uint64_t draw = 0; draw < std::max<std::uint64_t>(3, run.draws(24)); ++draw) {
        const LayerSettings settings = layersOf(1 + static_cast<int>(draw % 5), 1 + static_cast<int>(draw % 4), draw % 3 ? 0.0f : 0.3f);
        const int resolution = draw % 2 ? 64 : 128;
        const Rsm rsm = syntheticRsm(resolution, 532 + static_cast<std::uint32_t>(draw), random.uniform(0.2f, 1.0f));
        const auto all = partition(rsm, settings);
        const Lrsm lrsm = buildLrsm(rsm, settings);
        forEachTexel(lrsm, [&](int layer, int lod, int x, int y, const LrsmTexel& t) {
            const LayerMean m = meanOf(rsm, all, lrsm.ranges[std::size_t(layer)], lod, x, y);
            double r = 0.0, n = 0.0;
            for (int c = 0; c < 3; ++c) {
                r = std::max(r, std::abs(double(t.radiance[c]) - m.radiance[c]) / kSyntheticRadiance);
                n = std::max(n, std::abs(double(t.normal[c]) - m.normal[c]));
            }
            const double errors[5] = {r, n, std::abs(double(t.depth[0]) - m.z), std::abs(double(t.depth[1]) - m.z2),
                                      std::max(std::abs(double(t.depth[2]) - m.alpha), std::abs(double(t.normal[3]) - m.alpha))};
            for (int k = 0; k < 5; ++k)
                include(rows[k].worst, errors[k], rows[k].at, errors[k] > rows[k].worst.error ? texelText(settings, layer, lod, x, y) : std::string());
        });
        // Eq. 14: all layers together are the whole map, if they are a partition.
        if (settings.overlap > 0.0f) continue;
        double whole = 0.0, sum = 0.0, covered = 0.0, alpha = 0.0;
        for (const RsmTexel& t : rsm.texels.texels) whole += double(t.radiance.x), covered += double(t.coverage);
        for (int layer = 0; layer < lrsm.layers(); ++layer) {
            sum += double(lrsm.level(layer, lrsm.levels() - 1)->radiance[0]);
            alpha += double(lrsm.level(layer, lrsm.levels() - 1)->depth[2]);
        }
        const double texels = double(resolution) * resolution;
        include(energy, alpha == covered / texels ? std::abs(sum - whole / texels) / (whole / texels) : 1.0, energyAt, text(settings));
    }
    for (Row& row : rows)
        run.add({.equation = row.equation,
                 .function = row.function,
                 .oracle = "sums over the RSM's texels in double, membership as printed",
                 .domain = "random maps of 64^2 and 128^2, 1 .. 5 x 1 .. 4 layers, with and without overlap",
                 .errorKind = row.equation == std::string("6") ? "relative to the largest radiance" : "absolute",
                 .bound = row.bound},
                row.worst, row.at);
    run.add({.equation = "14",
             .function = "buildLrsm, A R summed over the layers at the top level",
             .oracle = "the RSM's mean in double",
             .domain = "as above, without overlap",
             .errorKind = "relative",
             .bound = {"kLayerSumMaxError", double(kLayerSumMaxError)}},
            energy, energyAt);
}

/// Table 1: what is stored is the conversion of the float mean of what is stored below.
void checkStorage(CheckRun& run)
{
    for (const HalfRounding rounding : {HalfRounding::d3d, HalfRounding::nearestEven}) {
        MapWorst wrong;
        std::string at;
        LayerSettings settings = layersOf(2, 2, 0.2f, Storage::gpu);
        settings.halfRounding = rounding;
        const Rsm rsm = syntheticRsm(run.draws(1) > 1 ? 128 : 64, 541);
        const Lrsm lrsm = buildLrsm(rsm, settings), wide = buildLrsm(rsm, layersOf(2, 2, 0.2f));
        forEachTexel(lrsm, [&](int layer, int lod, int x, int y, const LrsmTexel& t) {
            // The base level from the float means, every other from the four texels stored below.
            const int n = lod ? lrsm.resolutionAt(lod - 1) : lrsm.baseResolution;
            const LrsmTexel* child = lod ? lrsm.level(layer, lod - 1) + (2 * y) * n + 2 * x : wide.level(layer, 0) + y * n + x;
            const auto mean = [&](auto part, int c) {
                return lod ? 0.25f * (((child[0].*part)[c] + (child[1].*part)[c]) + ((child[n].*part)[c] + (child[n + 1].*part)[c])) : (child->*part)[c];
            };
            double bad = 0.0;
            for (int c = 0; c < 4; ++c) {
                if (c < 3 && double(t.radiance[c]) != oracle::half(double(mean(&LrsmTexel::radiance, c)), rounding)) bad = 1.0;
                if (double(t.normal[c]) != oracle::half(double(mean(&LrsmTexel::normal, c)), rounding)) bad = 1.0;
                if (c < 3 && double(t.depth[c]) != oracle::unorm16(mean(&LrsmTexel::depth, c))) bad = 1.0;
            }
            include(wrong, bad, at, bad > wrong.error ? texelText(settings, layer, lod, x, y) : std::string());
        });
        run.add(exactCheck("table1", std::string("buildLrsm, gpu, half ") + (rounding == HalfRounding::d3d ? "toward zero" : "nearest even"),
                           "conversions in double of the float mean of the stored children", "a random map of 128^2, 2 x 2 layers, all levels"),
                wrong, at);
    }
}

}  // namespace

void checkLayers(CheckRun& run)
{
    checkPartition(run);
    checkFlatMap(run);
    checkDecay(run);
    checkDecaySum(run);
    checkMeans(run);
    checkStorage(run);
}

}  // namespace lrsm
