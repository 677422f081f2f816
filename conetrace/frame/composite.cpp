#include "conetrace/frame/composite.h"

#include "conetrace/frame/specular_albedo.h"
#include "core/base/parallel.h"

#include <optional>

namespace lrsm {
namespace {

constexpr std::size_t kPixelsPerTask = 4096;

}  // namespace

IndirectLight shadeIndirect(const GBuffer& gbuffer, const Camera& camera, const Image<Vec3>& irradiance, const Image<Vec3>& specularRadiance)
{
    IndirectLight light;
    light.diffuse = Image<Vec3>(gbuffer.width, gbuffer.height);
    light.specular = Image<Vec3>(gbuffer.width, gbuffer.height);
    std::optional<SpecularAlbedo> lobe;
    if (!specularRadiance.empty()) lobe.emplace();

    parallelFor(irradiance.texels.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!gbuffer.covered(i)) continue;
            light.diffuse.texels[i] = gbuffer.albedo.texels[i] * irradiance.texels[i] * (1.0f / kPi);
            if (!lobe || gbuffer.specularColor.texels[i] == Vec3(0.0f)) continue;
            const Vec3 toEye = glm::normalize(directionToEye(camera, gbuffer.position.texels[i]));
            const float nDotV = glm::dot(gbuffer.normal.texels[i], toEye);
            light.specular.texels[i] = (*lobe)(gbuffer.specularColor.texels[i], nDotV, gbuffer.roughness.texels[i]) * specularRadiance.texels[i];
        }
    });
    return light;
}

Image<Vec3> composite(const Image<Vec3>& direct, const IndirectLight& indirect)
{
    Image<Vec3> sum(direct.width, direct.height);
    parallelFor(sum.texels.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) sum.texels[i] = direct.texels[i] + indirect.diffuse.texels[i] + indirect.specular.texels[i];
    });
    return sum;
}

}  // namespace lrsm
