#include "apps/compare/compare_layer.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kZBlock = 8;          // pixels along a side of the z-test's blocks
constexpr float kHeatLimit = 1.0f;  // error maps end at one mean of the reference

std::string number(double value)
{
    return numberText(4, value);
}

/// As a display shows it: clipped and sRGB encoded, in [0, 1].
Image<Vec3> displayed(const Image<Vec3>& picture)
{
    Image<Vec3> result = picture;
    for (Vec3& v : result.texels)
        for (int c = 0; c < 3; ++c) {
            const float x = std::clamp(v[c], 0.0f, 1.0f);
            v[c] = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
        }
    return result;
}

Json poolJson(const FlipPool& pool)
{
    return {{"mean", pool.mean},
            {"weighted_median", pool.weightedMedian},
            {"weighted_quartiles", {pool.firstWeightedQuartile, pool.thirdWeightedQuartile}},
            {"min", pool.min},
            {"max", pool.max}};
}

Json zJson(const ZTest& z)
{
    return {{"values", z.values},
            {"rms", z.rms},
            {"largest", z.largest},
            {"beyond_3", z.beyond3},
            {"p_value", z.pValue},
            {"noise_rmse_over_mean", z.noise},
            {"differ_without_variance", z.certain}};
}

Json finite(double value)
{
    return std::isfinite(value) ? Json(value) : Json(value > 0 ? "inf" : value < 0 ? "-inf" : "nan");
}

double worstChannelEnergy(const LayerComparison& c)
{
    double worst = 0.0;
    for (const double ratio : c.metrics.channelRatio) worst = std::max(worst, std::abs(ratio - 1.0));
    return worst;
}

double worstRegionEnergy(const LayerComparison& c)
{
    double light = 0.0, worst = 0.0;
    for (const RegionMetrics& region : c.regions) light += region.meanReference * double(region.pixels);
    for (const RegionMetrics& region : c.regions)
        if (region.meanReference * double(region.pixels) >= 0.01 * light && region.pixels > 0) worst = std::max(worst, std::abs(region.energyRatio - 1.0));
    return worst;
}

double worstRegionRmse(const LayerComparison& c)
{
    double worst = 0.0;
    for (const RegionMetrics& region : c.regions) worst = std::max(worst, region.rmse);
    return worst;
}

}  // namespace

LayerComparison compareLayer(const std::string& layer, const Image<Vec3>& reference, const Image<Vec3>& test, const std::optional<Image<Vec3>>& variance,
                             const PixelMask& valid, const CompareSettings& settings)
{
    LayerComparison result;
    result.layer = layer;
    result.metrics = measure(reference, test, valid);
    result.regions = measureRegions(reference, test, splitRegions(reference.width, reference.height, settings.regionColumns, settings.regionRows), valid);

    result.exposureStops = settings.exposureStops ? *settings.exposureStops : settings.sceneReferred ? automaticExposure(reference) : 0.0f;
    result.referenceShown = exposed(reference, result.exposureStops);
    result.testShown = exposed(test, result.exposureStops);
    const Image<Vec3> referenceDisplay = displayed(result.referenceShown), testDisplay = displayed(result.testShown);
    result.psnr = psnr(referenceDisplay, testDisplay);
    result.ssim = ssim(referenceDisplay, testDisplay);
    result.flipMap = flip(result.referenceShown, result.testShown, settings.pixelsPerDegree);
    result.flip = poolFlip(result.flipMap);
    if (settings.sceneReferred) {
        result.flipExposures = settings.flipExposures ? *settings.flipExposures : automaticFlipExposures(reference);
        result.hdrFlip = poolFlip(hdrFlip(reference, test, result.flipExposures, settings.pixelsPerDegree));
    }
    if (variance) {
        result.pixelZ = zTest(reference, test, *variance, valid);
        const BlockMeans blocks = averageBlocks(reference, test, *variance, kZBlock, valid);
        result.blockZ = zTest(blocks.reference, blocks.test, blocks.variance);
    }

    const auto mean = float(result.metrics.meanReference);
    result.absolute = result.signedError = Image<float>(reference.width, reference.height);
    for (std::size_t i = 0; i < reference.texels.size(); ++i) {
        const float difference = luminance(test.texels[i]) - luminance(reference.texels[i]);
        result.signedError.texels[i] = mean > 0.0f ? difference / mean : difference;
        result.absolute.texels[i] = std::abs(result.signedError.texels[i]);
    }
    return result;
}

