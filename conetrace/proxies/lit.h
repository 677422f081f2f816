#pragma once

#include "conetrace/frame/gather.h"
#include "conetrace/proxies/places.h"

namespace lrsm {

/// What each proxy reflects of the lights, on the side that reflects most: [P] Fig. 2 (a).
struct ProxyLight {
    std::vector<Vec3> radiance;  ///< W/(m^2 sr) times the pre-exposure; 0: lit by none
    std::vector<Vec3> normals;   ///< geometric, unit, of the side that shines; of unlit ones the front's
    float preExposure = 1.0f;    ///< preExposureOf
    bool half = true;            ///< radiance is stored in half
    std::uint64_t lit = 0;
    std::uint64_t bothSides = 0;  ///< lit on the other side too, which is dropped
    ConversionCounts conversions;
};

template <class Visit>
void forEachArray(const ProxyLight& light, Visit&& visit)
{
    constexpr std::size_t kGpuHalf4 = 8, kGpuFloat4 = 16, kGpuPacked = 4;
    visit(light.radiance, ArrayTraits{light.radiance.size() * (light.half ? kGpuHalf4 : kGpuFloat4)});
    visit(light.normals, ArrayTraits{light.normals.size() * kGpuPacked});
}

Counters countersOf(const ProxyLight& light);

/// albedo L_d <n.l> V / pi, lights added; V by the light's map (frame/shadow_map.h), <n.l> of the shading normal, none where geometric normal or shading normal
/// look away from the light.
ProxyLight lightProxies(const GatherInput& input, const PointProxies& proxies);

}  // namespace lrsm
