#pragma once

#include "conetrace/frame/cones.h"
#include "conetrace/frame/gather.h"
#include "conetrace/proxies/lists.h"
#include "conetrace/proxies/vpl.h"
#include "conetrace/proxies/walk.h"
#include "core/scene/brdf.h"

/// Sparse shadow rays from a low-resolution G-buffer: [P] Sec. 3.1, Fig. 2 (c).
namespace lrsm {

/// Directions of the rays: pp_rays in strata of equal cosine weight, one of 16 sets a block (4x4, as cones have them).
ConeSet shadowRays(const ProxySettings& settings);

/// Ray j of `count` within the lobe of exponent n about `mirror` (unit): its cosines are distributed as cos^n. Directions alternate with `rotation` as the
/// others'.
Vec3 lobeRay(const Vec3& mirror, float exponent, int j, int count, int rotation);

/// The cell whose disc a ray meets first, or kNoCell.
inline constexpr std::uint32_t kNoCell = ~std::uint32_t(0);
inline std::uint32_t cellMet(const ProxyCells& cells, const ShadowRay& ray)
{
    std::uint32_t met = kNoCell;
    walkCells(cells.grid, ray.origin, ray.direction, [&](std::uint32_t cell) {
        if (!meetsDisc(cells, cell, ray)) return false;
        met = cell;
        return true;
    });
    return met;
}

/// Everything that shadow rays read.
struct MarchWorld {
    const GBuffer& gbuffer;
    const Camera& camera;
    const ProxyCells& cells;
    const ConeSet& rays;
    const ProxySettings& settings;
    bool specular = false;  ///< the scene has a specular part
};

/// visit(direction, diffuse) for the shadow rays of one pixel, of the block (column, row): those of the lobe, which are not diffuse, where its surface has one.
/// They start rayStart off its surface.
template <class Visit>
void forShadowRays(const MarchWorld& world, std::size_t pixel, int column, int row, const Visit& visit);
inline Vec3 rayStart(const MarchWorld& world, std::size_t pixel)
{
    return world.gbuffer.position.texels[pixel] + world.gbuffer.geometricNormal.texels[pixel] * world.cells.radius;
}

/// V_p of a pixel a block of pp_march_divisor.
VisibilityLists marchShadowRays(const MarchWorld& world);

template <class Visit>
void forShadowRays(const MarchWorld& world, std::size_t pixel, int column, int row, const Visit& visit)
{
    const GBuffer& g = world.gbuffer;
    const Vec3 normal = g.normal.texels[pixel], geometric = g.geometricNormal.texels[pixel];
    const int rotation = rotationOfPixel(column, row, Rotation::strata);
    const Mat3 basis = basisFromNormal(normal);
    for (const Vec3& direction : world.rays.rotation(rotation)) visit(basis * direction, true);

    if (!world.specular || g.specularColor.texels[pixel] == Vec3(0.0f)) return;
    const Vec3 toEye = glm::normalize(directionToEye(world.camera, g.position.texels[pixel]));
    const Vec3 mirror = glm::normalize(mirrorDirection(normal, toEye));
    const float exponent = phongExponent(g.roughness.texels[pixel]);
    for (int j = 0; j < world.settings.lobeRays; ++j) {
        const Vec3 direction = lobeRay(mirror, exponent, j, world.settings.lobeRays, rotation);
        if (glm::dot(direction, geometric) > 0.0f) visit(direction, false);
    }
}

}  // namespace lrsm
