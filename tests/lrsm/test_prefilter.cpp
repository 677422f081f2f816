// Means and storage are held against double in apps/validate/equations/layer_checks.cpp; here are traps, counts and invariances.
#include "apps/validate/equations/synthetic_maps.h"
#include "core/base/parallel.h"

#include <catch.h>
#include <cstring>

using namespace lrsm;

namespace {

Rsm flatRsm(int resolution, float depth, const Vec3& radiance = Vec3(1.0f))
{
    return flatMap(plainProjection(resolution), {.depth = depth, .radiance = radiance});
}

bool sameBits(const Lrsm& a, const Lrsm& b)
{
    return a.ranges == b.ranges && a.texels.size() == b.texels.size() && a.validTexelsPerLayer == b.validTexelsPerLayer &&
           a.negativeVariances == b.negativeVariances && a.conversions.halfSaturations == b.conversions.halfSaturations &&
           std::memcmp(a.texels.data(), b.texels.data(), bytesOf(a)) == 0;
}

template <class Visit>
void forEachTexel(const Lrsm& lrsm, const Visit& visit)
{
    for (int layer = 0; layer < lrsm.layers(); ++layer)
        for (int lod = 0; lod < lrsm.levels(); ++lod)
            for (int y = 0; y < lrsm.resolutionAt(lod); ++y)
                for (int x = 0; x < lrsm.resolutionAt(lod); ++x) visit(layer, lod, x, y, lrsm.level(layer, lod)[y * lrsm.resolutionAt(lod) + x]);
}

}  // namespace

TEST_CASE("with overlap a texel is stored in both layers, and decay restores the energy", "[lrsm][eq14][eq15]")
{
    const Rsm rsm = syntheticRsm(64, 15, 1.0f);
    const Lrsm lrsm = buildLrsm(rsm, layersOf(4, 1, 0.4f));
    std::uint64_t expected = 0, storedTexels = 0;
    for (const float z : rsm.depthLinear.texels)
        for (const LayerRange& range : lrsm.ranges) expected += z >= range.depthMin && z < range.depthMax ? 1 : 0;
    for (const std::uint64_t count : lrsm.validTexelsPerLayer) storedTexels += count;
    CHECK(storedTexels == expected);
    CHECK(storedTexels > rsm.texels.texels.size() * 11 / 10);
}

TEST_CASE("predicted bytes are the bytes that layers hold", "[lrsm][memory]")
{
    const int resolution = GENERATE(2, 4, 64, 256);
    const Lrsm lrsm = buildLrsm(syntheticRsm(resolution, 16, 1.0f), layersOf(2, 2, 0.0f, Storage::gpu));
    CHECK(bytesOf(lrsm) == predictLayerBytes(resolution) * std::size_t(lrsm.layers()));
    CHECK(gpuBytesOf(lrsm) * 2 == bytesOf(lrsm));
    CHECK(predictLayerBytes(1024) == std::size_t(48) * 349525);  // Table 2's 512^2: (4^10 - 1) / 3 texels
}

TEST_CASE("empty layers are dropped, counted, and hold nothing when kept", "[lrsm]")
{
    const Rsm rsm = flatRsm(32, 0.25f);
    LayerSettings settings = layersOf(4, 2, 0.0f, Storage::gpu);
    settings.fitRanges = false;
    const Lrsm dropped = buildLrsm(rsm, settings);
    CHECK(dropped.layers() == 1);
    CHECK(dropped.layersAsked == 8);
    CHECK(countLayers(rsm, settings) == 1);
    CHECK(dropped.validTexelsPerLayer.front() == 1024);
    CHECK(dropped.ranges.front().depthMin == 0.25f);
    CHECK(dropped.ranges.front().nDotLMin == 0.5f);

    settings.dropEmpty = false;
    const Lrsm kept = buildLrsm(rsm, settings);
    REQUIRE(kept.layers() == 8);
    CHECK(countLayers(rsm, settings) == 8);
    CHECK(kept.layersAsked == 8);
    for (int layer = 0; layer < 8; ++layer) {
        CHECK((kept.ranges[std::size_t(layer)] == dropped.ranges[0]) == (kept.validTexelsPerLayer[std::size_t(layer)] > 0));
        const LrsmTexel empty{};
        if (kept.validTexelsPerLayer[std::size_t(layer)] == 0)
            for (std::size_t i = 0; i < kept.texelsPerLayer; ++i) REQUIRE(std::memcmp(kept.level(layer, 0) + i, &empty, sizeof empty) == 0);
        else
            CHECK(std::memcmp(kept.level(layer, 0), dropped.level(0, 0), bytesOf(dropped)) == 0);
    }
}

