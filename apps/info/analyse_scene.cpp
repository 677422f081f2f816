#include "apps/info/analyse_scene.h"

#include "conetrace/frame/cones.h"
#include "conetrace/frame/gbuffer.h"
#include "conetrace/frame/schedule.h"
#include "core/base/elementary.h"
#include "core/base/float_state.h"
#include "core/scene/check_scene.h"
#include "core/settings/settings_table.h"
#include "lrsm/rsm.h"
#include "voxel/voxelize.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace lrsm {
namespace {

/// Metres across an LRSM texel of `lod` at a distance along the ray through its centre.
double texelEdge(const LightProjection& projection, int resolution, int x, int y, double metresBeyondNear)
{
    const auto n = static_cast<double>(resolution);
    if (projection.type == LightType::directional) return 2.0 * double(projection.halfWidth) / n;
    const double half = double(projection.halfWidth);
    const double px = (2.0 * (x + 0.5) / n - 1.0) * half, py = (2.0 * (y + 0.5) / n - 1.0) * half;
    const double axial = (double(projection.depthNear) + metresBeyondNear) / std::sqrt(1.0 + px * px + py * py);
    return 2.0 * axial * half / n;
}

/// What one layer holds at one texel, depths in metres.
struct LayerTexel {
    double alpha = 0.0, radiance = 0.0, mean = 0.0, variance = 0.0;
    Vec3 normal{0.0f};
};

LayerTexel layerTexel(const LrsmTexel& texel, const LayerRange& range, double depthRange)
{
    LayerTexel out;
    if (!(texel.depth[2] > 0.0f) || !(texel.normal[3] > 0.0f)) return out;
    const double scale = double(range.depthMax - range.depthMin) * depthRange, mean = double(texel.depth[0]) / double(texel.depth[2]);
    out.alpha = double(texel.depth[2]);
    out.radiance = double(texel.radiance[0]) + double(texel.radiance[1]) + double(texel.radiance[2]);
    out.mean = double(range.depthMin) * depthRange + mean * scale;
    out.variance = std::max(0.0, double(texel.depth[1]) / double(texel.depth[2]) - mean * mean) * scale * scale;
    out.normal = Vec3(texel.normal[0], texel.normal[1], texel.normal[2]) / texel.normal[3];
    return out;
}

/// How far `one` moves when its texel is read from the mixture of those layers for which `joined` is true; in [0, 1].
template <class Joined>
double moved(const std::vector<LayerTexel>& texel, const LayerTexel& one, double tapVariance, const Joined& joined)
{
    double alpha = 0.0, first = 0.0, second = 0.0;
    Vec3 normal(0.0f);
    for (std::size_t i = 0; i < texel.size(); ++i) {
        if (!(texel[i].alpha > 0.0) || !joined(i)) continue;
        alpha += texel[i].alpha;
        first += texel[i].alpha * texel[i].mean;
        second += texel[i].alpha * (texel[i].variance + texel[i].mean * texel[i].mean);
        normal += static_cast<float>(texel[i].alpha) * texel[i].normal;
    }
    const double mean = first / alpha, variance = std::max(0.0, second / alpha - mean * mean);
    const double sigma = std::sqrt(one.variance + tapVariance), merged = std::sqrt(variance + tapVariance);
    const double depth = std::hypot(one.mean - mean, sigma - merged) / sigma;
    return std::min(1.0, depth + double(glm::length(one.normal - normal / static_cast<float>(alpha))));
}

LightAnalysis analyseLight(const Light& light, const Rsm& rsm, const Lrsm& lrsm, double mapTap)
{
    LightAnalysis out;
    out.name = light.name;
    out.layers = lrsm.layers();
    std::set<float> depths, normals;
    for (const LayerRange& range : lrsm.ranges) {
        depths.insert(range.depthMin);
        normals.insert(range.nDotLMin);
    }
    out.depthSlices = static_cast<int>(depths.size());
    out.normalSlices = static_cast<int>(normals.size());

    const double range = double(rsm.projection.depthRange());
    std::vector<double> edges;
    const int n = rsm.texels.width;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const RsmTexel& texel = rsm.texels.at(x, y);
            if (!(texel.coverage > 0.0f)) continue;
            ++out.texels;
            if (texel.radiance != Vec3(0.0f)) edges.push_back(2.0 * texelEdge(rsm.projection, n, x, y, double(rsm.depthLinear.at(x, y)) * range));
        }
    out.litTexels = edges.size();
    if (edges.empty()) return out;
    const auto middle = edges.begin() + static_cast<std::ptrdiff_t>((edges.size() - 1) / 2);
    std::nth_element(edges.begin(), middle, edges.end());
    out.texelSize = *middle;
    const int level = static_cast<int>(std::floor(log2Exact(mapTap / out.texelSize) + 0.5));
    out.moved = movedByOneDepthLayer(lrsm, std::clamp(level, 0, lrsm.levels() - 1));
    return out;
}

