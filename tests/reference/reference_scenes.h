#pragma once

#include "core/scene/scene.h"

#include <initializer_list>

/// Scenes of a few rectangles for the reference's tests.
namespace lrsm::test {

/// Rectangle corner + s edgeU + t edgeV; its front is on the side of cross(edgeU, edgeV).
inline Mesh rectangle(const Vec3& corner, const Vec3& edgeU, const Vec3& edgeV, int material = 0)
{
    Mesh mesh;
    mesh.material = material;
    mesh.positions = {corner, corner + edgeU, corner + edgeU + edgeV, corner + edgeV};
    mesh.normals.assign(4, glm::normalize(glm::cross(edgeU, edgeV)));
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

inline Material diffuse(const Vec3& albedo, bool doubleSided = true)
{
    Material material;
    material.baseColor = Vec4(albedo, 1.0f);
    material.metallic = 0.0f;
    material.doubleSided = doubleSided;
    return material;
}

inline Light sun(const Vec3& direction, float irradiance)
{
    Light light;
    light.direction = glm::normalize(direction);
    light.intensity = Vec3(irradiance);
    return light;
}

inline Scene makeScene(std::initializer_list<Mesh> meshes, std::initializer_list<Material> materials, std::initializer_list<Light> lights)
{
    Scene scene;
    scene.meshes = meshes;
    scene.materials = materials;
    scene.lights = lights;
    for (const Mesh& mesh : scene.meshes)
        for (const Vec3& p : mesh.positions) scene.bounds.include(p);
    return scene;
}

/// Room [-1, 1]^3, open towards +z when asked; faces look inwards.
inline std::vector<Mesh> boxRoom(bool open)
{
    std::vector<Mesh> walls = {
        rectangle({-1, -1, -1}, {0, 0, 2}, {2, 0, 0}),  // floor, up
        rectangle({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}),   // ceiling, down
        rectangle({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}),  // back, +z
        rectangle({-1, -1, -1}, {0, 2, 0}, {0, 0, 2}),  // left, +x
        rectangle({1, -1, -1}, {0, 0, 2}, {0, 2, 0}),   // right, -x
    };
    if (!open) walls.push_back(rectangle({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}));  // front, -z
    return walls;
}

/// Looks at `target` from `eye`; a single pixel of a narrow field of view is a probe of one point.
inline Camera lookAt(const Vec3& eye, const Vec3& target, float verticalFov = 0.7f)
{
    Camera camera;
    camera.position = eye;
    camera.forward = glm::normalize(target - eye);
    const Vec3 reference = std::abs(camera.forward.y) > 0.9f ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
    camera.up = glm::normalize(reference - glm::dot(reference, camera.forward) * camera.forward);
    camera.verticalFov = verticalFov;
    camera.nearPlane = 1e-3f;
    return camera;
}

}  // namespace lrsm::test
