#pragma once

#include "conetrace/render.h"

#include <cstdint>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

/// One row of a sweep: what was rendered, how far from the truth it is, and what it cost.
namespace lrsm {

/// Of the repeats of one measurement. Spread: (largest - smallest) / median; 0 with one repeat.
struct RepeatedTime {
    double median = 0.0, min = 0.0, spread = 0.0;  ///< median and min in milliseconds
};
RepeatedTime summarize(std::vector<double> milliseconds);

/// On the layer `irradiance`, over the pixels that show a surface. All over the mean of the truth.
struct PictureError {
    double energy = 1.0;  ///< sum of the picture over sum of the truth
    double rmse = 0.0;    ///< as measured, the truth's noise included
    double mae = 0.0;
    double flip = 0.0;   ///< mean LDR-FLIP at the exposure chosen from the truth
    double noise = 0.0;  ///< RMSE of the truth itself, from its stored variance: no rmse below it means anything
    /// sqrt(rmse^2 - noise^2), and never below the noise floor's own uncertainty, `noise` / 4: what is claimed.
    double net() const;
};

/// One family of passes in a row: its column is FAMILY_ms, spaces as underscores.
struct PassTime {
    std::string family;     ///< passFamily: "rsm" for "rsm 0", "rsm 1", ...
    bool perPixel = false;  ///< work grows with the picture
    RepeatedTime time;
};

enum class RowKind {
    preset,     ///< a preset as it is
    axis,       ///< one or more settings taken from axes
    search,     ///< visited by the front search
    pathTracer  ///< the honest alternative: `samples` paths a pixel
};

/// "preset", "axis", "search", "path_tracer".
const char* rowKindName(RowKind kind);

/// Where a row's thumbnail is: thumbnails/<key>.png beside the rows.
struct Measurement {
    std::string scene;    ///< name shown: built-in or stem of the file
    std::string caseKey;  ///< 16 hex digits of scene, camera, size, truth: rows of one case are comparable
    std::string key;      ///< 16 hex digits of the case, settings, samples and version: no two rows of a sweep share it
    std::string label;    ///< "balanced", "cone_count=4", "path tracer 16 spp"; what to call it
    RowKind kind = RowKind::axis;
    std::string base;           ///< preset that the axis was laid around; empty otherwise
    std::uint64_t samples = 0;  ///< paths a pixel of the path tracer; 0: LRSM
    Settings settings;          ///< of an LRSM row
    int width = 0, height = 0;
    std::uint64_t truthSamples = 0;  ///< paths a pixel of the truth

    PictureError error;

    RepeatedTime frame;                   ///< wall time of all passes
    double frameCpu = 0.0;                ///< median processor time of all passes, all threads, ms
    std::vector<PassTime> passes;         ///< in the frame's order; the passes of a family summed
    double calibrationCpu = 0.0;          ///< processor time of the calibration frame run beside this row, ms
    double cost = 0.0;                    ///< frameCpu / calibrationCpu: time in calibration frames, the figure that carries between runs and machines
    Counters counters;                    ///< of one frame, by name, summed over its passes; none for the path tracer
    std::uint64_t rays = 0;               ///< path tracer
    std::size_t bytes = 0, gpuBytes = 0;  ///< of the resident passes (PassTraits) together, held; in the GPU's formats
    std::string irradianceSha256;         ///< equal hashes: equal bits
};

/// An object: scene, case, key, label, kind, base, spp, width, height, truth_spp, energy, rmse, net, mae, flip, noise, frame_ms, frame_ms_min,
/// frame_ms_spread, frame_cpu_ms, calibration_cpu_ms, cost, passes (an object of {ms, ms_min, ms_spread, per_pixel} by family), counters (an object),
/// rays, bytes, gpu_bytes, irradiance_sha256, then one entry a setting by its key (null for the path tracer).
/// Passes and counters are those that the frame reported: no list of them is anywhere.
/// Numbers that are not finite are null too; they read back as NaN. Reads back to the same bits.
nlohmann::ordered_json measurementJson(const Measurement& row);
/// What the columns of a family of passes begin with in tables: "voxel mips" -> "voxel_mips".
std::string passColumn(std::string family);

/// The same flat, for tables: a pass's three columns are FAMILY_ms, FAMILY_ms_min and FAMILY_ms_spread ("voxel_mips_ms"), a counter's is its name.
nlohmann::ordered_json measurementColumns(const Measurement& row);
/// Throws InputError beginning with `place`.
Measurement measurementFromJson(const nlohmann::ordered_json& json, const std::string& place);

}  // namespace lrsm
