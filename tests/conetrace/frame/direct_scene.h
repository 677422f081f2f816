#pragma once

#include "conetrace/frame/gbuffer.h"
#include "core/scene/light.h"
#include "core/scene/shapes.h"
#include "lrsm/depth_map.h"
#include "tests/conetrace/ray_oracle.h"

/// A small world for direct light and its shadows.
namespace lrsm {

inline const Requirements kDirectNeeds;

inline void addMesh(Scene& scene, Mesh mesh, const Vec3& albedo, bool doubleSided)
{
    mesh.material = int(scene.materials.size());
    scene.materials.push_back(diffuseMaterial("m", albedo, doubleSided));
    scene.meshes.push_back(std::move(mesh));
}

/// A floor, a slanted wall, a hovering square and a ball.
inline Scene directScene()
{
    Scene scene;
    Mesh floor, wall, square, ball;
    addQuad(floor, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4});
    addQuad(wall, {-4, 0, -3}, {4, 0, -3}, {4, 4, -4}, {-4, 4, -4});
    addQuad(square, {-2, 1.5f, 1}, {-0.5f, 1.5f, 1}, {-0.5f, 1.5f, -1}, {-2, 1.5f, -1});
    addSphere(ball, Vec3(1.5f, 0.8f, 0), 0.8f, 4);
    addMesh(scene, floor, Vec3(0.8f, 0.6f, 0.4f), false);
    addMesh(scene, wall, Vec3(0.5f), false);
    addMesh(scene, square, Vec3(0.3f, 0.9f, 0.1f), true);
    addMesh(scene, ball, Vec3(0.7f), false);
    updateBounds(scene);
    return scene;
}
inline Camera directCamera()
{
    return lookAt({0.5f, 4, 6}, {0, 0.7f, -0.5f}, {0, 1, 0}, 0.9f);
}
inline Light testLight(int kind)
{
    return kind == 0 ? directionalLight(glm::normalize(Vec3(0.35f, -1, -0.2f)), Vec3(3, 2, 1))
                     : spotLight({-1.5f, 5, 1.5f}, {0.2f, 0, -0.3f}, Vec3(40, 50, 60), 0.5f, 0.9f);
}

inline std::vector<Rsm> renderMaps(const Scene& scene, int resolution)
{
    std::vector<Rsm> maps;
    RsmSettings settings;
    settings.resolution = resolution;
    for (const Light& light : scene.lights) maps.push_back(renderRsm(scene, light, kDirectNeeds, settings));
    return maps;
}
inline std::vector<DepthMapView> depthsOf(const std::vector<Rsm>& maps)
{
    return {maps.begin(), maps.end()};
}

/// Is the light seen from p, by ray casting? Single-sided faces let light through their backs.
inline bool litByRay(const Scene& scene, const LightSample& sample, const Vec3& p, const Vec3& n)
{
    const glm::dvec3 origin = glm::dvec3(p) + glm::dvec3(n) * 1e-4;
    const oracle::RayHit hit = oracle::closestHit(scene, origin, glm::dvec3(sample.toLight), 0.0, false);
    return hit.mesh < 0 || hit.t > double(sample.distance) - 1e-3;
}

}  // namespace lrsm
