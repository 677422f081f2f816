#pragma once

#include "core/base/simd.h"
#include "reference/light_pool.h"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

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

/// From a receiver to a point that faces it, and that it faces.
struct PoolWay {
    Vec3 direction{0.0f};
    float distance2 = 0.0f, leaving = 0.0f;  ///< leaving: <n_y.-w>
};

/// The weights of a pool's points for one receiver, as running sums.
class PoolWeights {
  public:
    bool any() const { return !sums_.empty() && sums_.back() > 0.0; }
    /// \param u  in [0, 1)
    Choice choose(float u) const;

    /// w = (sum of L's channels) reach (sum of f's channels) c / (p_a + c p_b) for one subset's points.
    template <class Respond>
    void weigh(const LightPool& pool, const LightReceiver& receiver, float candidates, const Respond& respond, std::size_t subset);
    /// The same for CosineResponse and every point of a pool that is one subset.
    void weighDiffuse(const LightPool& pool, const LightReceiver& receiver, float candidates);

  private:
    void sum(const LightPool& pool);
    std::vector<float> weights_;
    std::vector<std::pair<std::size_t, PoolWay>> facing_;
    std::vector<double> sums_;
    std::size_t first_ = 0, stride_ = 1;
    double drawn_ = 1.0;
};

/// s_b f / p_b along a way to a point, V aside.
template <class Respond>
Vec3 answerAlong(const PoolWay& way, const LightPool::Point& point, float candidates, const Respond& respond)
{
    const Response response = respond(way.direction);
    const float both = response.density * way.leaving + candidates * point.density * way.distance2;
    return both > 0.0f ? response.value * (candidates * way.leaving / both) : Vec3(0.0f);
}

/// The same towards point j of a pool; its direction in `direction`. 0 where either side does not face the other.
template <class Respond>
Vec3 connection(const LightPool& pool, std::size_t j, const LightReceiver& receiver, float candidates, const Respond& respond, Vec3& direction)
{
    const LightPool::Point& point = pool.points[j];
    const Vec3 way = point.surface.position - receiver.origin;
    const float distance2 = glm::dot(way, way);
    direction = way / std::sqrt(distance2);
    const float leaving = -glm::dot(point.surface.geometricNormal, direction);
    const bool facing = leaving > 0.0f && glm::dot(receiver.geometricNormal, direction) > 0.0f && -glm::dot(point.surface.normal, direction) >= kLeastFacing;
    return facing ? answerAlong({direction, distance2, leaving}, point, candidates, respond) : Vec3(0.0f);
}

/// Of a point in PoolWeights.
inline float poolWeight(const LightPool::Point& point, const Vec3& answer, const Vec3& direction)
{
    const float sum = answer.x + answer.y + answer.z;
    if (!(sum > 0.0f) || !point.glossy) return point.brightness * sum;
    const Vec3 specular = specularRadiance(point.surface, point.sample, -direction);
    return (point.brightness + point.reach * (specular.x + specular.y + specular.z)) * sum;
}

inline Float4 squareRoot(const Float4& v)
{
#if defined(__SSE2__)
    return reinterpret_cast<Float4>(_mm_sqrt_ps(reinterpret_cast<__m128>(v)));
#else
    return {std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
#endif
}

template <class Respond>
void PoolWeights::weigh(const LightPool& pool, const LightReceiver& receiver, float candidates, const Respond& respond, std::size_t subset)
{
    first_ = subset;
    stride_ = pool.subsets;
    const std::size_t slots = pool.slotsASubset(), begin = subset * slots;
    weights_.assign(pool.subsetSize(subset), 0.0f);

    // Which points face, as connection() has it, four at a time and without a branch on it: it would be guessed wrong
    facing_.resize(slots + 1);
    std::size_t facing = 0;
    const Vec3 o = receiver.origin, g = receiver.geometricNormal;
    for (std::size_t slot = 0; slot < slots; slot += kPoolLanes) {
        const auto at = [&](const std::vector<float>& stream) { return loadFloat4(stream.data() + begin + slot); };
        const Float4 wx = at(pool.x) - o.x, wy = at(pool.y) - o.y, wz = at(pool.z) - o.z;
        const Float4 distance2 = wx * wx + wy * wy + wz * wz, distance = squareRoot(distance2);
        const Float4 dx = wx / distance, dy = wy / distance, dz = wz / distance;
        const Float4 leaving = -(at(pool.gx) * dx + at(pool.gy) * dy + at(pool.gz) * dz);
        const Float4 above = g.x * dx + g.y * dy + g.z * dz;
        const Float4 shading = -(at(pool.nx) * dx + at(pool.ny) * dy + at(pool.nz) * dz);
        const Int4 seen = (leaving > 0.0f) & (above > 0.0f) & (shading >= kLeastFacing);
        for (std::size_t lane = 0; lane < kPoolLanes; ++lane) {
            facing_[facing] = {slot + lane, {Vec3(dx[lane], dy[lane], dz[lane]), distance2[lane], leaving[lane]}};
            facing -= std::size_t(std::ptrdiff_t(seen[lane]));
        }
    }

    // What the receiver answers to these
    for (const auto& [i, way] : std::span(facing_).first(facing)) {
        const LightPool::Point& point = pool.points[subset + stride_ * i];
        weights_[i] = poolWeight(point, answerAlong(way, point, candidates, respond), way.direction);
    }
    sum(pool);
}

/// Radiance that reaches the receiver from point j of a pool: its own, 0 where something is in the way.
Vec3 radianceFrom(Tracer& tracer, const LightPool& pool, std::size_t j, const LightReceiver& receiver, const Vec3& direction);

}  // namespace lrsm
