#pragma once

#include "conetrace/ism/maps.h"
#include "conetrace/proxies/vpl.h"

/// What virtual lights give a pixel: [ISM] Sec. 5.
namespace lrsm {

/// Everything that a pixel reads.
struct IsmWorld {
    const GBuffer& gbuffer;
    const Camera& camera;
    const VirtualLights& lights;
    const ImperfectMaps& maps;
    const IsmSettings& settings;
    const VplSettings& vpl;
    const VplLobeIntegral* lobe = nullptr;  ///< where the scene has a specular part
};

/// Does the light's map leave the surface lit? By the texel that it is in, where it may lie ism_bias behind, and by as much more as its own plane falls away
/// from the light within kSlopeTexels: a texel's depth is that of its nearest point.
inline constexpr float kSlopeTexels = 1.0f, kMostSlope = 16.0f;
inline bool litByMap(const IsmWorld& world, std::size_t light, const Vec3& position, const Vec3& normal)
{
    const int n = world.maps.resolution;
    const VirtualLight& from = world.lights.lights[light];
    const MapPlace place = placeInMap(from, position, n);
    const int column = std::clamp(static_cast<int>(place.u), 0, n - 1), row = std::clamp(static_cast<int>(place.v), 0, n - 1);
    const float stored = world.maps.depth[light * world.maps.texels() + std::size_t(row * n + column)];
    if (stored >= 1.0f) return true;
    const float cosine = std::max(glm::dot(normal, from.position - position) / place.distance, 1.0f / kMostSlope);
    const float slope = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)) / cosine, texelAngle = (1.0f + place.z) * (2.0f / float(n));
    const float bias = world.settings.bias * world.maps.range + kSlopeTexels * place.distance * texelAngle * slope;
    return place.distance <= stored * world.maps.range + bias;
}

/// Irradiance by every 16th of the lights from `first` on, times 16; or, `interleaved` false, by all. W/m^2.
inline constexpr std::size_t kInterleaved = 16;
Vec3 irradianceByLights(const IsmWorld& world, const Vec3& position, const Vec3& normal, std::size_t first, bool interleaved);

/// Mean radiance over the specular lobe: Eq. 7's weight of each light, over the lobe's integral. All lights: no filter would average them.
Vec3 lobeByLights(const IsmWorld& world, std::size_t pixel);

/// All covered pixels; parallel over tiles. Opacity stays 0: lights say nothing of where none are.
Gathered gatherFromLights(const IsmWorld& world, const Requirements& needs);

}  // namespace lrsm
