#include "apps/validate/ladder/surface_integral.h"

#include "core/base/elementary.h"
#include "core/base/rng.h"
#include "reference/directions.h"

namespace lrsm {
namespace {

enum class Use : std::uint32_t { disk = 1, bundle = 2, beam = 3 };

/// Jittered point of stratum (i, j) of side^2.
UnitPoint stratum(int i, int j, int side, const SampleKey& key, Use use)
{
    const Philox4 words = philox({key.pixel, key.coneAndStep, static_cast<std::uint32_t>(j * side + i), static_cast<std::uint32_t>(use)},
                                 {static_cast<std::uint32_t>(key.seed), static_cast<std::uint32_t>(key.seed >> 32)});
    const auto n = static_cast<float>(side);
    return {(static_cast<float>(i) + unitFloat(words[0])) / n, (static_cast<float>(j) + unitFloat(words[1])) / n};
}

/// Unit square to unit disk, equal areas to equal areas.
Vec2 onDisk(const UnitPoint& xi)
{
    const SinCos turn = sinCos(2.0 * 3.14159265358979323846 * double(xi.v));
    const double radius = std::sqrt(double(xi.u));
    return {static_cast<float>(radius * turn.cos), static_cast<float>(radius * turn.sin)};
}

/// <n.v> of Eq. 2 is clamped to 0 at the back of a single-sided surface.
bool facesRay(const Scene& scene, const RayHit& hit)
{
    return hit.front || scene.materials[std::size_t(scene.meshes[hit.surface.mesh].material)].doubleSided;
}

/// f_r L_d <n.l> V(x, l), summed over lights, with the diffuse f_r of Eq. 6.
Vec3 diffuseRadiance(Tracer& tracer, const RayHit& hit, const Vec3& toViewer)
{
    Surface surface = evaluateSurface(tracer.scene(), hit.surface, toViewer);
    surface.specularColor = Vec3(0.0f);
    return directLight(tracer, surface, toViewer);
}

struct RaySum {
    Vec3 radiance{0.0f};
    int hits = 0;
    double mean() const { return hits ? double(radiance.x + radiance.y + radiance.z) / (3.0 * hits) : 0.0; }
};

}  // namespace

SurfaceIntegral integrateSurface(Tracer& tracer, const ConeSample& sphere, int side, const SampleKey& key)
{
    const Mat3 basis = basisFromNormal(sphere.toReceiver);
    RaySum halves[2];
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            const Vec2 at = sphere.radius * onDisk(stratum(i, j, side, key, Use::disk));
            const float reach = std::sqrt(std::max(0.0f, sphere.radius * sphere.radius - glm::dot(at, at)));
            const Vec3 entry = sphere.centre + basis * Vec3(at, reach);
            const std::optional<RayHit> hit = tracer.closestHit({entry, -sphere.toReceiver, 0.0f, 2.0f * reach, RayKind::bounce});
            if (!hit || !facesRay(tracer.scene(), *hit)) continue;
            RaySum& half = halves[(i + j) % 2];
            half.radiance += diffuseRadiance(tracer, *hit, sphere.toReceiver);
            ++half.hits;
        }

    const int hits = halves[0].hits + halves[1].hits;
    SurfaceIntegral integral;
    if (hits == 0) return integral;
    integral.radiance = (halves[0].radiance + halves[1].radiance) / static_cast<float>(hits);
    integral.coverage = double(hits) / (double(side) * side);
    integral.noise = 0.5 * std::abs(halves[0].mean() - halves[1].mean());
    return integral;
}

Vec3 integrateBeam(Tracer& tracer, const Beam& beam, int side, const SampleKey& key)
{
    const Mat3 basis = basisFromNormal(beam.direction);
    Vec3 sum(0.0f);
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            const Vec2 at = beam.radius * onDisk(stratum(i, j, side, key, Use::beam));
            const std::optional<RayHit> hit = tracer.closestHit({beam.begin + basis * Vec3(at, 0.0f), beam.direction, 0.0f, beam.length, RayKind::bounce});
            if (hit && facesRay(tracer.scene(), *hit)) sum += diffuseRadiance(tracer, *hit, -beam.direction);
        }
    return sum / static_cast<float>(side * side);
}

std::vector<Vec3> coneBundle(const Vec3& axis, float tanHalf, int side, const SampleKey& key)
{
    const float cosHalf = 1.0f / std::sqrt(1.0f + tanHalf * tanHalf);
    std::vector<Vec3> directions;
    directions.reserve(std::size_t(side) * std::size_t(side));
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) directions.push_back(coneDirection(axis, cosHalf, stratum(i, j, side, key, Use::bundle)));
    return directions;
}

}  // namespace lrsm
