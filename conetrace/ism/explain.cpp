#include "conetrace/ism/explain.h"

#include "conetrace/frame/cones.h"
#include "conetrace/frame/pixel_text.h"
#include "conetrace/ism/gather.h"

#include <algorithm>

namespace lrsm {
namespace {

constexpr std::size_t kShownLights = 16;

/// What a light would give if nothing hid it.
struct LightShare {
    std::size_t light = 0;
    Vec3 irradiance{0.0f};
    float brightness() const { return irradiance.x + irradiance.y + irradiance.z; }
};

std::string lightText(const IsmWorld& world, const LightShare& share, const Receiver& receiver)
{
    const VirtualLight& light = world.lights.lights[share.light];
    const int n = world.maps.resolution;
    const MapPlace place = placeInMap(light, receiver.position, n);
    const int column = std::clamp(static_cast<int>(place.u), 0, n - 1), row = std::clamp(static_cast<int>(place.v), 0, n - 1);
    const float stored = world.maps.depth[share.light * world.maps.texels() + std::size_t(row * n + column)];
    return formatted("  %5zu  %8.4f %8.4f %8.4f  %8.4f  %3d,%-3d  %8.4f  %-6s  %.4g %.4g %.4g\n", share.light, double(light.position.x),
                     double(light.position.y), double(light.position.z), double(place.distance), column, row,
                     stored < 1.0f ? double(stored * world.maps.range) : -1.0,
                     litByMap(world, share.light, receiver.position, receiver.normal) ? "lit" : "hidden", double(share.irradiance.x),
                     double(share.irradiance.y), double(share.irradiance.z));
}

}  // namespace

std::string explainIsm(const GatherInput& input, int x, int y)
{
    const GBuffer& gbuffer = input.gbuffer;
    const std::size_t pixel = gbuffer.position.index(x, y);
    if (!gbuffer.covered(pixel)) return nothingDrawnText(x, y);
    const PassWatch nobody{.hashPasses = false, .progress = {}, .observe = {}};
    PassLog log(nobody);
    const ImperfectLights made = buildImperfectLights(input, log);
    const IsmWorld world{
        .gbuffer = gbuffer, .camera = input.camera, .lights = made.lights, .maps = made.maps, .settings = input.settings.ism, .vpl = input.settings.vpl};
    const Receiver receiver = receiverAt(gbuffer, input.opacity.base.grid, input.settings.cones, x, y);

    std::vector<LightShare> shares;
    std::size_t hidden = 0;
    for (std::size_t i = 0; i < made.lights.lights.size(); ++i) {
        const VirtualLight& light = made.lights.lights[i];
        const float geometry = vplGeometry(vplNear(world.vpl, light.area), light.position - receiver.position, receiver.normal, light.normal());
        if (!(geometry > 0.0f)) continue;
        shares.push_back({i, light.intensity * (geometry / made.lights.preExposure)});
        hidden += litByMap(world, i, receiver.position, receiver.normal) ? 0 : 1;
    }
    std::stable_sort(shares.begin(), shares.end(), [](const LightShare& a, const LightShare& b) { return a.brightness() > b.brightness(); });

    std::string text = receiverText(gbuffer, receiver, x, y);
    text += formatted("%zu virtual lights: %zu face the pixel, %zu of them are hidden by their maps of %d^2 texels from %d points\n\n",
                      made.lights.lights.size(), shares.size(), hidden, made.maps.resolution, world.settings.points);
    text +=
        "those that shine most on it; the depth of -1 is an empty texel's\n  light  position                    distance  texel    depth             "
        "irradiance, unhidden\n";
    for (std::size_t k = 0; k < std::min(kShownLights, shares.size()); ++k) text += lightText(world, shares[k], receiver);
    const Vec3 e =
        irradianceByLights(world, receiver.position, receiver.normal, std::size_t(rotationOfPixel(x, y, Rotation::strata)), world.settings.interleave);
    text += irradianceText(e, 0.0f);
    return text + originText(input.scene);
}

}  // namespace lrsm
