#include "apps/info/describe_analysis.h"

#include <cstdio>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

/// Metres as millimetres below 1 m.
std::string length(double metres)
{
    char text[32];
    if (metres < 1.0)
        std::snprintf(text, sizeof text, "%.3g mm", 1e3 * metres);
    else
        std::snprintf(text, sizeof text, "%.3g m", metres);
    return text;
}

std::string percent(double share)
{
    char text[32];
    std::snprintf(text, sizeof text, share < 0.1 ? "%.2g %%" : "%.0f %%", 100.0 * share);
    return text;
}

std::string ratio(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", value);
    return text;
}

std::string spread(const double (&percentiles)[3])
{
    return length(percentiles[1]) + " (" + length(percentiles[0]) + " .. " + length(percentiles[2]) + ")";
}

Json lightJson(const LightAnalysis& light, const SceneAnalysis& analysis)
{
    Json clusters = Json::array();
    for (const DepthCluster& cluster : light.clusters)
        clusters.push_back({{"nearest", cluster.nearest}, {"farthest", cluster.farthest}, {"texels", cluster.texels}});
    return {{"name", light.name},
            {"texels", light.texels},
            {"lit_texels", light.litTexels},
            {"depth_clusters", clusters},
            {"n_dot_l", {light.nDotLMin, light.nDotLMax}},
            {"texel_size", light.texelSize},
            {"texel_size_largest", light.texelSizeLargest},
            {"texel_over_tap", light.texelSize / analysis.finestTap},
            {"moved_by_one_depth_layer", light.merged.depth},
            {"moved_by_one_normal_layer", light.merged.normal},
            {"depth_slices", light.depthSlices},
            {"normal_slices", light.normalSlices},
            {"layers", light.layers}};
}

void printLight(std::ostream& out, std::size_t index, const LightAnalysis& light, const SceneAnalysis& analysis)
{
    out << "  light " << index << ": ";
    if (light.litTexels == 0) {
        out << "lights nothing: no layer, no sample\n";
        return;
    }
    out << percent(static_cast<double>(light.litTexels) / static_cast<double>(light.texels)) << " of the map's surface is lit, " << light.clusters.size()
        << (light.clusters.size() == 1 ? " depth cluster, " : " depth clusters, ") << light.layers << " layers kept\n"
        << "    LRSM texel " << length(light.texelSize) << ", " << ratio(light.texelSize / analysis.finestTap) << " of the finest tap\n"
        << "    light that moves if read through one depth layer " << percent(light.merged.depth) << ", through one <n.l> layer "
        << percent(light.merged.normal) << "\n";
}

}  // namespace

Json analysisJson(const SceneAnalysis& analysis)
{
    const auto triple = [](const double(&values)[3]) { return Json{values[0], values[1], values[2]}; };
    Json json = {{"voxel_size", analysis.voxelSize},
                 {"finest_tap", analysis.finestTap},
                 {"voxel_levels", analysis.voxelLevels},
                 {"voxel_levels_read", analysis.voxelLevelsRead},
                 {"cone_start", analysis.coneStart},
                 {"pixel_footprint", triple(analysis.pixelFootprint)},
                 {"triangle_edge", triple(analysis.triangleEdge)},
                 {"covered_fraction", analysis.coveredFraction},
                 {"lights", Json::array()}};
    for (const LightAnalysis& light : analysis.lights) json["lights"].push_back(lightJson(light, analysis));
    return json;
}

Json adviceJson(const std::vector<Advice>& advice)
{
    Json list = Json::array();
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

void printAnalysis(std::ostream& out, const SceneAnalysis& analysis)
{
    out << "what this scene requires, at these settings:\n"
        << "  voxel " << length(analysis.voxelSize) << ", finest tap " << length(analysis.finestTap) << ", cones start " << length(analysis.coneStart)
        << " off the surface\n"
        << "  pixel footprint " << spread(analysis.pixelFootprint) << ", shortest triangle edges " << spread(analysis.triangleEdge) << "\n";
    for (std::size_t i = 0; i < analysis.lights.size(); ++i) printLight(out, i, analysis.lights[i], analysis);
    if (analysis.lights.empty()) out << "  no lights: the cones read voxels for the opacity alone\n";
}

void printAdvice(std::ostream& out, const std::vector<Advice>& advice)
{
    out << "advice (docs/requirements.md says what it cost and saved where measured):\n";
    if (advice.empty()) out << "  none: the settings fit\n";
    for (const Advice& change : advice)
        out << "  --set " << change.key << "=" << change.to << " (" << change.from << "): " << change.why << "; time x" << ratio(change.predictedTimeRatio)
            << ", memory x" << ratio(change.predictedMemoryRatio) << (change.bitsEqual ? ", every bit kept" : "") << "\n";
}

}  // namespace lrsm
