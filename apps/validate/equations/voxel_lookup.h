#pragma once

#include "voxel/opacity_pyramid.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lrsm::oracle {

/// Sec. 3.1: the quadrilinear lookup at (x, y, z) in base voxels and a level, by tents over all texels near, in double.
inline glm::dvec3 lookup(const OpacityPyramid& pyramid, const std::array<float, 4>& in)
{
    const double lod = std::min(std::max(double(in[3]), 0.0), pyramid.levels() - 1.0);
    glm::dvec3 sum(0.0);
    for (int level = static_cast<int>(lod); level <= std::min(static_cast<int>(lod) + 1, pyramid.levels() - 1); ++level) {
        const int n = pyramid.resolutionAt(level);
        const double share = std::max(0.0, 1.0 - std::abs(lod - level)),
                     scale = pyramid.axes == OpacityAxes::directional ? std::ldexp(1.0, -std::min(level, 3)) : 1.0;
        int first[3];
        for (int i = 0; i < 3; ++i) first[i] = static_cast<int>(std::floor(double(in[std::size_t(i)]) / (1 << level) - 0.5));
        for (int k = 0; k < 8; ++k) {
            double weight = share * scale;
            int c[3];
            bool inside = true;
            for (int i = 0; i < 3; ++i) {
                c[i] = first[i] + ((k >> i) & 1);
                weight *= std::max(0.0, 1.0 - std::abs(double(in[std::size_t(i)]) / (1 << level) - (c[i] + 0.5)));
                inside = inside && c[i] >= 0 && c[i] < n;
            }
            for (int axis = 0; axis < 3 && inside; ++axis)
                sum[axis] += weight * double(pyramid.value(level, pyramid.axes == OpacityAxes::directional && level > 0 ? axis : 0, c[0], c[1], c[2]));
        }
    }
    return sum;
}

}  // namespace lrsm::oracle
