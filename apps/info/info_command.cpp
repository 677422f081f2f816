#include "apps/common/commands.h"
#include "apps/common/common_options.h"
#include "apps/common/describe.h"
#include "apps/common/memory.h"
#include "apps/info/advice.h"
#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "core/report/table.h"
#include "core/scene/builtin_scenes.h"
#include "core/scene/load_scene.h"
#include "core/scene/scene_hash.h"
#include "core/settings/settings_table.h"
#include "voxel/radiance/octree_bytes.h"
#include "voxel/voxelize.h"

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

struct InfoArguments : CommonOptions {
    bool list = false;
    bool sparse = false;
};

/// Metres as millimetres below 1 m.
std::string length(double metres)
{
    return metres < 1.0 ? shortNumber(1e3 * metres) + " mm" : shortNumber(metres) + " m";
}

std::string percent(double share)
{
    return (share < 0.1 ? numberText(2, 100.0 * share) : fixedNumber(0, 100.0 * share)) + " %";
}

nlohmann::ordered_json lightJson(const LightAnalysis& light, const SceneAnalysis& analysis)
{
    return {{"name", light.name},
            {"texels", light.texels},
            {"lit_texels", light.litTexels},
            {"texel_size", light.texelSize},
            {"texel_over_tap", light.texelSize / analysis.finestTap},
            {"moved_by_one_depth_layer", light.moved},
            {"depth_slices", light.depthSlices},
            {"normal_slices", light.normalSlices},
            {"layers", light.layers}};
}

nlohmann::ordered_json analysisJson(const SceneAnalysis& analysis)
{
    nlohmann::ordered_json json = {
        {"finest_tap", analysis.finestTap}, {"covered_fraction", analysis.coveredFraction}, {"lights", nlohmann::ordered_json::array()}};
    for (const LightAnalysis& light : analysis.lights) json["lights"].push_back(lightJson(light, analysis));
    return json;
}

nlohmann::ordered_json adviceJson(const std::vector<Advice>& advice)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Advice& change : advice)
        list.push_back({{"key", change.key},
                        {"from", change.from},
                        {"to", change.to},
                        {"why", change.why},
                        {"bits_equal", change.bitsEqual},
                        {"predicted_time_ratio", change.predictedTimeRatio},
                        {"predicted_memory_ratio", change.predictedMemoryRatio}});
    return list;
}

void printLight(std::ostream& out, std::size_t index, const LightAnalysis& light, const SceneAnalysis& analysis)
{
    out << "  light " << index << ": ";
    if (light.litTexels == 0) {
        out << "lights nothing: no layer, no sample\n";
        return;
    }
    out << percent(static_cast<double>(light.litTexels) / static_cast<double>(light.texels)) << " of the map's surface is lit, " << light.layers
        << " layers kept\n"
        << "    LRSM texel " << length(light.texelSize) << ", " << fixedNumber(2, light.texelSize / analysis.finestTap) << " of the finest tap\n"
        << "    light that moves if read through one depth layer " << percent(light.moved) << "\n";
}

void printAnalysis(std::ostream& out, const SceneAnalysis& analysis)
{
    out << "what this scene requires, at these settings:\n  finest tap of a cone " << length(analysis.finestTap) << "\n";
    for (std::size_t i = 0; i < analysis.lights.size(); ++i) printLight(out, i, analysis.lights[i], analysis);
    if (analysis.lights.empty()) out << "  no lights: the cones read voxels for the opacity alone\n";
}

void printAdvice(std::ostream& out, const std::vector<Advice>& advice)
{
    out << "advice (docs/requirements.md says what it cost and saved where measured):\n";
    if (advice.empty()) out << "  none: the settings fit\n";
    for (const Advice& change : advice)
        out << "  --set " << change.key << "=" << change.to << " (" << change.from << "): " << change.why << "; time x"
            << fixedNumber(2, change.predictedTimeRatio) << ", memory x" << fixedNumber(2, change.predictedMemoryRatio)
            << (change.bitsEqual ? ", every bit kept" : "") << "\n";
}

