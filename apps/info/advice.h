#pragma once

#include "core/scene/requirements.h"
#include "core/scene/scene.h"
#include "core/settings/settings.h"
#include "lrsm/layers.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// What a scene, seen by one camera, requires of the settings: measured on its light maps and its G-buffer, which are cheap beside the cones.
namespace lrsm {

/// A run of depths without a wide gap, in metres beyond the light's nearest depth.
struct DepthCluster {
    double nearest = 0.0, farthest = 0.0;
    std::uint64_t texels = 0;
    bool operator==(const DepthCluster&) const = default;
};

/// Runs of `depths` (any order; metres) that are parted by gaps wider than `gap`, nearest first.
std::vector<DepthCluster> depthClusters(std::vector<float> depths, double gap);

/// The gap between two depths that a layer's Gaussian tells apart at a tap of width D: six of the least sigma D/2 that the `slab` estimator gives it, 3 D.
double partedGap(double tapWidth);

/// How much of a map's light would be read elsewhere if layers were merged: texel by texel of one level, the share of radiance that moves. A layer's
/// depths move from N(mu, s^2) to the merged N(mu', s'^2) by their Wasserstein distance over s, s^2 = variance + D^2/4, capped at 1; its mean normal by
/// the length of the difference. 0: merging them changes nothing.
struct MergedLight {
    double depth = 0.0;   ///< depth slices merged into one
    double normal = 0.0;  ///< <n.l> slices merged into one
};
MergedLight mergedLight(const Lrsm& lrsm, int level);

/// One light's map, as cones read it.
struct LightAnalysis {
    std::string name;
    std::uint64_t texels = 0;               ///< RSM texels that show a surface
    std::uint64_t litTexels = 0;            ///< of these, with any radiance: a light without one builds no layer and is sampled by nothing
    std::vector<DepthCluster> clusters;     ///< of lit texels, parted by partedGap of the finest tap
    double nDotLMin = 0.0, nDotLMax = 0.0;  ///< of lit texels
    double texelSize = 0.0;                 ///< metres, edge of an LRSM base texel (two RSM texels) at the lit surfaces, median
    double texelSizeLargest = 0.0;          ///< 95th percentile
    MergedLight merged;
    int depthSlices = 0, normalSlices = 0;  ///< that hold a lit texel
    int layers = 0;                         ///< that do, and are kept
};

struct SceneAnalysis {
    std::vector<LightAnalysis> lights;
    double voxelSize = 0.0;                    ///< metres
    double finestTap = 0.0;                    ///< metres, narrowest tap of any diffuse cone
    double mapTap = 0.0;                       ///< metres, the tap at whose LRSM level layers are merged for comparison: kMapTapVoxels voxels
    int voxelLevels = 0, voxelLevelsRead = 0;  ///< of the pyramid; how many of them a diffuse cone can read
    double coneStart = 0.0;                    ///< metres to a cone's first voxel tap
    double pixelFootprint[3] = {};             ///< metres, edge of a pixel across the viewing axis at the visible surfaces: 5th, 50th, 95th percentile
    double triangleEdge[3] = {};               ///< metres, shortest edge of the scene's triangles, each weighted by its area: the same percentiles
    double coveredFraction = 0.0;              ///< of the picture
    bool specular = false;
};

/// Diffuse cones of some 30 voxels and more read taps this wide, in base voxels.
inline constexpr double kMapTapVoxels = 4.0;

/// Renders each light's RSM, splits it into layers, and renders the G-buffer at `width` x `height`; no voxels, no cones.
SceneAnalysis analyseScene(const Scene& scene, const Camera& camera, const Requirements& needs, const Settings& settings, int width, int height);

/// One change of one setting that the scene allows.
struct Advice {
    std::string key, from, to;                                    ///< as in --set
    std::string why;                                              ///< one sentence with the numbers that it rests on
    bool bitsEqual = false;                                       ///< the picture keeps every bit; otherwise docs/requirements.md says what the rule has cost
    double predictedTimeRatio = 1.0, predictedMemoryRatio = 1.0;  ///< of the whole frame, after over before, this change alone; 1: none expected
};

/// What may be changed in `settings` for this scene, all together; empty when nothing is. Rules that did not predict are not here: see docs/requirements.md.
std::vector<Advice> adviseSettings(const SceneAnalysis& analysis, const Settings& settings, int width, int height);

/// `settings` with all advice laid over it.
Settings applyAdvice(Settings settings, const std::vector<Advice>& advice);

}  // namespace lrsm
