#pragma once

#include "core/base/elementary.h"
#include "lrsm/footprint.h"
#include "lrsm/gaussian_visibility.h"
#include "lrsm/layers.h"

namespace lrsm {

/// GPU sampler: texel centres at +0.5, bilinear, trilinear between levels, border 0, level clamped to [0, last].
inline FilteredTexel sampleLayer(const Lrsm& lrsm, int layer, float u, float v, float level, FilterFraction fraction)
{
    return sampleLayer(lrsm, layer, makeFootprint(lrsm, u, v, level, fraction));
}

/// log2(diameter in LRSM texels) + bias, clamped to >= minLevel: Sec. 5's mip level (its `log` is base 2).
/// An LRSM texel is two RSM texels wide. A diameter of 0 gives minLevel. Error <= kLrsmLevelMaxError for results below 32.
inline constexpr float kLrsmLevelMaxError = 3e-6f;
inline float lrsmLevel(float diameterMetres, float rsmTexelSizeMetres, float bias, float minLevel)
{
    const float diameterTexels = diameterMetres / (2.0f * rsmTexelSizeMetres);
    return std::max(fastLog2(diameterTexels) + bias, minLevel);
}

/// Eq. 8: <nBar . v> clamped to >= 0; nBar = sum alpha n / sum alpha, not renormalised.
/// 0 where alpha is 0. Error <= kNormalTermMaxError for means of length <= 1.
inline constexpr float kNormalTermMaxError = 3e-7f;
inline float normalTerm(const FilteredTexel& texel, const Vec3& toReceiver)
{
    const float facing = glm::dot(texel.normal, toReceiver);
    return facing > 0.0f && texel.normalAlpha > 0.0f ? facing / texel.normalAlpha : 0.0f;
}
/// The `backface` setting's variants of the term: N, or 1 where N > 0.
inline float backfaceWeight(float n, Backface mode)
{
    if (mode == Backface::cosine) return n;
    return n > 0.0f ? 1.0f : 0.0f;
}

/// Eq. 10, 11: mean and variance (floored at kVarianceFloor when > 0 is asked; raw when floor = -inf) of the warped depth.
struct DepthMoments {
    float mean = 0.0f, variance = 0.0f;
    bool negative = false;  ///< the raw variance was below 0
};
/// All zero where alpha is 0. Errors, of what the given sums say: <= kDepthMeanMaxError and kDepthVarianceMaxError for depths in [0, 1].
inline constexpr float kDepthMeanMaxError = 3e-8f;
inline constexpr float kDepthVarianceMaxError = 2e-7f;
inline DepthMoments depthMoments(const FilteredTexel& texel, float floor = kVarianceFloor)
{
    if (!(texel.depthAlpha > 0.0f)) return {};
    const float mean = texel.depth / texel.depthAlpha;
    const float variance = texel.depthSquared / texel.depthAlpha - mean * mean;
    return {mean, std::max(variance, floor), variance < 0.0f};
}

/// One cone sample: centre, radius, unit direction from the sample to the receiver.
struct ConeSample {
    Vec3 centre{0.0f};
    float radius = 0.0f;
    Vec3 toReceiver{0.0f, 1.0f, 0.0f};
};

/// The terms of one layer's contribution, kept apart so that --pixel, validation and capture can show them.
struct LayerTerms {
    int layer = 0;
    float decay = 0.0f;                  ///< f, Eq. 15 (1 for `touched`)
    Vec3 radiance{0.0f};                 ///< A R
    float alpha = 0.0f;                  ///< A, Eq. 14
    float normal = 0.0f;                 ///< N as weighted by `backface`
    float mean = 0.0f, variance = 0.0f;  ///< warped
    float visibility = 0.0f;             ///< V, Eq. 12
    Vec3 outgoing{0.0f};                 ///< f A R V N
};

/// Algorithm 1: outgoing radiance of one cone sample from one light's LRSM (Eq. 5-15).
/// `terms`, when given, receives each sampled layer's terms. Error against exact arithmetic on the stored texels, for the projected point as
/// it is, <= kSampleLrsmMaxError times the map's largest radiance: a variance of 2.5e-5 is the difference of two floats near 1. Footprints that
/// hold one value keep kSampleLrsmFlatMaxError.
inline constexpr float kSampleLrsmMaxError = 3e-4f, kSampleLrsmFlatMaxError = 6e-6f;
Vec3 sampleLrsm(const Lrsm& lrsm, const ConeSample& sample, const ConeSettings& settings, const NormalCdf& phi, std::vector<LayerTerms>* terms = nullptr);

}  // namespace lrsm