/// What an octree over the scene's voxels would take in place of the dense radiance grid.
struct SparseReport {
    std::vector<std::size_t> occupied;
    OctreeBytes bytes;
};
SparseReport countSparse(const Scene& scene, const VoxelSettings& settings)
{
    const std::vector<std::size_t> occupied = countOccupiedTexels(voxelize(scene, settings));
    return {occupied, octreeBytes(occupied, settings.resolution)};
}

nlohmann::ordered_json sparseJson(const SparseReport& report)
{
    return {{"occupied", report.occupied},
            {"dense", report.bytes.dense},
            {"octree_occupied_only", report.bytes.occupiedOnly},
            {"octree_tiles_of_eight", report.bytes.tilesOfEight},
            {"octree_bricks", report.bytes.bricks}};
}

void printSparse(std::ostream& out, const SparseReport& report)
{
    const auto line = [&](const char* what, std::size_t bytes) { out << "  " << what << megabytes(bytes) << "\n"; };
    out << "radiance in voxels, dense and as octrees over the " << report.occupied.front() << " occupied ones (counted, none is built):\n";
    line("dense grid                                  ", report.bytes.dense);
    line("octree, occupied nodes only                 ", report.bytes.occupiedOnly);
    line("octree, children in tiles of eight          ", report.bytes.tilesOfEight);
    line("octree, tiles of eight with bricks of 3^3   ", report.bytes.bricks);
}

int listBuiltins(bool json)
{
    nlohmann::ordered_json names = nlohmann::ordered_json::array();
    for (const BuiltinSceneInfo& info : builtinScenes()) {
        names.push_back({{"name", info.name}, {"summary", info.summary}});
        if (!json) std::cout << info.name << ": " << info.summary << "\n";
    }
    if (json) std::cout << jsonText(names);
    return 0;
}

int runInfo(const InfoArguments& options)
{
    if (options.list) return listBuiltins(options.json);
    const Settings settings = chosenSettings(options);
    const IVec2 size = chosenSize(options);
    const ThreadLimit threads(options.threads);
    const Scene scene = loadChosenScene(options);
    const Requirements needs = analyseRequirements(scene, settings.force);
    const SceneAnalysis analysis = analyseScene(scene, chosenCamera(scene, options), needs, settings, size.x, size.y);
    const std::vector<Advice> advice = adviseSettings(scene, analysis, settings, size.x, size.y);
    const std::vector<VoxelGrid> grids = gridsOf(scene, settings.voxel, chosenCamera(scene, options).position);
    const auto memory = predictMemory({scene, needs, settings, size.x, size.y});

    if (options.json) {
        nlohmann::ordered_json json = {{"version", LRSM_VERSION},
                                       {"scene", sceneJson(scene, hashScene(scene))},
                                       {"voxel_grids", voxelGridsJson(grids, scene.origin)},
                                       {"requires", requirementsJson(needs)},
                                       {"settings", settingsToJson(settings)},
                                       {"memory", memoryJson(memory)},
                                       {"analysis", analysisJson(analysis)},
                                       {"advice", adviceJson(advice)}};
        if (options.sparse) json["sparse"] = sparseJson(countSparse(scene, settings.voxel));
        std::cout << jsonText(json);
        return 0;
    }
    printScene(std::cout, scene);
    printVoxelGrids(std::cout, grids, scene.origin);
    printRequirements(std::cout, needs);
    printAnalysis(std::cout, analysis);
    printAdvice(std::cout, advice);
    std::cout << "memory of a frame with these settings, in MB of 10^6 bytes:\n";
    printMemory(std::cout, memory);
    if (options.sparse) printSparse(std::cout, countSparse(scene, settings.voxel));
    return 0;
}

}  // namespace

Command addInfo(CLI::App& program)
{
    CLI::App* parser = program.add_subcommand("info", "What is in a scene, what it requires, how much memory a frame takes");
    const auto options = std::make_shared<InfoArguments>();
    addSceneOptions(*parser, *options);
    addSettingOptions(*parser, *options);
    addPictureOptions(*parser, *options);
    addRunOptions(*parser, *options);
    parser->add_flag("--list", options->list, "list the built-in scenes");
    parser->add_flag("--sparse", options->sparse, "count what an octree would take in place of voxel cone tracing's dense grid");
    return {parser, [options] { return runInfo(*options); }};
}

}  // namespace lrsm
