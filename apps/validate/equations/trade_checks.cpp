// What Table 1's storage and its rounding cost, beside float32: error and bias of L, time and bytes.
#include "lrsm/sample.h"

#include "apps/validate/equations/algorithm1_twin.h"
#include "apps/validate/equations/check_run.h"
#include "apps/validate/equations/synthetic_maps.h"

namespace lrsm {
namespace {

/// A surface of gentle waves: what a footprint in a real map mostly looks like, and V is worth something.
Rsm gentleMap(int n)
{
    Rsm rsm = syntheticRsm(n, 901, 1.0f);
    rsm.projection = sunOverCube(n);
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const double a = 6.2831853 * 3 * x / n, b = 6.2831853 * 2 * y / n;
            RsmTexel& t = rsm.texels.at(x, y);
            t.normal = glm::normalize(Vec3(float(0.2 * std::cos(a)), 1.0f, float(0.2 * std::sin(b))));
            t.nDotL = t.normal.y;
            rsm.depthLinear.at(x, y) = static_cast<float>(0.5 + 0.06 * std::sin(a) + 0.05 * std::cos(b));
        }
    return rsm;
}

struct StorageChoice {
    const char *setting, *name;
    Storage storage;
    HalfRounding rounding;
};

}  // namespace

void addStorageTrades(CheckRun& run)
{
    const Rsm rsm = gentleMap(256);
    const StorageChoice choices[4] = {{"storage", "gpu", Storage::gpu, HalfRounding::d3d},
                                      {"storage", "float32", Storage::float32, HalfRounding::d3d},
                                      {"half_rounding", "d3d", Storage::gpu, HalfRounding::d3d},
                                      {"half_rounding", "nearest_even", Storage::gpu, HalfRounding::nearestEven}};
    ConeSettings cones;
    cones.gather.backface = Backface::cosine;
    const NormalCdf phi;
    LayerSettings layers = layersOf(2, 2);
    const Lrsm exact = buildLrsm(rsm, layers);

    Chart curve{.title = "bias of A R by mip level: half toward zero and nearest even", .xLabel = "mip level", .yLabel = "mean of stored / exact - 1"};
    for (const StorageChoice& choice : choices) {
        layers.storage = choice.storage;
        layers.halfRounding = choice.rounding;
        const Lrsm lrsm = buildLrsm(rsm, layers);
        EquationTrade trade{.setting = choice.setting,
                            .choice = choice.name,
                            .quantity = choice.setting == std::string("storage") ? "L, Algorithm 1, over the largest radiance" : "A R of all levels, relative"};
        std::uint64_t count = 0;
        const auto include = [&](double error) {
            trade.worst = std::max(trade.worst, std::abs(error));
            trade.meanError += std::abs(error);
            trade.bias += error;
            ++count;
        };
        if (choice.setting == std::string("storage")) {
            // The twin samples the float32 maps: what is left is storage, and the kernel's arithmetic.
            SearchRandom random(902);
            for (std::uint64_t i = 0; i < run.draws(20000); ++i) {
                const ConeSample cone{Vec3(random.uniform(-1.9f, 1.9f), random.uniform(-0.5f, 0.5f), random.uniform(-1.9f, 1.9f)), random.uniform(0.02f, 0.5f),
                                      randomUnit(random)};
                const twin::Projected p = twin::project(exact.projection, twin::DVec3(cone.centre));
                const twin::Outgoing expected = twin::algorithm1(exact, p, cone, cones);
                if (expected.toJump > 1e-5) include((double(sampleLrsm(lrsm, cone, cones, phi).x) - expected.radiance.x) / kSyntheticRadiance);
            }
        } else {
            ChartSeries series{.label = choice.name};
            for (int lod = 0; lod < lrsm.levels(); ++lod) {
                double sum = 0.0, texels = 0.0;
                const std::size_t n = std::size_t(lrsm.resolutionAt(lod)) * std::size_t(lrsm.resolutionAt(lod));
                for (int layer = 0; layer < lrsm.layers(); ++layer)
                    for (std::size_t i = 0; i < n; ++i) {
                        const double stored = double(lrsm.level(layer, lod)[i].radiance[0]), wide = double(exact.level(layer, lod)[i].radiance[0]);
                        if (!(wide > 1e-3)) continue;
                        include(stored / wide - 1.0);
                        sum += stored / wide - 1.0;
                        texels += 1.0;
                    }
                series.x.push_back(lod), series.y.push_back(texels > 0.0 ? sum / texels : 0.0);
            }
            curve.series.push_back(series);
        }
        trade.meanError /= double(std::max<std::uint64_t>(count, 1));
        trade.bias /= double(std::max<std::uint64_t>(count, 1));
        trade.bytes = choice.storage == Storage::gpu ? 24 : 48;  // of a texel: three textures of four channels
        // To build, a base texel.
        trade.nanoseconds = run.time(1, [&, small = gentleMap(64)](std::size_t) { return buildLrsm(small, layers).texels.front().depth[0]; }) / (32.0 * 32.0);
        run.add(trade);
    }
    run.add({"table1", curve});
}

}  // namespace lrsm
