#pragma once

#include "conetrace/frame/gather.h"
#include "core/base/arrays.h"

/// Virtual lights drawn from the reflective shadow maps: [ISM] Sec. 3. [ISM]: Ritschel, Grosch, Kim, Seidel, Dachsbacher and Kautz, "Imperfect Shadow Maps for
/// Efficient Computation of Indirect Illumination", SIGGRAPH Asia 2008.
namespace lrsm {

struct VirtualLight {
    Vec3 position{0.0f};
    Mat3 frame{1.0f};      ///< columns: tangent, bitangent, normal of the surface that shines
    Vec3 intensity{0.0f};  ///< along the normal, W/sr times the pre-exposure; times the cosine elsewhere
    float area = 0.0f;     ///< m^2, of the surface that it stands for

    const Vec3& normal() const { return frame[2]; }
};

struct VirtualLights {
    std::vector<VirtualLight> lights;
    float preExposure = 1.0f;  ///< of the light maps
};

template <class Visit>
void forEachArray(const VirtualLights& lights, Visit&& visit)
{
    // Position and area, intensity, normal.
    constexpr std::size_t kGpuLight = 16 + 8 + 4;
    visit(lights.lights, ArrayTraits{lights.lights.size() * kGpuLight});
}

inline Counters countersOf(const VirtualLights& lights)
{
    return {{"virtual_lights", double(lights.lights.size())}};
}

/// `settings.lights` of them at texels of the maps, texels in the order of lights and rows, by the quantiles (i + 1/2) / n of their distribution: the flux
/// luminance(L) a of a texel's radiance and surface, or the same for each that shines. A light is L a over its texel's part in that and n, so that together
/// they are the maps' light. None where the maps are dark.
VirtualLights drawLights(const std::vector<Rsm>& rsms, const IsmSettings& settings);

}  // namespace lrsm
