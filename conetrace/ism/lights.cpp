#include "conetrace/ism/lights.h"

#include "core/base/parallel.h"
#include "lrsm/texel_area.h"

namespace lrsm {
namespace {

constexpr std::size_t kTexelsPerTask = 8192;
constexpr float kLeastNormal = 1e-6f;

float luminanceOf(const Vec3& radiance)
{
    return glm::dot(radiance, Vec3(0.2126f, 0.7152f, 0.0722f));
}

/// Sums of the distribution up to and with each texel.
std::vector<double> cumulated(const Rsm& rsm, IsmSampling sampling, double before)
{
    std::vector<double> sums(rsm.texels.texels.size());
    parallelFor(sums.size(), kTexelsPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const RsmTexel& texel = rsm.texels.texels[i];
            const float brightness = texel.coverage > 0.0f && glm::length(texel.normal) > kLeastNormal ? luminanceOf(texel.radiance) : 0.0f;
            sums[i] = !(brightness > 0.0f) ? 0.0 : sampling == IsmSampling::uniform ? 1.0 : double(brightness) * double(texelArea(rsm, i));
        }
    });
    for (double& sum : sums) {
        before += sum;
        sum = before;
    }
    return sums;
}

VirtualLight lightAt(const Rsm& rsm, std::size_t texel, double share, int count)
{
    const RsmTexel& at = rsm.texels.texels[texel];
    VirtualLight light;
    light.position = texelPosition(rsm, texel);
    light.frame = basisFromNormal(glm::normalize(at.normal));
    light.area = static_cast<float>(double(texelArea(rsm, texel)) / (share * count));
    light.intensity = at.radiance * light.area;
    return light;
}

}  // namespace

VirtualLights drawLights(const std::vector<Rsm>& rsms, const IsmSettings& settings)
{
    VirtualLights out;
    std::vector<std::vector<double>> sums;
    double total = 0.0;
    for (const Rsm& rsm : rsms) {
        out.preExposure = rsm.preExposure;
        sums.push_back(cumulated(rsm, settings.sampling, total));
        if (!sums.back().empty()) total = sums.back().back();
    }
    if (!(total > 0.0)) return out;

    std::size_t map = 0, texel = 0;
    for (int i = 0; i < settings.lights; ++i) {
        const double quantile = (i + 0.5) / settings.lights * total;
        while (!(sums[map][texel] > quantile))
            if (++texel == sums[map].size()) ++map, texel = 0;
        const double before = texel > 0 ? sums[map][texel - 1] : map > 0 ? sums[map - 1].back() : 0.0;
        out.lights.push_back(lightAt(rsms[map], texel, (sums[map][texel] - before) / total, settings.lights));
    }
    return out;
}

}  // namespace lrsm
