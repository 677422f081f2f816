// Sec. 4.3 of Sugihara, Rauwendaal, Salvi: Layered Reflective Shadow Maps for Voxel-based Indirect Illumination, HPG 2014.
#include "lrsm/layers.h"

#include "core/base/parallel.h"

#include <cmath>

namespace lrsm {
namespace {

/// Depth slices thinner than the light's range times this would have ULPs for a range.
constexpr float kThinnestDepthRange = 0x1p-16f;

/// Nearest and farthest depth of the texels that were drawn; {0, 1} without any.
Vec2 fittedDepths(const Rsm& rsm)
{
    constexpr std::size_t kRows = 64;
    const auto width = static_cast<std::size_t>(rsm.texels.width), height = static_cast<std::size_t>(rsm.texels.height);
    std::vector<Vec2> chunks((height + kRows - 1) / kRows, Vec2(kInfinity, -kInfinity));
    parallelFor(height, kRows, [&](std::size_t begin, std::size_t end) {
        float nearest = kInfinity, farthest = -kInfinity;
        for (std::size_t i = begin * width; i < end * width; ++i)
            if (rsm.texels.texels[i].coverage > 0.0f) {
                nearest = std::min(nearest, rsm.depthLinear.texels[i]);
                farthest = std::max(farthest, rsm.depthLinear.texels[i]);
            }
        chunks[begin / kRows] = Vec2(nearest, farthest);
    });
    Vec2 fitted(kInfinity, -kInfinity);
    for (const Vec2& chunk : chunks) fitted = Vec2(std::min(fitted.x, chunk.x), std::max(fitted.y, chunk.y));
    if (!(fitted.x <= fitted.y)) return Vec2(0.0f, 1.0f);
    if (fitted.y - fitted.x < kThinnestDepthRange) {
        // One flat depth: room around it, so that warped depths and radii stay finite.
        const float centre = 0.5f * (fitted.x + fitted.y);
        return Vec2(centre - 0.5f * kThinnestDepthRange, centre + 0.5f * kThinnestDepthRange);
    }
    return fitted;
}

/// Distance between neighbouring floats at |x|.
float ulp(float x)
{
    const float a = std::abs(x);
    return std::nextafter(a, kInfinity) - a;
}

float smoothstep(float t)
{
    const float c = std::min(std::max(t, 0.0f), 1.0f);
    return c * c * (3.0f - 2.0f * c);
}

}  // namespace

Counters countersOf(const Lrsm& lrsm)
{
    Counters counters = {{"layers_asked", double(lrsm.layersAsked)},
                         {"layers_kept", double(lrsm.layers())},
                         {"half_saturations", static_cast<double>(lrsm.conversions.halfSaturations)},
                         {"nans", static_cast<double>(lrsm.conversions.nans)},
                         {"negative_variances", static_cast<double>(lrsm.negativeVariances)}};
    for (std::size_t i = 0; i < lrsm.ranges.size(); ++i) {
        const LayerRange& range = lrsm.ranges[i];
        const auto add = [&](const char* name, double value) { counters.push_back({"layer" + std::to_string(i) + "_" + name, value, true}); };
        add("depth_min", double(range.depthMin));
        add("depth_max", double(range.depthMax));
        add("n_dot_l_min", double(range.nDotLMin));
        add("n_dot_l_max", double(range.nDotLMax));
        add("delta", double(range.delta));
        add("valid_texels", i < lrsm.validTexelsPerLayer.size() ? static_cast<double>(lrsm.validTexelsPerLayer[i]) : 0.0);
    }
    return counters;
}

std::vector<LayerRange> partition(const Rsm& rsm, const LayerSettings& settings)
{
    const Vec2 depths = settings.fitRanges ? fittedDepths(rsm) : Vec2(0.0f, 1.0f);
    const int slices = std::max(settings.depthLayers, 1), normalSlices = std::max(settings.normalLayers, 1);
    const float slice = (depths.y - depths.x) / static_cast<float>(slices);

    // Two neighbours overlap by exactly delta, centred on the cut between them. Eq. 15's weights then sum to k(t) + k(1 - t) = 1 at every
    // depth, if zMax of the one minus zMin of the other *is* delta: so cuts and delta / 2 are whole multiples of one ULP of the far end.
    const float grid = ulp(depths.y);
    const float halfDelta = grid * std::floor(0.5f * settings.overlap * slice / grid + 0.5f);
    const auto cut = [&](int i) { return grid * std::floor((depths.x + slice * static_cast<float>(i)) / grid + 0.5f); };

    std::vector<LayerRange> ranges;
    ranges.reserve(static_cast<std::size_t>(slices) * static_cast<std::size_t>(normalSlices));
    for (int i = 0; i < slices; ++i) {
        LayerRange range;
        const bool first = i == 0, last = i == slices - 1;
        const float reach = settings.outermostDecay ? 0.0f : 2.0f * halfDelta;
        range.delta = 2.0f * halfDelta;
        range.depthMin = first ? depths.x - reach : cut(i) - halfDelta;
        range.depthMax = last ? depths.y + reach : cut(i + 1) + halfDelta;
        range.decayAtMin = !first || (settings.outermostDecay && halfDelta > 0.0f);
        range.decayAtMax = !last || (settings.outermostDecay && halfDelta > 0.0f);
        for (int n = 0; n < normalSlices; ++n) {
            range.nDotLMin = static_cast<float>(n) / static_cast<float>(normalSlices);
            range.nDotLMax = static_cast<float>(n + 1) / static_cast<float>(normalSlices);
            ranges.push_back(range);
        }
    }
    return ranges;
}

float decay(const LayerRange& range, float zc)
{
    // Half-open where the neighbour begins, closed at the far end of all layers.
    const bool inside = zc >= range.depthMin && (zc < range.depthMax || (zc == range.depthMax && !range.decayAtMax));
    if (!inside) return 0.0f;
    if (range.decayAtMin && zc < range.depthMin + range.delta) return smoothstep((zc - range.depthMin) / range.delta);
    if (range.decayAtMax && zc > range.depthMax - range.delta) return smoothstep((range.depthMax - zc) / range.delta);
    return 1.0f;
}

}  // namespace lrsm
