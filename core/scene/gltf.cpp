#include "core/scene/gltf.h"

#include "core/base/elementary.h"
#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "core/decode/decode.h"
#include "core/scene/defaults.h"
#include "core/scene/gltf_document.h"
#include "core/scene/invisible.h"
#include "core/scene/mip_chain.h"
#include "core/scene/pose_asset.h"
#include "core/scene/reach.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <set>

namespace lrsm {
namespace gltf {
namespace {

constexpr std::size_t kMaxTriangles = std::size_t(1) << 28;  // three split vertices each stay below 2^32
constexpr std::int64_t kMaxPixels = std::int64_t(1) << 27;   // of a texture
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
    return side(16) * side(20) > std::uint64_t(kMaxPixels);
}

bool isKtx(const std::vector<unsigned char>& bytes)
{
    constexpr unsigned char kKtx[] = {0xab, 'K', 'T', 'X', ' '};
    return bytes.size() >= std::size(kKtx) && std::equal(std::begin(kKtx), std::end(kKtx), bytes.begin());
}

Image<Rgba8> decode(const Asset& asset, std::size_t index)
{
    const EncodedImage& encoded = asset.images[index];
    const std::string place = asset.file + ": " + at("images", index);
    if (!encoded.problem.empty()) throw InputError(encoded.problem);
    if (encoded.bytes.empty() || encoded.bytes.size() > 0x7fffffff) throw InputError(place, "is empty or too large");
    if (isTooLarge(encoded.bytes)) throw InputError(place, "has more than 2^27 pixels");
    if (const std::optional<WebpSize> size = webpSize(encoded.bytes)) {
        if (std::int64_t(size->width) * size->height > kMaxPixels) throw InputError(place, "has more than 2^27 pixels");
        const std::optional<Bytes> rgba = decodeWebp(encoded.bytes);
        if (!rgba) throw InputError(place, "\"" + encoded.name + "\" cannot be decoded: a damaged WebP file, or an animation");
        Image<Rgba8> image(size->width, size->height);
        for (std::size_t i = 0; i < image.texels.size(); ++i)
            image.texels[i] = {.r = (*rgba)[4 * i], .g = (*rgba)[4 * i + 1], .b = (*rgba)[4 * i + 2], .a = (*rgba)[4 * i + 3]};
        return image;
    }

    tinygltf::Image decoded;
    std::string error, warning;
    if (!tinygltf::LoadImageData(&decoded, int(index), &error, &warning, 0, 0, encoded.bytes.data(), int(encoded.bytes.size()), nullptr) ||
        decoded.component != 4 || (decoded.bits != 8 && decoded.bits != 16))
        throw InputError(place, "\"" + encoded.name + "\" cannot be decoded: it is damaged, or none of PNG, JPEG and WebP" +
                                    conversionAdvice(isKtx(encoded.bytes) ? "KHR_texture_basisu" : ""));
    return toRgba8(decoded);
}

/// Textures that a triangle's material refers to, in order.
std::vector<int> usedTextures(const Asset& asset)
{
    std::set<int> textures;
    for (const int n : asset.sceneNodes) {
        if (asset.nodes[std::size_t(n)].mesh < 0) continue;
        for (const Primitive& primitive : asset.meshes[std::size_t(asset.nodes[std::size_t(n)].mesh)].primitives) {
            if (primitive.triangles.empty()) continue;
            const Material& material = asset.materials[std::size_t(primitive.material)];
            for (const TextureUse* use : {&material.baseColorTexture, &material.metallicRoughnessTexture, &material.normalTexture})
                if (*use) textures.insert(use->texture);
        }
    }
    return {textures.begin(), textures.end()};
}

/// Each image once, in parallel; then their mips. What was encoded goes.
void decodeTextures(Asset& asset)
{
    const std::vector<int> textures = usedTextures(asset);
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
        asset.textures[std::size_t(texture)]->image = images[std::size_t(found - indices.begin())];
    }
    asset.images.clear();
    buildMipChains(asset.textures, asset.materials);
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
        const std::size_t instances = std::max<std::size_t>(asset.nodes[std::size_t(n)].instances.size(), 1);
        for (const Primitive& primitive : asset.meshes[std::size_t(asset.nodes[std::size_t(n)].mesh)].primitives) {
            triangles += instances * primitive.triangles.size();
            vertices += instances * primitive.positions.size();
        }
        if (std::max(triangles, vertices) > kMaxTriangles)
            throw InputError(asset.file, "the scene has more than " + std::to_string(kMaxTriangles) + " triangles or vertices");
    }
}

