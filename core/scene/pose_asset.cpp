#include "core/scene/pose_asset.h"

#include "core/base/errors.h"
#include "core/scene/light.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace lrsm::gltf {
namespace {

using DMat3 = glm::dmat3;

/// A primitive's vertices on their way to world space.
struct Vertices {
    std::vector<DVec3> positions, normals, tangents;
};

std::vector<DVec3> widen(const std::vector<Vec3>& values)
{
    return {values.begin(), values.end()};
}

Vertices morphed(const Primitive& primitive, const std::vector<float>& weights)
{
    Vertices vertices{widen(primitive.positions), widen(primitive.normals), {}};
    for (const Vec4& tangent : primitive.tangents) vertices.tangents.emplace_back(tangent);
    const auto add = [](std::vector<DVec3>& stream, const std::vector<Vec3>& offsets, double weight) {
        for (std::size_t i = 0; i < stream.size() && i < offsets.size(); ++i) stream[i] += weight * DVec3(offsets[i]);
    };
    for (std::size_t t = 0; t < primitive.targets.size() && t < weights.size(); ++t) {
        if (weights[t] == 0.0f) continue;
        add(vertices.positions, primitive.targets[t].positions, double(weights[t]));
        add(vertices.normals, primitive.targets[t].normals, double(weights[t]));
    }
    return vertices;
}

/// The matrix that carries normals, up to a positive factor: the cofactors, which are det * inverse transpose and exist for a
/// flattening transform too, times the determinant's sign.
DMat3 normalMatrix(const DMat4& m)
{
    const DVec3 a(m[0]), b(m[1]), c(m[2]);
    const DMat3 cofactors(glm::cross(b, c), glm::cross(c, a), glm::cross(a, b));
    return glm::dot(a, glm::cross(b, c)) < 0.0 ? DMat3(-cofactors[0], -cofactors[1], -cofactors[2]) : cofactors;
}

bool isMirrored(const DMat4& m)
{
    return glm::dot(DVec3(m[0]), glm::cross(DVec3(m[1]), DVec3(m[2]))) < 0.0;
}

void transformVertex(Vertices& vertices, std::size_t i, const DMat4& world, const DMat3& normalWorld)
{
    vertices.positions[i] = DVec3(world * glm::dvec4(vertices.positions[i], 1.0));
    if (!vertices.normals.empty()) vertices.normals[i] = normalWorld * vertices.normals[i];
    if (!vertices.tangents.empty()) vertices.tangents[i] = DMat3(world) * vertices.tangents[i];
}

void transformAll(Vertices& vertices, const DMat4& world)
{
    const DMat3 normalWorld = normalMatrix(world);
    for (std::size_t i = 0; i < vertices.positions.size(); ++i) transformVertex(vertices, i, world, normalWorld);
}

/// Linear blend skinning: each vertex by the weighted sum of its joints' matrices, weights brought to a sum of 1.
void skinAll(Vertices& vertices, const Primitive& primitive, const std::vector<DMat4>& worldFromBind, const DMat4& fallback)
{
    for (std::size_t i = 0; i < vertices.positions.size(); ++i) {
        DMat4 blended(0.0);
        double sum = 0.0;
        for (const Influences& set : primitive.influences) {
            for (int k = 0; k < 4; ++k) {
                const double weight = double(set.weights[i][k]);
                if (weight == 0.0) continue;
                blended += worldFromBind[set.joints[i][std::size_t(k)]] * weight;
                sum += weight;
            }
        }
        const DMat4 world = sum > 0.0 ? blended / sum : fallback;
        transformVertex(vertices, i, world, normalMatrix(world));
    }
}

/// Unit v; 0 where v has no direction.
DVec3 unitOrZero(const DVec3& v)
{
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (!(largest > 0.0) || !std::isfinite(largest)) return DVec3(0.0);
    const DVec3 scaled = v / largest;
    return scaled / std::sqrt(glm::dot(scaled, scaled));
}

DVec3 areaNormal(const std::vector<DVec3>& p, const std::array<std::uint32_t, 3>& t)
{
    return glm::cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]);
}

