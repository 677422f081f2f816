#include "apps/capture/scene_buffers.h"

#include "apps/capture/fill.h"
#include "apps/capture/tolerances.h"
#include "core/scene/brdf.h"

namespace lrsm {

namespace {

enum Stream : std::uint32_t { hasUv0 = 1, hasUv1 = 2, hasTangents = 4, hasColors = 8 };

constexpr std::size_t kMeshColumns = 6;

std::uint32_t streamsOf(const Mesh& mesh)
{
    return (mesh.uv0.empty() ? 0u : hasUv0) | (mesh.uv1.empty() ? 0u : hasUv1) | (mesh.tangents.empty() ? 0u : hasTangents) |
           (mesh.colors.empty() ? 0u : hasColors);
}

bool textured(const Material& m)
{
    return m.baseColorTexture || m.metallicRoughnessTexture || m.normalTexture;
}

/// One stream of all meshes, 0 where a mesh has none.
template <class T>
std::vector<T> joined(const Scene& scene, std::vector<T> Mesh::*stream)
{
    std::vector<T> all;
    for (const Mesh& mesh : scene.meshes) {
        const std::size_t end = all.size() + mesh.positions.size();
        all.insert(all.end(), (mesh.*stream).begin(), (mesh.*stream).end());
        all.resize(end, T(0.0f));
    }
    return all;
}

std::vector<float> materialRows(const Scene& scene)
{
    std::vector<float> rows;
    for (const Material& m : scene.materials) {
        const Vec3 color = glm::clamp(Vec3(m.baseColor), Vec3(0.0f), Vec3(1.0f)), albedo = color * (1.0f - m.metallic);
        const Vec3 f0 = hasSpecularPart(m) ? Vec3(0.04f) + (color - Vec3(0.04f)) * m.metallic : Vec3(0.0f);
        for (const float value : {albedo.x, albedo.y, albedo.z, f0.x, f0.y, f0.z, m.roughness, m.doubleSided ? 1.0f : 0.0f, textured(m) ? 1.0f : 0.0f})
            rows.push_back(value);
    }
    return rows;
}

}  // namespace

void describeScene(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    std::size_t vertices = 0, triangles = 0;
    std::uint32_t streams = 0;
    for (const Mesh& mesh : frame.scene.meshes) {
        vertices += mesh.positions.size();
        triangles += mesh.triangles.size();
        streams |= streamsOf(mesh);
    }
    const auto list = [&](const std::string& name, Dtype dtype, std::size_t count, const Catalogue::Names& components, const std::string& item,
                          const Catalogue::Text& text) { out.add("scene." + name, dtype, {count}, {item}, components, text, tolerances::kGiven); };
    list("positions", Dtype::f4, vertices, {"x", "y", "z"}, "vertex", {"of all meshes, one after the other", kWorldSpace, "m"});
    list("normals", Dtype::f4, vertices, {"x", "y", "z"}, "vertex", {"unit", kWorldSpace, ""});
    if (streams & hasUv0) list("uv0", Dtype::f4, vertices, {"u", "v"}, "vertex", {"first texture coordinates; 0 for meshes without", "texture", ""});
    if (streams & hasUv1) list("uv1", Dtype::f4, vertices, {"u", "v"}, "vertex", {"second texture coordinates; 0 for meshes without", "texture", ""});
    if (streams & hasTangents)
        list("tangents", Dtype::f4, vertices, {"x", "y", "z", "sign"}, "vertex",
             {"bitangent = sign cross(normal, tangent); 0 for meshes without", kWorldSpace, ""});
    if (streams & hasColors)
        list("colors", Dtype::f4, vertices, {"r", "g", "b", "a"}, "vertex", {"multiply the base colour; 0 for meshes without", "linear", ""});
    list("triangles", Dtype::u4, triangles, {"a", "b", "c"}, "triangle", {"vertices, counter-clockwise seen from the front; submitted in this order", "", ""});
    list("triangle_mesh", Dtype::u4, triangles, {}, "triangle", {"mesh; object id minus 1", "", ""});
    list("meshes", Dtype::u4, frame.scene.meshes.size(), {"material", "first_vertex", "vertices", "first_triangle", "triangles", "streams"}, "mesh",
         {"streams: 1 uv0, 2 uv1, 4 tangents, 8 colors", "", ""});
    list("materials", Dtype::f4, frame.scene.materials.size(),
         {"albedo.r", "albedo.g", "albedo.b", "f0.r", "f0.g", "f0.b", "roughness", "double_sided", "textured"}, "material",
         {"as without textures and vertex colours; f0 is 0 where there is no specular part", "linear", ""});
}

bool withoutTextures(const Scene& scene)
{
    for (const Mesh& mesh : scene.meshes)
        if (textured(scene.materials[static_cast<std::size_t>(mesh.material)])) return false;
    return true;
}

void toBuffers(const Scene& scene, std::vector<Buffer>& buffers)
{
    std::vector<std::uint32_t> meshes, meshOfTriangle, triangles;
    std::uint32_t firstVertex = 0, firstTriangle = 0;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        const Mesh& mesh = scene.meshes[m];
        const auto vertices = static_cast<std::uint32_t>(mesh.positions.size()), count = static_cast<std::uint32_t>(mesh.triangles.size());
        for (const std::uint32_t value : {static_cast<std::uint32_t>(mesh.material), firstVertex, vertices, firstTriangle, count, streamsOf(mesh)})
            meshes.push_back(value);
        for (const auto& triangle : mesh.triangles) {
            for (const std::uint32_t corner : triangle) triangles.push_back(firstVertex + corner);
            meshOfTriangle.push_back(static_cast<std::uint32_t>(m));
        }
        firstVertex += vertices;
        firstTriangle += count;
    }
    copyTo(buffers, "scene.positions", joined(scene, &Mesh::positions));
    copyTo(buffers, "scene.normals", joined(scene, &Mesh::normals));
    copyTo(buffers, "scene.uv0", joined(scene, &Mesh::uv0));
    copyTo(buffers, "scene.uv1", joined(scene, &Mesh::uv1));
    copyTo(buffers, "scene.tangents", joined(scene, &Mesh::tangents));
    copyTo(buffers, "scene.colors", joined(scene, &Mesh::colors));
    copyTo(buffers, "scene.triangles", triangles);
    copyTo(buffers, "scene.triangle_mesh", meshOfTriangle);
    copyTo(buffers, "scene.meshes", meshes);
    copyTo(buffers, "scene.materials", materialRows(scene));
}

