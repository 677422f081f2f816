#pragma once

#include "lrsm/rsm.h"

#include <random>

/// Reflective shadow maps made of numbers, for tests that need no scene.
namespace lrsm::test {

/// Uniform in [lo, hi), the same on every platform.
inline float uniform(std::mt19937& random, float lo = 0.0f, float hi = 1.0f)
{
    return lo + (hi - lo) * (static_cast<float>(random() >> 8) * 0x1p-24f);
}

inline Vec3 unitVector(std::mt19937& random)
{
    for (;;) {
        const Vec3 v{uniform(random, -1.0f, 1.0f), uniform(random, -1.0f, 1.0f), uniform(random, -1.0f, 1.0f)};  // {}: in this order
        const float length = glm::length(v);
        if (length > 0.1f && length <= 1.0f) return v / length;
    }
}

/// Independent random texels; `filled` of them valid, values as the RSM's half storage would hold them.
inline Rsm randomRsm(int resolution, unsigned seed, float filled = 0.8f, float nearest = 0.2f, float farthest = 0.9f)
{
    std::mt19937 random(seed);
    Rsm rsm;
    rsm.projection.resolution = resolution;
    rsm.texels = Image<RsmTexel>(resolution, resolution);
    rsm.depthLinear = Image<float>(resolution, resolution, 1.0f);
    ConversionCounts counts;
    const auto half = [&](float x) { return roundToHalf(x, HalfRounding::d3d, counts); };
    for (std::size_t i = 0; i < rsm.texels.texels.size(); ++i) {
        if (uniform(random) >= filled) continue;
        RsmTexel& texel = rsm.texels.texels[i];
        texel.coverage = 1.0f;
        texel.radiance = Vec3{half(uniform(random, 0.0f, 4.0f)), half(uniform(random)), half(uniform(random, 0.0f, 0.01f))};
        const Vec3 n = unitVector(random);
        texel.normal = Vec3(half(n.x), half(n.y), half(n.z));
        texel.nDotL = half(uniform(random));
        rsm.depthLinear.texels[i] = uniform(random, nearest, farthest);
    }
    return rsm;
}

/// Every texel the same surface.
inline Rsm flatRsm(int resolution, float depth, const Vec3& radiance = Vec3(1.0f), const Vec3& normal = Vec3(0.0f, 0.0f, 1.0f), float nDotL = 1.0f)
{
    Rsm rsm;
    rsm.projection.resolution = resolution;
    rsm.texels = Image<RsmTexel>(resolution, resolution, RsmTexel{radiance, 1.0f, normal, nDotL});
    rsm.depthLinear = Image<float>(resolution, resolution, depth);
    return rsm;
}

}  // namespace lrsm::test
