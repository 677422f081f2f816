#include "conetrace/caches/places.h"

#include "conetrace/caches/evaluate.h"
#include "conetrace/render.h"
#include "core/base/parallel.h"
#include "core/scene/builtin_scenes.h"
#include "tests/conetrace/caches/surfaces.h"

#include "catch.h"

#include <map>
#include <numeric>
#include <random>
#include <set>

using namespace lrsm;
using namespace lrsm::test;

namespace {

NormalAxes axesOf(const std::vector<std::pair<Vec3, std::uint32_t>>& normals)
{
    static const NormalAxisFinder finder;
    std::vector<std::uint32_t> counts(std::size_t(kNormalBins) * kNormalBins, 0);
    for (const auto& [normal, count] : normals) counts[std::size_t(normalBin(normal))] += count;
    return finder.axesOf(counts);
}

/// A picture with steps in depth, three normals in turn, and holes.
GBuffer stairs(int width, int height)
{
    return gbufferOf(width, height, [](int x, int y) -> SurfacePoint {
        if ((x * 7 + y * 13) % 31 == 0) return {Vec3(0.0f), Vec3(0.0f)};
        const std::array<Vec3, 4> normals = {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)};
        const float z = -1.0f - float((x / 5 + y / 3) % 4);
        return {Vec3(0.01f * float(x), 0.01f * float(y), z), normals[std::size_t((x / 3 + y / 7) % 4)]};
    });
}

GBuffer seen(const Scene& scene, int width, int height)
{
    return renderGBuffer(scene, scene.cameras.at(0), analyseRequirements(scene, {}), {width, height});
}

}  // namespace

TEST_CASE("normal bins: a bin's middle lies in it, and bins cover the sphere", "[caches]")
{
    for (int bin = 0; bin < kNormalBins * kNormalBins; ++bin) {
        CHECK(normalBin(normalOfBin(bin)) == bin);
        CHECK(std::abs(double(glm::length(normalOfBin(bin))) - 1.0) < 1e-6);
    }
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)})
        CHECK(glm::dot(normalOfBin(normalBin(axis)), axis) > 0.98f);
}

TEST_CASE("normal axes: one normal is the first axis, and is no other's, and normals at right angles are all three", "[caches]")
{
    const Vec3 normal = normalOfBin(37);
    const NormalAxes one = axesOf({{normal, 200}});
    CHECK(one[0] == normal);
    CHECK(std::abs(glm::dot(one[1], normal)) < 0.5f);
    CHECK(std::abs(glm::dot(one[2], normal)) < 0.5f);
    CHECK(std::abs(glm::dot(one[1], one[2])) < 0.7f);
    CHECK(axisOf(normal, one) == 0);
    CHECK(axisOf(-normal, one) == 1);

    const NormalAxes three = axesOf({{Vec3(0, 1, 0), 100}, {Vec3(1, 0, 0), 60}, {Vec3(0, 0, 1), 30}});
    CHECK(glm::dot(three[0], Vec3(0, 1, 0)) > 0.98f);
    CHECK(glm::dot(three[1], Vec3(1, 0, 0)) > 0.98f);
    CHECK(glm::dot(three[2], Vec3(0, 0, 1)) > 0.98f);
    // The blur: two near normals of 55 outvote a lone one of 60.
    const NormalAxes blurred = axesOf({{normalOfBin(100), 55}, {normalOfBin(101), 55}, {Vec3(-1, 0, 0), 60}});
    CHECK(std::max(glm::dot(blurred[0], normalOfBin(100)), glm::dot(blurred[0], normalOfBin(101))) > 0.98f);
}

