#include "conetrace/ism/evaluate.h"

#include "conetrace/frame/cones.h"
#include "conetrace/frame/tiles.h"
#include "core/scene/brdf.h"

namespace lrsm {
namespace {

struct LightCounts {
    std::uint64_t pixels = 0;
    LightCounts& operator+=(const LightCounts& other)
    {
        pixels += other.pixels;
        return *this;
    }
};

}  // namespace

Vec3 irradianceByLights(const IsmWorld& world, const Vec3& position, const Vec3& normal, std::size_t first, bool interleaved)
{
    const std::vector<VirtualLight>& lights = world.lights.lights;
    const std::size_t step = interleaved ? kInterleaved : 1;
    Vec3 sum(0.0f);
    for (std::size_t i = interleaved ? first : 0; i < lights.size(); i += step) {
        const VirtualLight& light = lights[i];
        const float geometry = vplGeometry(vplNear(world.vpl, light.area), light.position - position, normal, light.normal());
        if (geometry > 0.0f && litByMap(world, i, position, normal)) sum += light.intensity * geometry;
    }
    return sum * (float(step) / world.lights.preExposure);
}

Vec3 lobeByLights(const IsmWorld& world, std::size_t pixel)
{
    const GBuffer& g = world.gbuffer;
    const Vec3 position = g.position.texels[pixel], normal = g.normal.texels[pixel];
    const Vec3 mirror = glm::normalize(mirrorDirection(normal, glm::normalize(directionToEye(world.camera, position))));
    if (!(glm::dot(mirror, g.geometricNormal.texels[pixel]) > 0.0f)) return Vec3(0.0f);
    const float roughness = g.roughness.texels[pixel];
    const VplLobeWeight lobe(world.vpl, phongExponent(roughness));
    Vec3 sum(0.0f);
    for (std::size_t i = 0; i < world.lights.lights.size(); ++i) {
        const VirtualLight& light = world.lights.lights[i];
        const Vec3 toLight = light.position - position;
        const float d2 = std::max(glm::dot(toLight, toLight), kLeastDistance2), facing = -glm::dot(light.normal(), toLight);
        if (!(facing > 0.0f && glm::dot(normal, toLight) > 0.0f) || !litByMap(world, i, position, normal)) continue;
        const float distance = std::sqrt(d2);
        const VplNear near = vplNear(world.vpl, light.area);
        sum += light.intensity * (lobe.ofCosine(glm::dot(mirror, toLight) / distance) * std::min(near.most, facing / (distance * (d2 + near.softening))));
    }
    return sum / ((*world.lobe)(roughness)*world.lights.preExposure);
}

Gathered gatherFromLights(const IsmWorld& world, const Requirements& needs)
{
    const GBuffer& g = world.gbuffer;
    Gathered out = emptyGathered(g, needs);
    const LightCounts counts = forTiles<LightCounts>(g.width, g.height, [&] {
        return [&](int tileX, int tileY, LightCounts& tile) {
            forPixels(g.width, g.height, tileX, tileY, [&](int x, int y) {
                const std::size_t pixel = g.position.index(x, y);
                if (!g.covered(pixel)) return;
                const auto first = static_cast<std::size_t>(rotationOfPixel(x, y, Rotation::strata));
                out.irradiance.texels[pixel] = irradianceByLights(world, g.position.texels[pixel], g.normal.texels[pixel], first, world.settings.interleave);
                if (needs.specular && g.specularColor.texels[pixel] != Vec3(0.0f)) out.specular.texels[pixel] = lobeByLights(world, pixel);
                ++tile.pixels;
            });
        };
    });
    out.counters = {{"lit_pixels", double(counts.pixels)}};
    return out;
}

}  // namespace lrsm