void checkHasArea(const Scene& scene, const std::string& file)
{
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

/// From `kept`, where the file stood the same then.
Scene poseUnlessKept(const Asset& asset, Pose pose, PosedFile* kept)
{
    if (!kept) return poseAsset(asset, pose);
    if (!kept->pose || !kept->pose->sameAs(pose)) {
        *kept = {};
        kept->scene = poseAsset(asset, pose);
        kept->pose = std::make_shared<const Pose>(std::move(pose));
    }
    return kept->scene;
}

/// Posed, with lights and a camera, places relative to `origin`.
Scene posed(const Asset& asset, const LoadOptions& options, const DVec3& origin, PosedFile* kept)
{
    const int animation = asset.animations.empty() ? -1 : options.animation;
    Scene scene = poseUnlessKept(asset, poseNodes(asset, animation, options.time, origin), kept);
    if (scene.triangleCount() == 0) throw InputError(asset.file, "the scene has no triangles");
    scene.origin = origin;
    if (scene.lights.empty()) addDefaultLight(scene);
    if (scene.cameras.empty()) addDefaultCamera(scene);
    return scene;
}

/// The camera that will look, else the first: an unknown one is refused where it is chosen.
const Camera& eyeOf(const Scene& scene, const LoadOptions& options)
{
    if (options.eye) return *options.eye;
    try {
        return findCamera(scene, options.camera);
    } catch (const InputError&) {
        return scene.cameras.front();
    }
}

/// The coarsest step of the file's own positions in the world, metres, and how far from its node's origin it occurs.
struct FloatStep {
    double step = 0.0, distance = 0.0;
};

/// By how much instances enlarge a mesh at most; their places are double.
double largestInstance(const Node& node)
{
    double largest = node.instances.empty() ? 1.0 : 0.0;
    for (const DMat4& instance : node.instances)
        for (int c = 0; c < 3; ++c) largest = std::max(largest, std::sqrt(glm::dot(DVec3(instance[c]), DVec3(instance[c]))));
    return largest;
}

FloatStep coarsestStep(const Asset& asset, const Pose& pose)
{
    FloatStep coarsest;
    for (const int n : asset.sceneNodes) {
        const Node& node = asset.nodes[std::size_t(n)];
        if (node.mesh < 0 || node.skin >= 0) continue;
        const DMat4& world = pose.worldFromNode[std::size_t(n)];
        const double scale =
            largestInstance(node) * std::sqrt(std::max({glm::dot(world[0], world[0]), glm::dot(world[1], world[1]), glm::dot(world[2], world[2])}));
        float largest = 0.0f;
        for (const Primitive& primitive : asset.meshes[std::size_t(node.mesh)].primitives)
            for (const Vec3& p : primitive.positions) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        const double step = scale * double(std::nextafter(largest, kInfinity) - largest);
        if (step > coarsest.step) coarsest = {step, scale * double(largest)};
    }
    return coarsest;
}

/// What moving the origin cannot bring back.
void noteLostDigits(const Asset& asset, const LoadOptions& options, Scene& scene)
{
    constexpr double kWorthSaying = 0x1p-16;  // of the camera's reach
    const std::optional<double> reach = reachOf(scene, eyeOf(scene, options));
    const int animation = asset.animations.empty() ? -1 : options.animation;
    const FloatStep lost = coarsestStep(asset, poseNodes(asset, animation, options.time));
    if (!reach || lost.step <= kWorthSaying * *reach) return;
    char text[200];
    std::snprintf(text, sizeof text, "positions in the file are float32, %.4g m from their node's origin in steps of %.2g m: what was finer is lost there",
                  lost.distance, lost.step);
    scene.notes.emplace_back(text);
}

std::string fileName(const Asset& asset)
{
    return std::filesystem::path(asset.file).filename().string();
}

/// Move, turn, scale: read from the right.
DMat4 worldFromFile(const Placement& placement)
{
    constexpr double kDegree = 0.017453292519943295;
    // A whole turn more is the same place, to the bit.
    const SinCos yaw = sinCos((placement.yawDegrees - 360.0 * std::floor(placement.yawDegrees / 360.0)) * kDegree);
    const double c = placement.scale * yaw.cos, s = placement.scale * yaw.sin;
    return DMat4(glm::dvec4(c, 0.0, -s, 0.0), glm::dvec4(0.0, placement.scale, 0.0, 0.0), glm::dvec4(s, 0.0, c, 0.0), glm::dvec4(placement.position, 1.0));
}

void noteInvisible(Scene& scene)
{
    std::size_t triangles = 0;
    for (const lrsm::Mesh& mesh : scene.meshes) triangles += isDrawnNowhere(scene, mesh) ? mesh.triangles.size() : 0;
    if (triangles > 0) scene.notes.push_back(countOf(triangles, "triangle") + " drawn nowhere, and no obstacle to cones: alpha is below its cutoff everywhere");
}

}  // namespace
}  // namespace gltf

