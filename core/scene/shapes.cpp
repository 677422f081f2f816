#include "core/scene/shapes.h"

#include "core/base/elementary.h"

#include <map>
#include <utility>

namespace lrsm {
namespace {

std::uint32_t addVertex(Mesh& mesh, const Vec3& position, const Vec3& normal)
{
    mesh.positions.push_back(position);
    mesh.normals.push_back(normal);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

}  // namespace

void addQuad(Mesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    const Vec3 normal = glm::normalize(glm::cross(c - a, d - b));
    const std::uint32_t i = addVertex(mesh, a, normal);
    addVertex(mesh, b, normal);
    addVertex(mesh, c, normal);
    addVertex(mesh, d, normal);
    mesh.triangles.push_back({i, i + 1, i + 2});
    mesh.triangles.push_back({i, i + 2, i + 3});
}

void addBox(Mesh& mesh, const Vec3& min, const Vec3& max, bool inward)
{
    const auto corner = [&](int i) { return Vec3(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z); };
    static constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& f : kFaces) {
        if (inward)
            addQuad(mesh, corner(f[3]), corner(f[2]), corner(f[1]), corner(f[0]));
        else
            addQuad(mesh, corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3]));
    }
}

void addPrism(Mesh& mesh, std::span<const Vec2> outlineXz, float yMin, float yMax)
{
    const std::size_t n = outlineXz.size();
    const auto at = [&](std::size_t i, float y) { return Vec3(outlineXz[i % n].x, y, outlineXz[i % n].y); };
    for (std::size_t i = 0; i < n; ++i) addQuad(mesh, at(i, yMin), at(i + 1, yMin), at(i + 1, yMax), at(i, yMax));
    for (const auto& [y, up] : {std::pair{yMax, true}, std::pair{yMin, false}}) {
        const Vec3 normal(0.0f, up ? 1.0f : -1.0f, 0.0f);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (std::size_t i = 0; i < n; ++i) addVertex(mesh, at(i, y), normal);
        for (std::uint32_t i = 1; i + 1 < n; ++i) {
            if (up)
                mesh.triangles.push_back({first, first + i, first + i + 1});
            else
                mesh.triangles.push_back({first, first + i + 1, first + i});
        }
    }
}

void addColumn(Mesh& mesh, const Vec3& foot, float radius, float height, int sides)
{
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto n = static_cast<std::uint32_t>(sides);
    for (std::uint32_t i = 0; i < n; ++i) {
        // The unit circle by rational points would be uneven: deterministic sine and cosine.
        const Vec3 normal = [&] {
            const SinCos sc = sinCos(2.0 * 3.14159265358979323846 * double(i) / double(n));
            return Vec3(float(sc.cos), 0.0f, float(sc.sin));
        }();
        addVertex(mesh, foot + radius * normal, normal);
        addVertex(mesh, foot + radius * normal + Vec3(0.0f, height, 0.0f), normal);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t a = first + 2 * i, b = first + 2 * ((i + 1) % n);
        mesh.triangles.push_back({a, a + 1, b + 1});
        mesh.triangles.push_back({a, b + 1, b});
    }
}

void addSphere(Mesh& mesh, const Vec3& centre, float radius, int subdivisions, bool inward)
{
    std::vector<Vec3> directions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<std::array<std::uint32_t, 3>> faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < subdivisions; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> midpoints;
        const auto midpoint = [&](std::uint32_t a, std::uint32_t b) {
            const auto [it, isNew] = midpoints.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(directions.size()));
            if (isNew) directions.push_back(glm::normalize(directions[a] + directions[b]));
            return it->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (const auto& [a, b, c] : faces) {
            const std::uint32_t ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        faces = std::move(finer);
    }

    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& d : directions) addVertex(mesh, centre + radius * d, inward ? -d : d);
    for (const auto& [a, b, c] : faces) {
        if (inward)
            mesh.triangles.push_back({first + a, first + c, first + b});
        else
            mesh.triangles.push_back({first + a, first + b, first + c});
    }
}

Material diffuseMaterial(const std::string& name, const Vec3& albedo, bool doubleSided)
{
    Material material;
    material.name = name;
    material.baseColor = Vec4(albedo, 1.0f);
    material.metallic = 0.0f;
    material.roughness = 1.0f;
    material.doubleSided = doubleSided;
    return material;
}

Light spotLight(const Vec3& position, const Vec3& target, const Vec3& intensity, float innerConeAngleRadians, float outerConeAngleRadians)
{
    Light light;
    light.name = "spot";
    light.type = LightType::spot;
    light.position = position;
    light.direction = glm::normalize(target - position);
    light.up = basisFromNormal(light.direction)[1];
    light.intensity = intensity;
    light.innerConeAngle = innerConeAngleRadians;
    light.outerConeAngle = outerConeAngleRadians;
    return light;
}

Light directionalLight(const Vec3& directionWorld, const Vec3& irradiance)
{
    Light light;
    light.name = "sun";
    light.direction = glm::normalize(directionWorld);
    light.up = basisFromNormal(light.direction)[1];
    light.intensity = irradiance;
    return light;
}

Camera lookAt(const Vec3& eye, const Vec3& target, const Vec3& up, float verticalFovRadians)
{
    Camera camera;
    camera.name = "camera";
    camera.position = eye;
    camera.forward = glm::normalize(target - eye);
    const Vec3 right = glm::normalize(glm::cross(camera.forward, up));
    camera.up = glm::cross(right, camera.forward);
    camera.verticalFov = verticalFovRadians;
    return camera;
}

void updateBounds(Scene& scene)
{
    scene.bounds = {};
    for (const Mesh& mesh : scene.meshes)
        for (const auto& triangle : mesh.triangles)
            for (const std::uint32_t vertex : triangle) scene.bounds.include(mesh.positions[vertex]);
}

}  // namespace lrsm
