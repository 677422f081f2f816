#include "conetrace/frame/smooth_irradiance.h"

#include "conetrace/frame/same_surface.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lrsm {
namespace {

constexpr int kFirstSpacing = 4;  ///< pixels: the width of filterIrradiance
constexpr int kHorizonSteps[] = {2, 4, 8, 16, 32, 64, 128, 256};
constexpr int kHorizonDirections[8][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};

float nearnessAlong(const GBuffer& gbuffer, int x, int y, const int (&direction)[2])
{
    const std::size_t centre = gbuffer.position.index(x, y);
    const Vec3 position = gbuffer.position.texels[centre], normal = gbuffer.geometricNormal.texels[centre];
    float sum = 0.0f, horizon = kSamePlaneSlope;  // what is lower may be the surface itself
    for (const int step : kHorizonSteps) {
        const int nx = x + direction[0] * step, ny = y + direction[1] * step;
        if (!inPicture(gbuffer, nx, ny)) break;
        const std::size_t neighbour = gbuffer.position.index(nx, ny);
        if (!gbuffer.covered(neighbour)) continue;
        const Vec3 between = gbuffer.position.texels[neighbour] - position;
        const float distance = std::sqrt(glm::dot(between, between)), sine = glm::dot(between, normal) / distance;
        if (!(sine > horizon)) continue;
        sum += (sine * sine - horizon * horizon) / distance;
        horizon = sine;
    }
    return sum;
}

Vec3 smoothPixel(const Image<Vec3>& irradiance, const GBuffer& gbuffer, const Image<float>& nearness, int x, int y, int spacing)
{
    const std::size_t centre = irradiance.index(x, y);
    Vec3 sum(0.0f);
    float total = 0.0f;
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
            const int nx = x + i * spacing, ny = y + j * spacing;
            if (!inPicture(gbuffer, nx, ny)) continue;
            const std::size_t neighbour = irradiance.index(nx, ny);
            float weight = (i == 0 ? 1.0f : 0.5f) * (j == 0 ? 1.0f : 0.5f);
            if (neighbour != centre) {
                if (!sameSurface(gbuffer, centre, neighbour)) continue;
                const Vec3 between = gbuffer.position.texels[neighbour] - gbuffer.position.texels[centre];
                const float change = std::sqrt(glm::dot(between, between)) * std::max(nearness.texels[centre], nearness.texels[neighbour]);
                weight *= std::max(0.0f, 1.0f - change / kGradientTolerance);
            }
            sum += weight * irradiance.texels[neighbour];
            total += weight;
        }
    return sum / total;
}

}  // namespace

Image<float> nearnessOf(const GBuffer& gbuffer)
{
    Image<float> nearness(gbuffer.width, gbuffer.height);
    forCovered(gbuffer, [&](int x, int y) {
        float sum = 0.0f;
        for (const auto& direction : kHorizonDirections) sum += nearnessAlong(gbuffer, x, y, direction);
        nearness.at(x, y) = sum / float(std::size(kHorizonDirections));
    });
    return nearness;
}

Image<Vec3> smoothIrradiance(const Image<Vec3>& irradiance, const GBuffer& gbuffer, int passes)
{
    const Image<float> nearness = nearnessOf(gbuffer);
    Image<Vec3> from = irradiance;
    for (int pass = 0; pass < passes; ++pass) {
        Image<Vec3> to(irradiance.width, irradiance.height);
        forCovered(gbuffer, [&](int x, int y) { to.at(x, y) = smoothPixel(from, gbuffer, nearness, x, y, kFirstSpacing << pass); });
        from = std::move(to);
    }
    return from;
}

}  // namespace lrsm
