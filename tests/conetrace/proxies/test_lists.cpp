#include "conetrace/proxies/filter.h"

#include "conetrace/proxies/evaluate.h"
#include "tests/conetrace/caches/surfaces.h"

#include "catch.h"

#include <random>
#include <set>

using namespace lrsm;
using namespace lrsm::test;

namespace {

constexpr int kWidth = 50, kHeight = 39, kDivisor = 4;
constexpr std::size_t kCells = 1000;

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
    std::vector<std::uint32_t> one;
    for (std::size_t block = 0; block < std::size_t(blocks.columns() * blocks.rows()); ++block) {
        if (!equal || one.empty()) {
            one.clear();
            for (int k = 0; k < 12; ++k) set.add(cell(random));
            set.moveTo(one);
        }
        lists.cells.insert(lists.cells.end(), one.begin(), one.end());
        lists.first.push_back(std::uint32_t(lists.cells.size()));
        lists.opacity.push_back(0.5f);
        lists.lobeOpacity.push_back(1.0f);
        lists.rays.push_back(64);
    }
    return lists;
}

}  // namespace

TEST_CASE("visibility lists: a set of cells comes out rising, each once, and is empty then", "[proxies]")
{
    std::mt19937 random(5);
    std::uniform_int_distribution<std::uint32_t> cell(0, kCells - 1);
    CellSet set(kCells);
    for (int round = 0; round < 5; ++round) {
        std::set<std::uint32_t> expected;
        for (int k = 0; k < 100; ++k) {
            const std::uint32_t c = cell(random);
            set.add(c);
            expected.insert(c);
        }
        std::vector<std::uint32_t> out;
        set.moveTo(out);
        CHECK(out == std::vector<std::uint32_t>(expected.begin(), expected.end()));
    }
}

TEST_CASE("visibility filter: Eq. 4 against a union in sets, each list is in its filtered one", "[proxies]")
{
    const GBuffer g = corner();
    const Blocks blocks{g.width, g.height, kDivisor};
    const VisibilityLists lists = randomLists(g);
    const int radius = GENERATE(1, 3);
    const VisibilityLists filtered = filterVisibility(lists, g, radius, kCells);
    REQUIRE(filtered.size() == lists.size());
    std::size_t refused = 0, joined = 0;
    for (int row = 0; row < blocks.rows(); ++row)
        for (int column = 0; column < blocks.columns(); ++column) {
            const std::size_t block = std::size_t(row * blocks.columns() + column), pixel = blocks.pixel(column, row);
            std::set<std::uint32_t> expected;
            std::uint32_t rays = 0;
            for (int j = -radius; j <= radius && g.covered(pixel); ++j)
                for (int i = -radius; i <= radius; ++i) {
                    if (row + j < 0 || row + j >= blocks.rows() || column + i < 0 || column + i >= blocks.columns()) continue;
                    const std::size_t other = blocks.pixel(column + i, row + j);
                    const double z = double(g.depthLinear.texels[pixel]), dz = double(g.depthLinear.texels[other]) - z;
                    const bool same = g.covered(other) && std::abs(dz)<0.05 * z&& double(glm::dot(g.normal.texels[pixel], g.normal.texels[other]))> 0.9;
                    ++(same ? joined : refused);
                    if (!same) continue;
                    const auto list = lists.of(std::size_t((row + j) * blocks.columns() + column + i));
                    expected.insert(list.begin(), list.end());
                    rays += 64;
                }
            REQUIRE(filtered.rays[block] == rays);
            const auto list = filtered.of(block);
            REQUIRE(std::vector<std::uint32_t>(list.begin(), list.end()) == std::vector<std::uint32_t>(expected.begin(), expected.end()));
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
            forListedCells(equal, w, [&](std::uint32_t cell, float weight) {
                visited.push_back(cell);
                REQUIRE(weight == Approx(1.0f));
            });
            const auto all = equal.of(0);
            REQUIRE(visited == std::vector<std::uint32_t>(all.begin(), all.end()));

            std::vector<double> expected(kCells, 0.0), found(kCells, 0.0);
            for (std::size_t k = 0; k < 4; ++k)
                if (w.weight[k] > 0.0f)
                    for (const std::uint32_t cell : lists.of(w.block[k])) expected[cell] += double(w.weight[k]);
            forListedCells(lists, w, [&](std::uint32_t cell, float weight) { found[cell] += double(weight); });
            for (std::size_t c = 0; c < kCells; ++c) REQUIRE(found[c] == Approx(expected[c]).margin(1e-6));
        }
}
