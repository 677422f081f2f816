#include "conetrace/frame/gbuffer.h"

#include "core/base/elementary.h"
#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "core/raster/draw_scene.h"
#include "core/scene/check_scene.h"

#include <sstream>

namespace lrsm {

namespace {

using DVec3 = glm::dvec3;

/// Row `row` of a matrix: dot(axis, p - origin) * scale + shift.
void setRow(Mat4& m, int row, const Vec3& axis, const Vec3& origin, double scale, double shift)
{
    for (int k = 0; k < 3; ++k) m[k][row] = static_cast<float>(double(axis[k]) * scale);
    m[3][row] = static_cast<float>(shift - glm::dot(DVec3(axis), DVec3(origin)) * scale);
}

/// Distance along the camera's axis to the farthest corner of the bounds: scales the depths into [0, 1], clips nothing.
double farthestDepth(const Camera& camera, const Aabb& bounds)
{
    if (bounds.empty()) return 0.0;
    const DVec3 axis(camera.forward), farCorner(camera.forward.x > 0.0f ? bounds.max.x : bounds.min.x, camera.forward.y > 0.0f ? bounds.max.y : bounds.min.y,
                                                camera.forward.z > 0.0f ? bounds.max.z : bounds.min.z);
    return glm::dot(axis, farCorner - DVec3(camera.position));
}

/// Depths z/w = 1 - near / z are told apart as long as near / z is above float's rounding.
void checkDepthRatio(const Camera& camera, const Aabb& bounds)
{
    const double far = farthestDepth(camera, bounds);
    if (!camera.perspective || !(far > kMaxDepthRatio * double(camera.nearPlane))) return;
    std::ostringstream text;
    text << "the near plane at " << camera.nearPlane << " m is too near for a scene that reaches " << far
         << " m: float32 depths could not tell its surfaces apart; put it at " << far / kMaxDepthRatio << " m at least";
    throw InputError("camera \"" + camera.name + "\"", text.str());
}

void writePixel(GBuffer& out, std::size_t i, const Scene& scene, const Camera& camera, const SurfaceHit& hit, const PixelSpacing* spacing)
{
    const Vec3 pWorld = positionOf(scene, hit);
    const PixelSpacing here = spacing ? spacingAt(*spacing, camera, pWorld) : PixelSpacing();
    const Surface surface = evaluateSurface(scene, hit, directionToEye(camera, pWorld), spacing ? &here : nullptr);
    out.position.texels[i] = surface.position;
    out.geometricNormal.texels[i] = surface.geometricNormal;
    out.normal.texels[i] = surface.normal;
    out.albedo.texels[i] = surface.albedo;
    out.depthLinear.texels[i] = glm::dot(surface.position - camera.position, camera.forward);
    out.objectId.texels[i] = hit.mesh + 1;
    if (out.roughness.empty()) return;
    out.specularColor.texels[i] = surface.specularColor;
    out.roughness.texels[i] = surface.roughness;
}

}  // namespace

std::size_t GBuffer::predictBytes(int width, int height, bool specular)
{
    constexpr std::size_t kAlways = 4 * sizeof(Vec3) + sizeof(float) + sizeof(std::uint32_t);
    return std::size_t(width) * std::size_t(height) * (kAlways + (specular ? sizeof(Vec3) + sizeof(float) : 0));
}

Mat4 clipFromWorld(const Camera& camera, int width, int height, const Aabb& bounds)
{
    // The same half height as pixelRay's; the picture's own proportions decide its width.
    const Vec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
    const double half = camera.perspective ? tangent(0.5 * double(camera.verticalFov)) : 0.5 * double(camera.verticalExtent);
    // An orthographic near plane may be at 0; a perspective one scales with its scene.
    const double least = camera.perspective ? 0.0 : 1e-6;
    const double near = camera.nearPlane, far = std::max(farthestDepth(camera, bounds) * 1.001, near + 1e-3 * std::abs(near) + least);

    Mat4 m(0.0f);
    setRow(m, 0, right, camera.position, double(height) / (half * width), 0.0);
    setRow(m, 1, camera.up, camera.position, 1.0 / half, 0.0);
    if (camera.perspective) {
        const double scale = far / (far - near);
        setRow(m, 2, camera.forward, camera.position, scale, -near * scale);
        setRow(m, 3, camera.forward, camera.position, 1.0, 0.0);
    } else {
        setRow(m, 2, camera.forward, camera.position, 1.0 / (far - near), -near / (far - near));
        m[3][3] = 1.0f;
    }
    return m;
}

Vec3 directionToEye(const Camera& camera, const Vec3& pWorld)
{
    if (!camera.perspective) return -camera.forward;
    const Vec3 toEye = camera.position - pWorld;
    const float length = glm::length(toEye);
    return length > 0.0f ? toEye / length : -camera.forward;
}

GBuffer renderGBuffer(const Scene& scene, const Camera& camera, const Requirements& needs, const GBufferSettings& settings)
{
    checkBounds(scene.bounds);
    checkCamera(camera);
    checkDepthRatio(camera, scene.bounds);
    checkMaterials(scene);
    const int width = settings.width, height = settings.height;
    const SceneFragments drawn = drawScene(scene, clipFromWorld(camera, width, height, extentOf(scene)), needs, width, height);

    GBuffer out;
    out.width = width;
    out.height = height;
    out.raster = drawn.counts;
    for (Image<Vec3>* image : {&out.position, &out.geometricNormal, &out.normal, &out.albedo}) *image = Image<Vec3>(width, height);
    out.depthLinear = Image<float>(width, height);
    out.objectId = Image<std::uint32_t>(width, height);
    if (needs.specular) {
        out.specularColor = Image<Vec3>(width, height);
        out.roughness = Image<float>(width, height);
    }
    const PixelSpacing unit = pixelSpacing(camera, height), *spacing = settings.textureFilter == TextureFilter::trilinear ? &unit : nullptr;
    parallelFor(out.objectId.texels.size(), 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Fragment& fragment = drawn.fragments.texels[i];
            if (fragment.triangle != kNoTriangle) writePixel(out, i, scene, camera, hitOf(drawn.firstTriangle, fragment), spacing);
        }
    });
    return out;
}

}  // namespace lrsm
