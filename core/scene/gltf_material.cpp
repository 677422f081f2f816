#include "core/scene/gltf_material.h"

#include "core/base/elementary.h"
#include "core/scene/gltf_accessor.h"

namespace lrsm::gltf {
namespace {

Wrap wrapOf(int value)
{
    switch (value) {
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE: return Wrap::clampToEdge;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT: return Wrap::mirroredRepeat;
    default: return Wrap::repeat;
    }
}

/// KHR_texture_transform: translation * rotation * scale; the rotation is counter-clockwise as seen in the image, v downwards
/// (this sign, not the draft's, makes the extension's own example read the quadrant that it says).
void readTransform(const Json& transform, TextureUse& use)
{
    use.uvSet = transform.value("texCoord", use.uvSet);
    const auto pair = [&](const char* key, float fallback) {
        const auto found = transform.find(key);
        return found == transform.end() ? glm::dvec2(fallback) : glm::dvec2((*found)[0].get<double>(), (*found)[1].get<double>());
    };
    const glm::dvec2 scale = pair("scale", 1.0f);
    const SinCos r = sinCos(transform.value("rotation", 0.0));
    use.uvScaleRotation = glm::mat2(glm::dmat2(glm::dvec2(r.cos, -r.sin) * scale.x, glm::dvec2(r.sin, r.cos) * scale.y));
    use.uvOffset = Vec2(pair("offset", 0.0f));
}

/// The texture reference `key` of a material object.
TextureUse textureUse(const Document& document, const Json& owner, const char* key, const std::string& path)
{
    TextureUse use;
    const auto info = owner.find(key);
    if (info == owner.end()) return use;
    use.texture = (*info)["index"].get<int>();
    use.uvSet = info->value("texCoord", 0);
    if (const auto extensions = info->find("extensions"); extensions != info->end())
        if (const auto transform = extensions->find("KHR_texture_transform"); transform != extensions->end()) readTransform(*transform, use);
    if (use.uvSet > 1) document.fail(path + "." + key + ".texCoord", "only texture coordinate sets 0 and 1 are supported");
    return use;
}

Material readMaterial(const Document& document, std::size_t i, Asset& asset)
{
    const Json& json = document.json["materials"][i];
    const tinygltf::Material& source = document.model.materials[i];
    const std::string path = at("materials", i);

    Material material;
    material.name = source.name.empty() ? "material " + std::to_string(i) : source.name;
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    for (int c = 0; c < 4; ++c) material.baseColor[c] = float(pbr.baseColorFactor[std::size_t(c)]);
    material.metallic = float(pbr.metallicFactor);
    material.roughness = float(pbr.roughnessFactor);
    material.doubleSided = source.doubleSided;
    material.alphaMask = source.alphaMode == "MASK";
    material.alphaCutoff = float(source.alphaCutoff);
    if (source.alphaMode == "BLEND") {
        material.alphaMask = true;
        material.alphaCutoff = 0.5f;
        asset.notes.push_back("material \"" + material.name + "\": alpha blending replaced by a mask at 0.5");
    }
    if (const auto block = json.find("pbrMetallicRoughness"); block != json.end()) {
        const std::string inner = path + ".pbrMetallicRoughness";
        material.baseColorTexture = textureUse(document, *block, "baseColorTexture", inner);
        material.metallicRoughnessTexture = textureUse(document, *block, "metallicRoughnessTexture", inner);
    }
    material.normalTexture = textureUse(document, json, "normalTexture", path);
    material.normalScale = float(source.normalTexture.scale);
    return material;
}

void noteIgnored(const Document& document, Asset& asset)
{
    std::size_t occlusion = 0, emissive = 0;
    for (const Json& material : document.json.value("materials", Json::array())) {
        occlusion += material.contains("occlusionTexture");
        const std::vector<double> factor = material.value("emissiveFactor", std::vector<double>{0.0, 0.0, 0.0});
        emissive += factor[0] > 0.0 || factor[1] > 0.0 || factor[2] > 0.0;
    }
    if (occlusion > 0) asset.notes.push_back(countOf(occlusion, "occlusion texture") + " ignored");
    if (emissive > 0) asset.notes.push_back(countOf(emissive, "emissive material") + " ignored: only the lights of KHR_lights_punctual emit");
}

}  // namespace

void readMaterials(const Document& document, Asset& asset)
{
    for (std::size_t i = 0; i < document.model.materials.size(); ++i) asset.materials.push_back(readMaterial(document, i, asset));
    Material fallback;
    fallback.name = "glTF default";
    asset.materials.push_back(fallback);
    noteIgnored(document, asset);

    for (std::size_t i = 0; i < document.model.textures.size(); ++i) {
        const tinygltf::Texture& source = document.model.textures[i];
        Texture texture;
        texture.name = source.name.empty() ? "texture " + std::to_string(i) : source.name;
        if (source.sampler >= 0) {
            const tinygltf::Sampler& sampler = document.model.samplers[std::size_t(source.sampler)];
            texture.wrapS = wrapOf(sampler.wrapS);
            texture.wrapT = wrapOf(sampler.wrapT);
            texture.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
        }
        asset.textures.push_back(std::move(texture));
        asset.textureImage.push_back(source.source);
    }
    // A texture that only an unknown extension could fill (a compressed format, say) is left out, and the factor stands alone.
    for (Material& material : asset.materials) {
        for (TextureUse* use : {&material.baseColorTexture, &material.metallicRoughnessTexture, &material.normalTexture}) {
            if (!*use || asset.textureImage[std::size_t(use->texture)] >= 0) continue;
            asset.notes.push_back("material \"" + material.name + "\": a texture without a readable source ignored");
            use->texture = -1;
        }
    }
}

void readImages(const Document& document, Asset& asset)
{
    const Json images = document.json.value("images", Json::array());
    for (std::size_t i = 0; i < images.size(); ++i) {
        EncodedImage image{images[i].value("name", images[i].value("uri", std::string())), {}, {}};
        if (image.name.empty() || image.name.starts_with("data:")) image.name = "image " + std::to_string(i);
        try {
            if (images[i].contains("bufferView")) {
                const auto bytes = bufferViewBytes(document, images[i]["bufferView"].get<int>());
                image.bytes.assign(bytes.begin(), bytes.end());
            } else if (images[i].contains("uri")) {
                image.bytes = readUri(document, images[i]["uri"].get<std::string>(), at("images", i) + ".uri");
            } else {
                document.fail(at("images", i), "has neither uri nor bufferView");
            }
        } catch (const InputError& error) {
            image.problem = error.what();  // matters only if a triangle's material uses it
        }
        asset.images.push_back(std::move(image));
    }
}

}  // namespace lrsm::gltf