TEST_CASE("normal axes: weights fall as the paper has it, against a selection in double", "[caches]")
{
    std::mt19937 random(7);
    static const NormalAxisFinder finder;
    for (int trial = 0; trial < 20; ++trial) {
        std::vector<std::uint32_t> counts(256, 0);
        for (int k = 0; k < 6; ++k) counts[random() % 256] += std::uint32_t(1 + random() % 50);
        std::vector<double> w(256, 0.0);
        const double pixels = std::accumulate(counts.begin(), counts.end(), 0.0);
        for (int i = 0; i < 256; ++i)
            for (int j = 0; j < 256; ++j)
                w[std::size_t(i)] += counts[std::size_t(j)] / pixels * std::exp(30.0 * (double(glm::dot(normalOfBin(i), normalOfBin(j))) - 1.0));
        const NormalAxes axes = finder.axesOf(counts);
        for (const Vec3& axis : axes) {
            const auto best = std::size_t(std::max_element(w.begin(), w.end()) - w.begin());
            // Of bins of all but one weight either may be taken.
            CHECK(w[std::size_t(normalBin(axis))] > w[best] * (1.0 - 1e-5));
            for (int i = 0; i < 256; ++i)
                w[std::size_t(i)] = (w[std::size_t(i)] + 1.0) * (1.0 - std::pow(std::abs(double(glm::dot(normalOfBin(i), axis))), 8.0));
            CHECK(w[std::size_t(normalBin(axis))] < 1e-3);
        }
    }
}

TEST_CASE("clusters: pixels in any order make the same clusters, by any number of threads", "[caches]")
{
    const GBuffer g = stairs(75, 41);
    const Camera camera;
    const CacheSettings settings{.tile = 16, .minPixels = 0};
    const PixelClusters clusters = clusterPixels(g, camera, settings);
    {
        const ThreadLimit one(1);
        CHECK(hashOf(clusterPixels(g, camera, settings)) == hashOf(clusters));
    }
    // Each pixel falls to its key by itself; the pixels come shuffled.
    const DepthSlices slices(camera, g.height, settings.tile);
    std::vector<std::uint32_t> order(g.objectId.texels.size());
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), std::mt19937(3));
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::set<std::uint32_t>> expected;
    for (const std::uint32_t pixel : order) {
        if (!g.covered(pixel)) continue;
        const auto tile = (pixel / 75 / 16) * 5 + pixel % 75 / 16;
        const auto axis = std::uint32_t(axisOf(g.normal.texels[pixel], clusters.axes[tile]));
        expected[{tile, slices(g.depthLinear.texels[pixel]) << kSliceShift | axis}].insert(pixel);
    }
    REQUIRE(clusters.size() == expected.size());
    CHECK(clusters.size() > 100);
    std::size_t c = 0;
    for (const auto& [key, pixels] : expected) {
        CHECK(clusters.keys[c] == key.second);
        CHECK(clusters.tileFirst[key.first] <= c);
        CHECK(c < clusters.tileFirst[key.first + 1]);
        CHECK(std::vector<std::uint32_t>(pixels.begin(), pixels.end()) ==
              std::vector<std::uint32_t>(clusters.pixels.begin() + clusters.first[c], clusters.pixels.begin() + clusters.first[c + 1]));
        for (const std::uint32_t pixel : pixels) REQUIRE(clusters.clusterOf.texels[pixel] == c + 1);
        ++c;
    }
}

TEST_CASE("clusters: are as deep as a tile is wide, whatever the distance", "[caches]")
{
    Camera camera;
    const DepthSlices slices(camera, 720, 16);
    // Where a slice ends, its depth over the height of a tile there.
    const double tileAtOneMetre = 2.0 * std::tan(0.4) * 16.0 / 720.0;
    for (const double z : {0.1, 1.0, 20.0, 500.0}) {
        const std::uint32_t slice = slices(float(z));
        double begin = z, end = z;
        while (slices(float(begin)) == slice) begin *= 1.0 - 1e-4;
        while (slices(float(end)) == slice) end *= 1.0 + 1e-4;
        CHECK((end - begin) / (begin * tileAtOneMetre) == Approx(1.0).margin(0.02));
    }
    camera.perspective = false;
    camera.verticalExtent = 4.5f;
    const DepthSlices flat(camera, 720, 16);
    CHECK(flat(0.05f) == 0);
    CHECK(flat(0.15f) == 1);
    CHECK(flat(10.05f) == 100);
}

