#include "lrsm/footprint.h"
#include "lrsm/sample.h"
#include "synthetic_rsm.h"

#include <catch.h>

using namespace lrsm;
using test::randomRsm;
using test::uniform;

namespace {

Lrsm smallLrsm(unsigned seed, float filled = 1.0f)
{
    LayerSettings settings;
    settings.depthLayers = 1;
    settings.normalLayers = 1;
    settings.storage = Storage::float32;
    return buildLrsm(randomRsm(32, seed, filled), settings);
}

const float* numbers(const LrsmTexel& t)
{
    return t.radiance;
}

std::array<double, 11> numbersOf(const FilteredTexel& t)
{
    return {t.radiance.x, t.radiance.y, t.radiance.z, t.normal.x, t.normal.y, t.normal.z, t.normalAlpha, t.depth, t.depthSquared, t.depthAlpha, 0.0};
}

/// A GPU sampler in double: the sum over all texels of a level of value x tent(distance in texels), border 0.
std::array<double, 11> samplerTwin(const Lrsm& lrsm, double u, double v, double level)
{
    constexpr int kPlace[10] = {0, 1, 2, 4, 5, 6, 7, 8, 9, 10};
    std::array<double, 11> result{};
    level = std::clamp(level, 0.0, double(lrsm.levels() - 1));
    for (int lod = 0; lod < lrsm.levels(); ++lod) {
        const double share = std::max(0.0, 1.0 - std::abs(level - lod));
        const int n = lrsm.resolutionAt(lod);
        for (int y = 0; y < n && share > 0.0; ++y)
            for (int x = 0; x < n; ++x) {
                const double w = std::max(0.0, 1.0 - std::abs(u * n - (x + 0.5))) * std::max(0.0, 1.0 - std::abs(v * n - (y + 0.5)));
                for (std::size_t c = 0; c < 10; ++c) result[c] += share * w * double(numbers(lrsm.level(0, lod)[y * n + x])[kPlace[c]]);
            }
    }
    return result;
}

}  // namespace

TEST_CASE("the sampler equals a tent-filter twin in double, borders and levels included", "[lrsm][sampler]")
{
    const Lrsm lrsm = smallLrsm(31);
    std::mt19937 random(32);
    for (int i = 0; i < 3000; ++i) {
        const float u = uniform(random, -0.6f, 1.6f), v = uniform(random, -0.1f, 1.1f), level = uniform(random, -1.0f, 6.0f);
        const auto expected = samplerTwin(lrsm, u, v, level);
        const FilteredTexel texel = sampleLayer(lrsm, 0, u, v, level, FilterFraction::exact);
        const auto actual = numbersOf(texel);
        CAPTURE(u, v, level);
        for (std::size_t c = 0; c < 10; ++c) REQUIRE(std::abs(actual[c] - expected[c]) <= 8 * 4 * double(kFootprintWeightMaxError));  // eight texels of up to 4
    }
}

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

TEST_CASE("a constant texture stays constant, and results stay within their texels", "[lrsm][sampler]")
{
    const auto fraction = GENERATE(FilterFraction::exact, FilterFraction::fixed8);
    LayerSettings settings;
    settings.depthLayers = settings.normalLayers = 1;
    const Lrsm constant = buildLrsm(test::flatRsm(32, 0.4f, Vec3(0.7f, 1.0f, 3.0f)), settings), random = smallLrsm(34);
    const LrsmTexel texel = *constant.level(0, 0);
    std::mt19937 numbersSource(35);
    for (int i = 0; i < 2000; ++i) {
        const float level = uniform(numbersSource, 0.0f, 3.0f), u = uniform(numbersSource, 0.3f, 0.7f), v = uniform(numbersSource, 0.3f, 0.7f);
        const FilteredTexel sampled = sampleLayer(constant, 0, u, v, level, fraction);
        REQUIRE(sampled.radiance.x == Approx(texel.radiance[0]).epsilon(5e-7));
        REQUIRE(sampled.depth / sampled.depthAlpha == Approx(texel.depth[0]).epsilon(5e-7));
        REQUIRE(sampled.normalAlpha == Approx(1.0f).epsilon(5e-7));

        const LrsmFootprint footprint = makeFootprint(random, u, v, level, fraction);
        float lowest = kInfinity, highest = 0.0f, weights = 0.0f;
        for (int tap = 0; tap < footprint.taps; ++tap) {
            const float value = random.level(0, 0)[footprint.texel[tap]].radiance[0];
            lowest = std::min(lowest, value);
            highest = std::max(highest, value);
            REQUIRE(footprint.weight[tap] >= 0.0f);
            weights += footprint.weight[tap];
        }
        REQUIRE(weights == Approx(1.0f).epsilon(5e-7));
        const float value = sampleLayer(random, 0, footprint).radiance.x;
        REQUIRE(value >= lowest * (1.0f - 5e-7f));
        REQUIRE(value <= highest * (1.0f + 5e-7f));
    }
}

