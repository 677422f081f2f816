#pragma once

#include "lrsm/sample.h"

/// Algorithm 1 and what it stands on, once more, in double and straight from the paper: projection, mip level, sampler, Eq. 8, 10-12, 14, 15.
/// Shares the data structures with the kernel, and no code.
namespace lrsm::twin {

using DVec3 = glm::dvec3;

struct Projected {
    double u = 0.0, v = 0.0, depth = 0.0, texelSize = 1.0;
    bool valid = false;
};
Projected project(const LightProjection& projection, const DVec3& pWorld);

/// Sec. 5: log2 of the diameter in LRSM texels, two RSM texels wide each; biased, at least minLevel.
double level(double diameterMetres, double rsmTexelSize, double bias, double minLevel);

/// A LayerRange's depths, in double.
struct Slice {
    double depthMin = 0.0, depthMax = 1.0, delta = 0.0;
    bool decayAtMin = false, decayAtMax = false;
};
Slice sliceOf(const LayerRange& range);

/// Eq. 15 with k = smoothstep. Half-open where a neighbour begins, closed at the far end of all.
double decay(const Slice& slice, double zc);

/// Weight of texel (x, y) of a level in a trilinear lookup: tents about the texel's centre and about the level.
double weight(const Lrsm& lrsm, int lod, int x, int y, double u, double v, double level);

/// All of a layer's texel at a footprint.
struct Filtered {
    DVec3 radiance{0.0}, normal{0.0};
    double normalAlpha = 0.0, depth = 0.0, depthSquared = 0.0, depthAlpha = 0.0;
};
Filtered sample(const Lrsm& lrsm, int layer, double u, double v, double level);

struct Outgoing {
    DVec3 radiance{0.0};
    /// Distance to the nearest jump of the function (border of the map, a layer's edge, N = 0 of a step), in its own unit: where it is within
    /// rounding, kernel and twin may stand on different sides.
    double toJump = 1.0;
};
/// What UNORM16 moments resolve (docs/equations.md), written here a second time.
inline constexpr double kFloor = 2.5e-5;
/// From a projection as given: what its own error does to a sample depends on how steep the map is there, and is no fault of Algorithm 1.
Outgoing algorithm1(const Lrsm& lrsm, const Projected& at, const ConeSample& sample, const ConeSettings& settings, double varianceFloor = kFloor);

}  // namespace lrsm::twin
