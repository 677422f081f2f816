#pragma once

#include "core/base/image.h"
#include "core/base/math.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

/// What is in the world at one moment: plain structs, indices instead of pointers. Places count from Scene::origin: passes and reference know no other space
/// and call it the world; what is shown to a user adds the origin (worldPlace).
namespace lrsm {

/// 8-bit sRGB-or-linear texel as stored in the file (how to decode it is the use's matter, as in glTF).
struct Rgba8 {
    std::uint8_t r = 255, g = 255, b = 255, a = 255;
    bool operator==(const Rgba8&) const = default;
};

enum class Wrap { repeat, clampToEdge, mirroredRepeat };

struct Texture {
    std::string name;
    Image<Rgba8> image;  ///< empty when no used material refers to it: decoded only if used
    Wrap wrapS = Wrap::repeat;
    Wrap wrapT = Wrap::repeat;
    bool nearest = false;                           ///< magFilter NEAREST; else bilinear
    std::vector<Image<Rgba8>> colorMips, dataMips;  ///< levels 1 .. 1x1 (mip_chain.h), as colours and as numbers; empty where no material uses it so
};

/// Never changed once a scene has it: the scenes of one file's moments share it.
using SharedTexture = std::shared_ptr<const Texture>;

/// A texture as a material uses it: uv' = (uvScaleRotation * uv) + uvOffset (KHR_texture_transform).
struct TextureUse {
    int texture = -1;  ///< index into Scene::textures, -1: none
    int uvSet = 0;     ///< 0 or 1
    glm::mat2 uvScaleRotation{1.0f};
    Vec2 uvOffset{0.0f};
    explicit operator bool() const { return texture >= 0; }
};

/// glTF metallic-roughness. Diffuse albedo = baseColor (1 - metallic); F0 = mix(0.04, baseColor, metallic).
/// A dielectric of roughness 1 is modelled as Lambertian, without a specular part (see brdf.h).
struct Material {
    std::string name;
    Vec4 baseColor{1.0f};  ///< linear
    float metallic = 1.0f;
    float roughness = 1.0f;
    float normalScale = 1.0f;
    bool alphaMask = false;
    float alphaCutoff = 0.5f;
    bool doubleSided = false;
    TextureUse baseColorTexture, metallicRoughnessTexture, normalTexture;
};

/// One primitive in world space. Streams are parallel arrays, one entry a vertex; absent streams are empty.
struct Mesh {
    std::string name;
    int material = 0;  ///< index into Scene::materials
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;   ///< unit; always present (flat ones are computed where the file has none)
    std::vector<Vec4> tangents;  ///< xyz unit, w = +-1: bitangent = w * cross(normal, tangent). Empty: derived from uv where needed.
    std::vector<Vec2> uv0, uv1;
    std::vector<Vec4> colors;                             ///< linear, multiplied into baseColor
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from the front
};

enum class LightType {
    directional,  ///< intensity = irradiance on a plane facing it, W/m^2 per RGB channel
    spot,         ///< intensity in W/sr per RGB channel, cone falloff as in KHR_lights_punctual
    cubeFace,     ///< one of the six 90-degree square frusta a point light is split into; intensity in W/sr
};

struct Light {
    std::string name;
    LightType type = LightType::directional;
    Vec3 position{0.0f};                 ///< spot, cubeFace
    Vec3 direction{0.0f, -1.0f, 0.0f};   ///< unit, the way the light travels along its axis
    Vec3 up{0.0f, 0.0f, 1.0f};           ///< unit, orthogonal to direction: fixes the RSM's (and the cube face's) orientation
    Vec3 intensity{1.0f};                ///< colour times intensity
    float innerConeAngle = 0.0f;         ///< radians from the axis
    float outerConeAngle = 0.78539816f;  ///< radians from the axis, < pi/2
    float range = kInfinity;             ///< metres; beyond it no light (KHR_lights_punctual's window); +inf: none
};

struct Camera {
    std::string name;
    Vec3 position{0.0f};
    Vec3 forward{0.0f, 0.0f, -1.0f};  ///< unit
    Vec3 up{0.0f, 1.0f, 0.0f};        ///< unit, orthogonal to forward
    bool perspective = true;
    float verticalFov = 0.8f;     ///< radians, perspective
    float verticalExtent = 1.0f;  ///< metres from bottom to top of the picture, orthographic
    float aspect = 0.0f;          ///< width / height the file asks for; 0: as the picture
    float nearPlane = 0.01f;      ///< metres
};

struct Scene {
    std::string name;  ///< file name or built-in name
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<SharedTexture> textures;  ///< none is null
    std::vector<Light> lights;
    std::vector<Camera> cameras;
    Aabb bounds;                     ///< of all vertices that a triangle uses
    Aabb reach;                      ///< what voxel grid and light maps are fitted to (reach.h); empty: the bounds
    glm::dvec3 origin{0.0};          ///< in the file's world, metres; 0 unless the scene stands far away (chooseOrigin)
    std::vector<std::string> notes;  ///< what was skipped, replaced or assumed, one sentence each: shown by `info` and frame.json

    std::size_t triangleCount() const
    {
        std::size_t count = 0;
        for (const Mesh& mesh : meshes) count += mesh.triangles.size();
        return count;
    }
};

/// A place of the scene in the file's world.
inline glm::dvec3 worldPlace(const Scene& scene, const Vec3& place)
{
    return scene.origin + glm::dvec3(place);
}

/// What picture, light and rounding are measured by: a stray triangle far away must move nothing.
inline const Aabb& extentOf(const Scene& scene)
{
    return scene.reach.empty() ? scene.bounds : scene.reach;
}

/// Do voxel grid and light maps leave out part of the scene?
inline bool reachIsPart(const Scene& scene)
{
    return !scene.reach.empty() && !(scene.reach == scene.bounds);
}

}  // namespace lrsm
