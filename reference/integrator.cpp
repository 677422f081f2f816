#include "reference/integrator.h"

#include "reference/directions.h"

namespace lrsm {
namespace {

/// Surfaces that turn the back of a single-sided material to the path stop it and reflect nothing.
bool reflects(const Scene& scene, const RayHit& hit)
{
    return hit.front || scene.materials[static_cast<std::size_t>(scene.meshes[hit.surface.mesh].material)].doubleSided;
}

float brightest(const Vec3& v)
{
    return std::max({v.x, v.y, v.z});
}

/// One direction of a path that goes on, and f <n.w> / density along it.
struct Continuation {
    Vec3 direction{0.0f};
    Vec3 weight{0.0f};
};

/// Draws from the diffuse or the specular lobe and divides by the density of drawing the direction from either: the balance heuristic
/// in its one-sample form (Veach 1997, 9.2.4).
Continuation continuePath(const Surface& surface, const Vec3& toViewer, const Philox4& words)
{
    const float diffuse = brightest(surface.albedo), specular = brightest(surface.specularColor);
    if (!(diffuse + specular > 0.0f)) return {};
    const float pSpecular = specular / (diffuse + specular);

    const UnitPoint xi{unitFloat(words[0]), unitFloat(words[1])};
    const bool lobe = unitFloat(words[2]) < pSpecular;
    const Vec3 direction = lobe ? lobeDirection(surface, toViewer, xi) : cosineDirection(surface.normal, xi);
    const float cosine = glm::dot(surface.normal, direction);
    if (!(cosine > 0.0f && glm::dot(surface.geometricNormal, direction) > 0.0f)) return {};

    float density = (1.0f - pSpecular) * cosine / kPi;
    Vec3 reflected = surface.albedo * (cosine / kPi);
    if (pSpecular > 0.0f) {
        density += pSpecular * lobeDensity(surface, toViewer, direction);
        reflected += evaluateSpecular(surface, direction, toViewer);
    }
    if (!(density > 0.0f)) return {};
    return {direction, reflected / density};
}

constexpr int kFirstRouletteBounce = 3;      // shorter paths carry most of the light: never end them by chance
constexpr float kLargestSurvival = 0.95f;    // so that a white furnace ends, too

}  // namespace

Ray rayFrom(const Tracer& tracer, const Surface& surface, const Vec3& direction, RayKind kind)
{
    return {surface.position + surface.geometricNormal * tracer.offset(surface.position), direction, 0.0f, kInfinity, kind};
}

Vec3 directLight(Tracer& tracer, const Surface& surface, const Vec3& toViewer, Lobes lobes)
{
    Vec3 sum(0.0f);
    for (const LightSampler& light : tracer.lights()) {
        const LightSample sample = light(surface.position);
        if (sample.irradiance == Vec3(0.0f)) continue;
        const float cosine = glm::dot(surface.normal, sample.toLight);
        if (!(cosine > 0.0f && glm::dot(surface.geometricNormal, sample.toLight) > 0.0f)) continue;

        Vec3 reflected = surface.albedo * (cosine / kPi);
        if (lobes == Lobes::all) reflected += evaluateSpecular(surface, sample.toLight, toViewer);
        if (reflected == Vec3(0.0f)) continue;
        Ray shadow = rayFrom(tracer, surface, sample.toLight, RayKind::light);
        shadow.tFar = sample.distance;
        if (!tracer.occluded(shadow)) sum += reflected * sample.irradiance;
    }
    return sum;
}

Vec3 incomingRadiance(Tracer& tracer, const Ray& first, Transport transport, PathRandom& random, bool& hitAnything)
{
    Vec3 radiance(0.0f), throughput(1.0f);
    Ray ray = first;
    hitAnything = false;
    for (int bounce = 1;; ++bounce) {
        const std::optional<RayHit> hit = tracer.closestHit(ray);
        if (bounce == 1) hitAnything = hit.has_value();
        if (!hit || !reflects(tracer.scene(), *hit)) return radiance;

        const Vec3 toViewer = -ray.direction;
        const Surface surface = evaluateSurface(tracer.scene(), hit->surface, toViewer);
        if (transport == Transport::single) return directLight(tracer, surface, toViewer, Lobes::diffuse);

        radiance += throughput * directLight(tracer, surface, toViewer, Lobes::all);
        const Philox4 words = random.next();
        const Continuation next = continuePath(surface, toViewer, words);
        throughput *= next.weight;
        if (throughput == Vec3(0.0f)) return radiance;
        if (bounce >= kFirstRouletteBounce) {
            const float survival = std::min(kLargestSurvival, brightest(throughput));
            if (unitFloat(words[3]) >= survival) return radiance;
            throughput /= survival;
        }
        ray = rayFrom(tracer, surface, next.direction, RayKind::bounce);
    }
}

}  // namespace lrsm
