#include "voxel/sample_opacity.h"

#include <cassert>

namespace lrsm {

Vec3 sampleLevel(const OpacityPyramid& pyramid, const Vec3& pVoxels, int level, FilterFraction fraction)
{
    assert(level >= 0 && level < pyramid.levels());
    return withOpacitySampler(pyramid, fraction, [&](const auto& sample) { return sample.atLevel(pVoxels, level); });
}

Vec3 sampleOpacity(const OpacityPyramid& pyramid, const Vec3& pVoxels, float level, FilterFraction fraction)
{
    Vec3 sum(0.0f);
    forOpacityParts(pyramid, pVoxels, level, fraction, [&](const Vec3& part) { sum += part; });
    return sum;
}

}  // namespace lrsm
