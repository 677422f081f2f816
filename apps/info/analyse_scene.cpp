#include "apps/info/advice.h"
#include "conetrace/frame/cones.h"
#include "conetrace/frame/gbuffer.h"
#include "conetrace/frame/schedule.h"
#include "core/base/elementary.h"
#include "core/base/float_state.h"
#include "core/scene/check_scene.h"
#include "core/settings/settings_table.h"
#include "lrsm/rsm.h"
#include "voxel/bit_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

namespace lrsm {
namespace {

constexpr double kPercentiles[3] = {0.05, 0.5, 0.95};

struct Weighted {
    double value = 0.0, weight = 1.0;
};

/// The value below which `share` of the weight lies; 0 without any.
double percentile(std::vector<Weighted>& sorted, double share)
{
    double total = 0.0, below = 0.0;
    for (const Weighted& w : sorted) total += w.weight;
    for (const Weighted& w : sorted) {
        below += w.weight;
        if (below >= share * total) return w.value;
    }
    return 0.0;
}

void percentiles(std::vector<Weighted> values, double (&out)[3])
{
    std::sort(values.begin(), values.end(), [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
    for (int i = 0; i < 3; ++i) out[i] = percentile(values, kPercentiles[i]);
}

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

LightAnalysis analyseLight(const Light& light, const Rsm& rsm, const Lrsm& lrsm, double finestTap, double mapTap)
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
    std::vector<float> lit;
    std::vector<double> edges;
    float nDotLMin = kInfinity, nDotLMax = 0.0f;
    const int n = rsm.texels.width;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const RsmTexel& texel = rsm.texels.at(x, y);
            if (!(texel.coverage > 0.0f)) continue;
            ++out.texels;
            if (texel.radiance == Vec3(0.0f)) continue;
            const double depth = double(rsm.depthLinear.at(x, y)) * range;
            lit.push_back(static_cast<float>(depth));
            edges.push_back(2.0 * texelEdge(rsm.projection, n, x, y, depth));
            nDotLMin = std::min(nDotLMin, texel.nDotL);
            nDotLMax = std::max(nDotLMax, texel.nDotL);
        }
    out.litTexels = lit.size();
    if (lit.empty()) return out;
    out.nDotLMin = double(nDotLMin);
    out.nDotLMax = double(nDotLMax);
    const auto rank = [&](double share) {
        const auto at = edges.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(edges.size() - 1));
        std::nth_element(edges.begin(), at, edges.end());
        return *at;
    };
    out.texelSize = rank(0.5);
    out.texelSizeLargest = rank(0.95);
    out.clusters = depthClusters(std::move(lit), partedGap(finestTap));
    const int level = static_cast<int>(std::floor(log2Exact(mapTap / out.texelSize) + 0.5));
    out.merged = mergedLight(lrsm, std::clamp(level, 0, lrsm.levels() - 1));
    return out;
}

/// Taps of the diffuse cones.
void analyseCones(const Settings& settings, const VoxelFrame& frame, SceneAnalysis& out)
{
    const ConeSet cones = makeConeSet(settings.cones);
    float finest = kInfinity, coarsest = 0.0f, start = kInfinity;
    for (const ConeRing& ring : cones.rings) {
        const MarchSchedule schedule = makeSchedule(settings.cones, ring.tanHalf, 1.7320508f * static_cast<float>(frame.resolution));
        for (const MarchStep& step : schedule.steps) {
            finest = std::min(finest, step.tapWidth);
            if (!step.readVoxels) continue;
            start = std::min(start, step.middle);
            coarsest = std::max(coarsest, step.level);
        }
    }
    out.voxelSize = double(frame.voxelSize);
    out.finestTap = double(finest) * out.voxelSize;
    out.mapTap = kMapTapVoxels * out.voxelSize;
    out.coneStart = double(start) * out.voxelSize;
    out.voxelLevels = static_cast<int>(std::bit_width(static_cast<unsigned>(frame.resolution)));
    out.voxelLevelsRead = std::min(out.voxelLevels, static_cast<int>(std::ceil(coarsest)) + 1);
}

void analysePicture(const GBuffer& gbuffer, const Camera& camera, SceneAnalysis& out)
{
    const double perMetre = 2.0 * tangent(0.5 * double(camera.verticalFov)) / gbuffer.height;
    std::vector<Weighted> footprints;
    for (std::size_t i = 0; i < gbuffer.depthLinear.texels.size(); ++i)
        if (gbuffer.covered(i))
            footprints.push_back({camera.perspective ? double(gbuffer.depthLinear.texels[i]) * perMetre : double(camera.verticalExtent) / gbuffer.height});
    out.coveredFraction = static_cast<double>(footprints.size()) / static_cast<double>(gbuffer.depthLinear.texels.size());
    percentiles(std::move(footprints), out.pixelFootprint);
}

void analyseTriangles(const Scene& scene, SceneAnalysis& out)
{
    std::vector<Weighted> edges;
    for (const Mesh& mesh : scene.meshes)
        for (const auto& t : mesh.triangles) {
            const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
            const double area = double(glm::length(glm::cross(b - a, c - a)));
            if (area > 0.0) edges.push_back({double(std::min({glm::length(b - a), glm::length(c - b), glm::length(a - c)})), area});
        }
    percentiles(std::move(edges), out.triangleEdge);
}

}  // namespace

double partedGap(double tapWidth)
{
    return 3.0 * tapWidth;
}

std::vector<DepthCluster> depthClusters(std::vector<float> depths, double gap)
{
    std::sort(depths.begin(), depths.end());
    std::vector<DepthCluster> clusters;
    for (const float depth : depths) {
        const auto at = static_cast<double>(depth);
        if (clusters.empty() || at - clusters.back().farthest > gap) clusters.push_back({at, at, 0});
        clusters.back().farthest = at;
        ++clusters.back().texels;
    }
    return clusters;
}

MergedLight mergedLight(const Lrsm& lrsm, int level)
{
    MergedLight out;
    const double range = double(lrsm.projection.depthRange());
    double all = 0.0;
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
                out.depth += one.radiance * moved(texel, one, tapVariance, [&](std::size_t j) { return lrsm.ranges[j].nDotLMin == bounds.nDotLMin; });
                out.normal += one.radiance * moved(texel, one, tapVariance, [&](std::size_t j) { return lrsm.ranges[j].depthMin == bounds.depthMin; });
            }
        }
    if (all > 0.0) out = {out.depth / all, out.normal / all};
    return out;
}

SceneAnalysis analyseScene(const Scene& scene, const Camera& camera, const Requirements& needs, const Settings& settings, int width, int height)
{
    const FloatState state;
    checkScene(scene);
    validate(settings);
    SceneAnalysis out;
    out.specular = needs.specular;
    analyseCones(settings, fitVoxelFrame(scene.bounds, settings.voxel.resolution), out);
    for (const Light& light : scene.lights) {
        const Rsm rsm = renderRsm(scene, light, needs, settings.rsm);
        out.lights.push_back(analyseLight(light, rsm, buildLrsm(rsm, settings.layers), out.finestTap, out.mapTap));
    }
    analysePicture(renderGBuffer(scene, camera, needs, {width, height}), camera, out);
    analyseTriangles(scene, out);
    return out;
}

}  // namespace lrsm
