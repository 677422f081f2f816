#pragma once

#include "apps/validate/equations/worst_case.h"
#include "lrsm/layers.h"

/// Reflective shadow maps made of numbers, for checks that need no scene.
namespace lrsm {

/// Radiances of syntheticRsm are below this.
inline constexpr double kSyntheticRadiance = 4.0;

inline Vec3 randomUnit(SearchRandom& random)
{
    for (;;) {
        const float x = random.uniform(-1.0f, 1.0f), y = random.uniform(-1.0f, 1.0f), z = random.uniform(-1.0f, 1.0f);
        const float length = glm::length(Vec3(x, y, z));
        if (length > 0.1f && length <= 1.0f) return Vec3(x, y, z) / length;
    }
}

/// Independent texels, `filled` of them drawn, depths in [nearest, farthest]; a tenth of the depths and cosines lie on multiples of 1/8, where layers meet.
inline Rsm syntheticRsm(int resolution, std::uint32_t stream, float filled = 0.8f, float nearest = 0.2f, float farthest = 0.9f)
{
    SearchRandom random(stream);
    Rsm rsm;
    rsm.projection.resolution = resolution;
    rsm.texels = Image<RsmTexel>(resolution, resolution);
    rsm.depthLinear = Image<float>(resolution, resolution, 1.0f);
    for (std::size_t i = 0; i < rsm.texels.texels.size(); ++i) {
        if (random.uniform(0.0f, 1.0f) >= filled) continue;
        RsmTexel& texel = rsm.texels.texels[i];
        texel.coverage = 1.0f;
        const float r = random.uniform(0.0f, float(kSyntheticRadiance)), g = random.uniform(0.0f, 1.0f), b = random.uniform(0.0f, 0.01f);
        texel.radiance = Vec3(r, g, b);
        texel.normal = randomUnit(random);
        texel.nDotL = random.uniform(0.0f, 1.0f);
        float depth = random.uniform(nearest, farthest);
        if (random.word() % 10 == 0) depth = std::clamp(std::floor(depth * 8.0f + 0.5f) / 8.0f, nearest, farthest);
        if (random.word() % 10 == 0) texel.nDotL = std::floor(texel.nDotL * 8.0f + 0.5f) / 8.0f;
        rsm.depthLinear.texels[i] = depth;
    }
    return rsm;
}

/// A sun straight above a cube of 4 m about the origin; the map is a little wider than the cube.
inline LightProjection sunOverCube(int resolution)
{
    LightProjection p;
    p.position = Vec3(0.0f, 2.0f, 0.0f);
    p.right = Vec3(1.0f, 0.0f, 0.0f);
    p.up = Vec3(0.0f, 0.0f, -1.0f);
    p.forward = Vec3(0.0f, -1.0f, 0.0f);
    p.halfWidth = 2.1f;
    p.depthFar = 4.0f;
    p.resolution = resolution;
    return p;
}

/// A spot light above the same cube's corner, looking at its middle; field of view 80 degrees.
inline LightProjection spotOverCube(int resolution)
{
    LightProjection p;
    p.type = LightType::spot;
    p.position = Vec3(1.5f, 4.0f, 1.0f);
    p.forward = glm::normalize(-p.position);
    p.right = glm::normalize(glm::cross(p.forward, Vec3(0.0f, 0.0f, 1.0f)));
    p.up = glm::cross(p.right, p.forward);
    p.halfWidth = 0.8390996f;
    p.depthNear = 1.5f;
    p.depthFar = 8.0f;
    p.resolution = resolution;
    return p;
}

}  // namespace lrsm
