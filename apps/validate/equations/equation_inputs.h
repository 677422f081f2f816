#pragma once

#include "apps/validate/equations/worst_case.h"
#include "lrsm/footprint.h"

#include <utility>

/// The domains of the equations' functions, and what a point of each stands for: searched by the checks, and where the vectors come from.
namespace lrsm {

/// Eq. 8: a mean normal of length up to 1, premultiplied, and v_c; directions by their coordinates, so that a search can move each.
inline SearchSpace<float, 7> normalTermSpace()
{
    return {{{{-1.0f, 1.0f}, {-1.0f, 1.0f}, {-1.0f, 1.0f}, {0x1p-16f, 1.0f, Spacing::logarithmic}, {-1.0f, 1.0f}, {-1.0f, 1.0f}, {-1.0f, 1.0f}}},
            {{1.0f, 0.0f, 0.0f, 1.0f, 1.0f, 0.0f, 0.0f}, {0.6f, 0.8f, 0.0f, 0.25f, 0.6f, 0.8f, 0.0f}}};
}
inline std::pair<FilteredTexel, Vec3> normalTermOf(const std::array<float, 7>& in)
{
    FilteredTexel texel;
    texel.normalAlpha = in[3];
    texel.normal = Vec3(in[0], in[1], in[2]) / std::max(1.0f, glm::length(Vec3(in[0], in[1], in[2]))) * in[3];
    const Vec3 v(in[4], in[5], in[6]);
    return {texel, v / std::max(glm::length(v), 1e-6f)};
}

/// Eq. 10 and 11: alpha, the mean, and the share of the largest possible variance.
inline SearchSpace<float, 3> momentSpace()
{
    return {{{{0x1p-16f, 1.0f, Spacing::logarithmic}, {0.0f, 1.0f}, {0.0f, 1.0f}}}, {{1.0f, 1.0f, 0.0f}, {1.0f, 0.5f, 1.0f}, {0.25f, 1.0f, 0.5f}}};
}
inline FilteredTexel momentsOf(const std::array<float, 3>& in)
{
    FilteredTexel texel;
    texel.depthAlpha = in[0];
    texel.depth = in[0] * in[1];
    texel.depthSquared = in[0] * (in[1] * in[1] + in[2] * in[1] * (1.0f - in[1]));
    return texel;
}

/// Eq. 12: a cone sample given by where its nearer end lies, `edge` sigmas from the mean. V changes nowhere else.
struct Window {
    float mu, sigma2, zc, rc;
};
inline Window windowOf(const std::array<float, 4>& in)
{
    const float mu = in[0], sigma = in[1], edge = in[2], rc = in[3];
    return {mu, sigma * sigma, mu + rc + sigma * edge, rc};
}
inline SearchSpace<float, 4> windowSpace(float leastSigma)
{
    return {{{{0.0f, 1.0f}, {leastSigma, 1.0f, Spacing::logarithmic}, {-9.0f, 9.0f}, {0x1p-20f, 2.0f, Spacing::logarithmic}}},
            {{0.5f, 0.005f, 0.0f, 0.25f},
             {0.0f, 0.1f, -1.0f, 0.1f},
             {1.0f, 0.2f, 5.0f, 1.0f},
             {0.3f, leastSigma * 16.0f, -5.25f, 0x1p-10f},
             {0.7f, 1.0f, 0.0f, 0x1p-20f}}};
}

/// Eq. 15: where the range begins, its width, twice delta over the width, and where z_c is, from just before the range to just behind.
inline SearchSpace<float, 4> decaySpace()
{
    return {{{{0.0f, 0.9f}, {1e-3f, 1.0f, Spacing::logarithmic}, {0.01f, 1.0f}, {-0.01f, 1.01f}}},
            {{0.25f, 0.5f, 0.5f, 0.0f}, {0.25f, 0.5f, 0.5f, 1.0f}, {0.25f, 0.5f, 0.5f, 0.125f}, {0.25f, 0.5f, 0.5f, 0.875f}, {0.1f, 0.3f, 1.0f, 0.5f}}};
}
inline std::pair<LayerRange, float> decayOf(const std::array<float, 4>& in)
{
    LayerRange r;
    r.depthMin = in[0];
    r.depthMax = in[0] + in[1];
    r.delta = 0.5f * in[1] * in[2];
    r.decayAtMin = r.decayAtMax = true;
    return {r, r.depthMin + (r.depthMax - r.depthMin) * in[3]};
}

/// Opacity of a step: a, length in voxels, k.
inline SearchSpace<float, 3> stepSpace()
{
    return {{{{1e-6f, 1.5f, Spacing::logarithmic}, {0.01f, 64.0f, Spacing::logarithmic}, {0.25f, 4.0f}}},
            {{1.0f, 1.0f, 2.0f}, {0.5f, 1.0f, 1.0f}, {0.99999994f, 0.1f, 1.0f}}};
}

/// Sec. 5: diameter and texel in metres, bias, least level.
inline SearchSpace<float, 4> levelSpace()
{
    return {{{{1e-3f, 1e3f, Spacing::logarithmic}, {1e-4f, 1e2f, Spacing::logarithmic}, {-4.0f, 4.0f}, {0.0f, 4.0f}}},
            {{2.0f, 1.0f, 0.0f, 0.0f}, {4.0f, 1.0f, 0.0f, 0.0f}, {1.0f, 0.01f, 0.5f, 0.0f}, {1e-3f, 1.0f, 0.0f, 2.0f}}};
}

}  // namespace lrsm
