#include "conetrace/caches/mapping.h"

#include "conetrace/frame/cones.h"
#include "core/base/elementary.h"

#include <cmath>

namespace lrsm {
namespace {

constexpr double kQuarterPi = 0.78539816339744830962, kTwoPi = 8.0 * kQuarterPi;

/// Solid angle of a unit of the square there, but for a factor.
double density(const glm::dvec3& direction, CacheMapping mapping)
{
    if (mapping == CacheMapping::equalArea) return 1.0;
    // A point p of the octahedron's face lies |p| = 1 / (|x| + |y| + z) away: dw = dx dy / |p|^3.
    const double distance = 1.0 / (std::abs(direction.x) + std::abs(direction.y) + direction.z);
    return 1.0 / (distance * distance * distance);
}

struct Subdirection {
    glm::dvec3 direction;
    double solidAngle;
};

/// kSubdirections^2 a texel, [texel * kSubdirections^2 + k]; their solid angles sum to 2 pi.
std::vector<Subdirection> subdirections(int resolution, CacheMapping mapping)
{
    std::vector<Subdirection> all;
    double sum = 0.0;
    for (int row = 0; row < resolution; ++row)
        for (int column = 0; column < resolution; ++column)
            for (int k = 0; k < kSubdirections * kSubdirections; ++k) {
                const double u = column + (k % kSubdirections + 0.5) / kSubdirections, v = row + (k / kSubdirections + 0.5) / kSubdirections;
                const glm::dvec3 direction = hemisphereFromSquare(u / resolution, v / resolution, mapping);
                all.push_back({direction, density(direction, mapping)});
                sum += all.back().solidAngle;
            }
    for (Subdirection& one : all) one.solidAngle *= kTwoPi / sum;
    return all;
}

/// Level 0 from the sub-directions, each level above the sum of four.
std::vector<std::vector<float>> solidAngles(int resolution, const std::vector<Subdirection>& all)
{
    constexpr int kPerTexel = kSubdirections * kSubdirections;
    std::vector<double> level(std::size_t(resolution) * std::size_t(resolution));
    for (std::size_t i = 0; i < all.size(); ++i) level[i / kPerTexel] += all[i].solidAngle;
    std::vector<std::vector<float>> levels;
    for (int n = resolution;; n /= 2) {
        levels.emplace_back(level.begin(), level.end());
        if (n == 1) return levels;
        std::vector<double> above(level.size() / 4);
        for (std::size_t i = 0; i < level.size(); ++i) {
            const std::size_t row = i / std::size_t(n), column = i % std::size_t(n);
            above[(row / 2) * std::size_t(n / 2) + column / 2] += level[i];
        }
        level = std::move(above);
    }
}

std::vector<float> cosineShares(int resolution, const CacheSettings& settings, const std::vector<Subdirection>& all)
{
    constexpr int kPerTexel = kSubdirections * kSubdirections;
    const std::size_t texels = std::size_t(resolution) * std::size_t(resolution);
    std::vector<float> shares;
    for (int m = 0; m < kDiffuseNodes * kDiffuseNodes; ++m) {
        constexpr double kIntervals = kDiffuseNodes - 1;
        const glm::dvec3 normal = hemisphereFromSquare(m % kDiffuseNodes / kIntervals, m / kDiffuseNodes / kIntervals, settings.mapping);
        std::vector<double> cosines(texels);
        double sum = 0.0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const double cosine = std::max(0.0, glm::dot(normal, all[i].direction)) * all[i].solidAngle;
            cosines[i / kPerTexel] += cosine;
            sum += cosine;
        }
        const double whole = settings.horizon == CacheHorizon::renormalise ? sum : 4.0 * kQuarterPi;
        for (const double cosine : cosines) shares.push_back(static_cast<float>(cosine / whole));
    }
    return shares;
}

}  // namespace

glm::dvec3 hemisphereFromSquare(double u, double v, CacheMapping mapping)
{
    const double a = 2.0 * u - 1.0, b = 2.0 * v - 1.0;
    if (mapping == CacheMapping::octahedral) {
        const double x = 0.5 * (a + b), y = 0.5 * (b - a);
        return glm::normalize(glm::dvec3(x, y, 1.0 - std::abs(x) - std::abs(y)));
    }
    // r is signed: the four triangles of the square are two pairs.
    const bool wide = std::abs(a) > std::abs(b);
    const double r = wide ? a : b;
    if (r == 0.0) return {0.0, 0.0, 1.0};
    const SinCos angle = sinCos(kQuarterPi * (wide ? b : a) / r);
    const double along = wide ? angle.cos : angle.sin, across = wide ? angle.sin : angle.cos;
    const double radius = r * std::sqrt(2.0 - r * r);
    return {radius * along, radius * across, 1.0 - r * r};
}

Vec2 squareFromHemisphere(const Vec3& direction, CacheMapping mapping)
{
    const float z = std::max(direction.z, 0.0f), ax = std::abs(direction.x), ay = std::abs(direction.y);
    if (mapping == CacheMapping::octahedral) {
        const float sum = ax + ay + z;
        if (!(sum > 0.0f)) return Vec2(0.5f);
        const float x = direction.x / sum, y = direction.y / sum;
        return {0.5f + 0.5f * (x - y), 0.5f + 0.5f * (x + y)};
    }
    // 1 - z = (x^2 + y^2) / (1 + z), without the cancellation near the axis.
    const float r = z > 0.0f ? std::min(1.0f, std::sqrt((direction.x * direction.x + direction.y * direction.y) / (1.0f + z))) : 1.0f;
    const bool wide = ax > ay;
    const float longer = wide ? direction.x : direction.y, shorter = wide ? direction.y : direction.x;
    if (longer == 0.0f) return Vec2(0.5f);
    const float signedR = std::copysign(r, longer);
    constexpr float kFourOverPi = 4.0f / kPi;
    const float across = signedR * (kFourOverPi * octantArcTangent(shorter / longer));
    return wide ? Vec2(0.5f + 0.5f * signedR, 0.5f + 0.5f * across) : Vec2(0.5f + 0.5f * across, 0.5f + 0.5f * signedR);
}

CacheTables makeCacheTables(const CacheSettings& settings, Rotation rotation)
{
    CacheTables tables;
    const int n = tables.resolution = settings.resolution;
    tables.mapping = settings.mapping;
    for (int set = 0; set < kRotations; ++set) {
        const StratumPlace place = rotation == Rotation::strata ? stratumPlace(set) : StratumPlace{0.5, 0.5};
        for (int row = 0; row < n; ++row)
            for (int column = 0; column < n; ++column)
                tables.directions.emplace_back(hemisphereFromSquare((column + place.u) / n, (row + place.v) / n, settings.mapping));
    }
    const std::vector<Subdirection> all = subdirections(n, settings.mapping);
    tables.solidAngle = solidAngles(n, all);
    tables.cosineShare = cosineShares(n, settings, all);
    return tables;
}

float texelTanHalf(int resolution, float scale)
{
    const double c = 1.0 - 1.0 / (double(resolution) * double(resolution));
    return static_cast<float>(tangent(double(scale) * arcTangent2(std::sqrt(1.0 - c * c), c)));
}

}  // namespace lrsm