TEST_CASE("clusters: small ones join the nearest of their axis, more than rc_max double the tile", "[caches]")
{
    const GBuffer g = stairs(75, 41);
    const Camera camera;
    const PixelClusters all = clusterPixels(g, camera, {.tile = 16, .minPixels = 0}), joined = clusterPixels(g, camera, {.tile = 16, .minPixels = 8});
    CHECK(joined.size() < all.size());
    CHECK(joined.pixels.size() == all.pixels.size());
    std::set<std::uint32_t> keysBefore(all.keys.begin(), all.keys.end());
    for (const std::uint32_t pixel : all.pixels) {
        const std::uint32_t before = all.keys[all.clusterOf.texels[pixel] - 1], after = joined.keys[joined.clusterOf.texels[pixel] - 1];
        REQUIRE((before & 7u) == (after & 7u));
        REQUIRE(keysBefore.contains(after));
    }
    const PixelClusters few = clusterPixels(g, camera, {.tile = 4, .maxCaches = 150});
    CHECK(few.tile > 4);
    CHECK(few.size() <= 150);
    CHECK(clusterPixels(g, camera, {.tile = few.tile / 2}).size() > 150);
    CHECK(clusterPixels(g, camera, {.tile = 4, .maxCaches = 1}).tilesX == 1);
}

TEST_CASE("places: on a plane the pixel nearest the cluster's middle, on a cap its apex, and never a normal that turns away", "[caches]")
{
    const Camera camera;
    const CacheScoreScale scale = GENERATE(CacheScoreScale::cluster, CacheScoreScale::metre);
    const CacheSettings settings{.tile = 32, .scoreScale = scale};
    const auto placed = [&](const GBuffer& g) {
        PixelClusters one = clusterPixels(g, camera, settings);
        // As one cluster, whatever the depth.
        one.keys.resize(1);
        std::sort(one.pixels.begin(), one.pixels.end());
        one.first = {0, std::uint32_t(one.pixels.size())};
        return placeCaches(g, camera, one, settings, Rotation::none);
    };
    const auto plane = [](int x, int y) { return SurfacePoint{Vec3(0.01f * float(x), 0.01f * float(y), -1.0f), Vec3(0, 0, 1)}; };
    const CachePlaces flat = placed(gbufferOf(31, 31, plane));
    REQUIRE(flat.size() == 1);
    CHECK(flat.pixels[0] == 15 * 31 + 15);
    CHECK(flat.normals[0] == Vec3(0, 0, 1));
    CHECK(flat.pixelSizes[0] == Approx(2.0 * std::tan(0.4) / 31.0));

    const auto cap = [](int x, int y) {
        const Vec2 at(0.02f * float(x - 12), 0.02f * float(y - 18));
        const float z = std::sqrt(1.0f - glm::dot(at, at));
        return SurfacePoint{Vec3(at, z - 2.0f), Vec3(at, z)};
    };
    CHECK(placed(gbufferOf(25, 37, cap)).pixels[0] == 18 * 25 + 12);

    // In the middle stands one with its back turned.
    const auto turned = [&](int x, int y) {
        SurfacePoint at = plane(x, y);
        if (x == 15 && y == 15) at.normal = Vec3(0, 0, -1);
        return at;
    };
    CHECK(placed(gbufferOf(31, 31, turned)).normals[0] == Vec3(0, 0, 1));
}