const std::vector<MetricInfo>& metricInfos()
{
    using C = LayerComparison;
    using Value = std::optional<double>;
    static const std::vector<MetricInfo> all = {
        {"energy", "|sum test / sum reference - 1|", [](const C& c) -> Value { return std::abs(c.metrics.energyRatio - 1.0); }},
        {"channel_energy", "the same, worst of red, green and blue", [](const C& c) -> Value { return worstChannelEnergy(c); }},
        {"region_energy", "the same, worst region that holds at least 1 % of the light", [](const C& c) -> Value { return worstRegionEnergy(c); }},
        {"rmse", "RMSE / mean reference", [](const C& c) -> Value { return c.metrics.rmse; }},
        {"mae", "MAE / mean reference", [](const C& c) -> Value { return c.metrics.mae; }},
        {"relmse", "relative mean square error, worst 0.1 % trimmed", [](const C& c) -> Value { return c.metrics.relMse; }},
        {"largest", "largest |difference| / mean reference", [](const C& c) -> Value { return c.metrics.largest; }},
        {"region_rmse", "RMSE / mean reference of the worst region", [](const C& c) -> Value { return worstRegionRmse(c); }},
        {"psnr", "dB, of the pictures as shown", [](const C& c) -> Value { return c.psnr; }, true},
        {"ssim", "of the pictures as shown", [](const C& c) -> Value { return c.ssim; }, true},
        {"dssim", "1 - ssim", [](const C& c) -> Value { return 1.0 - c.ssim; }},
        {"flip", "mean LDR-FLIP", [](const C& c) -> Value { return c.flip.mean; }},
        {"flip_max", "largest LDR-FLIP", [](const C& c) -> Value { return c.flip.max; }},
        {"hdr_flip", "mean HDR-FLIP (not for PNG)", [](const C& c) { return c.hdrFlip ? Value(c.hdrFlip->mean) : Value(); }},
        {"zrms", "root mean square of z over pixels (reference with variance)", [](const C& c) { return c.pixelZ ? Value(c.pixelZ->rms) : Value(); }},
        {"zmax", "largest |z| of a pixel", [](const C& c) { return c.pixelZ ? Value(c.pixelZ->largest) : Value(); }},
        {"block_zrms", "root mean square of z over blocks of 8 x 8 pixels", [](const C& c) { return c.blockZ ? Value(c.blockZ->rms) : Value(); }},
        {"band", "stripes and blotches on flat parts: RMS of the error's 3 x 3 mean less its 17 x 17 mean, over the mean there",
         [](const C& c) { return c.band; }},
        {"nan", "pixels with NaN or infinity", [](const C& c) -> Value { return double(c.metrics.notFiniteTest + c.metrics.notFiniteReference); }},
    };
    return all;
}

Json comparisonJson(const LayerComparison& c)
{
    const Metrics& m = c.metrics;
    Json json = {{"layer", c.layer},
                 {"pixels", m.pixels},
                 {"not_finite_test", m.notFiniteTest},
                 {"not_finite_reference", m.notFiniteReference},
                 {"mean_reference", m.meanReference},
                 {"mean_test", m.meanTest},
                 {"energy_ratio", finite(m.energyRatio)},
                 {"channel_ratio", {finite(m.channelRatio[0]), finite(m.channelRatio[1]), finite(m.channelRatio[2])}},
                 {"rmse_over_mean", finite(m.rmse)},
                 {"mae_over_mean", finite(m.mae)},
                 {"relmse", finite(m.relMse)},
                 {"largest_over_mean", finite(m.largest)},
                 {"exposure_stops", c.exposureStops},
                 {"psnr", finite(c.psnr)},
                 {"ssim", c.ssim},
                 {"flip", poolJson(c.flip)}};
    if (c.hdrFlip) {
        json["hdr_flip"] = poolJson(*c.hdrFlip);
        json["hdr_flip"]["exposures"] = {{"start", c.flipExposures.start}, {"stop", c.flipExposures.stop}, {"count", c.flipExposures.count}};
    }
    if (c.band) json["band_over_mean"] = *c.band;
    if (c.pixelZ) json["z_pixels"] = zJson(*c.pixelZ);
    if (c.blockZ) json["z_blocks"] = zJson(*c.blockZ);
    json["regions"] = Json::array();
    for (const RegionMetrics& r : c.regions)
        json["regions"].push_back({{"x", {r.region.x0, r.region.x1}},
                                   {"y", {r.region.y0, r.region.y1}},
                                   {"pixels", r.pixels},
                                   {"mean_reference", r.meanReference},
                                   {"energy_ratio", finite(r.energyRatio)},
                                   {"rmse_over_mean", finite(r.rmse)},
                                   {"mae_over_mean", finite(r.mae)}});
    return json;
}

