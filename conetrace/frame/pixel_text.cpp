#include "conetrace/frame/pixel_text.h"

#include "conetrace/frame/cones.h"

namespace lrsm {

std::string nothingDrawnText(int x, int y)
{
    return formatted("pixel %d,%d: nothing is drawn here\n", x, y);
}

std::string receiverText(const GBuffer& gbuffer, const Receiver& receiver, int x, int y)
{
    const std::size_t pixel = gbuffer.position.index(x, y);
    const Vec3 p = receiver.position, n = receiver.normal, albedo = gbuffer.albedo.texels[pixel];
    return formatted("pixel %d,%d: object %u at %.5f %.5f %.5f, normal %.4f %.4f %.4f, albedo %.4f %.4f %.4f, rotation %d of %d\n", x, y,
                     gbuffer.objectId.texels[pixel], double(p.x), double(p.y), double(p.z), double(n.x), double(n.y), double(n.z), double(albedo.x),
                     double(albedo.y), double(albedo.z), receiver.rotation, kRotations);
}

std::string coneText(int cone, const Vec3& direction, float weight, float tanHalf)
{
    return formatted("\ncone %d  direction %.4f %.4f %.4f  weight %.5f  tan half-angle %.4f\n", cone, double(direction.x), double(direction.y),
                     double(direction.z), double(weight), double(tanHalf));
}

std::string resultText(const Vec3& radiance, float opacity)
{
    return formatted("  I = %.6g %.6g %.6g   opacity %.5f\n", double(radiance.x), double(radiance.y), double(radiance.z), double(opacity));
}

std::string irradianceText(const Vec3& irradiance, float opacity)
{
    return formatted("\nirradiance (before the 4x4 filter) %.6g %.6g %.6g, opacity %.5f\n", double(irradiance.x), double(irradiance.y), double(irradiance.z),
                     double(opacity));
}

std::string specularText(const Vec3& radiance)
{
    return formatted("specular cone (the last above): I = %.6g %.6g %.6g\n", double(radiance.x), double(radiance.y), double(radiance.z));
}

std::string originText(const Scene& scene)
{
    const glm::dvec3& origin = scene.origin;
    if (origin == glm::dvec3(0.0)) return {};
    return formatted("positions count from %.10g %.10g %.10g, the scene's origin\n", origin.x, origin.y, origin.z);
}

}  // namespace lrsm
