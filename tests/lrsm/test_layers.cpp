#include "lrsm/layers.h"
#include "synthetic_rsm.h"

#include <catch.h>

using namespace lrsm;
using test::flatRsm;
using test::randomRsm;

namespace {

LayerSettings layerSettings(int depthLayers, int normalLayers, float overlap = 0.0f, Storage storage = Storage::float32)
{
    LayerSettings settings;
    settings.depthLayers = depthLayers;
    settings.normalLayers = normalLayers;
    settings.overlap = overlap;
    settings.storage = storage;
    return settings;
}

/// Sum of Eq. 15 over the depth slices (one of the <n.l> slices stands for all).
double decaySum(const std::vector<LayerRange>& ranges, float z)
{
    double sum = 0.0;
    for (const LayerRange& range : ranges)
        if (range.nDotLMin == 0.0f) sum += static_cast<double>(decay(range, z));
    return sum;
}

std::uint64_t validTexels(const Rsm& rsm)
{
    std::uint64_t count = 0;
    for (const RsmTexel& texel : rsm.texels.texels) count += texel.coverage > 0.0f ? 1 : 0;
    return count;
}

}  // namespace

TEST_CASE("decay weights of all layers sum to 1 at every depth of the scene", "[lrsm][eq15]")
{
    const int depthLayers = GENERATE(1, 2, 3, 5, 16);
    const float overlap = GENERATE(0.0f, 0.05f, 0.1f, 0.37f, 0.5f);
    const bool fit = GENERATE(true, false);
    LayerSettings settings = layerSettings(depthLayers, 2, overlap);
    settings.fitRanges = fit;
    const Rsm rsm = randomRsm(16, 7);
    const std::vector<LayerRange> ranges = partition(rsm, settings);
    CAPTURE(depthLayers, overlap, fit);

    float lowest = 1.0f, highest = 0.0f;
    for (std::size_t i = 0; i < rsm.texels.texels.size(); ++i)
        if (rsm.texels.texels[i].coverage > 0.0f) {
            lowest = std::min(lowest, rsm.depthLinear.texels[i]);
            highest = std::max(highest, rsm.depthLinear.texels[i]);
        }
    if (!fit) lowest = 0.0f, highest = 1.0f;

    std::vector<float> depths = {lowest, highest};
    for (int i = 0; i <= 4000; ++i) depths.push_back(lowest + (highest - lowest) * static_cast<float>(i) / 4000.0f);
    for (const LayerRange& range : ranges)
        for (const float edge : {range.depthMin, range.depthMax, range.depthMin + range.delta, range.depthMax - range.delta})
            for (const float z : {std::nextafter(edge, -1.0f), edge, std::nextafter(edge, 2.0f)}) depths.push_back(z);
    for (const float z : depths) {
        if (!(z >= lowest && z <= highest)) continue;
        CAPTURE(z);
        REQUIRE(std::abs(decaySum(ranges, z) - 1.0) <= double(kDecaySumMaxError));
    }
}

TEST_CASE("decay is smoothstep over the overlap and 0 outside the range", "[lrsm][eq15]")
{
    LayerRange range;
    range.depthMin = 0.25f;
    range.depthMax = 0.75f;
    range.delta = 0.125f;
    range.decayAtMin = range.decayAtMax = true;
    for (int i = -64; i <= 192; ++i) {
        const double z = i / 128.0;
        const auto k = [](double t) { return t <= 0.0 ? 0.0 : t >= 1.0 ? 1.0 : t * t * (3.0 - 2.0 * t); };
        const double expected = z < 0.375 ? k((z - 0.25) / 0.125) : z <= 0.625 ? 1.0 : k((0.75 - z) / 0.125);
        CHECK(static_cast<double>(decay(range, static_cast<float>(z))) == Approx(expected).margin(double(kDecayMaxError)));
    }
    range.decayAtMax = false;
    CHECK(decay(range, 0.75f) == 1.0f);
    CHECK(decay(range, std::nextafter(0.75f, 1.0f)) == 0.0f);
    CHECK(decay(range, std::numeric_limits<float>::quiet_NaN()) == 0.0f);
}

TEST_CASE("outermost layers reach delta further, or decay at the scene's ends when asked", "[lrsm][eq15]")
{
    const Rsm rsm = randomRsm(16, 8);
    LayerSettings settings = layerSettings(3, 1, 0.25f);
    settings.fitRanges = false;
    const auto further = partition(rsm, settings);
    const float delta = further.front().delta;
    CHECK(delta == Approx(0.25 / 3.0).epsilon(1e-5));
    CHECK(further.front().depthMin == -delta);
    CHECK(further.back().depthMax == Approx(1.0f + delta).epsilon(1e-6));
    CHECK(decay(further.front(), 0.0f) == 1.0f);
    CHECK(decay(further.back(), 1.0f) == 1.0f);

    settings.outermostDecay = true;
    const auto literal = partition(rsm, settings);
    CHECK(literal.front().depthMin == 0.0f);
    CHECK(literal.back().depthMax == 1.0f);
    CHECK(decay(literal.front(), 0.0f) == 0.0f);
    CHECK(decay(literal.front(), 0.5f * delta) == Approx(0.5f).margin(1e-6));
    CHECK(decay(literal.back(), 1.0f) == 0.0f);
    CHECK(decay(literal.front(), delta) == Approx(1.0f));
}

TEST_CASE("neighbouring layers overlap by exactly delta, whatever the fitted range", "[lrsm][eq15]")
{
    for (unsigned seed = 0; seed < 40; ++seed) {
        std::mt19937 random(seed);
        const float a = test::uniform(random), b = test::uniform(random);
        const Rsm rsm = randomRsm(8, seed, 1.0f, std::min(a, b), std::max(a, b) + 1e-4f);
        const auto ranges = partition(rsm, layerSettings(2 + static_cast<int>(seed % 15), 1, test::uniform(random, 0.0f, 0.5f)));
        for (std::size_t i = 0; i + 1 < ranges.size(); ++i) {
            REQUIRE(static_cast<double>(ranges[i].depthMax) - static_cast<double>(ranges[i + 1].depthMin) == static_cast<double>(ranges[i].delta));
            REQUIRE(ranges[i].depthMin < ranges[i].depthMax);
        }
    }
}

TEST_CASE("without overlap every valid texel lies in exactly one layer", "[lrsm][eq13][eq14]")
{
    const int depthLayers = GENERATE(1, 3, 7, 16), normalLayers = GENERATE(1, 2, 3, 8);
    const bool fit = GENERATE(true, false);
    Rsm rsm = randomRsm(32, 9);
    // Planted: depths and cosines on the cuts, one ULP beside them, and at both ends.
    LayerSettings settings = layerSettings(depthLayers, normalLayers);
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
    CHECK(stored == validTexels(rsm));

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
