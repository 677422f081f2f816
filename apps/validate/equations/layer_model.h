#pragma once

#include "apps/validate/equations/algorithm1_twin.h"

#include <vector>

/// Sec. 4.3 in double, from the settings and the RSM alone: what lrsm/layers.h implements, read a second time.
namespace lrsm {

/// One layer's depths, and its weight f(z_c). Linear depth of the light, [depthMin, depthMax).
struct SelectedSlice {
    twin::Slice range;
    double share = 1.0;
    bool holdsEnd = false;  ///< the farthest slice is closed
};

class LayerModel {
  public:
    LayerModel(const Rsm& rsm, const LayerSettings& settings);

    int depthSlices() const { return slices_; }
    int normalSlices() const { return normalSlices_; }

    /// The i-th depth slice with its overlap.
    twin::Slice slice(int i) const;

    /// The partition of rung Eq. 13, 14: equal slices without overlap.
    int depthSlice(double depth) const;
    int normalSlice(double nDotL) const;

    /// The slices of rung Eq. 15, with their overlap: those that hold z_c, weighted by the decay; or those that [z_c - window, z_c + window] touches, weight 1.
    std::vector<SelectedSlice> select(double zc, double window, LayerSelection selection) const;

  private:
    double low_ = 0.0, high_ = 1.0;  ///< nearest and farthest depth of all slices, without what Eq. 15 adds at the ends
    double delta_ = 0.0;
    int slices_ = 1, normalSlices_ = 1;
    bool outermostDecay_ = false;
};

/// Is an RSM texel of this depth and <n.l> in the layer, by the printed membership: half-open ranges, the farthest and steepest of `all` closed.
bool belongs(const std::vector<LayerRange>& all, const LayerRange& range, float depth, float nDotL);

/// What texel (x, y) of level `lod` of a layer must hold: the sum over the RSM texels below it that are in the layer, over all of them.
struct LayerMean {
    double radiance[3] = {}, normal[3] = {}, alpha = 0.0, z = 0.0, z2 = 0.0;
};
LayerMean meanOf(const Rsm& rsm, const std::vector<LayerRange>& all, const LayerRange& range, int lod, int x, int y);

}  // namespace lrsm