TEST_CASE("a layer of texels that send no light is dropped, one lit texel keeps it whole", "[lrsm]")
{
    Rsm rsm = flatRsm(16, 0.1f);
    for (int x = 0; x < 16; ++x) rsm.depthLinear.at(x, 3) = 0.9f, rsm.texels.at(x, 3).radiance = Vec3(0.0f);
    const LayerSettings settings = layersOf(2, 1, 0.0f, Storage::gpu);
    const Lrsm dark = buildLrsm(rsm, settings);
    REQUIRE(dark.layers() == 1);
    CHECK(dark.ranges.front().depthMin == Approx(0.1f).epsilon(1e-3));
    rsm.texels.at(7, 3).radiance = Vec3(0.0f, 0.0f, 0.5f);
    const Lrsm lit = buildLrsm(rsm, settings);
    REQUIRE(lit.layers() == 2);
    CHECK(lit.validTexelsPerLayer.back() == 16);
    CHECK(std::memcmp(lit.level(0, 0), dark.level(0, 0), bytesOf(dark)) == 0);
}

TEST_CASE("degenerate maps: nothing drawn, one texel, one depth, the smallest size", "[lrsm]")
{
    const auto storage = GENERATE(Storage::float32, Storage::gpu);
    const float overlap = GENERATE(0.0f, 0.5f);
    const LayerSettings settings = layersOf(3, 2, overlap, storage);
    SECTION("nothing drawn")
    {
        const Lrsm lrsm = buildLrsm(syntheticRsm(16, 17, 0.0f), settings);
        CHECK(lrsm.layers() == 0);
        CHECK(lrsm.layersAsked == 6);
        CHECK(lrsm.levels() == 4);
        CHECK(bytesOf(lrsm) == 0);
    }
    SECTION("one texel")
    {
        Rsm rsm = syntheticRsm(16, 18, 0.0f);
        rsm.texels.at(5, 9) = RsmTexel{Vec3(2.0f), 1.0f, Vec3(0.0f, 1.0f, 0.0f), 1.0f};
        rsm.depthLinear.at(5, 9) = 0.625f;
        const Lrsm lrsm = buildLrsm(rsm, settings);
        REQUIRE(lrsm.layers() >= 1);
        CHECK(lrsm.level(lrsm.layers() - 1, 0)[4 * 8 + 2].normal[3] == 0.25f);
        CHECK(lrsm.level(lrsm.layers() - 1, 3)->radiance[0] == 2.0f / 256.0f);
    }
    SECTION("one depth")
    {
        const Lrsm lrsm = buildLrsm(flatRsm(16, 0.7f), settings);
        REQUIRE(lrsm.layers() >= 1);
        for (const LayerRange& range : lrsm.ranges) {
            CHECK(range.depthMin < range.depthMax);
            CHECK(range.depthMin <= 0.7f);
            CHECK(range.depthMax >= 0.7f);
        }
        forEachTexel(lrsm, [](int, int, int, int, const LrsmTexel& t) { REQUIRE((t.depth[0] >= 0.0f && t.depth[0] <= 1.0f && t.normal[3] == 1.0f)); });
    }
    SECTION("the smallest map")
    {
        const Lrsm lrsm = buildLrsm(flatRsm(2, 0.5f), settings);
        REQUIRE(lrsm.levels() == 1);
        REQUIRE(lrsm.layers() >= 1);
        CHECK(lrsm.level(0, 0)->radiance[1] == 1.0f);
    }
}

TEST_CASE("equal depths stay exactly equal up the pyramid", "[lrsm][eq10]")
{
    // A running mean of 4096 equal floats drifts; sums of pairs do not.
    const float depth = GENERATE(0.1f, 0.3f, 0.7777777f);
    LayerSettings settings = layersOf(1, 1);
    settings.fitRanges = false;
    const Lrsm lrsm = buildLrsm(flatRsm(128, depth), settings);
    forEachTexel(lrsm, [&](int, int, int, int, const LrsmTexel& t) {
        REQUIRE(t.depth[0] == depth);
        REQUIRE(t.depth[1] == depth * depth);
    });
    CHECK(lrsm.negativeVariances == 0);
}

