// Ranges, decay and means are held against double in apps/validate/equations/layer_checks.cpp; here are the traps.
#include "lrsm/layers.h"

#include "apps/validate/equations/synthetic_maps.h"

#include <catch.h>

using namespace lrsm;

TEST_CASE("decay of NaN is 0", "[lrsm][eq15]")
{
    CHECK(decay(LayerRange{}, std::numeric_limits<float>::quiet_NaN()) == 0.0f);
}

TEST_CASE("outermost layers reach delta further, or decay at the scene's ends when asked", "[lrsm][eq15]")
{
    LayerSettings settings = layersOf(3, 1, 0.25f);
    settings.fitRanges = false;
    const auto further = partition(syntheticRsm(16, 8), settings);
    CHECK(decay(further.front(), 0.0f) == 1.0f);
    CHECK(decay(further.back(), 1.0f) == 1.0f);
    settings.outermostDecay = true;
    const auto literal = partition(syntheticRsm(16, 8), settings);
    CHECK(decay(literal.front(), 0.0f) == 0.0f);
    CHECK(decay(literal.front(), 0.5f * literal.front().delta) == Approx(0.5f).margin(1e-6));
    CHECK(decay(literal.back(), 1.0f) == 0.0f);
}

TEST_CASE("without overlap every valid texel lies in exactly one layer", "[lrsm][eq13][eq14]")
{
    const int depthLayers = GENERATE(1, 3, 7, 16), normalLayers = GENERATE(1, 2, 3, 8);
    const bool fit = GENERATE(true, false);
    Rsm rsm = syntheticRsm(32, 9);
    // Planted: depths and cosines on the cuts, one ULP beside them, and at both ends.
    LayerSettings settings = layersOf(depthLayers, normalLayers);
    settings.fitRanges = fit;
    const auto ranges = partition(rsm, settings);
    std::size_t next = 0;
    for (const LayerRange& range : ranges)
        for (const float z : {range.depthMin, range.depthMax})
            for (const float c : {range.nDotLMin, range.nDotLMax}) {
                if (next + 3 >= rsm.texels.texels.size()) break;
                for (const float dz : {-1.0f, 0.0f, 2.0f}) {
                    rsm.texels.texels[next].coverage = 1.0f;
                    rsm.texels.texels[next].nDotL = std::clamp(std::nextafter(c, dz), 0.0f, 1.0f);
                    rsm.depthLinear.texels[next++] = std::clamp(std::nextafter(z, dz), ranges.front().depthMin, ranges.back().depthMax);
                }
            }
    const Lrsm lrsm = buildLrsm(rsm, settings);
    std::uint64_t stored = 0;
    for (const std::uint64_t count : lrsm.validTexelsPerLayer) stored += count;
    CHECK(stored == std::uint64_t(std::count_if(rsm.texels.texels.begin(), rsm.texels.texels.end(), [](const RsmTexel& t) { return t.coverage > 0.0f; })));

    // Eq. 13: the layers' alphas of each base texel sum to its covered fraction.
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            float covered = 0.0f, normalAlpha = 0.0f, depthAlpha = 0.0f;
            for (int i = 0; i < 4; ++i) covered += 0.25f * rsm.texels.at(2 * x + (i & 1), 2 * y + (i >> 1)).coverage;
            for (int layer = 0; layer < lrsm.layers(); ++layer) {
                normalAlpha += lrsm.level(layer, 0)[y * 16 + x].normal[3];
                depthAlpha += lrsm.level(layer, 0)[y * 16 + x].depth[2];
            }
            REQUIRE(normalAlpha == covered);
            REQUIRE(depthAlpha == covered);
        }
}