Scene sceneFromCapture(const Capture& capture)
{
    Scene scene;
    scene.name = capture.sceneName;
    scene.bounds = capture.sceneBounds;
    scene.reach = capture.sceneReach;
    scene.origin = capture.origin;
    scene.materials = capture.materials;
    scene.cameras = {capture.camera};
    for (const CapturedLight& light : capture.lights) scene.lights.push_back(light.light);
    if (!capture.sceneComplete) return scene;

    const std::size_t meshCount = capture.at("scene.meshes").shape.at(0), vertexCount = capture.at("scene.positions").shape.at(0);
    const auto meshes = valuesOf<std::uint32_t>(capture, "scene.meshes", Dtype::u4, meshCount * kMeshColumns);
    const auto triangles = copyFrom<std::array<std::uint32_t, 3>>(capture, "scene.triangles", Dtype::u4, capture.at("scene.triangles").shape.at(0));
    const auto stream = [&]<class T>(const std::string& name, std::vector<T> Mesh::*to, bool present, Mesh& mesh, std::size_t first, std::size_t count) {
        if (!present) return;
        const auto all = valuesOf<std::byte>(capture, name, Dtype::f4, vertexCount * sizeof(T) / sizeof(float));
        (mesh.*to).resize(count);
        if (count) std::memcpy((mesh.*to).data(), all.data() + first * sizeof(T), count * sizeof(T));
    };
    for (std::size_t m = 0; m < meshCount; ++m) {
        const auto row = meshes.subspan(m * kMeshColumns, kMeshColumns);
        const std::size_t first = row[1], count = row[2], firstTriangle = row[3], triangleCount = row[4];
        if (first + count > vertexCount || firstTriangle + triangleCount > triangles.size() || row[0] >= scene.materials.size())
            throw InputError("scene.meshes", "mesh " + std::to_string(m) + " points outside the scene");
        Mesh mesh;
        mesh.material = static_cast<int>(row[0]);
        stream("scene.positions", &Mesh::positions, true, mesh, first, count);
        stream("scene.normals", &Mesh::normals, true, mesh, first, count);
        stream("scene.uv0", &Mesh::uv0, row[5] & hasUv0, mesh, first, count);
        stream("scene.uv1", &Mesh::uv1, row[5] & hasUv1, mesh, first, count);
        stream("scene.tangents", &Mesh::tangents, row[5] & hasTangents, mesh, first, count);
        stream("scene.colors", &Mesh::colors, row[5] & hasColors, mesh, first, count);
        for (std::size_t t = firstTriangle; t < firstTriangle + triangleCount; ++t) {
            std::array<std::uint32_t, 3> corners = triangles[t];
            for (std::uint32_t& corner : corners) {
                if (corner < first || corner >= first + count)
                    throw InputError("scene.triangles", "triangle " + std::to_string(t) + " points outside its mesh");
                corner -= static_cast<std::uint32_t>(first);
            }
            mesh.triangles.push_back(corners);
        }
        scene.meshes.push_back(std::move(mesh));
    }
    return scene;
}

}  // namespace lrsm
