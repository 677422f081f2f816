#pragma once

#include "apps/sweep/measurement.h"
#include "core/settings/settings_table.h"

#include <cmath>
#include <string>
#include <vector>

/// A sweep whose every figure follows from a formula: scene s has errors (s + 1) times those of scene 0 and costs (s + 2) times.
namespace lrsm::test {

constexpr double kUnit = 10.0;  ///< ms of a calibration frame
constexpr double kNoise = 0.001;

/// `net` is what PictureError::net() gives back.
inline Measurement syntheticRow(int scene, const std::string& label, RowKind kind, double net, double cost, std::size_t bytes)
{
    Measurement row;
    row.scene = "scene" + std::to_string(scene);
    row.caseKey = "000000000000000" + std::to_string(scene);
    row.key = row.caseKey + "-" + label;
    row.label = label;
    row.kind = kind;
    row.width = 320;
    row.height = 180;
    row.truthSamples = 1024;
    row.error.noise = kNoise * (scene + 1);
    row.error.rmse = std::hypot(net * (scene + 1), row.error.noise);
    row.error.mae = 0.7 * row.error.rmse;
    row.error.flip = 0.5 * row.error.rmse;
    row.error.energy = 1.0 - 0.1 * net;
    row.cost = cost * (scene + 2);
    row.calibrationCpu = kUnit;
    row.frameCpu = row.cost * kUnit;
    row.frame = {0.6 * row.frameCpu, 0.6 * row.frameCpu, 0.0};
    row.bytes = bytes;
    row.gpuBytes = bytes / 2;
    row.irradianceSha256 = row.key;
    return row;
}

inline Measurement syntheticAxis(int scene, const std::string& assignment, double net, double cost, std::size_t bytes)
{
    Measurement row = syntheticRow(scene, assignment, RowKind::axis, net, cost, bytes);
    row.base = "balanced";
    applySetting(row.settings, assignment);
    return row;
}

/// The path tracer errs 0.8 / sqrt(spp) and costs 0.5 spp.
inline Measurement syntheticTracer(int scene, std::uint64_t samples)
{
    const double spp = static_cast<double>(samples);
    Measurement row = syntheticRow(scene, "path tracer " + std::to_string(samples) + " spp", RowKind::pathTracer, 0.8 / std::sqrt(spp), 0.5 * spp, 0);
    row.samples = samples;
    return row;
}

/// balanced (0.1, 4), fast (0.2, 1), accurate (0.05, 16) and one value of each kind around balanced.
inline std::vector<Measurement> syntheticSweep(int scenes)
{
    std::vector<Measurement> rows;
    for (int s = 0; s < scenes; ++s) {
        rows.push_back(syntheticRow(s, "balanced", RowKind::preset, 0.1, 4.0, 100'000'000));
        rows.push_back(syntheticRow(s, "fast", RowKind::preset, 0.2, 1.0, 50'000'000));
        rows.back().settings = preset("fast");
        rows.push_back(syntheticRow(s, "accurate", RowKind::preset, 0.05, 16.0, 400'000'000));
        rows.back().settings = preset("accurate");
        rows.push_back(syntheticAxis(s, "cone_count=12", 0.08, 8.0, 100'000'000));         // buys 20 % for 4 units
        rows.push_back(syntheticAxis(s, "cone_count=9", 0.09, 5.0, 100'000'000));          // buys 10 % for 1 unit
        rows.push_back(syntheticAxis(s, "cone_count=4", 0.15, 3.0, 100'000'000));          // pays 50 % for 1 unit
        rows.push_back(syntheticAxis(s, "voxel_resolution=256", 0.11, 2.0, 20'000'000));   // pays 10 % for 2 units
        rows.push_back(syntheticAxis(s, "mip_filter=max", 0.3, 4.5, 100'000'000));         // loses both
        rows.push_back(syntheticAxis(s, "voxel_storage=float32", 0.1, 4.4, 200'000'000));  // no gain
        rows.push_back(syntheticAxis(s, "density_k=1", 0.1, 4.04, 100'000'000));           // not one bit
        rows.back().irradianceSha256 = rows[rows.size() - 10].irradianceSha256;            // balanced's
        rows.push_back(syntheticAxis(s, "step=0.25", 0.07, 3.9, 100'000'000));             // wins both
        for (std::uint64_t spp = 1; spp <= 1024; spp *= 2) rows.push_back(syntheticTracer(s, spp));
    }
    return rows;
}

}  // namespace lrsm::test
