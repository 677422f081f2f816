#include "core/scene/exposure.h"

#include <algorithm>

namespace lrsm {
namespace {

double brightestIrradiance(const Scene& scene)
{
    const Vec3 extent = scene.bounds.empty() ? Vec3(1.0f) : (reachIsPart(scene) ? scene.reach : scene.bounds).extent();
    const double size = double(std::max({extent.x, extent.y, extent.z}));
    double brightest = 0.0;
    for (const Light& light : scene.lights) {
        const double intensity = double(std::max({light.intensity.x, light.intensity.y, light.intensity.z}));
        brightest = std::max(brightest, light.type == LightType::directional || !(size > 0.0) ? intensity : intensity / (size * size));
    }
    return brightest;
}

}  // namespace

float preExposureOf(const Scene& scene)
{
    constexpr int kLargestExponent = 100;  // both the factor and its inverse stay normal floats
    const double brightest = brightestIrradiance(scene);
    if (!(brightest > 0.0) || !std::isfinite(brightest) || (brightest >= kOrdinaryIrradianceMin && brightest <= kOrdinaryIrradianceMax)) return 1.0f;
    return std::ldexp(1.0f, std::clamp(-std::ilogb(brightest), -kLargestExponent, kLargestExponent));
}

}  // namespace lrsm
