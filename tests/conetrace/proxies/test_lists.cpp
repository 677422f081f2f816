#include "conetrace/proxies/filter.h"

#include "conetrace/proxies/evaluate.h"
#include "tests/conetrace/caches/surfaces.h"

#include "catch.h"

#include <map>
#include <random>

using namespace lrsm;
using namespace lrsm::test;

namespace {

constexpr int kWidth = 50, kHeight = 39, kDivisor = 4;
constexpr std::size_t kCells = 1000;
const Vec3 kFar(0.0f, 1e6f, 0.0f);

/// A floor below, a wall on the left, and nothing on the right.
GBuffer corner()
{
    return gbufferOf(kWidth, kHeight, [](int x, int y) -> SurfacePoint {
        if (x > 40) return {Vec3(0.0f), Vec3(0.0f)};
        return y > 20 ? SurfacePoint{Vec3(float(x), -1.0f, -2.0f - 0.1f * float(kHeight - y)), Vec3(0, 1, 0)}
                      : SurfacePoint{Vec3(float(x), 1.0f, -5.0f), Vec3(0, 0, 1)};
    });
}

VisibilityLists randomLists(const GBuffer& g, bool equal = false)
{
    const Blocks blocks{g.width, g.height, kDivisor};
    std::mt19937 random(3);
    std::uniform_int_distribution<std::uint32_t> cell(0, kCells - 1);
    VisibilityLists lists;
    lists.divisor = kDivisor;
    lists.first = {0};
    CellSet set(kCells);
    std::vector<std::uint32_t> one, hits;
    for (std::size_t block = 0; block < std::size_t(blocks.columns() * blocks.rows()); ++block) {
        if (!equal || one.empty()) {
            one.clear();
            VisibilityLists drawn;
            for (int k = 0; k < 12; ++k) set.add(cell(random), 1);
            set.moveTo(drawn);
            one = drawn.cells;
            hits = drawn.hits;
        }
        lists.cells.insert(lists.cells.end(), one.begin(), one.end());
        lists.hits.insert(lists.hits.end(), hits.begin(), hits.end());
        lists.first.push_back(std::uint32_t(lists.cells.size()));
        lists.opacity.push_back(0.5f);
        lists.lobeOpacity.push_back(1.0f);
        lists.rays.push_back(64);
    }
    return lists;
}

std::map<std::uint32_t, std::uint32_t> hitsOf(const VisibilityLists& lists, std::size_t block)
{
    std::map<std::uint32_t, std::uint32_t> hits;
    for (std::size_t entry = lists.first[block]; entry < lists.first[block + 1]; ++entry) hits[lists.cells[entry]] = lists.hits[entry];
    return hits;
}

/// Cells whose centroids are all at one place.
ProxyCells cellsAt(const Vec3& place)
{
    ProxyCells cells;
    cells.grid.size = IVec3(10);
    cells.lights.resize(kCells);
    for (CellLight& light : cells.lights) light.centroid = place;
    return cells;
}

}  // namespace

TEST_CASE("visibility lists: a set of cells comes out rising, each once with its hits, and is empty then", "[proxies]")
{
    std::mt19937 random(5);
    std::uniform_int_distribution<std::uint32_t> cell(0, kCells - 1);
    CellSet set(kCells);
    for (int round = 0; round < 5; ++round) {
        std::map<std::uint32_t, std::uint32_t> expected;
        for (int k = 0; k < 100; ++k) {
            const std::uint32_t c = cell(random) % 200, hits = std::uint32_t(k % 3);
            set.add(c, hits);
            expected[c] += hits;
        }
        VisibilityLists out;
        set.moveTo(out);
        std::map<std::uint32_t, std::uint32_t> found;
        for (std::size_t i = 0; i < out.cells.size(); ++i) found[out.cells[i]] = out.hits.at(i);
        CHECK(std::is_sorted(out.cells.begin(), out.cells.end()));
        CHECK(out.cells.size() == expected.size());
        CHECK(found == expected);
    }
}

