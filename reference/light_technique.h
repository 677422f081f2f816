#pragma once

#include "reference/light_pool.h"

/// The two techniques of light_pool.h side by side: what each may claim of the light, and how a receiver draws from a pool.
namespace lrsm {

/// Answer to light from a direction w, and the density of technique a there.
struct Response {
    Vec3 value{0.0f};      ///< f(w): <n.w> for irradiance, BRDF <n.w> for radiance, 1 / solid angle for the mean over a cone
    float density = 0.0f;  ///< p_a(w), 1/sr
};

struct CosineResponse {
    Vec3 normal;
    Response operator()(const Vec3& direction) const
    {
        const float cosine = std::max(0.0f, glm::dot(normal, direction));
        return {Vec3(cosine), cosine / kPi};
    }
};

/// Where light is received. Technique a's rays start at `origin`, so that is where b's densities are taken.
struct LightReceiver {
    Vec3 origin{0.0f};  ///< lifted off the surface, as rayFrom does
    Vec3 geometricNormal{0.0f}, normal{0.0f};
};
inline LightReceiver receiverAt(const Tracer& tracer, const Surface& surface)
{
    return {surface.position + surface.geometricNormal * tracer.offset(surface.position), surface.geometricNormal, surface.normal};
}

/// Technique b as a knows it.
struct LightTechnique {
    std::span<const LightMap> maps;
    const LightDensity* density = nullptr;  ///< q; null: a finds all light alone
    float candidates = 0.0f;                ///< c

    /// s_a of light `light`, diffusely reflected at a point that a ray of density p_a has struck after `distance` metres.
    float shareOfRay(float rayDensity, std::size_t light, const Surface& struck, const Vec3& toViewer, const Vec3& toLight, float distance) const;
};

/// One point of a pool, drawn in proportion to its weight.
struct Choice {
    std::size_t index = 0;
    float overDensity = 0.0f;  ///< (sum of w) / (N w_j)
};

/// The weights of a pool's points for one receiver, as running sums.
class PoolWeights {
  public:
    bool any() const { return !sums_.empty() && sums_.back() > 0.0; }
    /// \param u  in [0, 1)
    Choice choose(float u) const;

    /// w = (sum of L's channels) reach (sum of f's channels) c / (p_a + c p_b) for every `stride`-th point from `first` on.
    template <class Respond>
    void weigh(const LightPool& pool, const LightReceiver& receiver, float candidates, const Respond& respond, std::size_t first = 0, std::size_t stride = 1);
    /// The same for CosineResponse and every point.
    void weighDiffuse(const LightPool& pool, const LightReceiver& receiver, float candidates);

  private:
    void sum(const LightPool& pool);
    std::vector<float> weights_;
    std::vector<double> sums_;
    std::size_t first_ = 0, stride_ = 1;
    double drawn_ = 1.0;
};

/// s_b f / p_b towards point j of a pool, V aside; its direction in `direction`. 0 where either side does not face the other.
template <class Respond>
Vec3 connection(const LightPool& pool, std::size_t j, const LightReceiver& receiver, float candidates, const Respond& respond, Vec3& direction)
{
    const LightPool::Point& point = pool.points[j];
    const Vec3 way = point.surface.position - receiver.origin, normal = point.surface.normal;
    const float distance2 = glm::dot(way, way);
    direction = way / std::sqrt(distance2);
    const float leaving = -glm::dot(point.surface.geometricNormal, direction);
    const bool facing = leaving > 0.0f && glm::dot(receiver.geometricNormal, direction) > 0.0f &&
                        -(normal.x * direction.x + normal.y * direction.y + normal.z * direction.z) >= kLeastFacing;
    if (!facing) return Vec3(0.0f);
    const Response response = respond(direction);
    const float both = response.density * leaving + candidates * point.density * distance2;
    return both > 0.0f ? response.value * (candidates * leaving / both) : Vec3(0.0f);
}

/// Of point j in PoolWeights.
template <class Respond>
float poolWeight(const LightPool& pool, std::size_t j, const LightReceiver& receiver, float candidates, const Respond& respond)
{
    Vec3 direction;
    const Vec3 value = connection(pool, j, receiver, candidates, respond, direction);
    const LightPool::Point& point = pool.points[j];
    const float sum = value.x + value.y + value.z;
    if (!(sum > 0.0f) || !point.glossy) return point.brightness * sum;
    const Vec3 specular = specularRadiance(point.surface, point.sample, -direction);
    return (point.brightness + point.reach * (specular.x + specular.y + specular.z)) * sum;
}

template <class Respond>
void PoolWeights::weigh(const LightPool& pool, const LightReceiver& receiver, float candidates, const Respond& respond, std::size_t first, std::size_t stride)
{
    first_ = first;
    stride_ = stride;
    weights_.clear();
    for (std::size_t j = first; j < pool.size(); j += stride) weights_.push_back(poolWeight(pool, j, receiver, candidates, respond));
    sum(pool);
}

/// Radiance that reaches the receiver from point j of a pool: its own, 0 where something is in the way.
Vec3 radianceFrom(Tracer& tracer, const LightPool& pool, std::size_t j, const LightReceiver& receiver, const Vec3& direction);

}  // namespace lrsm
