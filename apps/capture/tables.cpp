#include "apps/capture/tables.h"

#include "apps/capture/picture_buffers.h"
#include "apps/capture/tolerances.h"
#include "conetrace/caches/gather.h"
#include "conetrace/frame/lobe.h"
#include "conetrace/frame/specular_albedo.h"
#include "conetrace/proxies/march.h"
#include "conetrace/vct/gather.h"

#include <algorithm>
#include <cstring>

namespace lrsm {

namespace {

constexpr int kPattern = 4;  ///< edge of the square of pixels over which directions alternate
constexpr std::size_t kStepColumns = 10;

template <class T>
Table tableOf(std::string name, Dtype dtype, std::vector<std::size_t> shape, const std::vector<T>& values)
{
    Table table{std::move(name), dtype, std::move(shape), std::vector<std::byte>(values.size() * sizeof(T))};
    if (!values.empty()) std::memcpy(table.bytes.data(), values.data(), table.bytes.size());
    return table;
}

Table rotations(Rotation rotation)
{
    std::vector<std::uint8_t> pattern;
    for (int y = 0; y < kPattern; ++y)
        for (int x = 0; x < kPattern; ++x) pattern.push_back(static_cast<std::uint8_t>(rotationOfPixel(x, y, rotation)));
    return tableOf("tables.rotation", Dtype::u1, {kPattern, kPattern}, pattern);
}

void addSchedules(CaptureTables& tables)
{
    std::vector<const MarchSchedule*> all;
    for (const MarchSchedule& schedule : tables.plan.ringSchedules) all.push_back(&schedule);
    for (const MarchSchedule& schedule : tables.plan.specularSchedules) all.push_back(&schedule);

    std::size_t longest = 0;
    for (const MarchSchedule* schedule : all) longest = std::max(longest, schedule->steps.size());
    std::vector<float> values(all.size() * longest * kStepColumns, 0.0f);
    std::vector<std::uint32_t> counts;
    for (std::size_t s = 0; s < all.size(); ++s) {
        counts.push_back(static_cast<std::uint32_t>(all[s]->steps.size()));
        float* row = values.data() + s * longest * kStepColumns;
        for (const MarchStep& step : all[s]->steps)
            for (const float value : {step.middle, step.begin, step.end, step.diameter, step.level, step.tapWidth, step.readVoxels ? 1.0f : 0.0f, step.settled,
                                      static_cast<float>(step.taps), static_cast<float>(step.firstTap)})
                *row++ = value;
    }
    tables.schedules = tableOf("tables.schedules", Dtype::f4, {all.size(), longest, kStepColumns}, values);
    tables.steps = tableOf("tables.schedule_steps", Dtype::u4, {all.size()}, counts);
}

/// The method's own.
GatherPlan planOf(const Requirements& needs, const Settings& settings)
{
    switch (settings.method) {
    case Method::vct: return planVct(settings.cones, needs, settings.voxel.resolution);
    case Method::caches: return planCaches(settings.caches, settings.cones, settings.voxel.resolution);
    case Method::proxies: {
        GatherPlan rays;
        rays.cones = shadowRays(settings.proxies);
        return rays;
    }
    case Method::ism: return {};
    case Method::lrsm: break;
    }
    return planGather(settings.cones, needs, settings.voxel.resolution);
}

}  // namespace

CaptureTables makeTables(const Requirements& needs, const Settings& settings)
{
    CaptureTables tables;
    tables.plan = planOf(needs, settings);
    tables.phi = NormalCdf(settings.cones.gather.gaussian, settings.cones.gather.gaussianTableSize);
    const auto cones = static_cast<std::size_t>(tables.plan.cones.count);
    tables.directions = tableOf("tables.cone_directions", Dtype::f4, {kRotations, cones, 3}, tables.plan.cones.directions);
    const bool always = settings.method == Method::proxies || settings.method == Method::ism;
    tables.rotation = rotations(always ? Rotation::strata : settings.cones.set.rotation);
    addSchedules(tables);
    if (settings.method == Method::caches) {
        const CacheTables caches = makeCacheTables(settings.caches, settings.cones.set.rotation);
        const auto n = std::size_t(caches.resolution);
        tables.cosineShare = tableOf("tables.rc_cosine_share", Dtype::f4, {kDiffuseNodes, kDiffuseNodes, n, n}, caches.cosineShare);
        tables.solidAngle = tableOf("tables.rc_solid_angle", Dtype::f4, {n, n}, caches.solidAngle[0]);
    }
    if (const std::vector<float>& phi = tables.phi.table(); !phi.empty()) tables.gaussian = tableOf("tables.gaussian", Dtype::f4, {phi.size()}, phi);
    if (needs.specular)
        tables.specularAlbedo =
            tableOf("tables.specular_albedo", Dtype::f4, {SpecularAlbedo::kRoughnessSize, SpecularAlbedo::kCosineSize, 2}, SpecularAlbedo().table());
    if (needs.specular && samplesLobes(settings)) {
        const auto points = lobePoints();
        tables.lobePoints = tableOf("tables.lobe_points", Dtype::f4, {kRotations, 3}, std::vector<LobePoint>(points.begin(), points.end()));
    }
    return tables;
}

void describeTables(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const CaptureTables tables = makeTables(frame.needs, frame.settings);
    const auto rows = [&](const Table& t, const Catalogue::Names& axes, const Catalogue::Names& components, const Catalogue::Text& text) {
        if (!t.bytes.empty()) out.add(t.name, t.dtype, {t.shape.begin(), t.shape.begin() + std::ssize(axes)}, axes, components, text, tolerances::kGiven);
    };
    rows(tables.directions, {"rotation", "cone"}, {"x", "y", "z"}, {"axes of the diffuse cones, unit", "tangent frame, z along the normal", ""});
    rows(tables.rotation, {"row", "column"}, {}, {"rotation of the pixel at (row & 3, column & 3)", "", ""});
    rows(tables.schedules, {"schedule", "step"}, {"middle", "begin", "end", "diameter", "level", "tap_width", "reads_voxels", "settled", "taps", "first_tap"},
         {"where a cone takes its samples; rows of 0 after the last step", "along the cone from its apex", "base voxels"});
    rows(tables.steps, {"schedule"}, {}, {"steps of each schedule", "", ""});
    rows(tables.gaussian, {"entry"}, {}, {"Phi over [-5, 5], linear between entries", "", ""});
    rows(tables.cosineShare, {"node_row", "node_column", "row", "column"}, {},
         {"share of each texel of a cache in the irradiance of a node's normal", "cache", ""});
    rows(tables.solidAngle, {"row", "column"}, {}, {"of a cache's texels", "cache", "sr"});
    rows(tables.lobePoints, {"rotation"}, {"x", "y", "weight"}, {"points of the specular lobe: in the unit disk of visible normals", "", ""});
    rows(tables.specularAlbedo, {"roughness", "root_n_dot_v"}, {"scale", "bias"},
         {"directional albedo of the lobe = F0 scale + bias; over roughness and sqrt(n.v), both 0 .. 1", "", ""});
}

}  // namespace lrsm
