#pragma once

#include "conetrace/caches/places.h"
#include "conetrace/frame/gbuffer.h"

namespace lrsm::test {

struct SurfacePoint {
    Vec3 position, normal;
};

/// A G-buffer of what `surface(x, y)` says; depth is -z of the position, as a camera at the origin looking along -z sees it.
template <class Surface>
GBuffer gbufferOf(int width, int height, const Surface& surface)
{
    GBuffer g;
    g.width = width;
    g.height = height;
    g.position = g.geometricNormal = g.normal = g.albedo = Image<Vec3>(width, height);
    g.depthLinear = Image<float>(width, height);
    g.objectId = Image<std::uint32_t>(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const SurfacePoint at = surface(x, y);
            const std::size_t pixel = g.position.index(x, y);
            if (at.normal == Vec3(0.0f)) continue;
            g.position.texels[pixel] = at.position;
            g.normal.texels[pixel] = g.geometricNormal.texels[pixel] = at.normal;
            g.depthLinear.texels[pixel] = -at.position.z;
            g.objectId.texels[pixel] = 1;
        }
    return g;
}

/// Caches that stand nowhere in particular, with these axes.
inline CachePlaces placesOf(const std::vector<Vec3>& normals)
{
    const std::size_t count = normals.size();
    CachePlaces places;
    places.pixels.assign(count, 0);
    places.positions.assign(count, Vec3(0.0f));
    places.normals = normals;
    places.pixelSizes.assign(count, 1.0f);
    places.rotations.assign(count, 0);
    frameCaches(places);
    return places;
}

}  // namespace lrsm::test
