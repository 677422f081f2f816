#include "reference/light_technique.h"

#include "core/base/simd.h"
#include "reference/search.h"

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
    weights_.resize(pool.x.size());
    const Vec3 o = receiver.origin, n = receiver.normal, g = receiver.geometricNormal;
    // The lengths of the way, d, stay in the products: no root is needed. X = d <n.w>, Y = d <n_y.-w>.
    for (std::size_t j = 0; j < pool.x.size(); j += kPoolLanes) {
        const auto at = [j](const std::vector<float>& stream) { return loadFloat4(stream.data() + j); };
        const Float4 dx = at(pool.x) - o.x, dy = at(pool.y) - o.y, dz = at(pool.z) - o.z;
        const Float4 distance2 = dx * dx + dy * dy + dz * dz;
        const Float4 arriving = n.x * dx + n.y * dy + n.z * dz, above = g.x * dx + g.y * dy + g.z * dz;
        const Float4 leaving = -(at(pool.gx) * dx + at(pool.gy) * dy + at(pool.gz) * dz);
        const Float4 shading = -(at(pool.nx) * dx + at(pool.ny) * dy + at(pool.nz) * dz);
        const Float4 product = arriving * leaving;
        const Float4 weight = at(pool.brightness) * candidates * product / (product / kPi + candidates * at(pool.density) * distance2 * distance2);
        const Int4 seen = (arriving > 0.0f) & (above > 0.0f) & (leaving > 0.0f) & (shading > 0.0f) &
                          (shading * shading >= kLeastFacing * kLeastFacing * distance2) & (weight > 0.0f);
        storeFloat4(weights_.data() + j, reinterpret_cast<Float4>(seen & reinterpret_cast<Int4>(weight)));
    }
    weights_.resize(pool.size());
    for (const std::uint32_t j : pool.glossy) {
        Vec3 direction;
        const Vec3 answer = connection(pool, j, receiver, candidates, CosineResponse{receiver.normal}, direction);
        weights_[j] = poolWeight(pool.points[j], answer, direction);
    }
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
    const std::size_t i = std::min(countUpTo(std::span<const double>(sums_), double(u) * sums_.back()), sums_.size() - 1);
    return {first_ + stride_ * i, float(double(stride_) * sums_.back() / (drawn_ * double(weights_[i])))};
}

Vec3 radianceFrom(Tracer& tracer, const LightPool& pool, std::size_t j, const LightReceiver& receiver, const Vec3& direction)
{
    const LightPool::Point& point = pool.points[j];
    const Vec3 position = point.surface.position, way = position - receiver.origin;
    const float distance = glm::length(way), offset = kCoincidence * tracer.offset(position), leaving = -glm::dot(point.surface.geometricNormal, direction);
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
