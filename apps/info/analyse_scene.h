#pragma once

#include "core/scene/requirements.h"
#include "core/scene/scene.h"
#include "core/settings/settings.h"
#include "lrsm/layers.h"

#include <cstdint>
#include <string>
#include <vector>

/// What a scene, seen by one camera, requires of the settings: measured on its light maps and its G-buffer, which are cheap beside the cones.
namespace lrsm {

/// How much of a map's light would be read elsewhere if its depth slices were merged into one: texel by texel of one level, the share of radiance that
/// moves. A layer's depths move from N(mu, s^2) to the merged N(mu', s'^2) by their Wasserstein distance over s, s^2 = variance + D^2/4, its mean normal by
/// the length of the difference; together capped at 1. 0: merging them changes nothing.
double movedByOneDepthLayer(const Lrsm& lrsm, int level);

/// One light's map, as cones read it.
struct LightAnalysis {
    std::string name;
    std::uint64_t texels = 0;               ///< RSM texels that show a surface
    std::uint64_t litTexels = 0;            ///< of these, with any radiance: a light without one builds no layer and is sampled by nothing
    double texelSize = 0.0;                 ///< metres, edge of an LRSM base texel (two RSM texels) at the lit surfaces, median
    double moved = 0.0;                     ///< movedByOneDepthLayer
    int depthSlices = 0, normalSlices = 0;  ///< that hold a lit texel
    int layers = 0;                         ///< that do, and are kept
};

struct SceneAnalysis {
    std::vector<LightAnalysis> lights;
    Requirements needs;
    double finestTap = 0.0;        ///< metres, narrowest tap of any diffuse cone
    double coveredFraction = 0.0;  ///< of the picture
};

/// Layers are merged for comparison at the level that a tap this wide reads, in base voxels: diffuse cones of some 30 voxels and more read such.
inline constexpr double kMapTapVoxels = 4.0;

/// Renders each light's RSM, splits it into layers, and renders the G-buffer at `width` x `height`; no voxels, no cones. `known`, an analysis of the same
/// scene by settings whose maps are the same, saves all of that.
SceneAnalysis analyseScene(const Scene& scene, const Camera& camera, const Requirements& needs, const Settings& settings, int width, int height,
                           const SceneAnalysis* known = nullptr);

/// Do settings differ in cones and direct light alone, and so not in light maps, layers and voxels?
bool sameMaps(const Settings& a, const Settings& b);

}  // namespace lrsm
