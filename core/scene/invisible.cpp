#include "core/scene/invisible.h"

#include <algorithm>

namespace lrsm {
namespace {

/// The largest that a mesh can have anywhere; a filtered texel is no larger than the largest.
float largestAlpha(const Scene& scene, const Mesh& mesh)
{
    const Material& material = scene.materials[std::size_t(mesh.material)];
    float alpha = material.baseColor.w;
    if (!mesh.colors.empty()) {
        float most = 0.0f;
        for (const Vec4& color : mesh.colors) most = std::max(most, color.w);
        alpha *= most;
    }
    if (!material.baseColorTexture || std::size_t(material.baseColorTexture.texture) >= scene.textures.size()) return alpha;
    const Image<Rgba8>& image = scene.textures[std::size_t(material.baseColorTexture.texture)]->image;
    if (image.empty()) return alpha;
    std::uint8_t most = 0;
    for (const Rgba8& texel : image.texels) most = std::max(most, texel.a);
    return alpha * (float(most) / 255.0f);
}

}  // namespace

bool isDrawnNowhere(const Scene& scene, const Mesh& mesh)
{
    if (std::size_t(mesh.material) >= scene.materials.size()) return false;  // bare triangles
    const Material& material = scene.materials[std::size_t(mesh.material)];
    return material.alphaMask && largestAlpha(scene, mesh) < material.alphaCutoff;
}

}  // namespace lrsm
