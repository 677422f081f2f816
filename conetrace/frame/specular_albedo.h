#pragma once

#include "core/base/math.h"

#include <vector>

namespace lrsm {

/// Directional albedo of the specular lobe: the integral of f_s(l, v) <n.l> over the hemisphere = F0 * scale + bias (Schlick's Fresnel is linear in
/// F0; Karis 2013 calls it split sum). It turns the mean radiance of the specular cone into reflected radiance.
/// Made by quadrature of brdf.h's own lobe on a grid over sqrt <n.v> and roughness, linear between: relative error <= kSpecularAlbedoMaxError for
/// roughness >= 0.2 and <n.v> >= 0.05. Smoother lobes are those of roughness 0.05 at least.
inline constexpr float kSpecularAlbedoMaxError = 0.01f;

class SpecularAlbedo {
  public:
    SpecularAlbedo();
    Vec3 operator()(const Vec3& specularColor, float nDotV, float roughness) const;

    static constexpr int kCosineSize = 32, kRoughnessSize = 16;
    const std::vector<Vec2>& table() const { return table_; }

  private:
    std::vector<Vec2> table_;  ///< scale, bias; [roughness * kCosineSize + sqrt <n.v>]
};

}  // namespace lrsm
