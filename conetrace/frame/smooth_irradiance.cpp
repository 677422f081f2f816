#include "conetrace/frame/smooth_irradiance.h"

#include "conetrace/frame/same_surface.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lrsm {
namespace {

constexpr int kFirstSpacing = 4;  ///< pixels: the width of filterIrradiance
constexpr int kHorizonSteps[] = {2, 4, 8, 16, 32, 64, 128, 256};
constexpr int kDirections[8][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};

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

constexpr unsigned kOpposite = 4;  ///< from a direction to the other way

/// Bit d: the surface goes on from a pixel to the next of direction d, or, doubled, to the one `spacing` pixels away over all that lie between.
using Links = Image<std::uint8_t>;

template <class Linked>
Links linksWhere(const GBuffer& gbuffer, int spacing, const Linked& linked)
{
    Links links(gbuffer.width, gbuffer.height);
    forCovered(gbuffer, [&](int x, int y) {
        unsigned bits = 0;
        for (unsigned d = 0; d < std::size(kDirections); ++d) {
            const int nx = x + kDirections[d][0] * spacing, ny = y + kDirections[d][1] * spacing;
            if (inPicture(gbuffer, nx, ny) && linked(links.index(x, y), links.index(nx, ny), d)) bits |= 1u << d;
        }
        links.at(x, y) = static_cast<std::uint8_t>(bits);
    });
    return links;
}

Links adjacent(const GBuffer& gbuffer)
{
    return linksWhere(gbuffer, 1, [&](std::size_t here, std::size_t there, unsigned) { return sameSurface(gbuffer, here, there); });
}

Links doubled(const Links& links, const GBuffer& gbuffer, int spacing)
{
    return linksWhere(gbuffer, spacing,
                      [&](std::size_t here, std::size_t there, unsigned d) { return (links.texels[here] & links.texels[there] & (1u << d)) != 0; });
}

struct SmoothInput {
    const GBuffer& gbuffer;
    const Image<float>& nearness;
    const Links& links;
    int spacing;
};

/// Weight of a linked tap, 0 where it is not of the same surface.
float tapWeight(const SmoothInput& in, std::size_t centre, std::size_t neighbour, unsigned d)
{
    if (!sameSurface(in.gbuffer, centre, neighbour)) return 0.0f;
    const Vec3 between = in.gbuffer.position.texels[neighbour] - in.gbuffer.position.texels[centre];
    const float change = std::sqrt(glm::dot(between, between)) * std::max(in.nearness.texels[centre], in.nearness.texels[neighbour]);
    const float tent = kDirections[d][0] != 0 && kDirections[d][1] != 0 ? 0.25f : 0.5f;
    return tent * std::max(0.0f, 1.0f - change / kGradientTolerance);
}

Vec3 smoothPixel(const Image<Vec3>& irradiance, const SmoothInput& in, int x, int y)
{
    const std::size_t centre = irradiance.index(x, y);
    Vec3 sum = irradiance.texels[centre];
    float total = 1.0f;
    for (unsigned d = 0; d < kOpposite; ++d) {
        // Both or neither, so that a gradient keeps its value.
        const unsigned both = 1u << d | 1u << (d + kOpposite);
        if ((in.links.texels[centre] & both) != both) continue;
        const int dx = kDirections[d][0] * in.spacing, dy = kDirections[d][1] * in.spacing;
        const std::size_t ahead = irradiance.index(x + dx, y + dy), behind = irradiance.index(x - dx, y - dy);
        const float weight = std::min(tapWeight(in, centre, ahead, d), tapWeight(in, centre, behind, d));
        sum += weight * (irradiance.texels[ahead] + irradiance.texels[behind]);
        total += 2.0f * weight;
    }
    return sum / total;
}

}  // namespace

Image<float> nearnessOf(const GBuffer& gbuffer)
{
    Image<float> nearness(gbuffer.width, gbuffer.height);
    forCovered(gbuffer, [&](int x, int y) {
        float sum = 0.0f;
        for (const auto& direction : kDirections) sum += nearnessAlong(gbuffer, x, y, direction);
        nearness.at(x, y) = sum / float(std::size(kDirections));
    });
    return nearness;
}

Image<Vec3> smoothIrradiance(const Image<Vec3>& irradiance, const GBuffer& gbuffer, int passes)
{
    const Image<float> nearness = nearnessOf(gbuffer);
    Links links = adjacent(gbuffer);
    for (int spacing = 1; spacing < kFirstSpacing; spacing *= 2) links = doubled(links, gbuffer, spacing);
    Image<Vec3> from = irradiance;
    for (int pass = 0, spacing = kFirstSpacing; pass < passes; ++pass, spacing *= 2) {
        if (pass > 0) links = doubled(links, gbuffer, spacing / 2);
        Image<Vec3> to(irradiance.width, irradiance.height);
        forCovered(gbuffer, [&](int x, int y) { to.at(x, y) = smoothPixel(from, {gbuffer, nearness, links, spacing}, x, y); });
        from = std::move(to);
    }
    return from;
}

}  // namespace lrsm
