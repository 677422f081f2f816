#include "core/scene/requirements.h"

#include "core/scene/brdf.h"

namespace lrsm {

Requirements analyseRequirements(const Scene& scene, const ForceSettings& force)
{
    if (force.everything) return {};

    // Only what a triangle uses counts: a file may list materials that nothing wears.
    Requirements need{.specular = false, .alphaTest = false, .normalMaps = false, .textures = false, .vertexColors = false, .leftOut = {}};
    for (const Mesh& mesh : scene.meshes) {
        if (mesh.triangles.empty()) continue;
        const Material& material = scene.materials[std::size_t(mesh.material)];
        need.specular |= hasSpecularPart(material);
        need.alphaTest |= material.alphaMask;
        need.normalMaps |= bool(material.normalTexture);
        need.textures |= material.baseColorTexture || material.metallicRoughnessTexture || material.normalTexture;
        need.vertexColors |= !mesh.colors.empty();
    }

    const auto leaveOut = [&](bool needed, const char* why) {
        if (!needed) need.leftOut.emplace_back(why);
    };
    leaveOut(need.specular, "specular cones and channels: no material has a specular part");
    leaveOut(need.alphaTest, "alpha test: no material has an alpha mask");
    leaveOut(need.normalMaps, "normal maps: no material has one");
    leaveOut(need.textures, "texture lookups: no material has a texture");
    leaveOut(need.vertexColors, "vertex colours: no mesh has them");
    return need;
}

}  // namespace lrsm
