#include "reference/integrator.h"

#include "reference/directions.h"

namespace lrsm {
namespace {

/// Surfaces that turn the back of a single-sided material to the path stop it and reflect nothing.
bool reflects(const Scene& scene, const RayHit& hit)
{
    return hit.front || scene.materials[static_cast<std::size_t>(scene.meshes[hit.surface.mesh].material)].doubleSided;
}

/// Where a ray struck, without the material. As interpolated by evaluateSurface.
Vec3 positionOf(const Scene& scene, const SurfaceHit& hit)
{
    const Mesh& mesh = scene.meshes[hit.mesh];
    const auto& triangle = mesh.triangles[hit.triangle];
    return (1.0f - hit.b1 - hit.b2) * mesh.positions[triangle[0]] + hit.b1 * mesh.positions[triangle[1]] + hit.b2 * mesh.positions[triangle[2]];
}

/// Radiance of a diffuse surface towards the ray. Most points are in shadow: the shadow rays go first, and the material is looked up only
/// where light arrives.
Vec3 diffuseRadiance(Tracer& tracer, const Ray& ray, const RayHit& hit)
{
    const float length2 = glm::dot(hit.scaledNormal, hit.scaledNormal);
    if (!(length2 > 0.0f)) return Vec3(0.0f);
    const Vec3 geometricNormal = hit.scaledNormal / std::sqrt(length2), position = positionOf(tracer.scene(), hit.surface);
    const Vec3 start = position + geometricNormal * tracer.offset(position);

    Vec3 radiance(0.0f);
    std::optional<Surface> surface;
    for (const LightSampler& light : tracer.lights()) {
        const LightSample sample = light(position);
        if (sample.irradiance == Vec3(0.0f) || !(glm::dot(geometricNormal, sample.toLight) > 0.0f)) continue;
        if (tracer.occluded({start, sample.toLight, 0.0f, sample.distance, RayKind::light})) continue;
        if (!surface) surface = evaluateSurface(tracer.scene(), hit.surface, -ray.direction);
        radiance += surface->albedo / kPi * std::max(0.0f, glm::dot(surface->normal, sample.toLight)) * sample.irradiance;
    }
    return radiance;
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

constexpr int kFirstRouletteBounce = 3;    // shorter paths carry most of the light: never end them by chance
constexpr float kLargestSurvival = 0.95f;  // so that a white furnace ends, too

}  // namespace

Ray rayFrom(const Tracer& tracer, const Surface& surface, const Vec3& direction, RayKind kind)
{
    return {surface.position + surface.geometricNormal * tracer.offset(surface.position), direction, 0.0f, kInfinity, kind};
}

Vec3 directLight(Tracer& tracer, const Surface& surface, const Vec3& toViewer)
{
    Vec3 sum(0.0f);
    for (const LightSampler& light : tracer.lights()) {
        const LightSample sample = light(surface.position);
        if (sample.irradiance == Vec3(0.0f)) continue;
        const float cosine = glm::dot(surface.normal, sample.toLight);
        if (!(cosine > 0.0f && glm::dot(surface.geometricNormal, sample.toLight) > 0.0f)) continue;

        const Vec3 reflected = surface.albedo * (cosine / kPi) + evaluateSpecular(surface, sample.toLight, toViewer);
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

        if (transport == Transport::single) return diffuseRadiance(tracer, ray, *hit);

        const Vec3 toViewer = -ray.direction;
        const Surface surface = evaluateSurface(tracer.scene(), hit->surface, toViewer);
        radiance += throughput * directLight(tracer, surface, toViewer);
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
