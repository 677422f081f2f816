#pragma once

#include "core/base/arrays.h"
#include "core/raster/rasterize.h"
#include "core/scene/camera.h"
#include "core/scene/requirements.h"
#include "core/scene/scene.h"
#include "core/settings/settings.h"

namespace lrsm {

/// What the eye sees along each pixel's ray (pixelRay, core/scene/camera.h), one surface a pixel; structure of arrays, zero where nothing was drawn.
struct GBuffer {
    int width = 0, height = 0;
    Image<Vec3> position;           ///< world, metres
    Image<Vec3> geometricNormal;    ///< unit, towards the eye
    Image<Vec3> normal;             ///< unit shading normal, towards the eye
    Image<Vec3> albedo;             ///< diffuse, linear
    Image<Vec3> specularColor;      ///< F0; empty image when the scene has no specular part
    Image<float> roughness;         ///< empty likewise
    Image<float> depthLinear;       ///< metres along the viewing axis; 0 where empty
    Image<std::uint32_t> objectId;  ///< mesh index + 1; 0 where empty
    RasterCounts raster;

    bool covered(std::size_t pixel) const { return objectId.texels[pixel] != 0; }
    static std::size_t predictBytes(int width, int height, bool specular);
};

/// On a GPU as here: positions need their 32 bits.
template <class Visit>
void forEachArray(const GBuffer& gbuffer, Visit&& visit)
{
    const auto visitImage = [&](const auto& image) { visit(image.texels, ArrayTraits{image.byteSize()}); };
    visitImage(gbuffer.position);
    visitImage(gbuffer.geometricNormal);
    visitImage(gbuffer.normal);
    visitImage(gbuffer.albedo);
    visitImage(gbuffer.specularColor);
    visitImage(gbuffer.roughness);
    visitImage(gbuffer.depthLinear);
    visitImage(gbuffer.objectId);
}

inline Counters countersOf(const GBuffer& gbuffer)
{
    return countersOf(gbuffer.raster);
}

struct GBufferSettings {
    int width = 1280, height = 720;
    TextureFilter textureFilter = TextureFilter::trilinear;
    bool operator==(const GBufferSettings&) const = default;
};

/// World-to-clip of a camera for a picture of this size; near at z/w = 0, the farthest point of `bounds` (what is beyond is not cut) at 1.
Mat4 clipFromWorld(const Camera& camera, int width, int height, const Aabb& bounds);

/// Unit direction from a point to the eye; against the viewing axis for an orthographic camera.
Vec3 directionToEye(const Camera& camera, const Vec3& pWorld);

GBuffer renderGBuffer(const Scene& scene, const Camera& camera, const Requirements& needs, const GBufferSettings& settings);

}  // namespace lrsm
