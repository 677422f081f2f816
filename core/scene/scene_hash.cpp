#include "core/scene/scene_hash.h"

#include "core/base/hash.h"
#include "core/base/parallel.h"

namespace lrsm {
namespace {

/// Feeds fields one by one, so that padding never counts, and each array after its length, so that no two scenes run together.
class Feeder {
  public:
    template <class T>
    requires std::is_arithmetic_v<T> Feeder& operator<<(T value)
    {
        sha_.add(std::as_bytes(std::span(&value, 1)));
        return *this;
    }
    Feeder& operator<<(bool value) { return *this << std::uint8_t(value); }
    Feeder& operator<<(const Vec2& v) { return *this << v.x << v.y; }
    Feeder& operator<<(const Vec3& v) { return *this << v.x << v.y << v.z; }
    Feeder& operator<<(const Vec4& v) { return *this << v.x << v.y << v.z << v.w; }
    template <class T>
    Feeder& operator<<(const std::vector<T>& values)
    {
        *this << std::uint64_t(values.size());
        sha_.add(values);
        return *this;
    }
    std::string hex() { return sha_.hex(); }

  private:
    Sha256 sha_;
};

Feeder& operator<<(Feeder& out, const TextureUse& use)
{
    return out << use.texture << use.uvSet << use.uvScaleRotation[0] << use.uvScaleRotation[1] << use.uvOffset;
}

Feeder& operator<<(Feeder& out, const Material& m)
{
    out << m.baseColor << m.metallic << m.roughness << m.normalScale << m.alphaMask << m.alphaCutoff << m.doubleSided;
    return out << m.baseColorTexture << m.metallicRoughnessTexture << m.normalTexture;
}

Feeder& operator<<(Feeder& out, const SharedTexture& t)
{
    return out << int(t->wrapS) << int(t->wrapT) << t->nearest << t->image.width << t->image.height << t->image.texels;
}

Feeder& operator<<(Feeder& out, const Mesh& m)
{
    return out << m.material << m.positions << m.normals << m.tangents << m.uv0 << m.uv1 << m.colors << m.triangles;
}

Feeder& operator<<(Feeder& out, const Light& l)
{
    return out << int(l.type) << l.position << l.direction << l.up << l.intensity << l.innerConeAngle << l.outerConeAngle << l.range;
}

Feeder& operator<<(Feeder& out, const Camera& c)
{
    return out << c.position << c.forward << c.up << c.perspective << c.verticalFov << c.verticalExtent << c.aspect << c.nearPlane;
}

template <class T>
void feedAll(Feeder& out, const std::vector<T>& items)
{
    out << std::uint64_t(items.size());
    for (const T& item : items) out << item;
}

}  // namespace

std::string hashScene(const Scene& scene)
{
    Feeder out;
    feedAll(out, scene.meshes);
    feedAll(out, scene.materials);
    feedAll(out, scene.textures);
    feedAll(out, scene.lights);
    feedAll(out, scene.cameras);
    // Ordinary scenes have neither, and keep their hash.
    if (scene.origin != glm::dvec3(0.0)) out << scene.origin.x << scene.origin.y << scene.origin.z;
    if (reachIsPart(scene)) out << scene.reach.min << scene.reach.max;
    return out.hex();
}

SceneKeys keysOf(const Scene& scene)
{
    const auto keyOf = [](const auto&... parts) {
        Feeder out;
        (out << ... << parts);
        return out.hex();
    };
    SceneKeys keys;
    keys.meshes.resize(scene.meshes.size());
    parallelFor(scene.meshes.size(), 1, [&](std::size_t m, std::size_t) { keys.meshes[m] = keyOf(scene.meshes[m]); });
    for (const Light& light : scene.lights) keys.lights.push_back(keyOf(light));
    Feeder materials;
    feedAll(materials, scene.materials);
    keys.materials = materials.hex();
    keys.boxes = keyOf(scene.bounds.min, scene.bounds.max, scene.reach.min, scene.reach.max);
    return keys;
}

}  // namespace lrsm
