#pragma once

#include "conetrace/proxies/gather.h"
#include "core/scene/shapes.h"

#include <random>

namespace lrsm::test {

/// Proxies of a test, all of one radiance, front faces shining.
inline ProxyLight shining(const PointProxies& proxies, const Vec3& radiance)
{
    ProxyLight light;
    light.radiance.assign(proxies.size(), radiance);
    light.normals = proxies.normals;
    light.half = false;
    return light;
}

/// A scene of quads, a mesh each, in a grey material.
inline Scene quadScene(const std::vector<std::array<Vec3, 4>>& quads, bool doubleSided = false)
{
    Scene scene;
    scene.materials = {diffuseMaterial("grey", Vec3(0.5f), doubleSided)};
    for (const auto& q : quads) {
        scene.meshes.emplace_back();
        addQuad(scene.meshes.back(), q[0], q[1], q[2], q[3]);
    }
    scene.cameras = {lookAt({0, 3, 3}, {0, 0, 0}, {0, 1, 0}, 0.8f)};
    updateBounds(scene);
    return scene;
}

inline Vec3 randomUnit(std::mt19937& random)
{
    std::normal_distribution<float> normal;
    return glm::normalize(Vec3(normal(random), normal(random), normal(random)));
}

}  // namespace lrsm::test
