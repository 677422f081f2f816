#include "conetrace/frame/irradiance_filter.h"

#include "conetrace/frame/lobe.h"
#include "conetrace/frame/same_surface.h"

#include <cstdlib>

namespace lrsm {
namespace {

constexpr int kReach = 2;

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
            const float weight = (std::abs(dx) == kReach ? 0.5f : 1.0f) * (std::abs(dy) == kReach ? 0.5f : 1.0f) * weightOf(neighbour);
            sum += weight * values.texels[neighbour];
            total += weight;
        }
    }
    return total > 0.0f ? sum / total : Vec3(0.0f);
}

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
    forCovered(gbuffer, [&](int x, int y) { filtered.at(x, y) = y < rows ? filterPixel(irradiance, gbuffer, rows, x, y) : irradiance.at(x, y); });
    return filtered;
}

}  // namespace lrsm
