#include "core/scene/exposure.h"

#include <algorithm>

namespace lrsm {
namespace {

double brightestIrradiance(const Scene& scene)
{
    const Aabb box = extentOf(scene).empty() ? Aabb{Vec3(0.0f), Vec3(1.0f)} : extentOf(scene);
    const double size = double(box.longestSide());
    double brightest = 0.0;
    for (const Light& light : scene.lights) {
        const double intensity = double(std::max({light.intensity.x, light.intensity.y, light.intensity.z}));
        const Vec3 off = light.position - glm::clamp(light.position, box.min, box.max);
        const double distance = std::max(size, std::sqrt(glm::dot(glm::dvec3(off), glm::dvec3(off))));
        brightest = std::max(brightest, light.type == LightType::directional || !(distance > 0.0) ? intensity : intensity / (distance * distance));
    }
    return brightest;
}

}  // namespace

float preExposureOf(const Scene& scene)
{
    constexpr int kLargestExponent = 100;  // both the factor and its inverse stay normal floats
    const double brightest = brightestIrradiance(scene);
    if (!(brightest > 0.0) || !std::isfinite(brightest) || (brightest >= kOrdinaryIrradianceMin && brightest <= kOrdinaryIrradianceMax)) return 1.0f;
    const int target = brightest < kOrdinaryIrradianceMin ? std::ilogb(kOrdinaryIrradianceMin) : 0;
    return std::ldexp(1.0f, std::clamp(target - std::ilogb(brightest), -kLargestExponent, kLargestExponent));
}

}  // namespace lrsm
