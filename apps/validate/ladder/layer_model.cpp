#include "apps/validate/ladder/layer_model.h"

#include <algorithm>

namespace lrsm {
namespace {

constexpr double kThinnest = 0x1p-16;  // of the light's range: docs of `partition`

double smooth(double t)
{
    const double c = std::clamp(t, 0.0, 1.0);
    return c * c * (3.0 - 2.0 * c);
}

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

std::vector<SelectedSlice> LayerModel::select(double zc, double window, LayerSelection selection) const
{
    std::vector<SelectedSlice> selected;
    for (int i = 0; i < slices_; ++i) {
        const bool first = i == 0, last = i == slices_ - 1;
        const double reach = outermostDecay_ ? 0.0 : delta_, width = (high_ - low_) / slices_;
        SelectedSlice slice;
        slice.depthMin = first ? low_ - reach : low_ + width * i - 0.5 * delta_;
        slice.depthMax = last ? high_ + reach : low_ + width * (i + 1) + 0.5 * delta_;
        slice.holdsEnd = last;
        if (selection == LayerSelection::touched) {
            slice.share = slice.depthMin <= zc + window && slice.depthMax >= zc - window ? 1.0 : 0.0;
        } else {
            // Eq. 15: k((z_c - zMin) / delta) at the one end, k((zMax - z_c) / delta) at the other, 1 between.
            const bool inside = zc >= slice.depthMin && (zc < slice.depthMax || (last && zc == slice.depthMax));
            slice.share = inside ? 1.0 : 0.0;
            if (inside && delta_ > 0.0 && (!first || outermostDecay_)) slice.share *= smooth((zc - slice.depthMin) / delta_);
            if (inside && delta_ > 0.0 && (!last || outermostDecay_)) slice.share *= smooth((slice.depthMax - zc) / delta_);
        }
        if (slice.share > 0.0) selected.push_back(slice);
    }
    return selected;
}

}  // namespace lrsm
