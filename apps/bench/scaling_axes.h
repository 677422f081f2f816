#pragma once

#include "core/scene/scene.h"
#include "core/settings/settings.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

/// The axes of `lrsm bench`: frames on which one size alone changes.
namespace lrsm {

/// What the axes are laid around.
struct ScalingBase {
    Scene scene;
    Camera camera;
    Settings settings;                     ///< each axis lowers voxel and RSM resolution of its own, so that what grows can be seen ...
    std::vector<std::string> assignments;  ///< ... and these "key=value" go over that
    std::optional<IVec2> size;             ///< of the picture, instead of the axis's own; the largest of the axis `pixels`
    bool quick = false;                    ///< three small values an axis: to see that it works
    int threads = 0;                       ///< of every axis but `threads`; 0: all
    int cores = 1;                         ///< the largest of the axis `threads`
};

/// One frame of an axis.
struct ScalingPoint {
    double x = 0.0;
    std::string label;
    std::shared_ptr<const Scene> scene;
    Settings settings;
    int width = 0, height = 0, threads = 0;
};

struct ScalingAxis {
    std::string name, xLabel;
    std::string xSeries;  ///< where x is what the frame turned out to have (layers kept); else empty
    std::string fixed;    ///< all else, in words
    Camera camera;
    std::vector<ScalingPoint> points;
};

/// pixels, cones, sets, layers, lights, voxels, rsm, triangles, threads: in the order of `lrsm bench`.
const std::vector<std::string>& scalingAxisNames();
/// InputError for an unknown name, and where the base cannot serve (no light).
ScalingAxis makeScalingAxis(const std::string& name, const ScalingBase& base);

}  // namespace lrsm
