#pragma once

#include "core/base/counters.h"
#include "core/base/elementary.h"
#include "core/base/math.h"
#include "core/settings/settings.h"

#include <algorithm>

/// One cone, whatever the method that follows it.
namespace lrsm {

/// Apex and axis. Distances along the cone are in base voxels.
struct ConeRay {
    Vec3 originWorld{0.0f};
    Vec3 originVoxels{0.0f};
    Vec3 direction{0.0f, 1.0f, 0.0f};       ///< unit
    Vec3 receiverNormal{0.0f, 1.0f, 0.0f};  ///< geometric, unit
};

struct ConeResult {
    Vec3 radiance{0.0f};   ///< I of Eq. 1
    float opacity = 0.0f;  ///< 1 - transmittance at the cone's end
};

struct ConeCounts {
    std::uint64_t cones = 0;
    std::uint64_t steps = 0;
    std::uint64_t voxelTaps = 0;    ///< quadrilinear
    std::uint64_t lrsmSamples = 0;  ///< trilinear footprints, one a layer
    bool operator==(const ConeCounts&) const = default;
    ConeCounts& operator+=(const ConeCounts& other)
    {
        cones += other.cones;
        steps += other.steps;
        voxelTaps += other.voxelTaps;
        lrsmSamples += other.lrsmSamples;
        return *this;
    }
};

inline Counters countersOf(const ConeCounts& counts)
{
    return {{"cones", static_cast<double>(counts.cones)},
            {"cone_steps", static_cast<double>(counts.steps)},
            {"voxel_taps", static_cast<double>(counts.voxelTaps)},
            {"lrsm_samples", static_cast<double>(counts.lrsmSamples)}};
}

/// Widths of its voxel that a trilinear lookup reaches from its centre: a tent of one width, of voxels that are themselves one wide.
inline constexpr float kKernelReachTaps = 1.5f;
/// The same of a lookup blended with the level above, whose voxels are twice as wide.
inline constexpr float kBlendedReachTaps = 2.0f * kKernelReachTaps;

/// Transmittance from optical depth F: linear (a wall covers each ray once) or exponential (randomly placed surfaces). Error <= kTransmittanceMaxError.
inline constexpr float kTransmittanceMaxError = 4e-7f;
inline float transmittanceOf(float opticalDepth, const ConeSettings& settings)
{
    if (settings.march.transmittance == TransmittanceModel::linear) return std::max(0.0f, 1.0f - opticalDepth);
    return fastExp2(-1.4426950f * settings.march.densityK * opticalDepth);
}

}  // namespace lrsm
