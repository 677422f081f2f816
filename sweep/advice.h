#pragma once

#include "core/base/settings.h"
#include "core/scene/requirements.h"
#include "core/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// What a scene, seen by one camera, requires of the settings: measured on its RSMs and its G-buffer, which are cheap beside the cones.
namespace lrsm {

/// A run of depths without a wide gap, in metres beyond the light's nearest depth.
struct DepthCluster {
    double nearest = 0.0, farthest = 0.0;
    std::uint64_t texels = 0;
    bool operator==(const DepthCluster&) const = default;
};

/// Runs of `depths` (any order; metres) that are parted by gaps wider than `gap`, nearest first.
std::vector<DepthCluster> depthClusters(std::vector<float> depths, double gap);

/// The gap that a layer's Gaussian (Eq. 12) can see past a tap of width D: below it two depths overlap within three sigma, sigma^2 = D^2 / 4 each
/// side, so that a cut between them parts nothing. 3 D.
double partedGap(double tapWidth);

/// One light's map, as its LRSM is sampled.
struct LightAnalysis {
    std::string name;
    std::uint64_t texels = 0;     ///< RSM texels that show a surface
    std::uint64_t litTexels = 0;  ///< of these, with any radiance: the rest cannot change the picture
    std::vector<DepthCluster> clusters;  ///< of lit texels, parted by partedGap of the finest tap
    double nDotLMin = 0.0, nDotLMax = 0.0;  ///< of lit texels
    double texelSize = 0.0;        ///< metres, edge of an RSM texel at the lit surfaces, median
    double texelSizeLargest = 0.0; ///< at the lit surface farthest along the light's axis
    double finestLevel = 0.0;      ///< LRSM level that the finest tap asks for there, unclamped; >= 1: the LRSM's base level is read by nothing
    double medianLevel = 0.0;      ///< the finest tap's at the median lit surface
    int layersKept = 0;            ///< after empty ones are dropped
};

struct SceneAnalysis {
    std::vector<LightAnalysis> lights;
    double voxelSize = 0.0;        ///< metres
    double finestTap = 0.0;        ///< metres, narrowest tap of any cone: voxelSize at the least
    double widestTap = 0.0;        ///< metres, the widest tap inside the grid
    int voxelLevels = 0, voxelLevelsRead = 0;  ///< of the pyramid; how many of them any cone can read
    double coneStart = 0.0;        ///< metres to a cone's first voxel tap
    double pixelFootprint = 0.0;   ///< metres, edge of a pixel on the visible surfaces, median
    double pixelFootprintSmallest = 0.0;  ///< 5th percentile
    double triangleEdge = 0.0;     ///< metres, median over the visible pixels of the seen triangle's shortest edge
    double coveredFraction = 0.0;  ///< of the picture
};

/// Renders each light's RSM and the G-buffer at `width` x `height` with `settings`; no voxels, no cones.
SceneAnalysis analyseScene(const Scene& scene, const Camera& camera, const Requirements& needs, const Settings& settings, int width, int height);

/// One change of one setting that the scene allows.
struct Advice {
    std::string key, from, to;  ///< as in --set
    std::string why;            ///< one sentence with the numbers that it rests on
    bool bitsEqual = false;     ///< the picture keeps every bit; otherwise its error is expected to stay within the rule's measured bound (docs/requirements.md)
    double predictedTimeRatio = 1.0, predictedMemoryRatio = 1.0;  ///< of the whole frame, after over before; 1: no change expected
};

/// What may be changed in `settings` for this scene, each on its own or all together; empty when nothing is.
std::vector<Advice> adviseSettings(const SceneAnalysis& analysis, const Settings& settings, int width, int height);

/// `settings` with all advice laid over it.
Settings applyAdvice(Settings settings, const std::vector<Advice>& advice);

}  // namespace lrsm