std::vector<NamedPicture> comparisonPictures(const LayerComparison& c)
{
    return {{"reference", tonemap(c.referenceShown, 0.0f)},
            {"test", tonemap(c.testShown, 0.0f)},
            {"error", falseColor(c.absolute, 0.0f, kHeatLimit)},
            {"signed", signedFalseColor(c.signedError, kHeatLimit)},
            {"flip", falseColor(c.flipMap, 0.0f, 1.0f)}};
}

ComparedLayer comparisonSection(const LayerComparison& c)
{
    const std::vector<NamedPicture> pictures = comparisonPictures(c);
    const auto encoded = [&](std::size_t i, const std::string& title) { return ReportPicture{title, encodePng(pictures[i].picture)}; };
    ComparedLayer section;
    section.title = "Layer " + (c.layer.empty() ? "RGB" : c.layer);
    section.reference = encoded(0, "reference");
    section.test = encoded(1, "test");
    section.maps = {encoded(2, "|error| of the luminance: dark blue 0, yellow one mean of the reference or more"),
                    encoded(3, "signed error: red too bright, blue too dark, full colour at one mean of the reference"),
                    encoded(4, "FLIP: dark blue 0, yellow 1")};

    const Metrics& m = c.metrics;
    ReportTable numbers{"Numbers (exposure " + number(c.exposureStops) + " stops)", {"metric", "value"}, {}};
    numbers.rows = {{"energy ratio (test / reference)", number(m.energyRatio)},
                    {"energy ratio of red, green, blue", number(m.channelRatio[0]) + ", " + number(m.channelRatio[1]) + ", " + number(m.channelRatio[2])},
                    {"RMSE / mean", number(m.rmse)},
                    {"MAE / mean", number(m.mae)},
                    {"relMSE, worst 0.1 % trimmed", number(m.relMse)},
                    {"PSNR as shown", number(c.psnr) + " dB"},
                    {"SSIM as shown", number(c.ssim)},
                    {"FLIP mean / weighted median / max", number(c.flip.mean) + " / " + number(c.flip.weightedMedian) + " / " + number(c.flip.max)}};
    if (c.hdrFlip)
        numbers.rows.push_back({"HDR-FLIP mean / weighted median / max, " + std::to_string(c.flipExposures.count) + " exposures " +
                                    number(c.flipExposures.start) + " .. " + number(c.flipExposures.stop),
                                number(c.hdrFlip->mean) + " / " + number(c.hdrFlip->weightedMedian) + " / " + number(c.hdrFlip->max)});
    if (c.pixelZ) {
        numbers.rows.push_back({"the truth's own noise: RMSE / mean", number(c.pixelZ->noise)});
        numbers.rows.push_back(
            {"z per pixel: rms, largest, share beyond 3", number(c.pixelZ->rms) + ", " + number(c.pixelZ->largest) + ", " + number(c.pixelZ->beyond3)});
        numbers.rows.push_back({"z per block of 8 x 8 pixels: rms, largest", number(c.blockZ->rms) + ", " + number(c.blockZ->largest)});
    }
    numbers.rows.push_back({"pixels compared", std::to_string(m.pixels)});
    numbers.rows.push_back({"pixels with NaN or infinity: test, reference", std::to_string(m.notFiniteTest) + ", " + std::to_string(m.notFiniteReference)});

    ReportTable regions{"Regions (errors over the mean of the whole reference)", {"x", "y", "mean reference", "energy ratio", "RMSE", "MAE"}, {}};
    for (const RegionMetrics& r : c.regions)
        regions.rows.push_back({std::to_string(r.region.x0) + " .. " + std::to_string(r.region.x1),
                                std::to_string(r.region.y0) + " .. " + std::to_string(r.region.y1), number(r.meanReference),
                                r.pixels ? number(r.energyRatio) : "-", number(r.rmse), number(r.mae)});
    section.tables = {numbers, regions};
    return section;
}

}  // namespace lrsm
