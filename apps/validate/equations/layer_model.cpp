#include "apps/validate/equations/layer_model.h"

#include <algorithm>

namespace lrsm {
namespace {

constexpr double kThinnest = 0x1p-16;  // of the light's range: docs of `partition`

}  // namespace

LayerModel::LayerModel(const Rsm& rsm, const LayerSettings& settings)
    : slices_(std::max(settings.depthLayers, 1)), normalSlices_(std::max(settings.normalLayers, 1)), outermostDecay_(settings.outermostDecay)
{
    if (settings.fitRanges) {
        double nearest = 2.0, farthest = -1.0;
        for (std::size_t i = 0; i < rsm.texels.texels.size(); ++i)
            if (rsm.texels.texels[i].coverage > 0.0f) {
                nearest = std::min(nearest, double(rsm.depthLinear.texels[i]));
                farthest = std::max(farthest, double(rsm.depthLinear.texels[i]));
            }
        if (nearest <= farthest) {
            const double centre = 0.5 * (nearest + farthest), half = std::max(0.5 * (farthest - nearest), 0.5 * kThinnest);
            low_ = farthest - nearest < kThinnest ? centre - half : nearest;
            high_ = farthest - nearest < kThinnest ? centre + half : farthest;
        }
    }
    delta_ = double(settings.overlap) * (high_ - low_) / slices_;
}

int LayerModel::depthSlice(double depth) const
{
    return std::clamp(static_cast<int>(std::floor((depth - low_) / (high_ - low_) * slices_)), 0, slices_ - 1);
}

int LayerModel::normalSlice(double nDotL) const
{
    return std::clamp(static_cast<int>(std::floor(nDotL * normalSlices_)), 0, normalSlices_ - 1);
}

twin::Slice LayerModel::slice(int i) const
{
    const bool first = i == 0, last = i == slices_ - 1, endsDecay = outermostDecay_ && delta_ > 0.0;
    const double reach = outermostDecay_ ? 0.0 : delta_, width = (high_ - low_) / slices_;
    return {.depthMin = first ? low_ - reach : low_ + width * i - 0.5 * delta_,
            .depthMax = last ? high_ + reach : low_ + width * (i + 1) + 0.5 * delta_,
            .delta = delta_,
            .decayAtMin = !first || endsDecay,
            .decayAtMax = !last || endsDecay};
}

std::vector<SelectedSlice> LayerModel::select(double zc, double window, LayerSelection selection) const
{
    std::vector<SelectedSlice> selected;
    for (int i = 0; i < slices_; ++i) {
        SelectedSlice chosen{slice(i), 1.0, i == slices_ - 1};
        if (selection == LayerSelection::touched)
            chosen.share = chosen.range.depthMin <= zc + window && chosen.range.depthMax >= zc - window ? 1.0 : 0.0;
        else
            chosen.share = twin::decay(chosen.range, zc);
        if (chosen.share > 0.0) selected.push_back(chosen);
    }
    return selected;
}

bool belongs(const std::vector<LayerRange>& all, const LayerRange& range, float depth, float nDotL)
{
    float farthest = -1e30f, steepest = -1e30f;
    for (const LayerRange& r : all) farthest = std::max(farthest, r.depthMax), steepest = std::max(steepest, r.nDotLMax);
    const bool inDepth = depth >= range.depthMin && (depth < range.depthMax || (depth == range.depthMax && range.depthMax == farthest));
    return inDepth && nDotL >= range.nDotLMin && (nDotL < range.nDotLMax || (nDotL == range.nDotLMax && range.nDotLMax == steepest));
}

LayerMean meanOf(const Rsm& rsm, const std::vector<LayerRange>& all, const LayerRange& range, int lod, int x, int y)
{
    const int edge = 2 << lod;
    LayerMean mean;
    for (int j = 0; j < edge; ++j)
        for (int i = 0; i < edge; ++i) {
            const RsmTexel& t = rsm.texels.at(x * edge + i, y * edge + j);
            const float z = rsm.depthLinear.at(x * edge + i, y * edge + j);
            if (t.coverage == 0.0f || !belongs(all, range, z, t.nDotL)) continue;
            const double w = (double(z) - double(range.depthMin)) / (double(range.depthMax) - double(range.depthMin));
            for (int c = 0; c < 3; ++c) mean.radiance[c] += double(t.radiance[c]), mean.normal[c] += double(t.normal[c]);
            mean.alpha += 1.0, mean.z += w, mean.z2 += w * w;
        }
    const double texels = double(edge) * edge;
    for (int c = 0; c < 3; ++c) mean.radiance[c] /= texels, mean.normal[c] /= texels;
    mean.alpha /= texels, mean.z /= texels, mean.z2 /= texels;
    return mean;
}

}  // namespace lrsm
