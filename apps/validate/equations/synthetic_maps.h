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

/// One texel of a map made by hand.
struct MapTexel {
    float depth = 0.5f;
    Vec3 radiance{1.0f};
    Vec3 normal{0.0f, 0.0f, 1.0f};
    float nDotL = 0.9f;
    float coverage = 1.0f;
};

/// The map of `projection` whose texels texel(x, y) gives, row by row; what has no coverage stays empty.
template <class Texel>
Rsm syntheticMap(const LightProjection& projection, Texel&& texel)
{
    Rsm rsm;
    rsm.projection = projection;
    rsm.texels = Image<RsmTexel>(projection.resolution, projection.resolution);
    rsm.depthLinear = Image<float>(projection.resolution, projection.resolution, 1.0f);
    for (int y = 0; y < projection.resolution; ++y)
        for (int x = 0; x < projection.resolution; ++x) {
            const MapTexel t = texel(x, y);
            if (!(t.coverage > 0.0f)) continue;
            rsm.texels.at(x, y) = {t.radiance, t.coverage, t.normal, t.nDotL};
            rsm.depthLinear.at(x, y) = t.depth;
        }
    return rsm;
}

/// Every texel the same.
inline Rsm flatMap(const LightProjection& projection, const MapTexel& texel)
{
    return syntheticMap(projection, [&](int, int) { return texel; });
}

/// A light at the origin that looks along -z, 2 m wide, depths over 1 m.
inline LightProjection plainProjection(int resolution)
{
    LightProjection p;
    p.resolution = resolution;
    return p;
}

/// Independent texels, `filled` of them drawn, depths in [nearest, farthest]; a tenth of the depths and cosines lie on multiples of 1/8, where layers meet.
inline Rsm syntheticRsm(int resolution, std::uint32_t stream, float filled = 0.8f, float nearest = 0.2f, float farthest = 0.9f)
{
    SearchRandom random(stream);
    return syntheticMap(plainProjection(resolution), [&](int, int) {
        MapTexel texel{.coverage = 0.0f};
        if (random.uniform(0.0f, 1.0f) >= filled) return texel;
        texel.coverage = 1.0f;
        const float r = random.uniform(0.0f, float(kSyntheticRadiance)), g = random.uniform(0.0f, 1.0f), b = random.uniform(0.0f, 0.01f);
        texel.radiance = Vec3(r, g, b);
        texel.normal = randomUnit(random);
        texel.nDotL = random.uniform(0.0f, 1.0f);
        texel.depth = random.uniform(nearest, farthest);
        if (random.word() % 10 == 0) texel.depth = std::clamp(std::floor(texel.depth * 8.0f + 0.5f) / 8.0f, nearest, farthest);
        if (random.word() % 10 == 0) texel.nDotL = std::floor(texel.nDotL * 8.0f + 0.5f) / 8.0f;
        return texel;
    });
}

inline LayerSettings layersOf(int depthLayers, int normalLayers, float overlap = 0.0f, Storage storage = Storage::float32)
{
    return {.depthLayers = depthLayers, .normalLayers = normalLayers, .overlap = overlap, .storage = storage};
}

/// One layer over the light's whole range.
inline LayerSettings oneLayer()
{
    LayerSettings layers = layersOf(1, 1);
    layers.fitRanges = false;
    return layers;
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