TEST_CASE("visibility filter: Eq. 4 as printed against a union in maps with sums of hits, each list is in its filtered one", "[proxies]")
{
    const GBuffer g = corner();
    const Blocks blocks{g.width, g.height, kDivisor};
    const VisibilityLists lists = randomLists(g);
    const int radius = GENERATE(1, 3);
    const VisibilityLists filtered = filterVisibility(lists, g, cellsAt(kFar), {.filterRadius = radius, .filterTest = ProxyFilterTest::printed});
    REQUIRE(filtered.size() == lists.size());
    std::size_t refused = 0, joined = 0;
    for (int row = 0; row < blocks.rows(); ++row)
        for (int column = 0; column < blocks.columns(); ++column) {
            const std::size_t block = std::size_t(row * blocks.columns() + column), pixel = blocks.pixel(column, row);
            std::map<std::uint32_t, std::uint32_t> expected;
            std::uint32_t rays = 0;
            for (int j = -radius; j <= radius && g.covered(pixel); ++j)
                for (int i = -radius; i <= radius; ++i) {
                    if (row + j < 0 || row + j >= blocks.rows() || column + i < 0 || column + i >= blocks.columns()) continue;
                    const std::size_t other = blocks.pixel(column + i, row + j);
                    const double z = double(g.depthLinear.texels[pixel]), dz = double(g.depthLinear.texels[other]) - z;
                    const bool same = g.covered(other) && std::abs(dz)<0.05 * z&& double(glm::dot(g.normal.texels[pixel], g.normal.texels[other]))> 0.9;
                    ++(same ? joined : refused);
                    if (!same) continue;
                    const auto from = std::size_t((row + j) * blocks.columns() + column + i);
                    for (std::size_t entry = lists.first[from]; entry < lists.first[from + 1]; ++entry) expected[lists.cells[entry]] += lists.hits[entry];
                    rays += 64;
                }
            REQUIRE(filtered.rays[block] == rays);
            REQUIRE(hitsOf(filtered, block) == expected);
            if (g.covered(pixel))
                for (const std::uint32_t cell : lists.of(block)) REQUIRE(expected.contains(cell));
        }
    CHECK(joined > 200);
    CHECK(refused > 200);
}

TEST_CASE("gathering: weights of the four lists sum to 1, are bilinear on a plane, and leave out another surface", "[proxies]")
{
    const GBuffer g = corner();
    const Blocks blocks{g.width, g.height, kDivisor};
    for (int y = 0; y < g.height; ++y)
        for (int x = 0; x <= 40; ++x) {
            const ListWeights w = listWeights(g, kDivisor, x, y);
            REQUIRE(double(w.weight[0] + w.weight[1] + w.weight[2] + w.weight[3]) == Approx(1.0).epsilon(1e-5));
            for (std::size_t k = 0; k < 4; ++k) {
                if (!(w.weight[k] > 0.0f)) continue;
                const std::size_t other = blocks.pixel(int(w.block[k]) % blocks.columns(), int(w.block[k]) / blocks.columns());
                REQUIRE(g.covered(other));
                // A block across the edge at y = 20 counts only where no other does.
                if (w.weight[k] < 1.0f) REQUIRE(((y > 20) == (int(other) / g.width > 20) || w.weight[k] < 1e-6f));
            }
            // On the wall, away from its borders: bilinear between the blocks' pixels, which are at 4 i + 2.
            if (y < 2 || y >= 18 || x < 2 || x >= 38) continue;
            const double fx = (x - 2) % 4 / 4.0, fy = (y - 2) % 4 / 4.0;
            REQUIRE(double(w.weight[0]) == Approx((1 - fx) * (1 - fy)).margin(1e-6));
            REQUIRE(double(w.weight[3]) == Approx(fx * fy).margin(1e-6));
        }
}

TEST_CASE("gathering: with equal lists each cell has the weight 1, whatever the pixel, else the sum over the lists that hold it", "[proxies]")
{
    const GBuffer g = corner();
    const VisibilityLists equal = randomLists(g, true), lists = randomLists(g);
    for (int y = 0; y < g.height; y += 3)
        for (int x = 0; x <= 40; x += 3) {
            const ListWeights w = listWeights(g, kDivisor, x, y);
            std::vector<std::uint32_t> visited;
            forListedCells(equal, w, [&](std::uint32_t cell, float weight, float share) {
                visited.push_back(cell);
                REQUIRE(weight == Approx(1.0f));
                REQUIRE(share == Approx(hitsOf(equal, 0).at(cell) / 64.0));
            });
            const auto all = equal.of(0);
            REQUIRE(visited == std::vector<std::uint32_t>(all.begin(), all.end()));

            std::vector<double> expected(kCells, 0.0), found(kCells, 0.0);
            for (std::size_t k = 0; k < 4; ++k)
                if (w.weight[k] > 0.0f)
                    for (const std::uint32_t cell : lists.of(w.block[k])) expected[cell] += double(w.weight[k]);
            forListedCells(lists, w, [&](std::uint32_t cell, float weight, float) { found[cell] += double(weight); });
            for (std::size_t c = 0; c < kCells; ++c) REQUIRE(found[c] == Approx(expected[c]).margin(1e-6));
        }
}

