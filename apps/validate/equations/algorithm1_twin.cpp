#include "apps/validate/equations/algorithm1_twin.h"

#include "apps/validate/equations/oracle.h"

namespace lrsm::twin {
namespace {

double tent(double distance)
{
    return std::max(0.0, 1.0 - std::abs(distance));
}

double fractionOf(double t, FilterFraction fraction, double& toTie)
{
    if (fraction == FilterFraction::exact) return t;
    const double scaled = t * 256.0 + 0.5;
    toTie = std::min(toTie, std::abs(scaled - std::round(scaled)));
    return std::floor(scaled) / 256.0;
}

}  // namespace

Projected project(const LightProjection& projection, const DVec3& pWorld)
{
    const DVec3 d = pWorld - DVec3(projection.position);
    const double x = glm::dot(DVec3(projection.right), d), y = glm::dot(DVec3(projection.up), d), z = glm::dot(DVec3(projection.forward), d);
    const double range = double(projection.depthFar) - double(projection.depthNear);
    Projected p;
    double half = double(projection.halfWidth), distance = z;
    if (projection.type != LightType::directional) {
        if (!(z > 0.0)) return p;
        half *= z;
        distance = glm::length(d);
    }
    p.valid = true;
    p.u = (x + half) / (2.0 * half);
    p.v = (half - y) / (2.0 * half);
    p.depth = (distance - double(projection.depthNear)) / range;
    p.texelSize = 2.0 * half / projection.resolution;
    return p;
}

double level(double diameterMetres, double rsmTexelSize, double bias, double minLevel)
{
    if (!(diameterMetres > 0.0)) return minLevel;
    return std::max(std::log2(diameterMetres) - std::log2(rsmTexelSize) - 1.0 + bias, minLevel);
}

Slice sliceOf(const LayerRange& range)
{
    return {.depthMin = range.depthMin, .depthMax = range.depthMax, .delta = range.delta, .decayAtMin = range.decayAtMin, .decayAtMax = range.decayAtMax};
}

double decay(const Slice& range, double zc)
{
    const double lo = range.depthMin, hi = range.depthMax, delta = range.delta;
    const auto k = [](double t) { return t <= 0.0 ? 0.0 : t >= 1.0 ? 1.0 : 3.0 * t * t - 2.0 * t * t * t; };
    if (!(zc >= lo && zc <= hi) || (zc == hi && range.decayAtMax)) return 0.0;
    if (range.decayAtMin && zc < lo + delta) return k((zc - lo) / delta);
    if (range.decayAtMax && zc > hi - delta) return k((hi - zc) / delta);
    return 1.0;
}

double weight(const Lrsm& lrsm, int lod, int x, int y, double u, double v, double level)
{
    const double n = lrsm.baseResolution >> lod, last = lrsm.levels() - 1;
    const double clamped = std::min(std::max(level, 0.0), last);
    return tent(clamped - lod) * tent(u * n - (x + 0.5)) * tent(v * n - (y + 0.5));
}

Filtered sample(const Lrsm& lrsm, int layer, double u, double v, double level)
{
    Filtered sum;
    const double clamped = std::min(std::max(level, 0.0), double(lrsm.levels() - 1));
    for (int lod = static_cast<int>(clamped); lod <= std::min(static_cast<int>(clamped) + 1, lrsm.levels() - 1); ++lod) {
        const int n = lrsm.baseResolution >> lod;
        const int x0 = static_cast<int>(std::floor(u * n - 0.5)), y0 = static_cast<int>(std::floor(v * n - 0.5));
        for (int y = std::max(y0, 0); y <= std::min(y0 + 1, n - 1); ++y)
            for (int x = std::max(x0, 0); x <= std::min(x0 + 1, n - 1); ++x) {
                const double w = weight(lrsm, lod, x, y, u, v, clamped);
                const LrsmTexel& t = lrsm.level(layer, lod)[std::size_t(y) * std::size_t(n) + std::size_t(x)];
                sum.radiance += w * DVec3(t.radiance[0], t.radiance[1], t.radiance[2]);
                sum.normal += w * DVec3(t.normal[0], t.normal[1], t.normal[2]);
                sum.normalAlpha += w * double(t.normal[3]);
                sum.depth += w * double(t.depth[0]);
                sum.depthSquared += w * double(t.depth[1]);
                sum.depthAlpha += w * double(t.depth[2]);
            }
    }
    return sum;
}

Outgoing algorithm1(const Lrsm& lrsm, const Projected& p, const ConeSample& cone, const ConeSettings& settings, double varianceFloor)
{
    Outgoing result;
    if (!p.valid) return result;
    for (const double edge : {p.u, 1.0 - p.u, p.v, 1.0 - p.v}) result.toJump = std::min(result.toJump, std::abs(edge));
    if (!(p.u >= 0.0 && p.u <= 1.0 && p.v >= 0.0 && p.v <= 1.0)) return result;

    // The sampler's fractions, exact or in 1/256: each level rounds its own coordinates.
    double toTie = 1.0;
    const double d = level(2.0 * double(cone.radius), p.texelSize, double(settings.gather.rsmLevelBias), double(settings.gather.rsmMinLevel));
    const double lod = fractionOf(std::min(std::max(d, 0.0), double(lrsm.levels() - 1)), settings.march.filterFraction, toTie);
    const auto filtered = [&](int layer) {
        if (settings.march.filterFraction == FilterFraction::exact) return sample(lrsm, layer, p.u, p.v, lod);
        Filtered sum;
        for (int fine = static_cast<int>(lod); fine <= std::min(static_cast<int>(lod) + 1, lrsm.levels() - 1); ++fine) {
            const double n = lrsm.baseResolution >> fine, share = tent(lod - fine);
            const double u = (fractionOf(p.u * n - 0.5, settings.march.filterFraction, toTie) + 0.5) / n,
                         v = (fractionOf(p.v * n - 0.5, settings.march.filterFraction, toTie) + 0.5) / n;
            const Filtered one = sample(lrsm, layer, u, v, fine);
            sum.radiance += share * one.radiance;
            sum.normal += share * one.normal;
            sum.normalAlpha += share * one.normalAlpha;
            sum.depth += share * one.depth;
            sum.depthSquared += share * one.depthSquared;
            sum.depthAlpha += share * one.depthAlpha;
        }
        return sum;
    };

    const double range = double(lrsm.projection.depthFar) - double(lrsm.projection.depthNear);
    const double window = double(cone.radius) * double(settings.gather.vRadiusScale) / range;
    for (int layer = 0; layer < lrsm.layers(); ++layer) {
        const LayerRange& bounds = lrsm.ranges[std::size_t(layer)];
        double f = 1.0;
        if (settings.gather.layerSelection == LayerSelection::touched) {
            const double gap = std::min(p.depth + window - double(bounds.depthMin), double(bounds.depthMax) - (p.depth - window));
            result.toJump = std::min(result.toJump, std::abs(gap));
            if (gap < 0.0) continue;
        } else {
            f = decay(sliceOf(bounds), p.depth);
            for (const double edge : {double(bounds.depthMin), double(bounds.depthMax)}) result.toJump = std::min(result.toJump, std::abs(p.depth - edge));
        }
        if (!(f > 0.0)) continue;
        const Filtered t = filtered(layer);
        if (!(t.depthAlpha > 0.0 && t.normalAlpha > 0.0)) continue;
        double n = glm::dot(t.normal, DVec3(cone.toReceiver)) / t.normalAlpha;
        if (settings.gather.backface == Backface::step) result.toJump = std::min(result.toJump, std::abs(n));
        if (!(n > 0.0)) continue;
        if (settings.gather.backface == Backface::step) n = 1.0;

        const double mu = t.depth / t.depthAlpha, sigma2 = std::max(t.depthSquared / t.depthAlpha - mu * mu, varianceFloor);
        const double width = double(bounds.depthMax) - double(bounds.depthMin);
        const double v = static_cast<double>(oracle::visibility(mu, sigma2, (p.depth - double(bounds.depthMin)) / width, window / width));
        result.radiance += (f * v * n) * t.radiance;
    }
    if (toTie < 1e-3) result.toJump = 0.0;  // a fraction that rounds either way
    return result;
}

}  // namespace lrsm::twin
