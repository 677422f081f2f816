#include "conetrace/proxies/march.h"

#include "core/base/parallel.h"

#include <atomic>

namespace lrsm {
namespace {

constexpr std::size_t kRowsPerTask = 2;
constexpr double kGolden = 0.61803398874989484820, kTwoPi = 6.28318530717958647693;

struct RayCount {
    std::uint32_t rays = 0, met = 0;
    void add(bool meets)
    {
        ++rays;
        met += meets ? 1u : 0u;
    }
    float partMet(float ofNone) const { return rays > 0 ? float(met) / float(rays) : ofNone; }
};

}  // namespace

ConeSet shadowRays(const ProxySettings& settings)
{
    ConeSettings cones;
    cones.set.count = settings.rays;
    cones.set.rotation = Rotation::strata;
    cones.march.estimator = Estimator::slab;
    return makeConeSet(cones);
}

Vec3 lobeRay(const Vec3& mirror, float exponent, int j, int count, int rotation)
{
    const StratumPlace place = stratumPlace(rotation);
    const double cosine = power((j + place.u) / count, 1.0 / (double(exponent) + 1.0)), sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const SinCos azimuth = sinCos(kTwoPi * (j * kGolden + place.v));
    return basisFromNormal(mirror) * Vec3(float(sine * azimuth.cos), float(sine * azimuth.sin), float(cosine));
}

VisibilityLists marchShadowRays(const MarchWorld& world)
{
    const GBuffer& g = world.gbuffer;
    const Blocks blocks{g.width, g.height, world.settings.marchDivisor};
    // Sums of integers are the same in any order.
    std::vector<std::uint32_t> proxyHits(world.settings.cellWeight == ProxyCellWeight::seen ? world.cells.numbers.size() : 0);
    std::vector<VisibilityLists> rows(std::size_t(blocks.rows()));
    parallelFor(rows.size(), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
        CellSet seen(world.cells.grid.count());
        for (std::size_t row = begin; row < end; ++row) {
            VisibilityLists& out = rows[row];
            out.first = {0};
            for (int column = 0; column < blocks.columns(); ++column) {
                const std::size_t pixel = blocks.pixel(column, int(row));
                RayCount diffuse, lobe;
                if (g.covered(pixel)) {
                    const Vec3 origin = rayStart(world, pixel);
                    forShadowRays(world, pixel, column, int(row), [&](const Vec3& direction, bool isDiffuse) {
                        const ShadowRay ray(origin, direction);
                        const std::uint32_t cell = cellMet(world.cells, ray);
                        (isDiffuse ? diffuse : lobe).add(cell != kNoCell);
                        if (cell == kNoCell) return;
                        seen.add(cell, isDiffuse ? 1u : 0u);
                        if (!proxyHits.empty()) std::atomic_ref(proxyHits[nearestDisc(world.cells, cell, ray).slot]).fetch_add(1, std::memory_order_relaxed);
                    });
                    seen.moveTo(out);
                }
                out.first.push_back(static_cast<std::uint32_t>(out.cells.size()));
                out.opacity.push_back(diffuse.partMet(0.0f));
                out.lobeOpacity.push_back(lobe.partMet(1.0f));
                out.rays.push_back(diffuse.rays);
            }
        }
    });
    VisibilityLists lists = joinRows(rows, blocks.divisor);
    lists.proxyHits = std::move(proxyHits);
    return lists;
}

}  // namespace lrsm
