// Sec. 4.2 and 4.3: what a layer's texel holds (Eq. 6, 8, 10, 11, 14), which layer a texel is in (Eq. 13), the sum over layers (Eq. 14) and its weights (Eq.
// 15).
#include "apps/validate/equations/equation_inputs.h"
#include "apps/validate/equations/layer_model.h"
#include "apps/validate/equations/synthetic_maps.h"
#include "apps/validate/vectors/make_vectors.h"
#include "apps/validate/vectors/set_parts.h"

namespace lrsm {
namespace {

constexpr int kTexelEdge = 4, kSlicesEach = 2;  ///< RSM texels along an edge of one LRSM texel of level 1; slices in depth and in <n.l>
constexpr int kFourLayers = kSlicesEach * kSlicesEach;

/// Two depth slices by two of <n.l> over depths from `nearest` to `farthest`.
std::vector<LayerRange> rangesOver(float nearest, float farthest, float overlap)
{
    return partition(syntheticRsm(2, 1400, 1.0f, nearest, farthest), layersOf(kSlicesEach, kSlicesEach, overlap));
}

Lrsm build(const Rsm& rsm, const std::vector<LayerRange>& ranges)
{
    LayerSettings settings = layersOf(kSlicesEach, kSlicesEach);
    return buildLrsm(rsm, settings, ranges, std::vector<bool>(ranges.size(), true));
}

/// One texel of level 1 of the second layer. 0: no texel of the RSM is in it, 1: all are, 2: one, 3: all of one depth and normal.
VectorCase layerTexel(int draw)
{
    SearchRandom random(1410 + static_cast<std::uint32_t>(draw));
    const float nearest = random.uniform(0.0f, 0.4f), farthest = nearest + random.uniform(0.1f, 0.6f);
    LayerRange range;
    range.depthMin = nearest, range.depthMax = farthest, range.nDotLMin = 0.5f, range.nDotLMax = 1.0f;
    LayerRange other = range;
    other.nDotLMin = 0.0f, other.nDotLMax = 0.5f;
    const std::vector<LayerRange> all = {other, range};
    const float filled = draw == 0 ? 0.0f : draw == 1 || draw == 3 ? 1.0f : random.uniform(0.0f, 1.0f);
    int index = 0;
    const MapTexel same{.depth = 0.5f * (nearest + farthest), .normal = Vec3(0.0f, 0.6f, 0.8f)};
    const Rsm rsm = syntheticMap(plainProjection(kTexelEdge), [&](int, int) {
        MapTexel t = same;
        const bool in = draw == 2 ? index++ == 5 : random.uniform(0.0f, 1.0f) < filled;
        if (draw != 3) {
            t.depth = random.uniform(nearest, farthest);
            t.normal = randomUnit(random);
            t.radiance = Vec3(random.uniform(0.0f, float(kSyntheticRadiance)), random.uniform(0.0f, 1.0f), random.uniform(0.0f, 0.01f));
        }
        t.nDotL = in ? 0.75f : 0.25f;
        return t;
    });
    const LayerMean exact = meanOf(rsm, all, range, 1, 0, 0);
    const Lrsm lrsm = build(rsm, all);
    const LrsmTexel& ours = *lrsm.level(1, 1);

    VectorCase made{std::vector<std::vector<double>>(6), {}};
    for (std::size_t i = 0; i < rsm.texels.texels.size(); ++i) {
        const RsmTexel& t = rsm.texels.texels[i];
        for (int c = 0; c < 3; ++c) made.inputs[0].push_back(double(t.radiance[c])), made.inputs[1].push_back(double(t.normal[c]));
        made.inputs[2].push_back(double(rsm.depthLinear.texels[i]));
        made.inputs[3].push_back(belongs(all, range, rsm.depthLinear.texels[i], t.nDotL) ? 1.0 : 0.0);
    }
    made.inputs[4] = {double(nearest)}, made.inputs[5] = {double(farthest)};
    // A narrow range magnifies what rounding leaves of z - depth_min.
    const double warp = double(kLayerDepthMaxError) + 2.0 * kHalfUlp * double(farthest) / (double(farthest) - double(nearest));
    made.results = {many({exact.radiance[0], exact.radiance[1], exact.radiance[2]}, double(kRadianceMeanMaxError) * kSyntheticRadiance,
                         {double(ours.radiance[0]), double(ours.radiance[1]), double(ours.radiance[2])}),
                    many({exact.normal[0], exact.normal[1], exact.normal[2]}, double(kLayerNormalMaxError),
                         {double(ours.normal[0]), double(ours.normal[1]), double(ours.normal[2])}),
                    single(exact.z, warp, double(ours.depth[0])), single(exact.z2, 2.0 * warp, double(ours.depth[1])),
                    single(exact.alpha, 0.0, double(ours.depth[2]))};
    return made;
}

void addTexel(std::vector<VectorSet>& sets)
{
    VectorSet& set = sets.emplace_back(
        VectorSet{.name = "layer_texel",
                  .meaning = "one LRSM texel as the mean over the 4x4 RSM texels below it, premultiplied: what is not in the layer counts as 0",
                  .inputs = {{"radiance", {kTexelEdge, kTexelEdge, 3}, "W/(m^2 sr)", "of each RSM texel, RGB"},
                             {"normal", {kTexelEdge, kTexelEdge, 3}, "", "unit"},
                             {"depth", {kTexelEdge, kTexelEdge}, "linear depth", "of the light, 0 .. 1"},
                             {"in_layer", {kTexelEdge, kTexelEdge}, "", "1 where the texel is in the layer", Dtype::u1},
                             {"depth_min", {}, "linear depth", "where the layer begins: z is warped to (z - depth_min) / (depth_max - depth_min)"},
                             {"depth_max", {}, "linear depth", "where it ends"}},
                  .outputs = {outputOf("6", {"eq6.radiance", {3}, "W/(m^2 sr)", "A R: mean radiance"}, {"kRadianceMeanMaxError", double(kRadianceMeanMaxError)},
                                       "relative to the largest radiance, 4"),
                              outputOf("8", {"eq8.mean_normal", {3}, "", "alpha n: mean normal"}, {"kLayerNormalMaxError", double(kLayerNormalMaxError)}),
                              outputOf("10", {"eq10.alpha_z", {}, "", "alpha z: mean warped depth"}, {"kLayerDepthMaxError", double(kLayerDepthMaxError)},
                                       "and an ULP of the inputs over the range"),
                              outputOf("11", {"eq11.alpha_z2", {}, "", "alpha z^2: mean square of the warped depth"},
                                       {"kLayerDepthMaxError", double(kLayerDepthMaxError)}, "and an ULP of the inputs over the range, twice"),
                              outputOf("14", {"eq14.coverage", {}, "", "A, alpha: share of the texels in the layer"}, {"exact", 0.0})},
                  .kinds = {}});
    fillSet(
        set, draws(4), [](const std::array<float, 1>& in) { return layerTexel(static_cast<int>(in[0])); }, 1420, kDrawCounts);
}

void addMembership(std::vector<VectorSet>& sets)
{
    VectorSet& set = sets.emplace_back(
        VectorSet{.name = "membership",
                  .meaning = "Eq. 13's alpha_l: which of four layers an RSM texel is in; ranges are half-open, the farthest and the steepest closed",
                  .inputs = {{"depth", {}, "linear depth", "of the texel"},
                             {"n_dot_l", {}, "", "of the texel"},
                             {"depth_min", {kFourLayers}, "linear depth", "of each layer"},
                             {"depth_max", {kFourLayers}, "linear depth", "of each layer"},
                             {"n_dot_l_min", {kFourLayers}, "", "of each layer"},
                             {"n_dot_l_max", {kFourLayers}, "", "of each layer"}},
                  .outputs = {outputOf("13", {"eq13.membership", {kFourLayers}, "", "alpha_l: 1 or 0"}, {"exact", 0.0})},
                  .kinds = {}});
    // The near end, the width, the overlap, the place in the width, <n.l>.
    SearchSpace<float, 5> space{{{{0.0f, 0.4f}, {0.1f, 0.5f}, {0.0f, 0.5f}, {0.0f, 1.0f}, {0.0f, 1.0f}}}, {}};
    for (const float overlap : {0.0f, 0.3f})
        for (const float at : {0.0f, 0.25f, 0.5f, 1.0f})
            for (const float n : {0.25f, 0.5f, 1.0f}) space.planted.push_back({0.25f, 0.5f, overlap, at, n});
    fillSet(set, space,
            [](const std::array<float, 5>& in) {
                const std::vector<LayerRange> ranges = rangesOver(in[0], in[0] + in[1], in[2]);
                const float nearest = ranges.front().depthMin, farthest = ranges.back().depthMax,
                            depth = std::min(nearest + (farthest - nearest) * in[3], farthest);
                const Lrsm lrsm = build(syntheticMap(plainProjection(2), [&](int, int) { return MapTexel{.depth = depth, .nDotL = in[4]}; }), ranges);
                VectorCase made{{{double(depth)}, {double(in[4])}, {}, {}, {}, {}}, {VectorResult{}}};
                for (std::size_t i = 0; i < ranges.size(); ++i) {
                    const LayerRange& r = ranges[i];
                    made.inputs[2].push_back(double(r.depthMin)), made.inputs[3].push_back(double(r.depthMax));
                    made.inputs[4].push_back(double(r.nDotLMin)), made.inputs[5].push_back(double(r.nDotLMax));
                    made.results[0].exact.push_back(belongs(ranges, r, depth, in[4]) ? 1.0 : 0.0);
                    made.results[0].allowed.push_back(0.0);
                    made.results[0].ours.push_back(double(lrsm.level(static_cast<int>(i), 0)->depth[2]));
                }
                return made;
            },
            1430, {.typical = 128, .worst = 0, .search = 32});
}

void addPartition(std::vector<VectorSet>& sets)
{
    constexpr int kSlices = 4;
    VectorSet& set = sets.emplace_back(VectorSet{
        .name = "partition",
        .meaning =
            "Sec. 4.3: four equal slices of the depths; neighbours overlap by delta, centred on the cut between them; the outer ends reach delta further",
        .inputs = {{"nearest", {}, "linear depth", "of the map"},
                   {"farthest", {}, "linear depth", "of the map"},
                   {"overlap", {}, "", "delta over a slice's width"}},
        .outputs = {outputOf("13", {"eq13.depth_min", {kSlices}, "linear depth", "where each slice begins"},
                             {"kPartitionMaxError", double(kPartitionMaxError)}),
                    outputOf("13", {"eq13.depth_max", {kSlices}, "linear depth", "where each ends"}, {"kPartitionMaxError", double(kPartitionMaxError)})},
        .kinds = {}});
    fillSet(
        set, SearchSpace<float, 3>{{{{0.0f, 0.4f}, {0.1f, 0.6f}, {0.0f, 0.5f}}}, {{0.25f, 0.5f, 0.0f}, {0.25f, 0.5f, 0.25f}}},
        [](const std::array<float, 3>& in) {
            const float nearest = in[0], farthest = in[0] + in[1];
            const Rsm rsm = syntheticMap(plainProjection(2), [&](int x, int) { return MapTexel{.depth = x ? farthest : nearest}; });
            const LayerSettings settings = layersOf(kSlices, 1, in[2]);
            const LayerModel model(rsm, settings);
            const std::vector<LayerRange> ours = partition(rsm, settings);
            VectorResult begins, ends;
            for (int i = 0; i < kSlices; ++i) {
                begins.exact.push_back(model.slice(i).depthMin), ends.exact.push_back(model.slice(i).depthMax);
                begins.ours.push_back(double(ours[std::size_t(i)].depthMin)), ends.ours.push_back(double(ours[std::size_t(i)].depthMax));
            }
            const double allowed = double(kPartitionMaxError);
            return VectorCase{{{double(nearest)}, {double(farthest)}, {double(in[2])}},
                              {many(begins.exact, allowed, begins.ours), many(ends.exact, allowed, ends.ours)}};
        },
        1440);
}

/// Of a sum over four layers in float32, over the sum: three products and three sums.
constexpr NamedBound kLayersMaxError{"8 half ULPs", 8.0 * kHalfUlp};

VectorCase layerSum(int draw)
{
    SearchRandom random(1450 + static_cast<std::uint32_t>(draw));
    VectorCase made{std::vector<std::vector<double>>(3), {}};
    double exact[3] = {};
    Vec3 ours(0.0f);
    for (int layer = 0; layer < kFourLayers; ++layer) {
        const float f = draw == 0 ? 0.0f : draw == 1 ? 1.0f : random.uniform(0.0f, 1.0f), a = draw == 2 && layer != 1 ? 0.0f : random.uniform(0.0f, 1.0f);
        const Vec3 l(random.uniform(0.0f, 4.0f), random.uniform(0.0f, 1.0f), random.uniform(0.0f, 0.01f));
        for (int c = 0; c < 3; ++c) exact[c] += double(f) * double(a) * double(l[c]);
        ours += (f * a) * l;
        made.inputs[0].push_back(double(f)), made.inputs[1].push_back(double(a));
        for (const double c : wide(l)) made.inputs[2].push_back(c);
    }
    VectorResult sum{{exact[0], exact[1], exact[2]}, {}, wide(ours)};
    for (const double value : exact) sum.allowed.push_back(kLayersMaxError.value * value);
    made.results = {sum};
    return made;
}

void addSum(std::vector<VectorSet>& sets)
{
    VectorSet& set =
        sets.emplace_back(VectorSet{.name = "layer_sum",
                                    .meaning = "Eq. 14 over four layers, each weighted by its decay",
                                    .inputs = {{"f", {kFourLayers}, "", "decay of Eq. 15"},
                                               {"a", {kFourLayers}, "", "coverage A_l"},
                                               {"l", {kFourLayers, 3}, "W/(m^2 sr)", "L_l of Eq. 5, RGB"}},
                                    .outputs = {outputOf("14", {"eq14.radiance", {3}, "W/(m^2 sr)", "sum of f_l A_l L_l"}, kLayersMaxError, "relative")},
                                    .kinds = {}});
    fillSet(
        set, draws(3), [](const std::array<float, 1>& in) { return layerSum(static_cast<int>(in[0])); }, 1460, kDrawCounts);
}

void addDecay(std::vector<VectorSet>& sets)
{
    VectorSet& set =
        sets.emplace_back(VectorSet{.name = "decay",
                                    .meaning = "Eq. 15 with k = smoothstep, 3 t^2 - 2 t^3, decaying at both ends",
                                    .inputs = {{"z_min", {}, "linear depth", "where the layer begins, its overlap included"},
                                               {"z_max", {}, "linear depth", "where it ends"},
                                               {"delta", {}, "linear depth", "over which it decays"},
                                               {"z_c", {}, "linear depth", "of the sample"}},
                                    .outputs = {outputOf("15", {"eq15.decay", {}, "", "f(z_c); 0 outside [z_min, z_max)"},
                                                         {"kDecayMaxError", double(kDecayMaxError)}, "absolute, and half an ULP of the inputs over delta")},
                                    .kinds = {}});
    fillSet(
        set, decaySpace(),
        [](const std::array<float, 4>& in) {
            const auto [r, z] = decayOf(in);
            constexpr double kSteepest = 1.5;  // of smoothstep
            const double allowed = double(kDecayMaxError) + kSteepest * kHalfUlp * double(r.depthMax) / double(r.delta);
            return VectorCase{{{double(r.depthMin)}, {double(r.depthMax)}, {double(r.delta)}, {double(z)}},
                              {single(twin::decay(twin::sliceOf(r), double(z)), allowed, double(decay(r, z)))}};
        },
        1470);
}

}  // namespace

void addLayerVectors(std::vector<VectorSet>& sets)
{
    addTexel(sets);
    addMembership(sets);
    addPartition(sets);
    addSum(sets);
    addDecay(sets);
}

}  // namespace lrsm
