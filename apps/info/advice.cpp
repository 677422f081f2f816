#include "apps/info/advice.h"

#include "conetrace/render.h"
#include "core/report/table.h"
#include "core/settings/settings_table.h"

#include <algorithm>

namespace lrsm {
namespace {

/// Depth slices whose merging moves less of the light than this part nothing worth a layer.
constexpr double kMergedDepthLimit = 0.008;
/// LRSM texels at most this fraction of the finest tap wide: every tap reads level 1 or coarser.
constexpr double kFineMap = 0.5;
/// Voxels so many times finer than the LRSM's texels resolve nothing that the light's map holds.
constexpr double kFineVoxels = 1.5;
constexpr int kLeastResolution = 64;

/// Work of a frame in units of its own, from the passes' shares on the built-in scenes: good for ratios between settings of one scene, no more.
double frameWork(const SceneAnalysis& analysis, const Settings& settings, const std::vector<int>& layers, int width, int height)
{
    const double voxels = settings.voxel.resolution / 512.0, texels = settings.rsm.resolution / 1024.0;
    const double pixels = analysis.coveredFraction * width * height, cones = double(settings.cones.set.count) * settings.cones.set.setsPerPixel;
    double meanLayers = 0.0, work = 120.0 * voxels * voxels * voxels;
    for (const int count : layers) {
        work += (110.0 + 25.0 + 11.0 * count) * texels * texels;
        meanLayers += static_cast<double>(count) / static_cast<double>(layers.size());
    }
    return work + 1.6e-3 * pixels * cones * (0.8 + 0.05 * meanLayers);
}

/// Collects advice, with what each change alone does to time and memory.
class Adviser {
  public:
    Adviser(const Scene& scene, const SceneAnalysis& analysis, const Settings& settings, int width, int height)
        : scene_(scene), analysis_(analysis), settings_(settings), width_(width), height_(height), layers_(layersOf(settings))
    {
    }

    void add(const std::string& key, const std::string& from, const std::string& to, const std::string& why, bool bitsEqual = false)
    {
        Settings changed = settings_;
        applySetting(changed, key + "=" + to);
        const std::vector<int> layers = layersOf(changed);
        const auto bytes = [&](const Settings& of, const std::vector<int>& kept) {
            const MemoryQuestion question{.scene = scene_, .needs = analysis_.needs, .settings = of, .width = width_, .height = height_, .layersKept = kept};
            return static_cast<double>(frameBytes(predictMemory(question), width_, height_));
        };
        advice.push_back(
            {.key = key,
             .from = from,
             .to = to,
             .why = why,
             .bitsEqual = bitsEqual,
             .predictedTimeRatio = frameWork(analysis_, changed, layers, width_, height_) / frameWork(analysis_, settings_, layers_, width_, height_),
             .predictedMemoryRatio = bytes(changed, layers) / bytes(settings_, layers_)});
    }
    void add(const std::string& key, int from, int to, const std::string& why) { add(key, std::to_string(from), std::to_string(to), why); }

    std::vector<Advice> advice;

  private:
    /// As analysed, less what the settings merge.
    std::vector<int> layersOf(const Settings& settings) const
    {
        std::vector<int> layers;
        for (const LightAnalysis& light : analysis_.lights) {
            int count = light.layers;
            if (settings.layers.depthLayers == 1 && light.depthSlices > 1) count = (count + light.depthSlices - 1) / light.depthSlices;
            if (settings.layers.normalLayers == 1 && light.normalSlices > 1) count = (count + light.normalSlices - 1) / light.normalSlices;
            layers.push_back(count);
        }
        return layers;
    }

    const Scene& scene_;
    const SceneAnalysis& analysis_;
    const Settings& settings_;
    int width_, height_;
    std::vector<int> layers_;
};

template <class Value>
double largest(const std::vector<LightAnalysis>& lights, const Value& value)
{
    double most = 0.0;
    for (const LightAnalysis& light : lights)
        if (light.litTexels > 0) most = std::max(most, value(light));
    return most;
}

void adviseLayers(const SceneAnalysis& analysis, const Settings& settings, Adviser& adviser)
{
    if (settings.method != Method::lrsm) return;
    const double moved = largest(analysis.lights, [](const LightAnalysis& light) { return light.moved; });
    const double slices = largest(analysis.lights, [](const LightAnalysis& light) { return double(light.depthSlices); });
    if (settings.layers.depthLayers > 1 && slices > 1.0 && moved < kMergedDepthLimit)
        adviser.add("depth_layers", settings.layers.depthLayers, 1,
                    "read through one layer, " + numberText(2, 100.0 * moved) + " % of the light moves in depth");
}

/// Texels of the light's map against the voxels: the finer of the two is wasted, where voxels hold occlusion alone.
void adviseResolutions(const SceneAnalysis& analysis, const Settings& settings, Adviser& adviser)
{
    if (settings.method != Method::lrsm) return;
    const double coarsest = largest(analysis.lights, [](const LightAnalysis& light) { return light.texelSize; }) / analysis.finestTap;
    double finest = kFineVoxels * 1e6;
    for (const LightAnalysis& light : analysis.lights)
        if (light.litTexels > 0) finest = std::min(finest, light.texelSize / analysis.finestTap);
    if (!(coarsest > 0.0)) return;

    int texels = settings.rsm.resolution;
    for (double ratio = coarsest; ratio <= kFineMap && texels > kLeastResolution; ratio *= 2.0) texels /= 2;
    if (texels < settings.rsm.resolution)
        adviser.add("rsm_resolution", settings.rsm.resolution, texels,
                    "LRSM texels are " + numberText(2, coarsest) + " of the finest tap wide: next to nothing reads the base level");

    int voxels = settings.voxel.resolution;
    float start = settings.cones.march.startVoxels;
    for (double ratio = finest; ratio >= kFineVoxels && voxels > kLeastResolution; ratio *= 0.5) {
        voxels /= 2;
        if (start > 2.0f) start = std::max(2.0f, start - 1.0f);  // near the same length, as the presets have it
    }
    if (voxels == settings.voxel.resolution) return;
    adviser.add("voxel_resolution", settings.voxel.resolution, voxels,
                "LRSM texels are " + numberText(2, finest) + " voxels wide: the light's map resolves less than the voxels");
    if (start != settings.cones.march.startVoxels)
        adviser.add("start_voxels", numberText(6, double(settings.cones.march.startVoxels)), numberText(6, double(start)), "goes with the wider voxels");
}

}  // namespace

std::vector<Advice> adviseSettings(const Scene& scene, const SceneAnalysis& analysis, const Settings& settings, int width, int height)
{
    Adviser adviser(scene, analysis, settings, width, height);
    if (settings.force.everything) adviser.add("force_everything", "true", "false", "it is for tests of the analysis", true);
    if (!settings.layers.dropEmpty) adviser.add("drop_empty", "false", "true", "layers without a lit texel send nothing", true);
    if (settings.method == Method::lrsm) adviseLayers(analysis, settings, adviser);
    adviseResolutions(analysis, settings, adviser);
    return adviser.advice;
}

Settings applyAdvice(Settings settings, const std::vector<Advice>& advice)
{
    for (const Advice& change : advice) applySetting(settings, change.key + "=" + change.to);
    validate(settings);
    return settings;
}

}  // namespace lrsm
