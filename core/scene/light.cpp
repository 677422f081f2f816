#include "core/scene/light.h"

#include "core/base/elementary.h"

#include <array>

namespace lrsm {
namespace {

constexpr float kInverseSquareLimit = 1e30f;

/// Which of the six faces +x, -x, +y, -y, +z, -z a direction leaves a cube through; ties go to the earlier axis.
int cubeFaceOf(const Vec3& d)
{
    const Vec3 a = glm::abs(d);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return 2 * axis + (d[axis] < 0.0f ? 1 : 0);
}

constexpr float kSteepRamp = 0.001f;

/// KHR_lights_punctual's cone: squared linear ramp in the cosine from the outer to the inner angle.
float coneFalloff(float cosInner, float cosOuter, float cosFromAxis)
{
    const float ramp = glm::clamp((cosFromAxis - cosOuter) / (cosInner - cosOuter), 0.0f, 1.0f);
    return ramp * ramp;
}

/// The same by 1 - cos of the angle between two unit vectors, |a - b|^2 / 2, which keeps its digits for small angles.
float steepFalloff(float versineInner, float versineOuter, const Vec3& direction, const Vec3& axis)
{
    const Vec3 off = direction - axis;
    const float versine = 0.5f * glm::dot(off, off), width = std::max(kSteepRamp * versineOuter, versineOuter - versineInner);
    const float ramp = glm::clamp((versineOuter - versine) / width, 0.0f, 1.0f);
    return ramp * ramp;
}

float versineOf(double angle)
{
    const double half = sinCos(0.5 * angle).sin;
    return static_cast<float>(2.0 * half * half);
}

float rangeWindow(float distance, float range)
{
    if (!std::isfinite(range)) return 1.0f;
    const float ratio = distance / range, ratio2 = ratio * ratio;
    return glm::clamp(1.0f - ratio2 * ratio2, 0.0f, 1.0f);
}

}  // namespace

LightSample sampleLight(const Light& light, const Vec3& pWorld)
{
    return LightSampler(light)(pWorld);
}

LightSampler::LightSampler(const Light& light) : light_(light)
{
    if (light.type == LightType::spot) {
        cosInner_ = static_cast<float>(sinCos(light.innerConeAngle).cos);
        cosOuter_ = static_cast<float>(sinCos(light.outerConeAngle).cos);
        versineInner_ = versineOf(light.innerConeAngle);
        versineOuter_ = versineOf(light.outerConeAngle);
        steep_ = cosInner_ - cosOuter_ < kSteepRamp;
    }
    face_ = cubeFaceOf(light.direction);
}

LightSample LightSampler::operator()(const Vec3& pWorld) const
{
    if (light_.type == LightType::directional) return {-light_.direction, kInfinity, glm::min(light_.intensity, Vec3(kMaxIrradiance))};

    const Vec3 fromLight = pWorld - light_.position;
    const float distance = glm::length(fromLight);
    if (!(distance > 0.0f)) return {-light_.direction, 0.0f, Vec3(0.0f)};  // at the light itself: no direction, no light
    const Vec3 direction = fromLight / distance;

    float attenuation = rangeWindow(distance, light_.range) / (distance * distance);
    if (light_.type == LightType::spot)
        attenuation *= steep_ ? steepFalloff(versineInner_, versineOuter_, direction, light_.direction)
                              : coneFalloff(cosInner_, cosOuter_, glm::dot(direction, light_.direction));
    else if (cubeFaceOf(direction) != face_)
        attenuation = 0.0f;
    // 1 / distance^2 may overflow; infinity times a black channel would be NaN.
    attenuation = std::min(attenuation, kInverseSquareLimit);
    return {-direction, distance, glm::min(light_.intensity * attenuation, Vec3(kMaxIrradiance))};
}

std::vector<Light> splitPointLight(const Vec3& position, const Vec3& intensity, float range, const std::string& name)
{
    static constexpr std::array<const char*, 6> kFaceNames = {"+x", "-x", "+y", "-y", "+z", "-z"};
    std::vector<Light> faces;
    for (int face = 0; face < 6; ++face) {
        Light light;
        light.name = name + " " + kFaceNames[std::size_t(face)];
        light.type = LightType::cubeFace;
        light.position = position;
        light.direction = Vec3(0.0f);
        light.direction[face / 2] = face % 2 ? -1.0f : 1.0f;
        light.up = face / 2 == 1 ? Vec3(0.0f, 0.0f, 1.0f) : Vec3(0.0f, 1.0f, 0.0f);
        light.intensity = intensity;
        light.range = range;
        faces.push_back(light);
    }
    return faces;
}

}  // namespace lrsm
