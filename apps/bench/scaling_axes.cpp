#include "apps/bench/scaling_axes.h"

#include "apps/bench/scaling_scenes.h"
#include "core/base/errors.h"
#include "core/base/text.h"
#include "core/settings/settings_table.h"

#include <algorithm>

namespace lrsm {
namespace {

constexpr std::size_t kMostTriangles = 2000000;

struct AxisRecipe {
    std::string name, xLabel;
    int width, height, voxels, rsm;  ///< a quick run has 32x18, 32^3, 64^2
    std::vector<int> values;         ///< a quick run has the first three ...
    int quickDivisor;                ///< ... over this
    /// Of a point with x = value, label = value and all else the base's, what its axis is about. False: the axis ends before it.
    bool (*change)(ScalingPoint&, int value, const ScalingBase&);
    std::string xSeries = {};
};

bool changePixels(ScalingPoint& point, int divisor, const ScalingBase&)
{
    point.width = std::max(1, point.width / divisor);
    point.height = std::max(1, point.height / divisor);
    point.x = double(point.width) * point.height;
    point.label = std::to_string(point.width) + "x" + std::to_string(point.height);
    return true;
}

bool changeCones(ScalingPoint& point, int count, const ScalingBase&)
{
    point.settings.cones.set.count = count;
    return true;
}

bool changeSets(ScalingPoint& point, int sets, const ScalingBase&)
{
    point.settings.cones.set.setsPerPixel = sets;
    return true;
}

/// Two digits: depth and normal layers.
bool changeLayers(ScalingPoint& point, int digits, const ScalingBase&)
{
    LayerSettings& layers = point.settings.layers;
    layers.depthLayers = digits / 10;
    layers.normalLayers = digits % 10;
    point.x = layers.depthLayers * layers.normalLayers;
    point.label = std::to_string(layers.depthLayers) + "x" + std::to_string(layers.normalLayers);
    return true;
}

bool changeLights(ScalingPoint& point, int count, const ScalingBase& base)
{
    point.scene = std::make_shared<const Scene>(withLightSplit(base.scene, count));
    return true;
}

bool changeVoxels(ScalingPoint& point, int resolution, const ScalingBase&)
{
    point.settings.voxel.resolution = resolution;
    point.label += "^3";
    return true;
}

bool changeRsm(ScalingPoint& point, int resolution, const ScalingBase&)
{
    point.settings.rsm.resolution = resolution;
    point.label += "^2";
    return true;
}

bool changeTriangles(ScalingPoint& point, int doublings, const ScalingBase& base)
{
    const std::size_t count = base.scene.triangleCount() << (2 * doublings);
    if (doublings > 0 && count > kMostTriangles) return false;
    point.scene = std::make_shared<const Scene>(subdivided(base.scene, doublings));
    point.x = double(count);
    point.label = std::to_string(count);
    return true;
}

/// 1, 2, 4 ... and all cores.
bool changeThreads(ScalingPoint& point, int threads, const ScalingBase& base)
{
    if (threads / 2 >= base.cores) return false;
    point.threads = std::min(threads, base.cores);
    point.x = point.threads;
    point.label = std::to_string(point.threads);
    return true;
}

const std::vector<AxisRecipe>& axisRecipes()
{
    static const std::vector<AxisRecipe> all = {
        {"pixels", "pixels", 1280, 720, 256, 512, {16, 8, 4, 2, 1}, 4, changePixels},
        {"cones", "diffuse cones a pixel", 160, 90, 256, 512, {1, 2, 4, 8, 16, 32, 64}, 1, changeCones},
        {"sets", "cone sets a pixel", 160, 90, 256, 512, {1, 2, 4, 8, 16}, 1, changeSets},
        {"layers", "layers kept", 160, 90, 128, 1024, {11, 21, 22, 32, 42, 43, 44}, 1, changeLayers, "layers_kept"},
        {"lights", "lights", 160, 90, 256, 512, {1, 2, 3, 4, 6, 8}, 1, changeLights},
        {"voxels", "voxels along an edge", 160, 90, 256, 512, {64, 128, 256, 512, 1024}, 4, changeVoxels},
        {"rsm", "RSM texels along an edge", 160, 90, 128, 512, {256, 512, 1024, 2048, 4096}, 8, changeRsm},
        {"triangles", "triangles", 160, 90, 256, 512, {0, 1, 2, 3, 4, 5, 6, 7, 8}, 1, changeTriangles},
        {"threads", "threads", 320, 180, 256, 512, {1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024}, 1, changeThreads},
    };
    return all;
}

/// "atrium, 430 triangles, 320x180, ...": what stays the same.
std::string describeFixed(const std::string& grows, const ScalingBase& base, const ScalingPoint& point)
{
    const Settings& s = point.settings;
    std::string text = base.scene.name;
    const auto say = [&](const std::string& what, const std::string& value) {
        if (what != grows) text += ", " + value;
    };
    say("triangles", std::to_string(base.scene.triangleCount()) + " triangles");
    say("lights", std::to_string(base.scene.lights.size()) + (base.scene.lights.size() == 1 ? " light" : " lights"));
    say("pixels", std::to_string(point.width) + "x" + std::to_string(point.height));
    say("voxels", "voxels " + std::to_string(s.voxel.resolution) + "^3");
    say("rsm", "RSM " + std::to_string(s.rsm.resolution) + "^2");
    say("layers", std::to_string(s.layers.depthLayers) + "x" + std::to_string(s.layers.normalLayers) + " layers");
    say("cones", std::to_string(s.cones.set.count) + " cones");
    return text;
}

}  // namespace

const std::vector<std::string>& scalingAxisNames()
{
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const AxisRecipe& recipe : axisRecipes()) list.push_back(recipe.name);
        return list;
    }();
    return names;
}

ScalingAxis makeScalingAxis(const std::string& name, const ScalingBase& base)
{
    const std::vector<AxisRecipe>& recipes = axisRecipes();
    const auto recipe = std::find_if(recipes.begin(), recipes.end(), [&](const AxisRecipe& one) { return one.name == name; });
    if (recipe == recipes.end()) throw InputError("axis \"" + name + "\"", "there is none of this name; the axes are " + joined(scalingAxisNames()));
    const IVec2 size = base.size.value_or(base.quick ? IVec2(32, 18) : IVec2(recipe->width, recipe->height));
    ScalingPoint same{.x = 0.0,
                      .label = {},
                      .scene = std::make_shared<const Scene>(base.scene),
                      .settings = base.settings,
                      .width = size.x,
                      .height = size.y,
                      .threads = base.threads};
    same.settings.voxel.resolution = base.quick ? 32 : recipe->voxels;
    same.settings.rsm.resolution = base.quick ? 64 : recipe->rsm;
    for (const std::string& assignment : base.assignments) applySetting(same.settings, assignment);

    std::vector<int> values = recipe->values;
    if (base.quick) values.resize(std::min<std::size_t>(3, values.size()));
    ScalingAxis axis{.name = name, .xLabel = recipe->xLabel, .xSeries = recipe->xSeries, .fixed = {}, .camera = base.camera, .points = {}};
    for (int value : values) {
        if (base.quick) value /= recipe->quickDivisor;
        ScalingPoint point = same;
        point.x = value;
        point.label = std::to_string(value);
        if (!recipe->change(point, value, base)) break;
        validate(point.settings);
        axis.points.push_back(std::move(point));
    }
    axis.fixed = describeFixed(name, base, axis.points.front());
    return axis;
}

}  // namespace lrsm
