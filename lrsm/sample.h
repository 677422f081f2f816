#pragma once

#include "lrsm/gaussian_visibility.h"
#include "lrsm/layers.h"

namespace lrsm {

/// What the pre-filtered texture of one layer holds at a footprint, after trilinear filtering; still premultiplied.
struct FilteredTexel {
    Vec3 radiance{0.0f};        ///< A R
    Vec3 normal{0.0f};          ///< alpha n
    float normalAlpha = 0.0f;   ///< alpha stored with the normal
    float depth = 0.0f;         ///< alpha z, warped
    float depthSquared = 0.0f;  ///< alpha z^2
    float depthAlpha = 0.0f;    ///< alpha stored with the depth
};

/// GPU sampler: texel centres at +0.5, bilinear, trilinear between levels, border 0, level clamped to [0, last].
FilteredTexel sampleLayer(const Lrsm& lrsm, int layer, float u, float v, float level, FilterFraction fraction);

/// log2(diameter in LRSM texels) + bias, clamped to >= minLevel: Sec. 5's mip level (its `log` is base 2).
float lrsmLevel(float diameterMetres, float rsmTexelSizeMetres, float bias, float minLevel);

/// Eq. 8: <nBar . v> clamped to >= 0; nBar = sum alpha n / sum alpha, not renormalised.
float normalTerm(const FilteredTexel& texel, const Vec3& toReceiver);
/// The `backface` setting's variants of the term: N, min(1, clamp N), or 1 where N > 0.
float backfaceWeight(float n, Backface mode, float clamp);

/// Eq. 10, 11: mean and variance (floored at kVarianceFloor when > 0 is asked; raw when floor = -inf) of the warped depth.
struct DepthMoments {
    float mean = 0.0f, variance = 0.0f;
    bool negative = false;  ///< the raw variance was below 0
};
DepthMoments depthMoments(const FilteredTexel& texel, float floor = kVarianceFloor);

/// One cone sample: centre, radius, unit direction from the sample to the receiver.
struct ConeSample {
    Vec3 centre{0.0f};
    float radius = 0.0f;
    Vec3 toReceiver{0.0f, 1.0f, 0.0f};
};

/// The terms of one layer's contribution, kept apart so that --pixel, validation and capture can show them.
struct LayerTerms {
    int layer = 0;
    float decay = 0.0f;       ///< f, Eq. 15 (1 for `touched`)
    Vec3 radiance{0.0f};      ///< A R
    float alpha = 0.0f;       ///< A, Eq. 14
    float normal = 0.0f;      ///< N as weighted by `backface`
    float mean = 0.0f, variance = 0.0f;  ///< warped
    float visibility = 0.0f;  ///< V, Eq. 12
    Vec3 outgoing{0.0f};      ///< f A R V N
};

/// Algorithm 1: outgoing radiance of one cone sample from one light's LRSM (Eq. 5-15).
/// `terms`, when given, receives each sampled layer's terms.
Vec3 sampleLrsm(const Lrsm& lrsm, const ConeSample& sample, const ConeSettings& settings, const NormalCdf& phi,
                std::vector<LayerTerms>* terms = nullptr);

}  // namespace lrsm
