#include "core/scene/gltf.h"

#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "core/scene/defaults.h"
#include "core/scene/gltf_document.h"
#include "core/scene/pose_asset.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

namespace lrsm {
namespace gltf {
namespace {

constexpr std::size_t kMaxTriangles = std::size_t(1) << 28;  // three split vertices each stay below 2^32
constexpr double kMaxExtent = 1e15;                          // metres; beyond it products of coordinates leave float's range

/// stb decodes 16-bit files to 16 bits; 8 are kept, rounded to nearest.
Image<Rgba8> toRgba8(const tinygltf::Image& decoded)
{
    Image<Rgba8> image(decoded.width, decoded.height);
    const bool wide = decoded.bits == 16;
    const auto channel = [&](std::size_t i) {
        if (!wide) return decoded.image[i];
        const unsigned value = decoded.image[2 * i] | unsigned(decoded.image[2 * i + 1]) << 8;
        return static_cast<unsigned char>((value * 255u + 32767u) / 65535u);
    };
    for (std::size_t i = 0; i < image.texels.size(); ++i)
        image.texels[i] = {.r = channel(4 * i), .g = channel(4 * i + 1), .b = channel(4 * i + 2), .a = channel(4 * i + 3)};
    return image;
}

/// A PNG of a few bytes can promise a picture of many gigabytes.
bool isTooLarge(const std::vector<unsigned char>& bytes)
{
    constexpr unsigned char kPng[] = {0x89, 'P', 'N', 'G'};
    if (bytes.size() < 24 || !std::equal(std::begin(kPng), std::end(kPng), bytes.begin())) return false;
    const auto side = [&](std::size_t at) {
        return std::uint64_t(bytes[at]) << 24 | std::uint64_t(bytes[at + 1]) << 16 | std::uint64_t(bytes[at + 2]) << 8 | bytes[at + 3];
    };
    return side(16) * side(20) > (std::uint64_t(1) << 27);
}

Image<Rgba8> decode(const Asset& asset, std::size_t index)
{
    const EncodedImage& encoded = asset.images[index];
    const std::string place = asset.file + ": " + at("images", index);
    if (!encoded.problem.empty()) throw InputError(encoded.problem);
    if (encoded.bytes.empty() || encoded.bytes.size() > 0x7fffffff) throw InputError(place, "is empty or too large");
    if (isTooLarge(encoded.bytes)) throw InputError(place, "has more than 2^27 pixels");

    tinygltf::Image decoded;
    std::string error, warning;
    if (!tinygltf::LoadImageData(&decoded, int(index), &error, &warning, 0, 0, encoded.bytes.data(), int(encoded.bytes.size()), nullptr) ||
        decoded.component != 4 || (decoded.bits != 8 && decoded.bits != 16))
        throw InputError(place, "\"" + encoded.name + "\" cannot be decoded: it is damaged, or neither PNG nor JPEG");
    return toRgba8(decoded);
}

/// Decodes what a triangle's material refers to, each image once, in parallel.
void decodeTextures(const Asset& asset, Scene& scene)
{
    std::set<int> textures;
    for (const lrsm::Mesh& mesh : scene.meshes) {
        const Material& material = scene.materials[std::size_t(mesh.material)];
        for (const TextureUse* use : {&material.baseColorTexture, &material.metallicRoughnessTexture, &material.normalTexture})
            if (*use) textures.insert(use->texture);
    }
    std::set<int> unique;
    for (const int texture : textures) unique.insert(asset.textureImage[std::size_t(texture)]);
    const std::vector<int> indices(unique.begin(), unique.end());

    // The first error in file order is the one reported, whatever thread meets which.
    std::vector<Image<Rgba8>> images(indices.size());
    std::vector<std::string> errors(indices.size());
    parallelFor(indices.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            try {
                images[i] = decode(asset, std::size_t(indices[i]));
            } catch (const InputError& error) {
                errors[i] = error.what();
            }
        }
    });
    for (const std::string& error : errors)
        if (!error.empty()) throw InputError(error);
    for (const int texture : textures) {
        const auto found = std::lower_bound(indices.begin(), indices.end(), asset.textureImage[std::size_t(texture)]);
        scene.textures[std::size_t(texture)].image = images[std::size_t(found - indices.begin())];
    }
}

void checkOptions(const Asset& asset, const LoadOptions& options)
{
    if (!std::isfinite(options.time)) throw InputError("time", "must be finite");
    if (options.animation < -1) throw InputError("animation", "must be an index, or -1 for none");
    // Asking for the first animation is the default, so it is no error where there is none.
    if (options.animation > 0 && std::size_t(options.animation) >= asset.animations.size())
        throw InputError(asset.file + ": animations",
                         "there is no animation " + std::to_string(options.animation) + ", only " + std::to_string(asset.animations.size()));
}

/// Instances multiply triangles; counted before any is made.
void checkSize(const Asset& asset)
{
    std::size_t triangles = 0, vertices = 0;
    for (const int n : asset.sceneNodes) {
        if (asset.nodes[std::size_t(n)].mesh < 0) continue;
        for (const Primitive& primitive : asset.meshes[std::size_t(asset.nodes[std::size_t(n)].mesh)].primitives) {
            triangles += primitive.triangles.size();
            vertices += primitive.positions.size();
        }
        if (std::max(triangles, vertices) > kMaxTriangles)
            throw InputError(asset.file, "the scene has more than " + std::to_string(kMaxTriangles) + " triangles or vertices");
    }
}

void checkNotEmpty(const Scene& scene, const std::string& file)
{
    if (scene.triangleCount() == 0) throw InputError(file, "the scene has no triangles");
    const glm::dvec3 extent = glm::dvec3(scene.bounds.max) - glm::dvec3(scene.bounds.min);
    if (std::max({extent.x, extent.y, extent.z}) > kMaxExtent) throw InputError(file, "the scene is larger than 1e15 m");
    for (const lrsm::Mesh& mesh : scene.meshes) {
        for (const auto& t : mesh.triangles) {
            const glm::dvec3 p0 = mesh.positions[t[0]], p1 = mesh.positions[t[1]], p2 = mesh.positions[t[2]];
            const glm::dvec3 normal = glm::cross(p1 - p0, p2 - p0);
            if (glm::dot(normal, normal) > 0.0) return;
        }
    }
    throw InputError(file, "no triangle of the scene has an area");
}

}  // namespace
}  // namespace gltf

