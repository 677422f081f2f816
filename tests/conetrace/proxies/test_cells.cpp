#include "conetrace/proxies/cells.h"

#include "conetrace/proxies/march.h"
#include "core/scene/builtin_scenes.h"
#include "tests/conetrace/proxies/proxy_scenes.h"

#include "catch.h"

#include <numbers>

using namespace lrsm;
using namespace lrsm::test;

namespace {

ProxyCells cellsOf(const Scene& scene, const ProxySettings& settings, const Vec3& radiance = Vec3(1.0f))
{
    const PointProxies proxies = placeProxies(scene, settings, TextureFilter::trilinear);
    return sortProxies(scene, proxies, shining(proxies, radiance), settings);
}

}  // namespace

TEST_CASE("proxy cells: each proxy stands once, in the cell that Eq. 1 says, those that shine first", "[proxies]")
{
    const Scene scene = *makeBuiltinScene("atrium");
    const ProxySettings settings{.count = 5000, .grid = 7};
    const PointProxies proxies = placeProxies(scene, settings, TextureFilter::trilinear);
    ProxyLight light = shining(proxies, Vec3(1, 2, 3));
    for (std::size_t i = 0; i < proxies.size(); i += 3) light.radiance[i] = Vec3(0.0f);
    const ProxyCells cells = sortProxies(scene, proxies, light, settings);
    const CellGrid& grid = cells.grid;
    CHECK(std::max({grid.size.x, grid.size.y, grid.size.z}) == 7);
    CHECK(double(grid.cellSize) == Approx(double(scene.bounds.longestSide()) / 7.0).epsilon(2e-4));

    std::vector<int> seen(proxies.size(), 0);
    for (std::uint32_t cell = 0; cell < grid.count(); ++cell) {
        std::uint32_t before = 0;
        for (std::uint32_t slot = cells.first[cell] * 4; slot < cells.first[cell + 1] * 4; ++slot) {
            const std::uint32_t number = cells.numbers[slot];
            if (number == kNoProxy) continue;
            ++seen[number];
            const Vec3 p = proxies.positions[number], v = (p - grid.origin) / grid.cellSize;
            const auto whole = [](float x) { return static_cast<std::uint32_t>(std::floor(x)); };
            const auto dx = static_cast<std::uint32_t>(grid.size.x), dy = static_cast<std::uint32_t>(grid.size.y);
            REQUIRE(whole(v.z) * dx * dy + whole(v.y) * dx + whole(v.x) == cell);
            const bool shines = slot < cells.litEnd[cell] * 4;
            REQUIRE(shines == (number % 3 != 0));
            const ProxyQuad& quad = cells.quads[slot / 4];
            REQUIRE(Vec3(quad.x[slot % 4], quad.y[slot % 4], quad.z[slot % 4]) == p);
            REQUIRE(quad.blue[slot % 4] == (shines ? 3.0f : 0.0f));
            if (slot != cells.first[cell] * 4 && slot != cells.litEnd[cell] * 4) REQUIRE(number > before);
            before = number;
        }
    }
    for (const int count : seen) REQUIRE(count == 1);
}

TEST_CASE("proxy cells: harmonics of one light are 3/4, 1/4 and 0 of its intensity at 0, 90 and 180 degrees, and carry pi L a and what the clamp adds",
          "[proxies]")
{
    PointProxies one;
    one.area = 0.25f;
    one.positions = {Vec3(0.5f)};
    one.normals = {glm::normalize(Vec3(1, 2, -2))};
    Scene scene = quadScene({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 1), Vec3(0, 1, 1)}});
    const ProxyCells cells = sortProxies(scene, one, shining(one, Vec3(2.0f, 4.0f, 8.0f)), {.grid = 3});
    const CellLight& light = cells.lights[cells.grid.hash(cells.grid.cellAt(one.positions[0]))];
    const Vec3 n = one.normals[0], across = glm::normalize(glm::cross(n, Vec3(0, 1, 0)));
    CHECK(light.intensity(n).y == Approx(0.75f * 4.0f * 0.25f));
    CHECK(light.intensity(across).y == Approx(0.25f * 4.0f * 0.25f));
    CHECK(light.intensity(-n) == Vec4(0.0f));
    CHECK(light.intensity(n).w == Approx(0.75f * 0.25f));
    CHECK(light.litArea == 0.25f);
    CHECK(light.centroid == Vec3(0.5f));

    // Over the sphere: pi, and 1/8 more by the clamp: 2 pi int_{-1/2}^1 (1/4 + c/2) dc = 9 pi / 8.
    double flux = 0.0;
    constexpr int kSteps = 2000;
    for (int k = 0; k < kSteps; ++k) {
        const double c = -1.0 + (k + 0.5) * 2.0 / kSteps;
        flux += double(light.intensity(n * float(c) + across * float(std::sqrt(1.0 - c * c))).x) * 2.0 * std::numbers::pi * 2.0 / kSteps;
    }
    CHECK(flux == Approx(9.0 / 8.0 * std::numbers::pi * 2.0 * 0.25).epsilon(1e-3));
}

