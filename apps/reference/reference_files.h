#pragma once

#include "core/base/output_folder.h"
#include "reference/checkpoint.h"

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

/// The files of a reference: image.exr (means, variances of the means, what the eye sees), PNGs, frame.json, samples.bin (exact sums).
namespace lrsm {

inline constexpr const char* kSamplesFile = "samples.bin";
inline constexpr const char* kSpecularPicture = "indirect.specular.png";  ///< not written where it would be black

/// What the picture shows besides light: taken from the tracer, or from image.exr when ranges are merged.
struct SeenLayers {
    Image<Vec3> direct, albedo, normal, position;
    Image<float> depth;
};
SeenLayers seenLayers(const Scene& scene, const PrimaryHits& primary);
/// From image.exr of another reference. Throws InputError.
SeenLayers readSeenLayers(const std::string& exrPath);

/// "A:B", A < B.
SampleRange parseSamples(const std::string& text);
/// "0:64, 128:256"
std::string describeRanges(const std::vector<SampleRange>& ranges);

/// Sums to files, and the picture that is in them; the EXR holds no time and no path, so equal samples give equal bytes.
ReferenceFrame writeReference(OutputFolder& folder, const Checkpoint& checkpoint, const SeenLayers& seen, const nlohmann::ordered_json& json,
                              std::optional<float> exposureStops);

}  // namespace lrsm