TEST_CASE("caches: every covered pixel of every scene reads one, within two tiles its own cluster's by weight", "[caches]")
{
    for (const BuiltinSceneInfo& info : builtinScenes()) {
        CAPTURE(info.name);
        const Scene scene = *makeBuiltinScene(info.name);
        const GBuffer g = seen(scene, 160, 90);
        for (const float radius : {1.0f, 2.0f}) {
            const CacheSettings settings{.tile = 8, .radius = radius, .minCosine = -1.0f};
            const PixelClusters clusters = clusterPixels(g, scene.cameras[0], settings);
            const CachePlaces places = placeCaches(g, scene.cameras[0], clusters, settings, Rotation::none);
            const CacheAtlas none;
            const CacheWorld world{.gbuffer = g, .camera = scene.cameras[0], .clusters = clusters, .places = places, .atlas = none, .settings = settings};
            std::size_t covered = 0, read = 0, withoutOwn = 0;
            for (int y = 0; y < g.height; ++y)
                for (int x = 0; x < g.width; ++x) {
                    const std::size_t pixel = g.position.index(x, y);
                    if (!g.covered(pixel)) continue;
                    ++covered;
                    bool any = false;
                    forCachesOf(world, x, y, [&](std::uint32_t cache, float weight) { any = any || (cache < places.size() && weight > 0.0f); });
                    read += any ? 1 : 0;
                    const std::uint32_t own = clusters.clusterOf.texels[pixel] - 1;
                    withoutOwn += cacheWeight(world, own, x, y, g.position.texels[pixel]).least() > 0.0f ? 0 : 1;
                }
            CHECK(read == covered);
            CHECK(covered == clusters.pixels.size());
            if (radius == 2.0f) CHECK(withoutOwn == 0);
        }
    }
}

TEST_CASE("caches: as many on a grid over the picture leave more pixels without one that faces as they do ([C] Fig. 6)", "[caches]")
{
    std::size_t clusteredWithout = 0, gridWithout = 0, covered = 0;
    for (const char* name : {"cornell-box", "atrium"}) {
        const Scene scene = *makeBuiltinScene(name);
        const GBuffer g = seen(scene, 160, 90);
        const CacheSettings settings{.tile = 8, .radius = 2.0f};
        const PixelClusters clusters = clusterPixels(g, scene.cameras[0], settings);
        const CachePlaces places = placeCaches(g, scene.cameras[0], clusters, settings, Rotation::none);

        // A cluster a square, of as many squares.
        const float pitch = std::sqrt(float(clusters.pixels.size()) / float(places.size()));
        PixelClusters squares;
        squares.tile = settings.tile;
        for (float y = 0.5f * pitch; y < 90.0f; y += pitch)
            for (float x = 0.5f * pitch; x < 160.0f; x += pitch) {
                const std::size_t pixel = g.position.index(int(x), int(y));
                if (g.covered(pixel)) squares.pixels.push_back(std::uint32_t(pixel));
            }
        squares.keys.resize(squares.pixels.size());
        squares.first.resize(squares.pixels.size() + 1);
        std::iota(squares.first.begin(), squares.first.end(), 0u);
        const CachePlaces grid = placeCaches(g, scene.cameras[0], squares, settings, Rotation::none);
        CHECK(double(grid.size()) == Approx(double(places.size())).epsilon(0.15));

        const auto without = [&](const CachePlaces& all) {
            const CacheAtlas none;
            const CacheWorld world{.gbuffer = g, .camera = scene.cameras[0], .clusters = clusters, .places = all, .atlas = none, .settings = settings};
            std::size_t count = 0;
            for (std::size_t pixel = 0; pixel < g.objectId.texels.size(); ++pixel) {
                const Vec3 position = g.position.texels[pixel], normal = g.normal.texels[pixel];
                bool any = !g.covered(pixel);
                for (std::uint32_t cache = 0; cache < all.size() && !any; ++cache)
                    any =
                        glm::dot(normal, all.normals[cache]) >= 0.5f && cacheWeight(world, cache, int(pixel % 160), int(pixel / 160), position).least() > 0.0f;
                count += any ? 0 : 1;
            }
            return count;
        };
        clusteredWithout += without(places);
        gridWithout += without(grid);
        covered += clusters.pixels.size();
    }
    CAPTURE(clusteredWithout, gridWithout, covered);
    CHECK(clusteredWithout * 4 < gridWithout);
    CHECK(clusteredWithout * 1000 < covered);
}
