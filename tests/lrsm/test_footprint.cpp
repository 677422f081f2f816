// Weights are held against tents in double in apps/validate/equations/sample_checks.cpp; here are the traps.
#include "lrsm/footprint.h"

#include "apps/validate/equations/synthetic_maps.h"
#include "lrsm/sample.h"

#include <catch.h>

using namespace lrsm;

namespace {

Lrsm smallLrsm(std::uint32_t stream)
{
    return buildLrsm(syntheticRsm(32, stream, 1.0f), layersOf(1, 1));
}

}  // namespace

TEST_CASE("sampling a texel's centre at a whole level gives that texel, bit for bit", "[lrsm][sampler]")
{
    const auto fraction = GENERATE(FilterFraction::exact, FilterFraction::fixed8);
    const Lrsm lrsm = smallLrsm(33);
    for (int lod = 0; lod < lrsm.levels(); ++lod) {
        const int n = lrsm.resolutionAt(lod);
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const LrsmFootprint footprint = makeFootprint(lrsm, (float(x) + 0.5f) / float(n), (float(y) + 0.5f) / float(n), float(lod), fraction);
                const LrsmTexel& texel = lrsm.level(0, lod)[y * n + x];
                const FilteredTexel sampled = sampleLayer(lrsm, 0, footprint);
                REQUIRE(sampled.radiance == Vec3(texel.radiance[0], texel.radiance[1], texel.radiance[2]));
                REQUIRE(sampled.normal == Vec3(texel.normal[0], texel.normal[1], texel.normal[2]));
                REQUIRE(sampled.depth == texel.depth[0]);
                REQUIRE(sampled.depthSquared == texel.depth[1]);
            }
    }
}

TEST_CASE("the border is 0: half at the map's edge, nothing far outside, nothing for NaN", "[lrsm][sampler]")
{
    const Lrsm lrsm = buildLrsm(flatMap(plainProjection(32), {}), layersOf(1, 1, 0.0f, Storage::gpu));
    CHECK(sampleLayer(lrsm, 0, 0.0f, 0.5f, 0.0f, FilterFraction::exact).normalAlpha == 0.5f);
    CHECK(sampleLayer(lrsm, 0, 1.0f, 1.0f, 0.0f, FilterFraction::exact).normalAlpha == 0.25f);
    CHECK(sampleLayer(lrsm, 0, 0.5f, 1.0f, 4.0f, FilterFraction::exact).normalAlpha == 0.5f);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float far : {-1.0f, 2.0f, -1e30f, 1e30f, kInfinity, -kInfinity, nan}) {
        CHECK(sampleLayer(lrsm, 0, far, 0.5f, 1.5f, FilterFraction::exact).depthAlpha == 0.0f);
        CHECK(sampleLayer(lrsm, 0, 0.5f, far, 1.5f, FilterFraction::fixed8).depthAlpha == 0.0f);
    }
}

TEST_CASE("a footprint outside the map is told from one that reaches in: it samples exactly nothing", "[lrsm][sampler]")
{
    const Lrsm lrsm = smallLrsm(21);
    SearchRandom random(22);
    int outside = 0;
    for (int i = 0; i < 20000; ++i) {
        const float u = random.uniform(-1.2f, 2.2f), v = random.uniform(-1.2f, 2.2f), level = random.uniform(0.0f, 5.0f);
        const LrsmFootprint footprint = makeFootprint(lrsm, u, v, level, i % 2 ? FilterFraction::exact : FilterFraction::fixed8);
        REQUIRE(outsideMap(footprint) == !(sampleDepth(layerTexels(lrsm, 0), footprint)[2] > 0.0f));  // the map is full
        outside += outsideMap(footprint) ? 1 : 0;
    }
    CHECK(outside > 5000);
    CHECK(outside < 19000);
}

TEST_CASE("levels are clamped to the chain, NaN is the base", "[lrsm][sampler]")
{
    const Lrsm lrsm = smallLrsm(39);
    const auto at = [&](float level) { return sampleLayer(lrsm, 0, 0.4f, 0.6f, level, FilterFraction::exact).radiance; };
    CHECK(at(-3.0f) == at(0.0f));
    CHECK(at(-kInfinity) == at(0.0f));
    CHECK(at(std::numeric_limits<float>::quiet_NaN()) == at(0.0f));
    CHECK(at(99.0f) == at(4.0f));
    CHECK(at(kInfinity) == at(4.0f));
    CHECK(makeFootprint(lrsm, 0.4f, 0.6f, 4.0f, FilterFraction::exact).taps == 4);
    CHECK(makeFootprint(lrsm, 0.4f, 0.6f, 3.5f, FilterFraction::exact).taps == 8);
}