/// Unit normals; a vertex whose own has no length takes its triangles' area-weighted mean.
void normalizeNormals(Vertices& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles)
{
    std::vector<bool> missing(vertices.normals.size(), false);
    bool any = false;
    for (std::size_t i = 0; i < vertices.normals.size(); ++i) {
        vertices.normals[i] = unitOrZero(vertices.normals[i]);
        missing[i] = vertices.normals[i] == DVec3(0.0);
        any |= missing[i];
    }
    if (!any) return;
    for (const auto& triangle : triangles)
        for (const std::uint32_t v : triangle)
            if (missing[v]) vertices.normals[v] += areaNormal(vertices.positions, triangle);
    for (std::size_t i = 0; i < missing.size(); ++i) {
        if (!missing[i]) continue;
        vertices.normals[i] = unitOrZero(vertices.normals[i]);
        if (vertices.normals[i] == DVec3(0.0)) vertices.normals[i] = DVec3(0.0, 1.0, 0.0);
    }
}

template <class T>
std::vector<T> gathered(const std::vector<T>& stream, const std::vector<std::array<std::uint32_t, 3>>& triangles)
{
    std::vector<T> result;
    if (stream.empty()) return result;
    result.reserve(3 * triangles.size());
    for (const auto& triangle : triangles)
        for (const std::uint32_t v : triangle) result.push_back(stream[v]);
    return result;
}

/// A primitive without normals: three own vertices a triangle, with its plane's normal (glTF 2.0, section 3.7.2.1).
void splitFlat(lrsm::Mesh& mesh, Vertices& vertices)
{
    vertices.positions = gathered(vertices.positions, mesh.triangles);
    mesh.uv0 = gathered(mesh.uv0, mesh.triangles);
    mesh.uv1 = gathered(mesh.uv1, mesh.triangles);
    mesh.colors = gathered(mesh.colors, mesh.triangles);
    vertices.normals.assign(vertices.positions.size(), DVec3(0.0));
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto first = std::uint32_t(3 * t);
        mesh.triangles[t] = {first, first + 1, first + 2};
    }
}

void storeTangents(lrsm::Mesh& mesh, const Vertices& vertices, const std::vector<Vec4>& source, bool mirrored)
{
    for (std::size_t i = 0; i < vertices.tangents.size(); ++i) {
        // A mirroring node turns the handedness of the tangent frame round with everything else.
        const float handedness = (source[i].w < 0.0f) != mirrored ? -1.0f : 1.0f;
        const DVec3 n = vertices.normals[i];
        DVec3 tangent = unitOrZero(vertices.tangents[i]);
        if (tangent == DVec3(0.0)) tangent = DVec3(basisFromNormal(Vec3(n))[0]);
        mesh.tangents.emplace_back(Vec3(tangent), handedness);
    }
}

struct SkinMatrices {
    const Skin* skin = nullptr;
    std::vector<DMat4> worldFromBind;
};

lrsm::Mesh worldMesh(const Primitive& primitive, const Mesh& source, const Node& node, const DMat4& world, const std::vector<float>& weights,
                     const SkinMatrices& skinning)
{
    lrsm::Mesh mesh;
    mesh.name = source.name;
    mesh.material = primitive.material;
    mesh.uv0 = primitive.uv0;
    mesh.uv1 = primitive.uv1;
    mesh.colors = primitive.colors;
    mesh.triangles = primitive.triangles;

    Vertices vertices = morphed(primitive, weights);
    const bool skinned = skinning.skin && !primitive.influences.empty();
    if (skinned)
        skinAll(vertices, primitive, skinning.worldFromBind, world);
    else
        transformAll(vertices, world);
    const bool mirrored = !skinned && isMirrored(world);
    if (mirrored)
        for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);

    if (vertices.normals.empty()) splitFlat(mesh, vertices);
    normalizeNormals(vertices, mesh.triangles);
    storeTangents(mesh, vertices, primitive.tangents, mirrored);
    for (const DVec3& normal : vertices.normals) mesh.normals.emplace_back(normal);
    for (const DVec3& position : vertices.positions) {
        mesh.positions.emplace_back(position);
        if (!isFinite(mesh.positions.back())) throw InputError("node \"" + node.name + "\"", "its world positions are not finite");
    }
    return mesh;
}

/// What lights and cameras take from their node: position, and unit axes along its -z and y.
struct Placement {
    Vec3 position, forward, up;
};

