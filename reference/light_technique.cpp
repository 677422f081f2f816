#include "reference/light_technique.h"

#include <algorithm>

namespace lrsm {
namespace {

/// Coincident triangles: a ray finds one of them, whichever is asked for. How far apart they may be, in the rays' own offset.
constexpr float kCoincidence = 2.0f;

}  // namespace

float LightTechnique::shareOfRay(float rayDensity, std::size_t light, const Surface& struck, const Vec3& toViewer, const Vec3& toLight, float distance) const
{
    if (!density || !seenAlike(struck.geometricNormal, struck.normal, toViewer)) return 1.0f;
    const std::optional<LightCoordinates> at = maps[light].coordinates(struck.position);
    if (!at) return 1.0f;
    const float leaving = glm::dot(struck.geometricNormal, toViewer);
    const auto overSurface = float(double((*density)({std::uint32_t(light), at->at})) * at->perArea * double(glm::dot(struck.geometricNormal, toLight)));
    const float a = rayDensity * leaving, both = a + candidates * overSurface * distance * distance;
    return both > a ? a / both : 1.0f;
}

void PoolWeights::weighDiffuse(const LightPool& pool, const LightReceiver& receiver, float candidates)
{
    first_ = 0;
    stride_ = 1;
    weights_.resize(pool.size());
    const Vec3 o = receiver.origin, n = receiver.normal, g = receiver.geometricNormal;
    // The lengths of the way, d, stay in the products: no root is needed. X = d <n.w>, Y = d <n_y.-w>.
    for (std::size_t j = 0; j < pool.size(); ++j) {
        const float dx = pool.x[j] - o.x, dy = pool.y[j] - o.y, dz = pool.z[j] - o.z;
        const float distance2 = dx * dx + dy * dy + dz * dz;
        const float arriving = n.x * dx + n.y * dy + n.z * dz, above = g.x * dx + g.y * dy + g.z * dz;
        const float leaving = -(pool.gx[j] * dx + pool.gy[j] * dy + pool.gz[j] * dz);
        const float shading = -(pool.nx[j] * dx + pool.ny[j] * dy + pool.nz[j] * dz);
        const float product = arriving * leaving;
        const float weight = pool.brightness[j] * candidates * product / (product / kPi + candidates * pool.density[j] * distance2 * distance2);
        const bool seen = (arriving > 0.0f) & (above > 0.0f) & (leaving > 0.0f) & (shading > 0.0f) &
                          (shading * shading >= kLeastFacing * kLeastFacing * distance2) & (weight > 0.0f);
        weights_[j] = seen ? weight : 0.0f;
    }
    for (const std::uint32_t j : pool.glossy) weights_[j] = poolWeight(pool, j, receiver, candidates, CosineResponse{receiver.normal});
    sum(pool);
}

void PoolWeights::sum(const LightPool& pool)
{
    drawn_ = double(pool.drawn);
    sums_.resize(weights_.size());
    double total = 0.0;
    for (std::size_t i = 0; i < weights_.size(); ++i) sums_[i] = total += double(weights_[i]);
    if (!std::isfinite(total)) sums_.clear();
}

Choice PoolWeights::choose(float u) const
{
    const auto above = std::upper_bound(sums_.begin(), sums_.end(), double(u) * sums_.back());
    const std::size_t i = std::min(std::size_t(above - sums_.begin()), sums_.size() - 1);
    return {first_ + stride_ * i, float(double(stride_) * sums_.back() / (drawn_ * double(weights_[i])))};
}

Vec3 radianceFrom(Tracer& tracer, const LightPool& pool, std::size_t j, const LightReceiver& receiver, const Vec3& direction)
{
    const LightPool::Point& point = pool.points[j];
    const Vec3 way = pool.position(j) - receiver.origin, normal = pool.geometricNormal(j);
    const float distance = glm::length(way), offset = kCoincidence * tracer.offset(pool.position(j)), leaving = -glm::dot(normal, direction);
    const Ray ray{receiver.origin, direction, 0.0f, distance + offset / leaving, RayKind::bounce};
    const std::optional<RayHit> hit = tracer.closestHit(ray);
    if (!hit) return Vec3(0.0f);
    if (hit->surface.mesh == point.hit.mesh && hit->surface.triangle == point.hit.triangle) return point.radianceTowards(-direction);

    // Of triangles that lie in each other, the one that technique a would have found counts.
    if ((distance - hit->t) * leaving > offset || !reflects(tracer.scene(), *hit)) return Vec3(0.0f);
    const Surface surface = evaluateSurface(tracer.scene(), hit->surface, -direction);
    const LightSample light = tracer.lights()[point.light](surface.position);
    if (!(glm::dot(surface.geometricNormal, light.toLight) > 0.0f)) return Vec3(0.0f);
    return diffuseRadiance(surface, light) + (pool.transport == Transport::full ? specularRadiance(surface, light, -direction) : Vec3(0.0f));
}

}  // namespace lrsm
