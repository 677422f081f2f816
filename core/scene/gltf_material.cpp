#include "core/scene/gltf_material.h"

#include "core/base/elementary.h"
#include "core/scene/gltf_accessor.h"

#include <algorithm>
#include <tuple>

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
TextureUse textureUse(const Json& owner, const char* key)
{
    TextureUse use;
    const auto info = owner.find(key);
    if (info == owner.end()) return use;
    use.texture = (*info)["index"].get<int>();
    use.uvSet = info->value("texCoord", 0);
    if (const auto extensions = info->find("extensions"); extensions != info->end())
        if (const auto transform = extensions->find("KHR_texture_transform"); transform != extensions->end()) readTransform(*transform, use);
    return use;
}

constexpr std::size_t kUvStreams = std::tuple_size_v<UvSets>;

/// Passes know two streams of texture coordinates: the file's sets that this material uses are numbered anew where there are others than 0 and 1.
UvSets assignUvSets(Material& material, std::vector<std::string>& notes)
{
    const std::array<TextureUse*, 3> uses = {&material.baseColorTexture, &material.metallicRoughnessTexture, &material.normalTexture};
    if (std::all_of(uses.begin(), uses.end(), [](const TextureUse* use) { return !*use || use->uvSet < int(kUvStreams); })) return {0, 1};
    UvSets sets;
    sets.fill(-1);
    std::size_t known = 0;
    for (TextureUse* use : uses) {
        if (!*use) continue;
        const auto end = sets.begin() + std::ptrdiff_t(known), found = std::find(sets.begin(), end, use->uvSet);
        if (found == end && known == kUvStreams) {
            notes.push_back("material \"" + material.name + "\": a texture ignored, its coordinates are the third set that the material uses");
            *use = TextureUse();
            continue;
        }
        if (found == end) sets[known++] = use->uvSet;
        use->uvSet = int(found - sets.begin());
    }
    return sets;
}

/// KHR_materials_pbrSpecularGlossiness: of two models the part that they have in common.
void readSpecularGlossiness(const Json& json, Material& material, std::vector<std::string>& notes)
{
    const std::vector<float> diffuse = json.value("diffuseFactor", std::vector<float>(4, 1.0f));
    material.baseColor = Vec4(diffuse[0], diffuse[1], diffuse[2], diffuse[3]);
    material.baseColorTexture = textureUse(json, "diffuseTexture");
    material.metallic = 0.0f;
    material.roughness = 1.0f;
    notes.push_back("material \"" + material.name + "\": of specular-glossiness the diffuse part is taken as albedo, the specular part left out");
}

/// The extension's object in `owner`; nullptr where there is none.
const Json* extensionIn(const Json& owner, const char* name)
{
    const auto extensions = owner.find("extensions");
    if (extensions == owner.end() || !extensions->is_object()) return nullptr;
    const auto found = extensions->find(name);
    return found == extensions->end() || !found->is_object() ? nullptr : &*found;
}

Material readMaterial(const Document& document, std::size_t i, Asset& asset)
{
    const Json& json = document.json["materials"][i];
    const tinygltf::Material& source = document.model.materials[i];

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
    if (const std::string mode = source.alphaMode; !mode.empty() && mode != "OPAQUE" && mode != "MASK" && mode != "BLEND")
        asset.notes.push_back("material \"" + material.name + "\": unknown alphaMode \"" + mode + "\" taken as OPAQUE");
    if (const auto block = json.find("pbrMetallicRoughness"); block != json.end()) {
        material.baseColorTexture = textureUse(*block, "baseColorTexture");
        material.metallicRoughnessTexture = textureUse(*block, "metallicRoughnessTexture");
    }
    if (const Json* block = extensionIn(json, "KHR_materials_pbrSpecularGlossiness")) {
        material.metallicRoughnessTexture = {};
        readSpecularGlossiness(*block, material, asset.notes);
    }
    material.normalTexture = textureUse(json, "normalTexture");
    material.normalScale = float(source.normalTexture.scale);
    return material;
}

void noteIgnored(const Document& document, Asset& asset)
{
    std::size_t occlusion = 0;
    const Json materials = document.json.value("materials", Json::array());
    for (std::size_t i = 0; i < materials.size(); ++i) {
        occlusion += materials[i].contains("occlusionTexture");
        const std::string material = "material \"" + asset.materials[i].name + "\"";
        const std::vector<double> factor = materials[i].value("emissiveFactor", std::vector<double>{0.0, 0.0, 0.0});
        if (factor[0] > 0.0 || factor[1] > 0.0 || factor[2] > 0.0)
            asset.notes.push_back("emissive " + material + " lights nothing: only the lights of KHR_lights_punctual and of view files emit");
        if (extensionIn(materials[i], "KHR_materials_unlit")) asset.notes.push_back("unlit " + material + " is lit like any other");
    }
    if (occlusion > 0) asset.notes.push_back(countOf(occlusion, "occlusion texture") + " ignored");
}

}  // namespace

void readMaterials(const Document& document, Asset& asset)
{
    for (std::size_t i = 0; i < document.model.materials.size(); ++i) asset.materials.push_back(readMaterial(document, i, asset));
    Material fallback;
    fallback.name = "glTF default";
    asset.materials.push_back(fallback);
    for (Material& material : asset.materials) asset.materialUvSets.push_back(assignUvSets(material, asset.notes));
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
        asset.textures.push_back(std::make_shared<Texture>(std::move(texture)));
        const Json* webp = extensionIn(document.json["textures"][i], "EXT_texture_webp");
        asset.textureImage.push_back(webp && isRead("EXT_texture_webp") ? (*webp)["source"].get<int>() : source.source);
    }
    // A texture that only an unknown extension could fill (a compressed format, say) is left out, and the factor stands alone.
    for (Material& material : asset.materials) {
        for (TextureUse* use : {&material.baseColorTexture, &material.metallicRoughnessTexture, &material.normalTexture}) {
            if (!*use || asset.textureImage[std::size_t(use->texture)] >= 0) continue;
            const Json& texture = document.json["textures"][std::size_t(use->texture)];
            const std::string extension = texture.contains("extensions") && !texture["extensions"].empty() ? texture["extensions"].begin().key() : "";
            asset.notes.push_back("material \"" + material.name + "\": a texture without a readable source ignored" + conversionAdvice(extension));
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
