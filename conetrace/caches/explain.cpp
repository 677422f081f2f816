#include "conetrace/caches/explain.h"

#include "conetrace/caches/gather.h"
#include "conetrace/frame/pixel_cones.h"
#include "conetrace/frame/pixel_text.h"
#include "core/scene/brdf.h"

namespace lrsm {
namespace {

std::string clusterText(const PixelClusters& clusters, std::uint32_t cluster, const GBuffer& gbuffer, std::size_t pixel)
{
    const std::uint32_t key = clusters.keys[cluster];
    const Vec3 normal = gbuffer.normal.texels[pixel];
    const auto x = int(pixel) % gbuffer.width, y = int(pixel) / gbuffer.width;
    const NormalAxes& axes = clusters.axes[std::size_t(y / clusters.tile) * std::size_t(clusters.tilesX) + std::size_t(x / clusters.tile)];
    std::string text = formatted("cluster %u of %zu: tile %d,%d of %d pixels, depth slice %u, %s axis %u, %u pixels\n", cluster, clusters.size(),
                                 x / clusters.tile, y / clusters.tile, clusters.tile, key >> kSliceShift, (key & 1) ? "against" : "along", (key >> 1) & 3u,
                                 clusters.first[cluster + 1] - clusters.first[cluster]);
    for (const Vec3& axis : axes)
        text += formatted("  axis %.4f %.4f %.4f  n.a %.4f\n", double(axis.x), double(axis.y), double(axis.z), double(glm::dot(normal, axis)));
    return text;
}

std::string cacheText(const CacheWorld& world, std::uint32_t cache, float weight, int x, int y, std::size_t pixel)
{
    const GBuffer& gbuffer = world.gbuffer;
    const Vec3 normal = gbuffer.normal.texels[pixel];
    const CacheWeight both = cacheWeight(world, cache, x, y, gbuffer.position.texels[pixel]);
    const Vec2 at = squareFromHemisphere(inCacheFrame(world, cache, normal), world.settings.mapping) * float(kDiffuseNodes - 1);
    const Vec4 diffuse = diffuseOf(world, cache, normal) / Vec4(Vec3(world.atlas.preExposure), 1.0f);
    const auto own = int(world.places.pixels[cache]);
    return formatted("  %6u  %4d,%-4d  %7.4f  %7.4f  %7.4f  %7.4f  %5.2f,%-5.2f  %.5g %.5g %.5g  %.4f\n", cache, own % gbuffer.width, own / gbuffer.width,
                     double(glm::dot(normal, world.places.normals[cache])), double(both.world), double(both.screen), double(weight), double(at.x), double(at.y),
                     double(diffuse.x), double(diffuse.y), double(diffuse.z), double(diffuse.w));
}

const char* fillText(CacheFill fill)
{
    switch (fill) {
    case CacheFill::vct: return "the voxels' radiance, one a direction of travel (rc_fill=vct)";
    case CacheFill::voxels: return "lit voxels (rc_fill=voxels)";
    case CacheFill::lrsm: break;
    }
    return "the layered light maps (rc_fill=lrsm)";
}

}  // namespace

std::string explainCaches(const GatherInput& input, int x, int y)
{
    const GBuffer& gbuffer = input.gbuffer;
    const std::size_t pixel = gbuffer.position.index(x, y);
    if (!gbuffer.covered(pixel)) return nothingDrawnText(x, y);
    const PassWatch nobody{.hashPasses = false, .progress = {}, .observe = {}};
    PassLog log(nobody);
    const Caches caches = buildCaches(input, log);
    const CacheWorld world{.gbuffer = gbuffer,
                           .camera = input.camera,
                           .clusters = caches.clusters,
                           .places = caches.places,
                           .atlas = caches.atlas,
                           .settings = input.settings.caches};

    std::string text = receiverText(gbuffer, receiverAt(gbuffer, input.opacity.base.grid, input.settings.cones, x, y), x, y);
    text += clusterText(caches.clusters, caches.clusters.clusterOf.texels[pixel] - 1, gbuffer, pixel);
    text += formatted("\ncaches within %g tiles, filled from %s; place in the %d x %d irradiance table\n", double(input.settings.caches.radius),
                      fillText(input.settings.caches.fill), kDiffuseNodes, kDiffuseNodes);
    text += "   cache  at pixel   n.axis   w world  w screen  weight   place        irradiance, opacity\n";
    forCachesOf(world, x, y, [&](std::uint32_t cache, float weight) { text += cacheText(world, cache, weight, x, y, pixel); });

    const CachedLight light = evaluatePixel(world, input.needs.specular, x, y);
    text += formatted("irradiance %.6g %.6g %.6g, opacity %.5f\n", double(light.irradiance.x), double(light.irradiance.y), double(light.irradiance.z),
                      double(light.opacity));
    if (input.needs.specular && gbuffer.specularColor.texels[pixel] != Vec3(0.0f)) {
        const Vec3 toEye = glm::normalize(directionToEye(input.camera, gbuffer.position.texels[pixel]));
        const Vec3 mirror = mirrorDirection(gbuffer.normal.texels[pixel], toEye);
        const float roughness = gbuffer.roughness.texels[pixel];
        text +=
            formatted("specular: towards %.4f %.4f %.4f at roughness %.3f, level %.3f of the caches: I = %.6g %.6g %.6g\n", double(mirror.x), double(mirror.y),
                      double(mirror.z), double(roughness), double(lobeLevel(roughness, caches.atlas.resolution, input.settings.caches.lobe)),
                      double(light.specular.x), double(light.specular.y), double(light.specular.z));
    }
    return text + originText(input.scene);
}

}  // namespace lrsm