Scene loadGltf(const std::string& path, const LoadOptions& options)
{
    const gltf::Asset asset = gltf::readAsset(path);
    gltf::checkOptions(asset, options);
    gltf::checkSize(asset);
    const int animation = asset.animations.empty() ? -1 : options.animation;
    Scene scene = gltf::poseAsset(asset, gltf::poseNodes(asset, animation, options.time));
    scene.name = std::filesystem::path(path).filename().string();
    gltf::checkNotEmpty(scene, path);
    gltf::decodeTextures(asset, scene);
    if (scene.lights.empty()) addDefaultLight(scene);
    if (scene.cameras.empty()) addDefaultCamera(scene);
    return scene;
}

const Camera& findCamera(const Scene& scene, const std::string& nameOrIndex)
{
    for (const Camera& camera : scene.cameras)
        if (camera.name == nameOrIndex) return camera;
    const bool number =
        !nameOrIndex.empty() && nameOrIndex.size() < 9 && std::all_of(nameOrIndex.begin(), nameOrIndex.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (number && std::stoul(nameOrIndex) < scene.cameras.size()) return scene.cameras[std::stoul(nameOrIndex)];

    std::string available;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) available += (i ? ", " : "") + std::to_string(i) + " \"" + scene.cameras[i].name + "\"";
    throw InputError("camera \"" + nameOrIndex + "\"", "there is none of that name or index; there are: " + (available.empty() ? "none" : available));
}

}  // namespace lrsm