TEST_CASE("visibility filter: a thin wall parts two floors of one depth and normal, an opening in it joins what sees through it", "[proxies]")
{
    // A floor seen from above at one depth, a wall of one pixel's width across it at x = 25, open above y = 12.
    const GBuffer g = gbufferOf(kWidth, kHeight, [](int x, int y) -> SurfacePoint {
        if (x == 25 && y >= 12) return {Vec3(float(x), float(-y), -99.0f), Vec3(0, 0, 1)};
        return {Vec3(float(x), float(-y), -100.0f), Vec3(0, 0, 1)};
    });
    const Blocks blocks{g.width, g.height, kDivisor};
    const VisibilityLists lists = randomLists(g);
    constexpr int kRadius = 3;
    const VisibilityLists filtered = filterVisibility(lists, g, cellsAt(kFar), {.filterRadius = kRadius, .filterTest = ProxyFilterTest::surface});
    const auto sameSide = [&](int a, int b) { return (blocks.middle(a, g.width) < 25) == (blocks.middle(b, g.width) < 25); };
    std::size_t parted = 0, through = 0;
    for (int row = 0; row < blocks.rows(); ++row)
        for (int column = 0; column < blocks.columns(); ++column) {
            std::uint32_t rays = 0;
            for (int y = std::max(0, row - kRadius); y <= std::min(blocks.rows() - 1, row + kRadius); ++y)
                for (int x = std::max(0, column - kRadius); x <= std::min(blocks.columns() - 1, column + kRadius); ++x) {
                    // The shortest ways lead through the rows from one block's to the other's: one of them is open, or none.
                    const bool open = sameSide(column, x) || blocks.middle(std::min(row, y), g.height) < 12;
                    ++(open ? through : parted);
                    rays += open ? 64 : 0;
                }
            REQUIRE(filtered.rays[std::size_t(row * blocks.columns() + column)] == rays);
        }
    CHECK(parted > 200);
    CHECK(through > 200);
}

TEST_CASE("visibility filter: lists go no farther than .15 of the harmonic mean distance of what rays meet, and always one block", "[proxies]")
{
    const GBuffer g = gbufferOf(kWidth, kHeight, [](int x, int y) -> SurfacePoint { return {Vec3(float(x), float(-y), -100.0f), Vec3(0, 0, 1)}; });
    const Blocks blocks{g.width, g.height, kDivisor};
    const VisibilityLists lists = randomLists(g);
    constexpr int column = 6, row = 5;
    const int from = row * blocks.columns() + column;
    const Vec3 position = g.position.texels[blocks.pixel(column, row)];
    const float distance = GENERATE(2.0f, 12.0f, 50.0f);
    const ProxyCells cells = cellsAt(position + Vec3(0.0f, 0.0f, distance));
    const std::vector<float> nearness = nearnessOfBlocks(lists, g, cells);
    const VisibilityLists filtered = filterVisibility(lists, g, cells, {.filterRadius = 4, .filterTest = ProxyFilterTest::surface});
    // Twelve rays of 64 met anything.
    CHECK(double(nearness[std::size_t(from)]) == Approx(12.0 / 64.0 / double(distance)).epsilon(1e-4));
    std::uint32_t rays = 0;
    for (int j = -4; j <= 4; ++j)
        for (int i = -4; i <= 4; ++i) {
            const double most = double(std::max(nearness[std::size_t(from)], nearness[std::size_t(from + j * blocks.columns() + i)]));
            const double apart = glm::distance(glm::dvec3(position), glm::dvec3(g.position.texels[blocks.pixel(column + i, row + j)]));
            if (std::max(std::abs(i), std::abs(j)) <= 1 || apart * most < 0.15) rays += 64;
        }
    CHECK(filtered.rays[std::size_t(from)] == rays);
}
