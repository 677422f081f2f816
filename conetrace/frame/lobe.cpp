#include "conetrace/frame/lobe.h"

#include "conetrace/frame/cones.h"
#include "core/base/elementary.h"
#include "core/scene/brdf.h"

namespace lrsm {
namespace {

static_assert(kRotations == 16);

/// Share u of the lobe within radius sqrt(u): u = 1 - (1 - p)^1.5 has more points, of less weight, in its long tail. With p itself the middle point of the
/// last sixteenth stands for all of the tail, and a glossy box has 5 % too much light (docs/pipeline.md).
double shareWithin(double p)
{
    return 1.0 - (1.0 - p) * std::sqrt(1.0 - p);
}
double shareDensity(double p)
{
    return 1.5 * std::sqrt(1.0 - p);
}

/// What is reflected over what is visible, G2 / G1: height-correlated Smith, as evaluateSpecular has it.
float shadowing(float nl, float nv, float alpha)
{
    const float alpha2 = alpha * alpha;
    const float maskL = std::sqrt(nl * nl * (1.0f - alpha2) + alpha2), maskV = std::sqrt(nv * nv * (1.0f - alpha2) + alpha2);
    return nl * (nv + maskV) / std::max(nl * maskV + nv * maskL, 1e-30f);
}

}  // namespace

std::array<LobePoint, 16> lobePoints()
{
    constexpr double kTwoPi = 6.28318530717958647693;
    std::array<LobePoint, 16> points;
    for (int rotation = 0; rotation < kRotations; ++rotation) {
        const StratumPlace place = stratumPlace(rotation);
        const double radius = std::sqrt(shareWithin(place.u));
        const SinCos azimuth = sinCos(kTwoPi * place.v);
        points[std::size_t(rotation)] = {float(radius * azimuth.cos), float(radius * azimuth.sin), float(shareDensity(place.u))};
    }
    return points;
}

SpecularLobes::SpecularLobes(const ConeSettings& settings)
    : sampling_(settings.specular.direction == SpecularDirection::lobe && settings.set.rotation != Rotation::none), points_(lobePoints())
{
}

LobeDirection SpecularLobes::direction(const Vec3& normal, const Vec3& toEye, float roughness, int rotation) const
{
    if (!sampling_ || !lobeIsWide(roughness)) return {glm::normalize(mirrorDirection(normal, toEye)), 1.0f};
    const LobePoint& point = points_[std::size_t(rotation)];
    const float alpha = std::max(roughness * roughness, kMinSpecularAlpha);
    const Vec3 direction = reflectLobe(normal, alpha, toEye, Vec2(point.x, point.y));
    const float nl = glm::dot(normal, direction), nv = std::max(glm::dot(normal, toEye), 0.0f);
    return {direction, nl > 0.0f ? point.weight * shadowing(nl, nv, alpha) : 0.0f};
}

}  // namespace lrsm
