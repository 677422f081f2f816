#include "reference/integrator.h"

#include "reference/directions.h"

namespace lrsm {
namespace {

float brightest(const Vec3& v)
{
    return std::max({v.x, v.y, v.z});
}

/// The two lobes of a surface seen from `toViewer`, one of which a path goes on by: the balance heuristic in its one-sample form (Veach 1997, 9.2.4).
class Scattering {
  public:
    Scattering(const Surface& surface, const Vec3& toViewer) : surface_(surface), toViewer_(toViewer)
    {
        const float diffuse = brightest(surface.albedo), specular = brightest(surface.specularColor);
        black_ = !(diffuse + specular > 0.0f);
        pSpecular_ = black_ ? 0.0f : specular / (diffuse + specular);
    }

    bool black() const { return black_; }

    Vec3 draw(const Philox4& words) const
    {
        const UnitPoint xi{unitFloat(words[0]), unitFloat(words[1])};
        return unitFloat(words[2]) < pSpecular_ ? lobeDirection(surface_, toViewer_, xi) : cosineDirection(surface_.normal, xi);
    }

    /// BRDF <n.w>, and the density of drawing w from either lobe.
    Response operator()(const Vec3& direction) const
    {
        const float cosine = glm::dot(surface_.normal, direction);
        if (!(cosine > 0.0f && glm::dot(surface_.geometricNormal, direction) > 0.0f)) return {};
        Response response{surface_.albedo * (cosine / kPi), (1.0f - pSpecular_) * cosine / kPi};
        if (pSpecular_ > 0.0f) {
            response.value += evaluateSpecular(surface_, direction, toViewer_);
            response.density += pSpecular_ * lobeDensity(surface_, toViewer_, direction);
        }
        return response;
    }

  private:
    const Surface& surface_;
    Vec3 toViewer_;
    float pSpecular_ = 0.0f;
    bool black_ = false;
};

/// Radiance towards `toViewer` straight from the lights; share(light, toLight): of each.
template <class Share>
Vec3 reflectedLight(Tracer& tracer, const Surface& surface, const Vec3& toViewer, const Share& share)
{
    Vec3 sum(0.0f);
    for (std::size_t k = 0; k < tracer.lights().size(); ++k) {
        const LightSample sample = tracer.lights()[k](surface.position);
        if (sample.irradiance == Vec3(0.0f)) continue;
        const float cosine = glm::dot(surface.normal, sample.toLight);
        if (!(cosine > 0.0f && glm::dot(surface.geometricNormal, sample.toLight) > 0.0f)) continue;

        const Vec3 diffuse = surface.albedo * (cosine / kPi), specular = evaluateSpecular(surface, sample.toLight, toViewer);
        if (diffuse + specular == Vec3(0.0f) || !tracer.lit(surface.position, surface.geometricNormal, sample)) continue;
        sum += share(k, sample.toLight) * (diffuse + specular) * sample.irradiance;
    }
    return sum;
}

/// Radiance of a diffuse surface towards the ray, what technique b claims left out.
Vec3 diffuseLight(Tracer& tracer, const PathStart& start, const RayHit& hit, const LightTechnique& technique)
{
    Vec3 radiance(0.0f);
    const Vec3 toViewer = -start.ray.direction;
    visitLights(tracer, start.ray, hit, [&](std::size_t k, const Surface& surface, const LightSample& sample) {
        const Vec3 reflected = diffuseRadiance(surface, sample);
        if (reflected != Vec3(0.0f)) radiance += technique.shareOfRay(start.density, k, surface, toViewer, sample.toLight, hit.t) * reflected;
    });
    return radiance;
}

/// Technique b at a vertex of a path: (sum of f L) of light that one of a pool's points sends.
Vec3 drawnLight(Tracer& tracer, const Surface& surface, const Scattering& scattering, const PathLight& light, const Philox4& words)
{
    if (!light.furtherPool || light.furtherPool->size() == 0) return Vec3(0.0f);
    const LightPool& pool = *light.furtherPool;
    const LightReceiver receiver = receiverAt(tracer, surface);
    PoolWeights& weights = *light.scratch;
    weights.weigh(pool, receiver, light.further.candidates, scattering, std::size_t(unitFloat(words[0]) * float(pool.subsets)));
    if (!weights.any()) return Vec3(0.0f);

    const Choice chosen = weights.choose(unitFloat(words[1]));
    Vec3 direction;
    const Vec3 response = connection(pool, chosen.index, receiver, light.further.candidates, scattering, direction);
    return response * chosen.overDensity * radianceFrom(tracer, pool, chosen.index, receiver, direction);
}

constexpr int kFirstRouletteBounce = 3;      // shorter paths carry most of the light: never end them by chance
constexpr float kRouletteThroughput = 0.5f;  // a path that carries less ends by chance, or goes on carrying this
constexpr float kLargestSurvival = 0.95f;    // so that a white furnace ends, too

}  // namespace

Vec3 directLight(Tracer& tracer, const Surface& surface, const Vec3& toViewer)
{
    return reflectedLight(tracer, surface, toViewer, [](std::size_t, const Vec3&) { return 1.0f; });
}

Vec3 incomingRadiance(Tracer& tracer, const PathStart& start, const PathLight& light, Transport transport, PathRandom& random, bool& hitAnything)
{
    Vec3 radiance(0.0f), throughput(1.0f);
    Ray ray = start.ray;
    float density = start.density;
    hitAnything = false;
    for (int bounce = 1;; ++bounce) {
        const std::optional<RayHit> hit = tracer.closestHit(ray);
        if (bounce == 1) hitAnything = hit.has_value();
        if (!hit || !reflects(tracer.scene(), *hit)) return radiance;

        if (transport == Transport::single) return diffuseLight(tracer, start, *hit, light.first);

        // Straight from the lights
        const Vec3 toViewer = -ray.direction;
        const Surface surface = evaluateSurface(tracer.scene(), hit->surface, toViewer);
        const LightTechnique& technique = bounce == 1 ? light.first : light.further;
        radiance += throughput * reflectedLight(tracer, surface, toViewer, [&](std::size_t k, const Vec3& toLight) {
                        return technique.shareOfRay(density, k, surface, toViewer, toLight, hit->t);
                    });

        // By one more reflection, from the lights' side
        const Scattering scattering(surface, toViewer);
        if (scattering.black()) return radiance;
        if (light.furtherPool) radiance += throughput * drawnLight(tracer, surface, scattering, light, random.next());

        // The next ray
        const Philox4 words = random.next();
        const Vec3 direction = scattering.draw(words);
        const Response next = scattering(direction);
        if (!(next.density > 0.0f)) return radiance;
        throughput *= next.value / next.density;
        if (throughput == Vec3(0.0f)) return radiance;
        if (bounce >= kFirstRouletteBounce) {
            const float survival = std::min(kLargestSurvival, brightest(throughput) / kRouletteThroughput);
            if (unitFloat(words[3]) >= survival) return radiance;
            throughput /= survival;
        }
        density = next.density;
        ray = rayFrom(tracer, surface, direction, RayKind::bounce);
    }
}

}  // namespace lrsm
