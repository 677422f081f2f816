#pragma once

#include "conetrace/frame/gather.h"
#include "conetrace/frame/shadow_map.h"
#include "core/base/parallel.h"
#include "core/scene/brdf.h"
#include "core/scene/light.h"
#include "voxel/surface/voxel_surface.h"

#include <vector>

/// Direct light on the surfaces of voxels.
namespace lrsm {

/// Light of one occupied voxel, lights added.
struct VoxelLight {
    Vec3 radiance{0.0f};
    Vec3 normal{0.0f};  ///< times luminance
    float luminance = 0.0f;

    void add(const Vec3& lightRadiance, const Vec3& lightNormal)
    {
        const float weight = glm::dot(lightRadiance, Vec3(0.2126f, 0.7152f, 0.0722f));
        radiance += lightRadiance;
        normal += weight * lightNormal;
        luminance += weight;
    }
};

/// Adds albedo L_d <n.l> V / pi of each surfel at its own place to its voxel, lights in their order. Where its normals cancel <n.l> is kMeanCosine and the
/// normal 0. V = visible(light, receiver, LightSample); the receiver faces the light.
template <class Visible>
void lightSurfels(const GatherInput& input, const VoxelSurface& surface, float preExposure, std::vector<VoxelLight>& lights, const Visible& visible)
{
    constexpr std::size_t kBricksAtOnce = 8192;
    const BitGrid& bits = input.opacity.base;
    const std::vector<LightSampler> samplers(input.scene.lights.begin(), input.scene.lights.end());
    parallelFor(bits.bricks.size(), kBricksAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t brick = begin; brick < end; ++brick)
            forEachBit(bits.bricks[brick], [&](int bit) {
                const std::size_t voxel = surface.index.at(bits, brick, bit);
                const VoxelSurfel& surfel = surface.surfels[voxel];
                const Vec3 p = bits.grid.origin + (Vec3(voxelOf(bits, brick, bit)) + surfel.position) * bits.grid.voxelSize;
                const bool cancels = normalCancels(surfel);
                for (std::size_t k = 0; k < samplers.size(); ++k) {
                    const LightSample light = samplers[k](p);
                    const Vec3 facing = cancels ? light.toLight : glm::normalize(surfel.normal);
                    const float nDotL = cancels ? kMeanCosine : glm::dot(facing, light.toLight);
                    if (light.irradiance == Vec3(0.0f) || !(nDotL > 0.0f)) continue;
                    const float seen = visible(k, ShadowReceiver{p, facing}, light);
                    const Vec3 radiance = reflectedRadiance(surfel.albedo, light.irradiance, nDotL) * (seen * preExposure);
                    lights[voxel].add(radiance, cancels ? Vec3(0.0f) : surfel.normal);
                }
            });
    });
}

}  // namespace lrsm
