#include "conetrace/frame/smooth_irradiance.h"

#include "conetrace/frame/four_lanes.inc"
#include "conetrace/frame/same_surface.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace lrsm {
namespace {

constexpr int kFirstSpacing = 4;  ///< pixels: the width of filterIrradiance
constexpr int kHorizonSteps[] = {2, 4, 8, 16, 32, 64, 128, 256};
constexpr int kDirections[8][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};

namespace nearness_lanes {

using namespace four_lanes;

/// Positions, NaN where nothing was drawn and outside the picture. A row holds all x, then all y, then all z.
class Places {
  public:
    explicit Places(const GBuffer& gbuffer) : width_(gbuffer.width), rows_(3 * gbuffer.width, gbuffer.height, kNone)
    {
        forCovered(gbuffer, [&](int x, int y) {
            for (int axis = 0; axis < 3; ++axis) rows_.at(x + axis * width_, y) = gbuffer.position.at(x, y)[axis];
        });
    }

    LaneVec3 at(int x, int y) const
    {
        const float* row = &rows_.texels[rows_.index(0, y)];
        if (x >= 0 && x + kLanes <= width_) return {load(row + x), load(row + width_ + x), load(row + 2 * width_ + x)};
        LaneVec3 lanes{lanesOf(kNone), lanesOf(kNone), lanesOf(kNone)};
        for (int k = std::max(0, -x); k < std::min(kLanes, width_ - x); ++k) {
            lanes.x[k] = row[x + k];
            lanes.y[k] = row[width_ + x + k];
            lanes.z[k] = row[2 * width_ + x + k];
        }
        return lanes;
    }

  private:
    static constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    int width_;
    Image<float> rows_;
};

LaneFloat nearnessAlong(const GBuffer& gbuffer, const Places& places, const LaneVec3& position, const LaneVec3& normal, int x, int y, const int (&direction)[2])
{
    LaneFloat sum{}, horizon = lanesOf(kSamePlaneSlope);  // what is lower may be the surface itself
    for (const int step : kHorizonSteps) {
        const int nx = x + direction[0] * step, ny = y + direction[1] * step;
        if (ny < 0 || ny >= gbuffer.height || nx <= -kLanes || nx >= gbuffer.width) break;
        const LaneVec3 between = places.at(nx, ny) - position;
        const LaneFloat above = dot(between, normal), distance = squareRoot(dot(between, between)), sine = above / distance;
        const LaneInt rises = sine > horizon;  // not where one of the two is none
        if (maskOf(rises) == 0) continue;
        sum = rises ? sum + (sine * sine - horizon * horizon) / distance : sum;
        horizon = rises ? sine : horizon;
    }
    return sum;
}

void nearnessInRow(const GBuffer& gbuffer, const Places& places, int y, Image<float>& nearness)
{
    for (int x = 0; x < gbuffer.width; x += kLanes) {
        const int count = std::min(kLanes, gbuffer.width - x);
        const LaneVec3 position = places.at(x, y);
        LaneVec3 normal{};
        for (int k = 0; k < count; ++k) {
            const Vec3& n = gbuffer.geometricNormal.at(x + k, y);
            normal.x[k] = n.x, normal.y[k] = n.y, normal.z[k] = n.z;
        }
        LaneFloat sum{};
        for (const auto& direction : kDirections) sum += nearnessAlong(gbuffer, places, position, normal, x, y, direction);
        for (int k = 0; k < count; ++k) nearness.at(x + k, y) = sum[k] / float(std::size(kDirections));
    }
}

}  // namespace nearness_lanes

constexpr unsigned kOpposite = 4;  ///< from a direction to the other way

/// Bit d: the surface goes on from a pixel to the next of direction d, or, doubled, to the one `spacing` pixels away over all that lie between.
using Links = Image<std::uint8_t>;

/// Bit d of a pixel is that of join(its links, those of the pixel `spacing` away along d).
template <class Join>
Links joined(const Links& links, int spacing, const Join& join)
{
    Links result(links.width, links.height);
    parallelFor(std::size_t(links.height), kFilterRowsPerTask, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (unsigned d = 0; d < std::size(kDirections); ++d) {
                const int dx = kDirections[d][0] * spacing, ny = y + kDirections[d][1] * spacing;
                const int first = std::max(0, -dx), count = links.width - std::abs(dx);
                if (ny < 0 || ny >= links.height || count <= 0) continue;
                const std::uint8_t *here = &links.at(first, y), *there = &links.at(first + dx, ny);
                std::uint8_t* const out = &result.at(first, y);
                for (int k = 0; k < count; ++k) out[k] |= static_cast<std::uint8_t>(join(here[k], there[k]) & (1u << d));
            }
    });
    return result;
}

Links adjacent(const GBuffer& gbuffer)
{
    Links half(gbuffer.width, gbuffer.height);
    forCovered(gbuffer, [&](int x, int y) {
        unsigned bits = 0;
        for (unsigned d = 0; d < kOpposite; ++d) {
            const int nx = x + kDirections[d][0], ny = y + kDirections[d][1];
            if (inPicture(gbuffer, nx, ny) && sameSurface(gbuffer, half.index(x, y), half.index(nx, ny))) bits |= 1u << d;
        }
        half.at(x, y) = static_cast<std::uint8_t>(bits);
    });
    // The other way a link is the same.
    return joined(half, 1, [](unsigned here, unsigned there) { return here | there << kOpposite; });
}

Links doubled(const Links& links, int spacing)
{
    return joined(links, spacing, [](unsigned here, unsigned there) { return here & there; });
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
    const nearness_lanes::Places places(gbuffer);
    parallelFor(std::size_t(gbuffer.height), kFilterRowsPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) nearness_lanes::nearnessInRow(gbuffer, places, static_cast<int>(y), nearness);
    });
    return nearness;
}

Image<Vec3> smoothIrradiance(const Image<Vec3>& irradiance, const GBuffer& gbuffer, int passes)
{
    const Image<float> nearness = nearnessOf(gbuffer);
    Links links = adjacent(gbuffer);
    for (int spacing = 1; spacing < kFirstSpacing; spacing *= 2) links = doubled(links, spacing);
    Image<Vec3> from = irradiance;
    for (int pass = 0, spacing = kFirstSpacing; pass < passes; ++pass, spacing *= 2) {
        if (pass > 0) links = doubled(links, spacing / 2);
        Image<Vec3> to(irradiance.width, irradiance.height);
        forCovered(gbuffer, [&](int x, int y) { to.at(x, y) = smoothPixel(from, {gbuffer, nearness, links, spacing}, x, y); });
        from = std::move(to);
    }
    return from;
}

}  // namespace lrsm
