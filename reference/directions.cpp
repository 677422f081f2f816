#include "reference/directions.h"

#include "core/base/elementary.h"

namespace lrsm {
namespace {

struct Disk {
    float x, y;
};

/// Uniform on the unit disk: radius sqrt(u), azimuth 2 pi v.
Disk diskPoint(UnitPoint xi)
{
    const float radius = std::sqrt(xi.u);
    const SinCos azimuth = sinCos(2.0 * double(kPi) * double(xi.v));
    return {radius * float(azimuth.cos), radius * float(azimuth.sin)};
}

float lobeAlpha(const Surface& surface)
{
    return std::max(surface.roughness * surface.roughness, kMinSpecularAlpha);
}

}  // namespace

Vec3 cosineDirection(const Vec3& normal, UnitPoint xi)
{
    const Disk disk = diskPoint(xi);
    const float z = std::sqrt(std::max(0.0f, 1.0f - xi.u));
    return glm::normalize(basisFromNormal(normal) * Vec3(disk.x, disk.y, z));
}

Vec3 coneDirection(const Vec3& axis, float cosHalf, UnitPoint xi)
{
    const float cosine = 1.0f - xi.u * (1.0f - cosHalf);
    // 1 - cos^2 from 1 - cos, which keeps its digits in a narrow cone.
    const float away = xi.u * (1.0f - cosHalf);
    const float sine = std::sqrt(std::max(0.0f, away * (2.0f - away)));
    const SinCos azimuth = sinCos(2.0 * double(kPi) * double(xi.v));
    return glm::normalize(basisFromNormal(axis) * Vec3(sine * float(azimuth.cos), sine * float(azimuth.sin), cosine));
}

Vec3 lobeDirection(const Surface& surface, const Vec3& toViewer, UnitPoint xi)
{
    const Disk disk = diskPoint(xi);
    return reflectLobe(surface.normal, lobeAlpha(surface), toViewer, Vec2(disk.x, disk.y));
}

float lobeDensity(const Surface& surface, const Vec3& toViewer, const Vec3& toLight)
{
    const Vec3 half = toLight + toViewer;
    const float length2 = glm::dot(half, half);
    const float nv = std::max(glm::dot(surface.normal, toViewer), 1e-6f);
    if (!(length2 > 0.0f)) return 0.0f;
    const Vec3 h = half / std::sqrt(length2);
    const float nh = glm::dot(surface.normal, h);
    if (!(nh > 0.0f)) return 0.0f;

    const float alpha = lobeAlpha(surface), alpha2 = alpha * alpha;
    const Vec3 sine = glm::cross(surface.normal, h);
    const float spread = glm::dot(sine, sine) + alpha2 * nh * nh;
    const float distribution = alpha2 / (kPi * spread * spread);
    const float masking = 2.0f * nv / (nv + std::sqrt(alpha2 + (1.0f - alpha2) * nv * nv));
    // D_v = G1 D <v.h> / <n.v>; the <v.h> cancels against the reflection's Jacobian.
    return masking * distribution / (4.0f * nv);
}

}  // namespace lrsm