/// Of the diffuse cones, in voxels.
double narrowestTap(const Settings& settings, int resolution)
{
    float finest = kInfinity;
    for (const ConeRing& ring : makeConeSet(settings.cones).rings)
        for (const MarchStep& step : makeSchedule(settings.cones, ring.tanHalf, 1.7320508f * static_cast<float>(resolution)).steps)
            finest = std::min(finest, step.tapWidth);
    return double(finest);
}

double coveredFraction(const GBuffer& gbuffer)
{
    const std::size_t pixels = gbuffer.depthLinear.texels.size();
    std::size_t covered = 0;
    for (std::size_t i = 0; i < pixels; ++i) covered += gbuffer.covered(i) ? 1 : 0;
    return static_cast<double>(covered) / static_cast<double>(pixels);
}

}  // namespace

double movedByOneDepthLayer(const Lrsm& lrsm, int level)
{
    const double range = double(lrsm.projection.depthRange());
    double all = 0.0, movedLight = 0.0;
    const int n = lrsm.resolutionAt(level);
    std::vector<LayerTexel> texel(static_cast<std::size_t>(lrsm.layers()));
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            for (int layer = 0; layer < lrsm.layers(); ++layer)
                texel[std::size_t(layer)] =
                    layerTexel(lrsm.level(layer, level)[std::size_t(y) * std::size_t(n) + std::size_t(x)], lrsm.ranges[std::size_t(layer)], range);
            for (std::size_t i = 0; i < texel.size(); ++i) {
                const LayerTexel& one = texel[i];
                if (!(one.radiance > 0.0)) continue;
                const double edge = texelEdge(lrsm.projection, n, x, y, one.mean), tapVariance = 0.25 * edge * edge;
                const LayerRange& bounds = lrsm.ranges[i];
                all += one.radiance;
                movedLight += one.radiance * moved(texel, one, tapVariance, [&](std::size_t j) { return lrsm.ranges[j].nDotLMin == bounds.nDotLMin; });
            }
        }
    return all > 0.0 ? movedLight / all : 0.0;
}

bool sameMaps(const Settings& a, const Settings& b)
{
    return a.surface == b.surface && a.voxel == b.voxel && a.rsm == b.rsm && a.layers == b.layers && a.force == b.force;
}

SceneAnalysis analyseScene(const Scene& scene, const Camera& camera, const Requirements& needs, const Settings& settings, int width, int height,
                           const SceneAnalysis* known)
{
    const FloatState state;
    checkScene(scene);
    validate(settings);
    const VoxelGrid grid = gridsOf(scene, settings.voxel, camera.position).front();
    const double voxelSize = double(grid.voxelSize);
    SceneAnalysis out = known ? *known : SceneAnalysis();
    out.needs = needs;
    out.finestTap = narrowestTap(settings, grid.resolution) * voxelSize;
    if (known) return out;
    for (const Light& light : scene.lights) {
        const Rsm rsm = renderRsm(scene, light, needs, settings.rsm, settings.surface.textureFilter);
        out.lights.push_back(analyseLight(light, rsm, buildLrsm(rsm, settings.layers), kMapTapVoxels * voxelSize));
    }
    out.coveredFraction = coveredFraction(renderGBuffer(scene, camera, needs, {width, height}));
    return out;
}

}  // namespace lrsm
