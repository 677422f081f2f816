#pragma once

#include "core/imageio/image_io.h"
#include "core/report/comparison.h"
#include "reference/flip.h"
#include "reference/metrics.h"
#include "reference/ztest.h"

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

/// The comparison of one layer of two pictures: numbers, maps, and how they are shown.
namespace lrsm {

struct CompareSettings {
    std::optional<float> exposureStops;          ///< for LDR-FLIP, PSNR, SSIM and the pictures; nothing: from the reference
    std::optional<FlipExposures> flipExposures;  ///< for HDR-FLIP; nothing: from the reference
    double pixelsPerDegree = kFlipPixelsPerDegree;
    int regionColumns = 4, regionRows = 4;
    bool sceneReferred = true;  ///< false: display values in [0, 1] (PNG): exposure 0, no HDR-FLIP
};

struct LayerComparison {
    std::string layer;
    Metrics metrics;
    std::vector<RegionMetrics> regions;
    float exposureStops = 0.0f;
    double psnr = 0.0, ssim = 1.0;
    FlipPool flip;
    std::optional<FlipPool> hdrFlip;
    FlipExposures flipExposures;
    std::optional<double> band;           ///< bandError, when a side says what is flat
    std::optional<ZTest> pixelZ, blockZ;  ///< when the reference stores variances; blocks of 8 x 8 pixels

    Image<Vec3> referenceShown, testShown;  ///< linear, exposed, not clipped
    Image<float> absolute, signedError;     ///< luminance, over the reference's mean
    Image<float> flipMap;
};

/// `variance` of the difference, or nothing. Pixels that are not finite are shown black and counted.
LayerComparison compareLayer(const std::string& layer, const Image<Vec3>& reference, const Image<Vec3>& test, const std::optional<Image<Vec3>>& variance,
                             const PixelMask& valid, const CompareSettings& settings);

/// What a comparison may be held to by name; `value` is nothing where a comparison does not have it (zrms without variance).
struct MetricInfo {
    std::string name, meaning;
    std::optional<double> (*value)(const LayerComparison& comparison);
    bool largerIsBetter = false;
};
const std::vector<MetricInfo>& metricInfos();

nlohmann::ordered_json comparisonJson(const LayerComparison& comparison);
ComparedLayer comparisonSection(const LayerComparison& comparison);

struct NamedPicture {
    std::string name;
    Image<Rgb8> picture;
};
/// reference, test, error, signed, flip.
std::vector<NamedPicture> comparisonPictures(const LayerComparison& comparison);

}  // namespace lrsm
