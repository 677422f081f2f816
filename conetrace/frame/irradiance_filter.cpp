#include "conetrace/frame/irradiance_filter.h"

#include "conetrace/frame/same_surface.h"

#include <cstdlib>

namespace lrsm {
namespace {

constexpr int kReach = 2;

Vec3 filterPixel(const Image<Vec3>& irradiance, const GBuffer& gbuffer, int rows, int x, int y)
{
    const std::size_t centre = irradiance.index(x, y);
    Vec3 sum(0.0f);
    float total = 0.0f;
    for (int dy = -kReach; dy <= kReach; ++dy) {
        for (int dx = -kReach; dx <= kReach; ++dx) {
            const int nx = x + dx, ny = y + dy;
            if (!inPicture(gbuffer, nx, ny) || ny >= rows) continue;
            const std::size_t neighbour = irradiance.index(nx, ny);
            if (neighbour != centre && !sameSurface(gbuffer, centre, neighbour)) continue;
            const float weight = (std::abs(dx) == kReach ? 0.5f : 1.0f) * (std::abs(dy) == kReach ? 0.5f : 1.0f);
            sum += weight * irradiance.texels[neighbour];
            total += weight;
        }
    }
    return sum / total;
}

}  // namespace

Image<Vec3> filterIrradiance(const Image<Vec3>& irradiance, const GBuffer& gbuffer, int rows)
{
    Image<Vec3> filtered(irradiance.width, irradiance.height);
    forCovered(gbuffer, [&](int x, int y) { filtered.at(x, y) = y < rows ? filterPixel(irradiance, gbuffer, rows, x, y) : irradiance.at(x, y); });
    return filtered;
}

}  // namespace lrsm