TEST_CASE("between two texel centres the result is monotone", "[lrsm][sampler]")
{
    const auto fraction = GENERATE(FilterFraction::exact, FilterFraction::fixed8);
    const Lrsm lrsm = smallLrsm(36);
    for (int x = 0; x < 15; ++x) {
        const float a = lrsm.level(0, 0)[5 * 16 + x].radiance[0], b = lrsm.level(0, 0)[5 * 16 + x + 1].radiance[0];
        float before = a;
        for (int i = 0; i <= 512; ++i) {
            const float u = (float(x) + 0.5f + float(i) / 512.0f) / 16.0f;
            const float value = sampleLayer(lrsm, 0, u, 5.5f / 16.0f, 0.0f, fraction).radiance.x;
            REQUIRE((b >= a ? value - before : before - value) >= -5e-7f * std::max(a, b));
            before = value;
        }
        REQUIRE(before == b);
    }
}

TEST_CASE("8-bit fractions: coordinates and level move in steps of 1/256", "[lrsm][sampler]")
{
    const Lrsm lrsm = smallLrsm(37);
    std::mt19937 random(38);
    for (int i = 0; i < 1000; ++i) {
        const float u = uniform(random), v = uniform(random), level = uniform(random, 0.0f, 4.0f);
        const float lod = std::floor(level * 256.0f + 0.5f) / 256.0f;
        std::array<double, 11> expected{};
        for (int fine = 0; fine < lrsm.levels(); ++fine) {
            const double share = std::max(0.0, 1.0 - std::abs(double(lod) - fine)), n = lrsm.resolutionAt(fine);
            const auto snap = [&](float x) { return (std::floor((double(x) * n - 0.5) * 256.0 + 0.5) / 256.0 + 0.5) / n; };
            if (share == 0.0) continue;
            const auto part = samplerTwin(lrsm, snap(u), snap(v), fine);
            for (std::size_t c = 0; c < 10; ++c) expected[c] += share * part[c];
        }
        const auto actual = numbersOf(sampleLayer(lrsm, 0, u, v, level, FilterFraction::fixed8));
        for (std::size_t c = 0; c < 10; ++c) REQUIRE(std::abs(actual[c] - expected[c]) <= 3e-6);
    }
}

TEST_CASE("the border is 0: half at the map's edge, nothing far outside, nothing for NaN", "[lrsm][sampler]")
{
    LayerSettings settings;
    settings.depthLayers = settings.normalLayers = 1;
    const Lrsm lrsm = buildLrsm(test::flatRsm(32, 0.4f), settings);
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
    std::mt19937 random(22);
    int outside = 0;
    for (int i = 0; i < 20000; ++i) {
        const float u = uniform(random, -1.2f, 2.2f), v = uniform(random, -1.2f, 2.2f), level = uniform(random, 0.0f, 5.0f);
        const LrsmFootprint footprint = makeFootprint(lrsm, u, v, level, i % 2 ? FilterFraction::exact : FilterFraction::fixed8);
        REQUIRE(outsideMap(footprint) == !(sampleDepth(layerTexels(lrsm, 0), footprint)[2] > 0.0f));  // the map is full
        outside += outsideMap(footprint) ? 1 : 0;
    }
    CHECK(outside > 5000);
    CHECK(outside < 19000);
}

TEST_CASE("levels are clamped to the chain; NaN is the base", "[lrsm][sampler]")
{
    const Lrsm lrsm = smallLrsm(39);
    const auto at = [&](float level) { return numbersOf(sampleLayer(lrsm, 0, 0.4f, 0.6f, level, FilterFraction::exact)); };
    CHECK(at(-3.0f) == at(0.0f));
    CHECK(at(-kInfinity) == at(0.0f));
    CHECK(at(std::numeric_limits<float>::quiet_NaN()) == at(0.0f));
    CHECK(at(99.0f) == at(4.0f));
    CHECK(at(kInfinity) == at(4.0f));
    CHECK(makeFootprint(lrsm, 0.4f, 0.6f, 4.0f, FilterFraction::exact).taps == 4);
    CHECK(makeFootprint(lrsm, 0.4f, 0.6f, 3.5f, FilterFraction::exact).taps == 8);
}
