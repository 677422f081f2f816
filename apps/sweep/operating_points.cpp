#include "apps/sweep/operating_points.h"

#include "core/base/text.h"
#include "core/settings/settings_table.h"

#include <string>

namespace lrsm {

namespace {

/// What each point changes against `balanced`, by rising cost: from the fronts of docs/accuracy.md. Narrower cones see finer voxels and maps: these go
/// together.
struct Point {
    std::string_view name, assignments;
};
constexpr Point kPoints[] = {
    {"1 cone, 256^3", "cone_count=1 voxel_resolution=256 rsm_resolution=256 start_voxels=2 step=0.75 voxel_level_bias=-2.5"},
    {"2 cones, 256^3", "cone_count=2 voxel_resolution=256 rsm_resolution=256 start_voxels=2 step=0.75 voxel_level_bias=-2.5"},
    {"3 cones, 256^3, RSM 256^2", "cone_count=3 voxel_resolution=256 rsm_resolution=256 start_voxels=2 voxel_level_bias=-2.5"},
    {"fast", "cone_count=3 voxel_resolution=256 rsm_resolution=512 start_voxels=2 voxel_level_bias=-2.5"},
    {"4 cones, 256^3", "cone_count=4 voxel_resolution=256 rsm_resolution=512 start_voxels=2 voxel_level_bias=-2.5"},
    {"6 cones, 256^3, long steps", "voxel_resolution=256 rsm_resolution=512 start_voxels=2 step=0.75"},
    {"6 cones, 256^3", "voxel_resolution=256 rsm_resolution=512 start_voxels=2"},
    {"proxies, every eighth pixel", "method=proxies pp_march_divisor=8 pp_gather_divisor=4"},
    {"caches", "method=caches aperture_scale=1 rotation=none irradiance_filter=false"},
    {"balanced", ""},
    {"proxies", "method=proxies"},
    {"6 rays", "visibility=rays aperture_scale=0.0625"},
    {"9 cones, 512^3", "cone_count=9 depth_layers=3"},
    {"fine", "cone_count=16 filter_passes=1 step=0.5"},
    {"rays", "visibility=rays cone_count=16 aperture_scale=0.0625"},
    {"accurate", "visibility=rays cone_count=32 aperture_scale=0.03 filter_passes=1 rsm_resolution=2048"},
};

}  // namespace

Settings settingsFromText(Settings base, std::string_view assignments)
{
    for (const std::string& word : split(assignments, " "))
        if (!word.empty()) applySetting(base, word);
    validate(base);
    return base;
}

std::vector<NamedSettings> operatingPoints()
{
    std::vector<NamedSettings> points;
    for (const Point& point : kPoints) points.push_back({std::string(point.name), settingsFromText(preset("balanced"), point.assignments)});
    return points;
}

}  // namespace lrsm
