#pragma once

#include "core/base/settings.h"

#include <vector>

namespace lrsm {

/// Standard normal distribution function Phi, three ways; the trade of speed for accuracy is a setting.
/// `table`: linear interpolation in N entries over [-5, 5]; `polynomial`: our own, the default; `exact`: double, our own erfc.
class NormalCdf {
  public:
    explicit NormalCdf(GaussianMethod method = GaussianMethod::polynomial, int tableSize = 1024);
    float operator()(float x) const;
    /// Stated bound on |error| of this instance, against exact arithmetic, for any float x; NaN gives NaN.
    float maxError() const;

  private:
    GaussianMethod method_;
    std::vector<float> table_;
    float scale_ = 0.0f;
};

/// Eq. 12: the fraction of the footprint whose depth lies in [zc - rc, zc + rc], depths taken as N(mu, sigma2).
/// All in the same unit. sigma2 <= 0 is the flat texel: 1 inside, 0 outside, 1/2 on the edge. rc >= 0.
float gaussianVisibility(const NormalCdf& phi, float mu, float sigma2, float zc, float rc);

/// Variance floor in warped units (depth in [0, 1] of the layer): what UNORM16 moments can resolve.
inline constexpr float kVarianceFloor = 2.5e-5f;

}  // namespace lrsm