///
/// Of sizes lights and cameras take nothing (KHR_lights_punctual): where a scale of 0 leaves no axes, those of `turned` hold.
Placement placementOf(const Node& node, const DMat4& world, const DMat3& turned, std::vector<std::string>& notes)
{
    const auto axes = [](const DVec3& z, const DVec3& y) {
        const DVec3 forward = unitOrZero(-z), upright = unitOrZero(y);
        return std::pair(forward, unitOrZero(upright - forward * glm::dot(upright, forward)));
    };
    auto [forward, up] = axes(DVec3(world[2]), DVec3(world[1]));
    if (forward == DVec3(0.0) || up == DVec3(0.0)) {
        std::tie(forward, up) = axes(turned[2], turned[1]);
        notes.push_back("node \"" + node.name + "\": a scale of 0 leaves its light or camera no direction: that of the rotations is taken");
    }
    const Placement placement{Vec3(DVec3(world[3])), Vec3(forward), Vec3(up)};
    if (forward == DVec3(0.0) || up == DVec3(0.0) || !isFinite(placement.position))
        throw InputError("node \"" + node.name + "\"", "its transform gives its light or camera no direction");
    return placement;
}

void addLight(const LocalLight& local, const Node& node, const DMat4& world, const DMat3& turned, Scene& scene)
{
    if (local.point) {
        const Vec3 position{DVec3(world[3])};
        if (!isFinite(position)) throw InputError("node \"" + node.name + "\"", "its light's position is not finite");
        for (Light& face : splitPointLight(position, local.light.intensity, local.light.range, local.light.name)) scene.lights.push_back(std::move(face));
        scene.notes.push_back("point light \"" + local.light.name + "\" split into six faces of a cube");
        return;
    }
    const Placement placement = placementOf(node, world, turned, scene.notes);
    Light light = local.light;
    light.position = placement.position;
    light.direction = placement.forward;
    light.up = placement.up;
    scene.lights.push_back(std::move(light));
}

void addCamera(const Camera& local, const Node& node, const DMat4& world, const DMat3& turned, Scene& scene)
{
    const Placement placement = placementOf(node, world, turned, scene.notes);
    Camera camera = local;
    if (camera.name.empty()) camera.name = node.name;
    camera.position = placement.position;
    camera.forward = placement.forward;
    camera.up = placement.up;
    scene.cameras.push_back(std::move(camera));
}

}  // namespace

Scene poseAsset(const Asset& asset, const Pose& pose)
{
    Scene scene;
    scene.materials = asset.materials;
    scene.textures.assign(asset.textures.begin(), asset.textures.end());
    scene.notes = asset.notes;
    for (const int n : asset.sceneNodes) {
        const Node& node = asset.nodes[std::size_t(n)];
        const DMat4& world = pose.worldFromNode[std::size_t(n)];
        if (node.mesh >= 0) {
            SkinMatrices skinning;
            if (node.skin >= 0) {
                skinning.skin = &asset.skins[std::size_t(node.skin)];
                for (std::size_t j = 0; j < skinning.skin->joints.size(); ++j)
                    skinning.worldFromBind.push_back(pose.worldFromNode[std::size_t(skinning.skin->joints[j])] * skinning.skin->inverseBind[j]);
            }
            const Mesh& mesh = asset.meshes[std::size_t(node.mesh)];
            for (const Primitive& primitive : mesh.primitives)
                for (std::size_t i = 0; i < std::max<std::size_t>(node.instances.size(), 1) && !primitive.triangles.empty(); ++i)
                    scene.meshes.push_back(
                        worldMesh(primitive, mesh, node, node.instances.empty() ? world : world * node.instances[i], pose.weights[std::size_t(n)], skinning));
        }
        if (node.light >= 0) addLight(asset.lights[std::size_t(node.light)], node, world, pose.turned[std::size_t(n)], scene);
        if (node.camera >= 0) addCamera(asset.cameras[std::size_t(node.camera)], node, world, pose.turned[std::size_t(n)], scene);
    }
    for (const lrsm::Mesh& mesh : scene.meshes)
        for (const auto& triangle : mesh.triangles)
            for (const std::uint32_t v : triangle) scene.bounds.include(mesh.positions[v]);
    return scene;
}

}  // namespace lrsm::gltf
