#include "conetrace/frame/irradiance_filter.h"

#include "conetrace/frame/four_lanes.inc"
#include "conetrace/frame/lobe.h"
#include "conetrace/frame/same_surface.h"

#include <cstdlib>
#include <limits>

namespace lrsm {
namespace {

constexpr int kReach = 2;

float tentAt(int dx, int dy)
{
    return (std::abs(dx) == kReach ? 0.5f : 1.0f) * (std::abs(dy) == kReach ? 0.5f : 1.0f);
}

/// `weightOf(pixel)`: what a pixel counts, 0 where it takes no part.
template <class WeightOf>
Vec3 weightedMean(const Image<Vec3>& values, const GBuffer& gbuffer, int rows, int x, int y, const WeightOf& weightOf)
{
    const std::size_t centre = values.index(x, y);
    Vec3 sum(0.0f);
    float total = 0.0f;
    for (int dy = -kReach; dy <= kReach; ++dy) {
        for (int dx = -kReach; dx <= kReach; ++dx) {
            const int nx = x + dx, ny = y + dy;
            if (!inPicture(gbuffer, nx, ny) || ny >= rows) continue;
            const std::size_t neighbour = values.index(nx, ny);
            if (neighbour != centre && !sameSurface(gbuffer, centre, neighbour)) continue;
            const float weight = tentAt(dx, dy) * weightOf(neighbour);
            sum += weight * values.texels[neighbour];
            total += weight;
        }
    }
    return total > 0.0f ? sum / total : Vec3(0.0f);
}

namespace filter_lanes {

using namespace four_lanes;

/// What a task's rows read, by component, kReach pixels more on every side; normals are NaN where nothing was drawn and outside the first `rows` of the
/// picture: of no surface.
class Window {
  public:
    Window(const Image<Vec3>& values, const GBuffer& gbuffer, int rows, int begin, int end)
        : first_(begin - kReach), stride_(gbuffer.width + 2 * kReach + kLanes), floats_(std::size_t(kFields * 3 * stride_ * (end - begin + 2 * kReach)))
    {
        for (int y = first_; y < end + kReach; ++y) {
            std::fill_n(row(y, kNormal), stride_, std::numeric_limits<float>::quiet_NaN());
            for (int x = 0; x < gbuffer.width && y >= 0 && y < rows; ++x) {
                const std::size_t i = values.index(x, y);
                if (!gbuffer.covered(i)) continue;
                put(kPosition, x, y, gbuffer.position.texels[i]);
                put(kGeometricNormal, x, y, gbuffer.geometricNormal.texels[i]);
                put(kNormal, x, y, gbuffer.normal.texels[i]);
                put(kValue, x, y, values.texels[i]);
            }
        }
    }

    /// filterPixel of (x, y) and those right of it.
    LaneVec3 mean(int x, int y) const
    {
        const LaneVec3 position = at(kPosition, x, y), geometricNormal = at(kGeometricNormal, x, y), normal = at(kNormal, x, y);
        LaneVec3 sum{};
        LaneFloat total{};
        for (int dy = -kReach; dy <= kReach; ++dy)
            for (int dx = -kReach; dx <= kReach; ++dx) {
                const int nx = x + dx, ny = y + dy;
                // As sameSurface.
                const LaneVec3 between = at(kPosition, nx, ny) - position;
                const LaneFloat limit = kSamePlaneSlope * kSamePlaneSlope * dot(between, between);
                const LaneFloat fromA = dot(between, geometricNormal), fromB = dot(between, at(kGeometricNormal, nx, ny));
                const LaneInt same = (dot(normal, at(kNormal, nx, ny)) >= kSameNormalCosine) & (fromA * fromA <= limit) & (fromB * fromB <= limit);
                const LaneInt counts = dx == 0 && dy == 0 ? lanesOf(-1) : same;
                const float weight = tentAt(dx, dy);
                const LaneVec3 value = at(kValue, nx, ny);
                sum = {counts ? sum.x + weight * value.x : sum.x, counts ? sum.y + weight * value.y : sum.y, counts ? sum.z + weight * value.z : sum.z};
                total = counts ? total + weight : total;
            }
        return {sum.x / total, sum.y / total, sum.z / total};
    }

  private:
    enum Field { kPosition, kGeometricNormal, kNormal, kValue, kFields };

    float* row(int y, int field) { return &floats_[std::size_t(((y - first_) * kFields + field) * 3 * stride_)]; }
    void put(Field field, int x, int y, const Vec3& v)
    {
        for (int axis = 0; axis < 3; ++axis) row(y, field)[axis * stride_ + x + kReach] = v[axis];
    }
    LaneVec3 at(Field field, int x, int y) const
    {
        const float* const first = &floats_[std::size_t(((y - first_) * kFields + field) * 3 * stride_ + x + kReach)];
        return {load(first), load(first + stride_), load(first + 2 * stride_)};
    }

    int first_, stride_;
    std::vector<float> floats_;
};

}  // namespace filter_lanes

}  // namespace

Vec3 filterPixel(const Image<Vec3>& irradiance, const GBuffer& gbuffer, int rows, int x, int y)
{
    return weightedMean(irradiance, gbuffer, rows, x, y, [](std::size_t) { return 1.0f; });
}

Vec3 filterSpecularPixel(const Image<Vec3>& specular, const Image<float>& lobeWeight, const GBuffer& gbuffer, int rows, int x, int y)
{
    if (!lobeIsWide(gbuffer.roughness.at(x, y))) return specular.at(x, y);
    return weightedMean(specular, gbuffer, rows, x, y,
                        [&](std::size_t pixel) { return lobeIsWide(gbuffer.roughness.texels[pixel]) ? lobeWeight.texels[pixel] : 0.0f; });
}

Image<Vec3> filterSpecular(const Image<Vec3>& specular, const Image<float>& lobeWeight, const GBuffer& gbuffer, int rows)
{
    Image<Vec3> filtered(specular.width, specular.height);
    forCovered(gbuffer,
               [&](int x, int y) { filtered.at(x, y) = y < rows ? filterSpecularPixel(specular, lobeWeight, gbuffer, rows, x, y) : specular.at(x, y); });
    return filtered;
}

Image<Vec3> filterIrradiance(const Image<Vec3>& irradiance, const GBuffer& gbuffer, int rows)
{
    Image<Vec3> filtered(irradiance.width, irradiance.height);
    parallelFor(std::size_t(rows), kFilterRowsPerTask, [&](std::size_t begin, std::size_t end) {
        const filter_lanes::Window window(irradiance, gbuffer, rows, static_cast<int>(begin), static_cast<int>(end));
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < gbuffer.width; x += four_lanes::kLanes) {
                const four_lanes::LaneVec3 mean = window.mean(x, y);
                for (int k = 0; k < std::min(four_lanes::kLanes, gbuffer.width - x); ++k)
                    if (gbuffer.covered(irradiance.index(x + k, y))) filtered.at(x + k, y) = Vec3(mean.x[k], mean.y[k], mean.z[k]);
            }
    });
    for (std::size_t i = std::size_t(rows) * std::size_t(gbuffer.width); i < filtered.texels.size(); ++i)
        if (gbuffer.covered(i)) filtered.texels[i] = irradiance.texels[i];
    return filtered;
}

}  // namespace lrsm
