// Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007 (GGX).
// Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014 (height-correlated Smith).
// glTF 2.0, section 3.9 (material), 3.7.2.1 (tangent space), appendix B (BRDF).
#include "core/scene/brdf.h"

#include "core/scene/texture_sampling.h"

#include <algorithm>

namespace lrsm {
namespace {

using DVec3 = glm::dvec3;

struct Triangle {
    const Mesh& mesh;
    std::array<std::uint32_t, 3> index;
    float b0, b1, b2;
    Vec2 right{0.0f}, down{0.0f};  ///< movement of (b1, b2) from pixel to pixel

    template <class T>
    T interpolate(const std::vector<T>& stream) const
    {
        return b0 * stream[index[0]] + b1 * stream[index[1]] + b2 * stream[index[2]];
    }
};

Triangle triangleAt(const Scene& scene, const SurfaceHit& hit)
{
    const Mesh& mesh = scene.meshes[hit.mesh];
    return {.mesh = mesh, .index = mesh.triangles[hit.triangle], .b0 = 1.0f - hit.b1 - hit.b2, .b1 = hit.b1, .b2 = hit.b2};
}

const std::vector<Vec2>& uvStream(const Mesh& mesh, const TextureUse& use)
{
    return use.uvSet == 1 ? mesh.uv1 : mesh.uv0;
}

Vec2 transformUv(const TextureUse& use, const Vec2& uv)
{
    return use.uvScaleRotation * uv + use.uvOffset;
}

/// A missing uv set reads the texture at uv 0, as a GPU's default attribute would.
TexturePlace placeAt(const Triangle& triangle, const TextureUse& use)
{
    const std::vector<Vec2>& stream = uvStream(triangle.mesh, use);
    if (stream.empty()) return {transformUv(use, Vec2(0.0f)), Vec2(0.0f), Vec2(0.0f)};
    const Vec2 edge1 = stream[triangle.index[1]] - stream[triangle.index[0]], edge2 = stream[triangle.index[2]] - stream[triangle.index[0]];
    const auto moved = [&](const Vec2& b) { return use.uvScaleRotation * (b.x * edge1 + b.y * edge2); };
    return {transformUv(use, triangle.interpolate(stream)), moved(triangle.right), moved(triangle.down)};
}

/// The next pixel's ray, parallel to `toViewer` in the limit, meets the triangle's plane where b1 and b2 have moved by this: right and down.
void setMovement(Triangle& triangle, const PixelSpacing& spacing, const Vec3& toViewer)
{
    const DVec3 p0 = triangle.mesh.positions[triangle.index[0]];
    const DVec3 e1 = DVec3(triangle.mesh.positions[triangle.index[1]]) - p0, e2 = DVec3(triangle.mesh.positions[triangle.index[2]]) - p0;
    const DVec3 n = glm::cross(e1, e2), v(toViewer);
    const double facing = glm::dot(n, v), area2 = glm::dot(n, n);
    const auto movement = [&](const DVec3& across) {
        const DVec3 along = across - v * (glm::dot(n, across) / facing);
        return Vec2(glm::dvec2(glm::dot(glm::cross(along, e2), n), glm::dot(glm::cross(e1, along), n)) / area2);
    };
    triangle.right = movement(spacing.right);
    triangle.down = movement(spacing.down);
}

bool hasTexture(const Material& material)
{
    return material.baseColorTexture || material.metallicRoughnessTexture || material.normalTexture;
}

/// Of triangles that lead out of the scene's reach in double: corners kilometres away round to more than what stands on them is thick. The point stays on the
/// plane, however coarse the barycentrics.
Vec3 positionAt(const Scene& scene, const Triangle& triangle)
{
    const std::vector<Vec3>& positions = triangle.mesh.positions;
    if (!reachIsPart(scene) || std::all_of(triangle.index.begin(), triangle.index.end(), [&](std::uint32_t v) { return scene.reach.contains(positions[v]); }))
        return triangle.interpolate(positions);
    const double b1(triangle.b1), b2(triangle.b2);
    return Vec3((1.0 - b1 - b2) * DVec3(positions[triangle.index[0]]) + b1 * DVec3(positions[triangle.index[1]]) + b2 * DVec3(positions[triangle.index[2]]));
}

float inUnitInterval(float x)
{
    return x > 0.0f ? std::min(x, 1.0f) : 0.0f;  // NaN too
}

Vec3 baseColorAt(const Scene& scene, const Material& material, const Triangle& triangle)
{
    Vec3 color(material.baseColor);
    if (const TextureUse& use = material.baseColorTexture) color *= Vec3(sampleTextureSrgb(*scene.textures[std::size_t(use.texture)], placeAt(triangle, use)));
    if (!triangle.mesh.colors.empty()) color *= Vec3(triangle.interpolate(triangle.mesh.colors));
    for (int c = 0; c < 3; ++c) color[c] = inUnitInterval(color[c]);
    return color;
}

/// At the base level.
float alphaAt(const Scene& scene, const Material& material, const Triangle& triangle)
{
    float alpha = material.baseColor.a;
    if (const TextureUse& use = material.baseColorTexture) alpha *= sampleTextureAlpha(*scene.textures[std::size_t(use.texture)], placeAt(triangle, use).uv);
    if (!triangle.mesh.colors.empty()) alpha *= triangle.interpolate(triangle.mesh.colors).a;
    return inUnitInterval(alpha);
}

/// Unit v, or `fallback` where v has no direction. In double: an edge of 1e-12 m must not underflow.
Vec3 normalizedOr(const DVec3& v, const Vec3& fallback)
{
    const double length2 = glm::dot(v, v);
    if (!(length2 > 0.0) || !std::isfinite(length2)) return fallback;
    return Vec3(v / std::sqrt(length2));
}

Vec3 geometricNormal(const Triangle& triangle)
{
    const DVec3 p0 = triangle.mesh.positions[triangle.index[0]];
    const DVec3 p1 = triangle.mesh.positions[triangle.index[1]];
    const DVec3 p2 = triangle.mesh.positions[triangle.index[2]];
    // A triangle without area has the direction of its first vertex normal, so that nothing downstream meets a NaN.
    return normalizedOr(glm::cross(p1 - p0, p2 - p0), triangle.mesh.normals[triangle.index[0]]);
}

/// dP/du of the normal map's own (transformed) uv and the bitangent's sign. glTF's green axis is up in the image while v grows
/// downwards, so the bitangent is along -dP/dv. w = 0: the uv are degenerate.
Vec4 tangentFromUv(const Triangle& triangle, const TextureUse& use)
{
    const std::vector<Vec2>& uv = uvStream(triangle.mesh, use);
    if (uv.empty()) return Vec4(0.0f);
    const auto uvOf = [&](int i) { return glm::dvec2(transformUv(use, uv[triangle.index[std::size_t(i)]])); };
    const auto pOf = [&](int i) { return DVec3(triangle.mesh.positions[triangle.index[std::size_t(i)]]); };
    const glm::dvec2 uv1 = uvOf(1) - uvOf(0), uv2 = uvOf(2) - uvOf(0);
    const DVec3 e1 = pOf(1) - pOf(0), e2 = pOf(2) - pOf(0);

    const double determinant = uv1.x * uv2.y - uv2.x * uv1.y;
    if (!(std::abs(determinant) > 0.0) || !std::isfinite(determinant)) return Vec4(0.0f);
    const double side = determinant > 0.0 ? 1.0 : -1.0;
    const Vec3 tangent = normalizedOr((e1 * uv2.y - e2 * uv1.y) * side, Vec3(0.0f));
    return tangent == Vec3(0.0f) ? Vec4(0.0f) : Vec4(tangent, float(-side));
}

Vec3 applyNormalMap(const Scene& scene, const Material& material, const Triangle& triangle, const Vec3& n)
{
    const TextureUse& use = material.normalTexture;
    const Vec4 tangent = triangle.mesh.tangents.empty() ? tangentFromUv(triangle, use) : triangle.interpolate(triangle.mesh.tangents);
    const Vec3 t = normalizedOr(DVec3(tangent) - DVec3(n) * glm::dot(DVec3(tangent), DVec3(n)), Vec3(0.0f));
    if (tangent.w == 0.0f || t == Vec3(0.0f)) return n;
    const Vec3 b = glm::cross(n, t) * std::copysign(1.0f, tangent.w);

    const Vec4 texel = sampleTexture(*scene.textures[std::size_t(use.texture)], placeAt(triangle, use));
    const Vec3 m = (2.0f * Vec3(texel) - 1.0f) * Vec3(material.normalScale, material.normalScale, 1.0f);
    return normalizedOr(DVec3(t) * double(m.x) + DVec3(b) * double(m.y) + DVec3(n) * double(m.z), n);
}

/// The nearest direction to n (unit) that does not face away from `toViewer`: n itself, or its projection on the plane
/// orthogonal to the viewer. Of a normal that looks straight away nothing is left; the geometric one stands in.
Vec3 pushToTangentPlane(const Vec3& n, const Vec3& toViewer, const Vec3& nGeometric)
{
    const DVec3 v(toViewer);
    const double facing = glm::dot(DVec3(n), v);
    if (!(facing < 0.0)) return n;
    const DVec3 projected = DVec3(n) - v * (facing / glm::dot(v, v));
    return glm::dot(projected, projected) > 1e-12 ? normalizedOr(projected, nGeometric) : nGeometric;
}

void setNormals(Surface& surface, const Scene& scene, const Material& material, const Triangle& triangle, const Vec3& toViewer)
{
    Vec3 nGeometric = geometricNormal(triangle);
    Vec3 n = normalizedOr(DVec3(triangle.interpolate(triangle.mesh.normals)), nGeometric);
    if (material.normalTexture) n = applyNormalMap(scene, material, triangle, n);

    const bool seenFromBehind = glm::dot(nGeometric, toViewer) < 0.0f;
    if (material.doubleSided) {
        // Two flips, not one: exporters wind double-sided surfaces carelessly, so vertex normals may disagree with the winding.
        if (seenFromBehind) nGeometric = -nGeometric;
        if (glm::dot(n, nGeometric) < 0.0f) n = -n;
    }
    surface.geometricNormal = nGeometric;
    surface.normal = seenFromBehind && !material.doubleSided ? n : pushToTangentPlane(n, toViewer, nGeometric);
}

}  // namespace

bool hasSpecularPart(const Material& material)
{
    // A texture multiplies its factor and can only lower it: metallic 0 stays 0, roughness 1 may drop.
    return material.metallic > 0.0f || material.roughness < 1.0f || material.metallicRoughnessTexture;
}

bool passesAlphaTest(const Scene& scene, const SurfaceHit& hit)
{
    const Material& material = scene.materials[std::size_t(scene.meshes[hit.mesh].material)];
    return !material.alphaMask || alphaAt(scene, material, triangleAt(scene, hit)) >= material.alphaCutoff;
}

Vec3 positionOf(const Scene& scene, const SurfaceHit& hit)
{
    return positionAt(scene, triangleAt(scene, hit));
}

Surface evaluateSurface(const Scene& scene, const SurfaceHit& hit, const Vec3& toViewer, const PixelSpacing* spacing)
{
    Triangle triangle = triangleAt(scene, hit);
    const Material& material = scene.materials[std::size_t(triangle.mesh.material)];
    if (spacing && hasTexture(material)) setMovement(triangle, *spacing, toViewer);

    Surface surface;
    surface.position = positionAt(scene, triangle);
    setNormals(surface, scene, material, triangle, toViewer);

    float metallic = material.metallic, roughness = material.roughness;
    if (const TextureUse& use = material.metallicRoughnessTexture) {
        const Vec4 texel = sampleTexture(*scene.textures[std::size_t(use.texture)], placeAt(triangle, use));
        roughness *= texel.g;
        metallic *= texel.b;
    }
    const Vec3 baseColor = baseColorAt(scene, material, triangle);
    surface.roughness = roughness;
    surface.albedo = baseColor * (1.0f - metallic);
    if (hasSpecularPart(material)) surface.specularColor = Vec3(0.04f) + (baseColor - Vec3(0.04f)) * metallic;
    return surface;
}

Vec3 evaluateSpecular(const Surface& surface, const Vec3& toLight, const Vec3& toViewer)
{
    const float nl = glm::dot(surface.normal, toLight), nv = glm::dot(surface.normal, toViewer);
    if (!(nl > 0.0f && nv > 0.0f) || surface.specularColor == Vec3(0.0f)) return Vec3(0.0f);
    const Vec3 half = toLight + toViewer;  // not zero, both being on the normal's side; but its square may round to 0
    const float half2 = glm::dot(half, half);
    if (!(half2 > 0.0f)) return Vec3(0.0f);
    const Vec3 h = half / std::sqrt(half2);
    const float nh = glm::dot(surface.normal, h), vh = std::max(0.0f, glm::dot(toViewer, h));

    // GGX distribution; sin^2 by the cross product, since 1 - nh^2 loses all digits near a mirror's highlight.
    const float alpha = std::max(surface.roughness * surface.roughness, kMinSpecularAlpha), alpha2 = alpha * alpha;
    const Vec3 sine = glm::cross(surface.normal, h);
    const float spread = glm::dot(sine, sine) + alpha2 * nh * nh;
    const float d = alpha2 / (kPi * spread * spread);

    // Smith masking and shadowing over 4 nl nv, height-correlated.
    const float maskL = nv * std::sqrt(nl * nl * (1.0f - alpha2) + alpha2);
    const float maskV = nl * std::sqrt(nv * nv * (1.0f - alpha2) + alpha2);
    const float visibility = 0.5f / std::max(maskL + maskV, 1e-30f);  // products of two grazing cosines may round to 0

    // Schlick's Fresnel.
    const float grazing = 1.0f - std::min(vh, 1.0f), grazing2 = grazing * grazing;
    const Vec3 fresnel = surface.specularColor + (Vec3(1.0f) - surface.specularColor) * (grazing2 * grazing2 * grazing);
    return fresnel * (d * visibility * nl);
}

Vec3 reflectLobe(const Vec3& normal, float alpha, const Vec3& toViewer, const Vec2& disk)
{
    const Mat3 basis = basisFromNormal(normal);
    const Vec3 viewer = glm::transpose(basis) * toViewer;

    // Stretched to a hemisphere, the visible normals are a disk seen from the viewer, its far half squeezed.
    const Vec3 stretched = glm::normalize(Vec3(alpha * viewer.x, alpha * viewer.y, std::max(viewer.z, 1e-6f)));
    // The squeezed axis must lie in the plane of the viewer and the pole.
    const float planar2 = stretched.x * stretched.x + stretched.y * stretched.y;
    const Vec3 across = planar2 > 0.0f ? Vec3(-stretched.y, stretched.x, 0.0f) / std::sqrt(planar2) : basisFromNormal(stretched)[0];
    const Vec3 upward = glm::cross(stretched, across);
    const float squeeze = 0.5f * (1.0f + stretched.z);
    const float y = (1.0f - squeeze) * std::sqrt(std::max(0.0f, 1.0f - disk.x * disk.x)) + squeeze * disk.y;
    const float z = std::sqrt(std::max(0.0f, 1.0f - disk.x * disk.x - y * y));
    const Vec3 visible = disk.x * across + y * upward + z * stretched;

    const Vec3 half = basis * glm::normalize(Vec3(alpha * visible.x, alpha * visible.y, std::max(0.0f, visible.z)));
    return glm::normalize(mirrorDirection(half, toViewer));
}

}  // namespace lrsm