TEST_CASE("proxy cells: a ray visits the cells that a fine walk along it does, in their order", "[proxies]")
{
    const CellGrid grid{.origin = Vec3(-1.0f, 2.0f, 0.5f), .cellSize = 0.37f, .size = IVec3(5, 3, 9)};
    std::mt19937 random(7);
    std::uniform_real_distribution<float> around(-0.5f, 1.5f);
    std::size_t rays = 0, visited = 0;
    for (int k = 0; k < 600; ++k) {
        const Vec3 extent = Vec3(grid.size) * grid.cellSize;
        const Vec3 origin = grid.origin + extent * Vec3(around(random), around(random), around(random));
        Vec3 direction = randomUnit(random);
        if (k % 10 == 0) direction = Vec3(0, k % 20 == 0 ? 1 : -1, 0);
        std::vector<std::uint32_t> walked, fine;
        walkCells(grid, origin, direction, [&](std::uint32_t cell) {
            walked.push_back(cell);
            return false;
        });
        // In double, cells whose chord is longer than what the fine walk may step over.
        std::vector<std::pair<std::uint32_t, int>> runs;
        constexpr double kStep = 2e-4;
        for (double t = 0.0; t < 12.0; t += kStep) {
            const glm::dvec3 at = (glm::dvec3(origin) + t * glm::dvec3(direction) - glm::dvec3(grid.origin)) / double(grid.cellSize);
            const glm::ivec3 v(glm::floor(at));
            if (glm::any(glm::lessThan(v, IVec3(0))) || glm::any(glm::greaterThanEqual(v, grid.size))) continue;
            const std::uint32_t cell = grid.hash(v);
            if (runs.empty() || runs.back().first != cell)
                runs.push_back({cell, 1});
            else
                ++runs.back().second;
        }
        for (const auto& [cell, steps] : runs)
            if (steps > 3) fine.push_back(cell);
        // The others of the walk are grazed.
        std::size_t next = 0;
        for (const std::uint32_t cell : walked)
            if (next < fine.size() && cell == fine[next]) ++next;
        CAPTURE(k);
        REQUIRE(next == fine.size());
        REQUIRE(walked.size() <= fine.size() + 3);
        rays += walked.empty() ? 0 : 1;
        visited += walked.size();
    }
    CHECK(rays > 100);
    CHECK(visited > 3 * rays);
}

TEST_CASE("proxy cells: a ray meets the first cell of which it meets a disc, and of that the nearest, against all discs in double", "[proxies]")
{
    const Scene scene = *makeBuiltinScene("cornell-box");
    const ProxyCells cells = cellsOf(scene, {.count = 800, .radius = 1.0f, .grid = 5});
    std::mt19937 random(11);
    std::uniform_real_distribution<float> inside(0.1f, 0.9f);
    const double radius2 = double(cells.discRadius) * double(cells.discRadius);
    std::size_t met = 0, through = 0;
    for (int k = 0; k < 400; ++k) {
        const Vec3 origin = scene.bounds.min + scene.bounds.extent() * Vec3(inside(random), inside(random), inside(random)), direction = randomUnit(random);
        const glm::dvec3 o(origin), d(direction);
        // Per cell: which of its discs is met first, and where; and by how much the nearest miss or hit is decided.
        std::vector<double> meets(cells.grid.count(), double(kInfinity));
        std::vector<std::size_t> nearest(cells.grid.count(), 0);
        double closest = 1.0;
        for (std::uint32_t cell = 0; cell < cells.grid.count(); ++cell)
            for (std::uint32_t slot = cells.first[cell] * 4; slot < cells.first[cell + 1] * 4; ++slot) {
                if (cells.numbers[slot] == kNoProxy) continue;
                const ProxyQuad& q = cells.quads[slot / 4];
                const std::size_t lane = slot % 4;
                const glm::dvec3 p(q.x[lane], q.y[lane], q.z[lane]), n(q.nx[lane], q.ny[lane], q.nz[lane]);
                const double t = glm::dot(n, p - o) / glm::dot(n, d);
                const glm::dvec3 away = o + t * d - p;
                closest = std::min(closest, std::abs(glm::dot(away, away) / radius2 - 1.0));
                if (!(t > 0.0 && glm::dot(away, away) <= radius2)) continue;
                closest = std::min(closest, std::abs(t - meets[cell]));
                if (t < meets[cell]) nearest[cell] = slot;
                meets[cell] = std::min(meets[cell], t);
            }
        if (closest < 1e-4) continue;
        std::uint32_t expected = kNoCell;
        walkCells(cells.grid, origin, direction, [&](std::uint32_t cell) {
            if (meets[cell] < double(kInfinity)) expected = cell;
            return meets[cell] < double(kInfinity);
        });
        const ShadowRay ray(origin, direction);
        REQUIRE(cellMet(cells, ray) == expected);
        if (expected != kNoCell) {
            const MetDisc disc = nearestDisc(cells, expected, ray);
            REQUIRE(disc.slot == nearest[expected]);
            REQUIRE(double(disc.distance) == Approx(meets[expected]).epsilon(1e-3));
        }
        ++(expected == kNoCell ? through : met);
    }
    CHECK(met > 150);
    CHECK(through > 20);
}
