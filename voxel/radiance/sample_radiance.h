#pragma once

#include "voxel/radiance/isotropic_volume.h"
#include "voxel/radiance/radiance_volume.h"

namespace lrsm {

/// How a cone along `direction` (unit) sees the volume: made once a cone.
///
/// Level 0: each of the 8 texels about the place, dark but opaque where it faces away from the cone (facesAway with n.direction), blended trilinearly.
/// Above: the three textures of the directions of travel that `direction` has parts of, each blended trilinearly, weighted by |d_k| (vct_weights=absolute;
/// where the opacity is above 1, all four channels are divided by it) or d_k^2 (squared). Between levels linear. Texel centres at +0.5, border 0.
class RadianceLookup {
  public:
    RadianceLookup(const RadianceVolume& volume, const VctSettings& settings, FilterFraction fraction, const Vec3& direction);

    /// Radiance (premultiplied) and opacity; pVoxels in base voxels, `level` clamped to the volume's.
    Vec4 operator()(const Vec3& pVoxels, float level) const;
    Vec4 atLevel(const Vec3& pVoxels, int level) const;

  private:
    const RadianceVolume& volume_;
    float facing_;
    bool absolute_;
    bool fixed8_;
    Vec3 direction_;
    std::array<int, 3> faces_{};  ///< direction of travel of each axis
    Vec3 weights_{0.0f};
};

/// How any cone sees an isotropic volume: quadrilinear, texel centres at +0.5, border 0.
class IsotropicLookup {
  public:
    IsotropicLookup(const IsotropicVolume& volume, FilterFraction fraction) : volume_(volume), fixed8_(fraction == FilterFraction::fixed8) {}

    /// Radiance (premultiplied) and opacity; pVoxels in base voxels, `level` clamped to the volume's.
    Vec4 operator()(const Vec3& pVoxels, float level) const;
    Vec4 atLevel(const Vec3& pVoxels, int level) const;

  private:
    const IsotropicVolume& volume_;
    bool fixed8_;
};

/// Error of a lookup's opacity, of what the stored texels say, and of its radiance relative to the largest texel's.
inline constexpr float kRadianceLookupMaxError = 1e-6f;

}  // namespace lrsm
