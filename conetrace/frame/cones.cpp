#include "conetrace/frame/cones.h"

#include "core/base/elementary.h"

#include <algorithm>

namespace lrsm {
namespace {

constexpr double kHalfPi = 1.57079632679489661923, kTwoPi = 6.28318530717958647693;
constexpr double kLargestHalfAngle = 1.4;  // about 80 degrees: a wider cone has no useful diameter

/// arccos on [-1, 1] by bisection of our own cosine: set-up only, the same bits everywhere.
double arcCosine(double c)
{
    double low = 0.0, high = 2.0 * kHalfPi;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (sinCos(middle).cos > c ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

float tracedTangent(double halfAngle, float scale)
{
    return static_cast<float>(tangent(std::min(halfAngle * double(scale), kLargestHalfAngle)));
}

Vec3 directionAt(double cosPolar, double sinPolar, double azimuth)
{
    const SinCos sc = sinCos(azimuth);
    return Vec3(float(sinPolar * sc.cos), float(sinPolar * sc.sin), float(cosPolar));
}

ConeRing paperRing(int ring, int rings, int count, const ConeSettings& settings)
{
    const double h = kHalfPi / (2 * rings - 1);
    const bool single = rings == 1;
    const double inner = ring == 0 ? 0.0 : (2 * ring - 1) * h, outer = single ? kHalfPi : (2 * ring + 1) * h;
    const double sinInner = sinCos(inner).sin, sinOuter = sinCos(outer).sin;

    ConeRing r;
    r.count = count;
    r.innerAngle = static_cast<float>(inner);
    r.outerAngle = static_cast<float>(outer);
    // A single ring of several cones has its axes at 45 degrees; one cone alone looks along the normal, 120 degrees wide.
    const double axis = single ? (count == 1 ? 0.0 : 0.5 * kHalfPi) : 2 * ring * h;
    const double halfAngle = single ? (count == 1 ? kHalfPi * 2.0 / 3.0 : 0.5 * kHalfPi) : h;
    r.axisAngle = static_cast<float>(axis);
    r.tanHalf = tracedTangent(halfAngle, settings.set.apertureScale);
    r.weight = static_cast<float>((sinOuter * sinOuter - sinInner * sinInner) / count);
    return r;
}

/// Malley's disc: r^2 of the ring runs over [first, first + count) / total.
ConeRing slabRing(int first, int count, int total, const ConeSettings& settings)
{
    const double cosInner = std::sqrt(1.0 - double(first) / total), cosOuter = std::sqrt(1.0 - double(first + count) / total);
    ConeRing r;
    r.count = count;
    r.innerAngle = static_cast<float>(arcCosine(cosInner));
    r.outerAngle = static_cast<float>(arcCosine(cosOuter));
    r.axisAngle = 0.5f * (r.innerAngle + r.outerAngle);
    // Cap of the stratum's own solid angle 2 pi (cosInner - cosOuter) / count = 2 pi (1 - cos a).
    r.tanHalf = tracedTangent(arcCosine(1.0 - (cosInner - cosOuter) / count), settings.set.apertureScale);
    r.weight = static_cast<float>(1.0 / total);
    return r;
}

}  // namespace

std::vector<int> ringCounts(int count)
{
    if (count <= 4) return {count};
    // A cone's share of the hemisphere is about (2 pi / count) steradian: as many rings as such squares fit from pole to horizon.
    const int rings = std::max(2, static_cast<int>(kHalfPi / std::sqrt(kTwoPi / count) + 0.5));
    const double h = kHalfPi / (2 * rings - 1), cosCap = sinCos(kHalfPi - h).sin;
    std::vector<int> counts = {1};
    int placed = 1;
    for (int ring = 1; ring < rings; ++ring) {
        // Cones in proportion to solid angle, rounded cumulatively.
        const double share = (cosCap - sinCos(kHalfPi - (2 * ring + 1) * h).sin) / cosCap;
        const int upTo = ring + 1 == rings ? count : 1 + static_cast<int>((count - 1) * share + 0.5);
        counts.push_back(upTo - placed);
        placed = upTo;
    }
    return counts;
}

ConeSet makeConeSet(const ConeSettings& settings)
{
    const bool slab = settings.march.estimator == Estimator::slab;
    const std::vector<int> counts = ringCounts(settings.set.count);
    ConeSet set;
    set.count = settings.set.count;
    int first = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        ConeRing ring = slab ? slabRing(first, counts[i], settings.set.count, settings)
                             : paperRing(static_cast<int>(i), static_cast<int>(counts.size()), counts[i], settings);
        ring.first = first;
        first += ring.count;
        set.rings.push_back(ring);
    }

    for (int rotation = 0; rotation < kRotations; ++rotation) {
        const StratumPlace jitter = stratumPlace(rotation);
        for (const ConeRing& ring : set.rings) {
            const double sinInner = sinCos(ring.innerAngle).sin, sinOuter = sinCos(ring.outerAngle).sin;
            for (int k = 0; k < ring.count; ++k) {
                if (settings.set.rotation == Rotation::strata) {
                    // Uniform in the disc of Malley's method: cosine-weighted over the cone's share of the ring.
                    const double r2 = sinInner * sinInner + (sinOuter * sinOuter - sinInner * sinInner) * jitter.u;
                    set.directions.push_back(directionAt(std::sqrt(1.0 - r2), std::sqrt(r2), kTwoPi * (k + jitter.v) / ring.count));
                } else {
                    const SinCos axis = sinCos(ring.axisAngle);
                    const double turn = settings.set.rotation == Rotation::azimuth ? kTwoPi * rotation / kRotations : 0.0;
                    set.directions.push_back(directionAt(axis.cos, axis.sin, kTwoPi * k / ring.count + turn));
                }
            }
        }
    }
    return set;
}

StratumPlace stratumPlace(int rotation)
{
    const int reversed = ((rotation & 1) << 3) | ((rotation & 2) << 1) | ((rotation & 4) >> 1) | ((rotation & 8) >> 3);
    return {(rotation + 0.5) / kRotations, (reversed + 0.5) / kRotations};
}

int rotationOfPixel(int x, int y, Rotation rotation)
{
    if (rotation == Rotation::none) return 0;
    // Interleaved bits of x^y and y, most significant last: the 4x4 ordered-dither matrix.
    const int a = (x ^ y) & 3, b = y & 3;
    return ((a & 1) << 3) | ((b & 1) << 2) | ((a & 2)) | ((b & 2) >> 1);
}

float specularTanHalf(const ConeSettings& settings, float roughness)
{
    constexpr float kWidest = 1.7320508f;  // tan 60 degrees
    if (settings.specular.aperture == SpecularAperture::fixed)
        return static_cast<float>(tangent(0.5 * double(settings.specular.apertureDegrees) * kHalfPi / 90.0));
    const float alpha = roughness * roughness;
    return alpha < 1.0f ? std::min(kWidest, 2.0f * alpha / (1.0f - alpha * alpha)) : kWidest;
}

}  // namespace lrsm