GltfFile openGltf(const std::string& path)
{
    auto asset = std::make_shared<gltf::Asset>(gltf::readAsset(path));
    gltf::checkSize(*asset);
    gltf::decodeTextures(*asset);
    return asset;
}

Scene poseGltf(const gltf::Asset& asset, const LoadOptions& options, PosedFile* kept)
{
    gltf::checkOptions(asset, options);
    Scene scene = gltf::posed(asset, options, glm::dvec3(0.0), kept);
    const glm::dvec3 origin = chooseOrigin(scene, gltf::eyeOf(scene, options));
    if (origin != glm::dvec3(0.0)) {
        scene = gltf::posed(asset, options, origin, kept);
        gltf::noteLostDigits(asset, options, scene);
    }
    scene.name = gltf::fileName(asset);
    gltf::checkHasArea(scene, asset.file);
    gltf::noteInvisible(scene);
    return scene;
}

double lengthOfAnimation(const gltf::Asset& asset, int animation)
{
    double end = 0.0;
    if (animation >= 0 && std::size_t(animation) < asset.animations.size())
        for (const gltf::Channel& channel : asset.animations[std::size_t(animation)].channels) end = std::max(end, double(channel.times.back()));
    return end;
}

Scene loadGltf(const std::string& path, const LoadOptions& options)
{
    return poseGltf(*openGltf(path), options);
}

std::size_t addPlaced(Scene& scene, const gltf::Asset& asset, const Placement& placement, float time, PosedFile* kept)
{
    gltf::checkOptions(asset, {.time = time, .animation = placement.animation});
    const int animation = asset.animations.empty() ? -1 : placement.animation;
    Scene placed = gltf::poseUnlessKept(asset, gltf::poseNodes(asset, animation, time, scene.origin, gltf::worldFromFile(placement)), kept);
    if (placed.triangleCount() == 0) throw InputError(asset.file, "the scene has no triangles");
    placed.notes = asset.notes;  // without those of its lights
    gltf::noteInvisible(placed);
    if (!placed.lights.empty() || !placed.cameras.empty()) placed.notes.emplace_back("its lights and cameras are left out");

    const std::size_t firstMaterial = scene.materials.size(), firstTexture = scene.textures.size();
    for (Material& material : placed.materials)
        for (TextureUse* use : {&material.baseColorTexture, &material.metallicRoughnessTexture, &material.normalTexture})
            if (*use) use->texture += int(firstTexture);
    for (Mesh& mesh : placed.meshes) mesh.material += int(firstMaterial);
    const auto append = [](auto& to, auto& from) { to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end())); };
    append(scene.meshes, placed.meshes);
    append(scene.materials, placed.materials);
    append(scene.textures, placed.textures);
    scene.bounds.include(placed.bounds);
    for (const std::string& text : placed.notes) {
        const std::string note = "object " + gltf::fileName(asset) + ": " + text;
        if (std::find(scene.notes.begin(), scene.notes.end(), note) == scene.notes.end()) scene.notes.push_back(note);  // several of one file
    }
    return firstMaterial;
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
