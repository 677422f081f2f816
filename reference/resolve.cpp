#include "core/base/parallel.h"
#include "reference/path_trace.h"
#include "reference/sample_layout.h"

namespace lrsm {
namespace {

/// Reads means and variances of three values in a row.
struct ColorReader {
    const SampleSums& sums;
    double unit;
    bool variance;

    void read(std::size_t pixel, int channel, Image<Vec3>& mean, Image<Vec3>& spread) const
    {
        for (int c = 0; c < 3; ++c) {
            const Estimate e = estimate(sums, pixel * std::size_t(sums.channels) + std::size_t(channel + c));
            mean.texels[pixel][c] = float(e.mean * unit);
            if (variance) spread.texels[pixel][c] = float(e.variance * unit * unit);
        }
    }
};

}  // namespace

ReferenceFrame resolveFrame(const SampleSums& sums, double unit, const Image<Vec3>& direct, const Image<Vec3>& albedo)
{
    const bool variance = sums.completeBlocks >= 2, lobe = sums.channels > kDiffuseChannels, cone = sums.channels == kConeChannels;
    const auto picture = [&](bool wanted) { return wanted ? Image<Vec3>(direct.width, direct.height) : Image<Vec3>(); };
    ReferenceFrame frame;
    frame.samples = sums.sampleCount();
    frame.direct = direct;
    frame.irradiance = frame.indirectDiffuse = frame.indirectSpecular = frame.combined = picture(true);
    frame.irradianceVariance = frame.indirectDiffuseVariance = frame.indirectSpecularVariance = frame.combinedVariance = picture(variance);
    frame.specularCone = picture(cone);
    frame.specularConeVariance = picture(cone && variance);
    frame.opacity = Image<float>(direct.width, direct.height);
    if (variance) frame.opacityVariance = frame.opacity;
    if (frame.samples == 0) return frame;

    const ColorReader reader{sums, unit, variance};
    parallelFor(direct.texels.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            reader.read(i, kIrradiance, frame.irradiance, frame.irradianceVariance);
            if (lobe) reader.read(i, kLobe, frame.indirectSpecular, frame.indirectSpecularVariance);
            if (cone) reader.read(i, kCone, frame.specularCone, frame.specularConeVariance);
            const Estimate open = estimate(sums, i * std::size_t(sums.channels) + kOpacity);
            frame.opacity.texels[i] = float(open.mean);

            const Vec3 reflectance = albedo.texels[i] / kPi;
            frame.indirectDiffuse.texels[i] = reflectance * frame.irradiance.texels[i];
            frame.combined.texels[i] = direct.texels[i] + frame.indirectDiffuse.texels[i] + frame.indirectSpecular.texels[i];
            if (!variance) continue;
            frame.opacityVariance.texels[i] = float(open.variance);
            frame.indirectDiffuseVariance.texels[i] = reflectance * reflectance * frame.irradianceVariance.texels[i];
            // The two lobes are sampled independently.
            frame.combinedVariance.texels[i] = frame.indirectDiffuseVariance.texels[i] + frame.indirectSpecularVariance.texels[i];
        }
    });
    return frame;
}

}  // namespace lrsm