TEST_CASE("negative variances are counted over all stored texels", "[lrsm][eq11]")
{
    const Rsm rsm = GENERATE(flatRsm(64, 0.37f), flatRsm(256, 0.613f), syntheticRsm(64, 19));
    LayerSettings settings = layersOf(2, 1, 0.0f, Storage::gpu);
    settings.fitRanges = false;
    const Lrsm lrsm = buildLrsm(rsm, settings);
    std::uint64_t negative = 0, covered = 0;
    forEachTexel(lrsm, [&](int, int, int, int, const LrsmTexel& t) {
        if (!(t.depth[2] > 0.0f)) return;
        const float mean = t.depth[0] / t.depth[2];
        negative += t.depth[1] / t.depth[2] - mean * mean < 0.0f ? 1 : 0;
        ++covered;
    });
    CHECK(lrsm.negativeVariances == negative);
    CHECK(covered >= 1365);
    if (rsm.depthLinear.at(0, 0) == 0.613f) CHECK(negative == 21845);  // planted: UNORM16 rounds z up and z^2 down
}

TEST_CASE("conversions that saturate or meet NaN are counted", "[lrsm][table1]")
{
    Rsm rsm = flatRsm(4, 0.5f, Vec3(1e6f, 1.0f, std::numeric_limits<float>::quiet_NaN()));
    LayerSettings settings = layersOf(1, 1, 0.0f, Storage::gpu);
    const Lrsm lrsm = buildLrsm(rsm, settings);
    CHECK(lrsm.conversions.halfSaturations == 4);  // stored as 65504, which no longer saturates in the level above
    CHECK(lrsm.conversions.nans == 5);
    CHECK(lrsm.level(0, 1)->radiance[0] == 65504.0f);
}

TEST_CASE("the number of threads changes no bit", "[lrsm][determinism]")
{
    const Rsm rsm = syntheticRsm(256, 20);
    const LayerSettings settings = layersOf(3, 2, 0.1f, Storage::gpu);
    std::vector<Lrsm> results;
    for (const int threads : {1, 2, 8}) {
        const ThreadLimit limit(threads);
        results.push_back(buildLrsm(rsm, settings));
    }
    CHECK(sameBits(results[0], results[1]));
    CHECK(sameBits(results[0], results[2]));
}

TEST_CASE("light scaled by 2^k scales A R exactly and nothing else", "[lrsm][invariance]")
{
    const Rsm rsm = syntheticRsm(32, 21);
    const LayerSettings settings = layersOf(3, 2);
    const Lrsm lrsm = buildLrsm(rsm, settings);
    for (const float scale : {0x1p-20f, 0.5f, 8.0f, 0x1p30f}) {
        Rsm scaled = rsm;
        for (RsmTexel& texel : scaled.texels.texels) texel.radiance *= scale;
        Lrsm expected = lrsm;
        for (LrsmTexel& texel : expected.texels)
            for (int c = 0; c < 3; ++c) texel.radiance[c] *= scale;
        CHECK(sameBits(buildLrsm(scaled, settings), expected));
    }
}

TEST_CASE("depths scaled by 2^-k, or moved by one, keep every stored bit", "[lrsm][invariance]")
{
    const float overlap = GENERATE(0.0f, 0.25f);
    const LayerSettings settings = layersOf(4, 2, overlap);
    Rsm rsm = syntheticRsm(32, 22, 1.0f, 0.0f, 0.25f);
    for (float& z : rsm.depthLinear.texels) z = std::floor(z * 1024.0f) / 1024.0f;
    rsm.depthLinear.texels[0] = 0.0f;
    rsm.depthLinear.texels[1] = 0.25f;
    const Lrsm lrsm = buildLrsm(rsm, settings);

    Rsm scaled = rsm, moved = rsm;
    for (float& z : scaled.depthLinear.texels) z *= 0.125f;
    for (float& z : moved.depthLinear.texels) z += 0.5f;
    const Lrsm byScale = buildLrsm(scaled, settings), byOffset = buildLrsm(moved, settings);
    REQUIRE(byScale.layers() == lrsm.layers());
    for (int i = 0; i < lrsm.layers(); ++i) {
        CHECK(byScale.ranges[std::size_t(i)].depthMin == 0.125f * lrsm.ranges[std::size_t(i)].depthMin);
        CHECK(byOffset.ranges[std::size_t(i)].depthMax == 0.5f + lrsm.ranges[std::size_t(i)].depthMax);
    }
    CHECK(std::memcmp(byScale.texels.data(), lrsm.texels.data(), bytesOf(lrsm)) == 0);
    CHECK(std::memcmp(byOffset.texels.data(), lrsm.texels.data(), bytesOf(lrsm)) == 0);
}
