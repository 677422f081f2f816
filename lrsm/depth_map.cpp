#include "lrsm/depth_map.h"

#include "core/base/memory.h"
#include "core/base/parallel.h"
#include "core/raster/draw_scene.h"

namespace lrsm {

LightProjection refine(const LightProjection& projection, int factor)
{
    LightProjection finer = projection;
    finer.resolution *= factor;
    return finer;
}

DepthMap renderDepthMap(const Scene& scene, const Light& light, const Requirements& needs, const LightProjection& projection)
{
    const int n = projection.resolution;
    requireMemory(DepthMap::predictBytes(n) + std::size_t(n) * std::size_t(n) * sizeof(Fragment), "shadow map of light \"" + light.name + "\"",
                  "lower shadow_resolution or rsm_resolution");
    const SceneFragments drawn = drawScene(scene, clipFromWorld(projection), needs, n, n);
    DepthMap map{projection, Image<float>(n, n, 1.0f), drawn.counts};
    constexpr std::size_t kChunk = 16384;
    parallelFor(map.depthLinear.texels.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Fragment& fragment = drawn.fragments.texels[i];
            if (fragment.triangle == kNoTriangle) continue;
            const Vec3 pWorld = positionOf(scene, hitOf(drawn.firstTriangle, fragment));
            map.depthLinear.texels[i] = glm::clamp(projectToLight(projection, pWorld).depth, 0.0f, 1.0f);
        }
    });
    return map;
}

}  // namespace lrsm
