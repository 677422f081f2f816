#include "core/raster/rasterize.h"

#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "raster_oracle.h"

#include "catch.h"

#include <atomic>
#include <bit>
#include <cstring>
#include <random>

using namespace lrsm;

namespace {

using Random = std::mt19937_64;
using Triangle = std::array<Vec4, 3>;

float uniform(Random& random, float low, float high)
{
    return low + (high - low) * float(random() >> 40) * 0x1p-24f;
}

RasterOutput drawAll(const std::vector<Triangle>& triangles, int width, int height, std::vector<Cull> cull = {})
{
    std::vector<Vec4> positions;
    std::vector<std::array<std::uint32_t, 3>> indices;
    for (const Triangle& t : triangles) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        positions.insert(positions.end(), t.begin(), t.end());
        indices.push_back({first, first + 1, first + 2});
    }
    return rasterize({positions, indices, cull}, width, height);
}

bool sameBits(const RasterOutput& a, const RasterOutput& b)
{
    return std::memcmp(a.fragments.texels.data(), b.fragments.texels.data(), a.fragments.byteSize()) == 0 && a.counts.submitted == b.counts.submitted &&
           a.counts.drawn == b.counts.drawn && a.counts.clipped == b.counts.clipped && a.counts.culled == b.counts.culled &&
           a.counts.dropped == b.counts.dropped;
}

/// Clip position of a point given in pixels (y down).
Vec4 atPixel(float x, float y, float zOverW, float w, int width, int height)
{
    return Vec4((2.0f * x / float(width) - 1.0f) * w, (1.0f - 2.0f * y / float(height)) * w, zOverW * w, w);
}

enum class Kind { random, tiny, sliver, huge, onGrid, degenerate, nearClipped, farOut };
constexpr Kind kKinds[] = {Kind::random, Kind::tiny, Kind::sliver, Kind::huge, Kind::onGrid, Kind::degenerate, Kind::nearClipped, Kind::farOut};

Triangle makeTriangle(Kind kind, Random& random, int width, int height)
{
    const float w0 = float(width), h0 = float(height);
    const auto anywhere = [&](float border) {
        const float x = uniform(random, -border * w0, (1 + border) * w0), y = uniform(random, -border * h0, (1 + border) * h0);
        const float z = uniform(random, 0, 1);
        return atPixel(x, y, z, std::ldexp(uniform(random, 0.5f, 1), int(random() % 12) - 4), width, height);
    };
    Triangle t{anywhere(0.2f), anywhere(0.2f), anywhere(0.2f)};
    switch (kind) {
    case Kind::random: break;
    case Kind::tiny: {
        const float size = std::ldexp(2.0f, -int(random() % 8)), x = uniform(random, 0, w0), y = uniform(random, 0, h0);
        for (Vec4& v : t) v = atPixel(x + uniform(random, 0, size), y + uniform(random, 0, size), uniform(random, 0, 1), 1, width, height);
        break;
    }
    case Kind::sliver: {
        const float s = uniform(random, -1, 2), d = std::ldexp(1.0f, -int(random() % 16));
        for (int k = 0; k < 4; ++k) t[2][k] = t[0][k] + s * (t[1][k] - t[0][k]) + uniform(random, -d, d) * 0.1f;
        t[2].w = std::abs(t[2].w) + 0.01f;
        t[2].z = std::abs(t[2].z);
        break;
    }
    case Kind::huge:
        for (Vec4& v : t) v.x *= std::ldexp(1.0f, int(random() % 20)), v.y *= std::ldexp(1.0f, int(random() % 20));
        break;
    case Kind::onGrid:  // corners on pixel centres and borders: many centres lie exactly on edges
        for (Vec4& v : t)
            v = atPixel(float(random() % (2 * unsigned(width) + 8)) * 0.5f - 2, float(random() % (2 * unsigned(height) + 8)) * 0.5f - 2, uniform(random, 0, 1),
                        1, width, height);
        break;
    case Kind::degenerate:
        if (random() % 2)
            t[2] = t[random() % 2];
        else
            t[2] = 0.5f * (t[0] + t[1]);
        break;
    case Kind::nearClipped:
        for (Vec4& v : t) {
            v.w = uniform(random, -1, 1.5f);
            v.z = v.w - 0.125f;  // an infinite projection's near plane, through all signs of w
            v.x = uniform(random, -2, 2);
            v.y = uniform(random, -2, 2);
        }
        break;
    case Kind::farOut:
        for (Vec4& v : t)
            if (random() % 2) v *= Vec4(uniform(random, 1, 4000), uniform(random, 1, 4000), 1, 1);
        break;
    }
    return t;
}

/// Compares one triangle's picture with the oracle's; returns the number of wrong pixels.
int compareWithOracle(const Triangle& t, int width, int height, bool clipped)
{
    const RasterOutput drawn = drawAll({t}, width, height);
    const std::vector<oracle::Snapped> polygon = oracle::snappedPolygon(t, width, height);
    long double largest = 0;
    for (const oracle::Snapped& v : polygon) largest = std::max(largest, v.z);

    int wrong = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Fragment& f = drawn.fragments.at(x, y);
            const bool covered = f.triangle == 0, expected = oracle::winding(polygon, x, y) != 0;
            wrong += covered != expected;
            if (!covered || !expected || clipped) continue;
            const oracle::Exact exact = oracle::interpolate(polygon, x, y);
            wrong += !(std::abs(f.depth - exact.depth) <= kRasterDepthMaxError * largest);
            wrong += !(std::abs(f.b1 - exact.b1) <= kRasterBarycentricMaxError);
            wrong += !(std::abs(f.b2 - exact.b2) <= kRasterBarycentricMaxError);
        }
    return wrong;
}

void compareManyWithOracle(Kind kind, int count, std::uint64_t seed)
{
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        const int width = random() % 2 ? 32 : 1 + int(random() % 40), height = random() % 2 ? 16 : 1 + int(random() % 30);
        const Triangle t = makeTriangle(kind, random, width, height);
        CAPTURE(int(kind), i, width, height);
        REQUIRE(compareWithOracle(t, width, height, kind == Kind::nearClipped || kind == Kind::huge || kind == Kind::farOut) == 0);
    }
}

}  // namespace

TEST_CASE("coverage, depth and barycentrics equal brute force for every kind of triangle", "[raster]")
{
    for (const Kind kind : kKinds) compareManyWithOracle(kind, 10000, 100 + std::uint64_t(kind));
}

TEST_CASE("millions: coverage, depth and barycentrics equal brute force", "[.long][raster]")
{
    for (const Kind kind : kKinds) compareManyWithOracle(kind, 1000000, 9000 + std::uint64_t(kind));
}

TEST_CASE("large triangles across many tiles equal brute force", "[raster]")
{
    Random random(7);
    for (int i = 0; i < 60; ++i) {
        const int width = 129 + int(random() % 100), height = 100 + int(random() % 100);
        const Triangle t = makeTriangle(kKinds[random() % 8], random, width, height);
        CAPTURE(i, width, height);
        REQUIRE(compareWithOracle(t, width, height, true) == 0);
    }
}

TEST_CASE("vertices snap to 1/256 pixel, ties to even", "[raster]")
{
    // A left edge at x = 8.5 pixels + offset: the centre at 8.5 is covered while the snapped offset is <= 0.
    const auto coversCentre = [](float offset) {
        const RasterOutput drawn =
            drawAll({{atPixel(8.5f + offset, -10, 0.5f, 1, 32, 32), atPixel(8.5f + offset, 50, 0.5f, 1, 32, 32), atPixel(31, 20, 0.5f, 1, 32, 32)}}, 32, 32);
        return drawn.fragments.at(8, 20).triangle == 0;
    };
    CHECK(coversCentre(0.0f));
    CHECK(coversCentre(0x1p-9f));  // half a step above an even multiple (8.5 * 256 = 2176): down
    CHECK_FALSE(coversCentre(0x1p-9f + 0x1p-18f));
    CHECK_FALSE(coversCentre(0x1p-8f));
    CHECK_FALSE(coversCentre(0x1.8p-8f));
    CHECK(coversCentre(-0x1p-9f));
}

TEST_CASE("top-left rule: two triangles of a square share no centre and leave none out", "[raster]")
{
    // Square with all borders through centres: exactly its top and left rows of centres belong to it.
    const Vec4 a = atPixel(2.5f, 3.5f, 0.5f, 1, 16, 16), b = atPixel(9.5f, 3.5f, 0.5f, 1, 16, 16), c = atPixel(9.5f, 10.5f, 0.5f, 1, 16, 16),
               d = atPixel(2.5f, 10.5f, 0.5f, 1, 16, 16);
    const RasterOutput one = drawAll({{a, b, c}}, 16, 16), two = drawAll({{a, c, d}}, 16, 16);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            CAPTURE(x, y);
            const int hits = (one.fragments.at(x, y).triangle == 0) + (two.fragments.at(x, y).triangle == 0);
            REQUIRE(hits == (x >= 2 && x < 9 && y >= 3 && y < 10 ? 1 : 0));
        }
}

namespace {

/// How often each pixel is hit when the triangles are drawn one by one.
std::vector<int> hitCounts(const std::vector<Vec4>& positions, const std::vector<std::array<std::uint32_t, 3>>& triangles, int width, int height)
{
    std::vector<int> hits(std::size_t(width) * std::size_t(height));
    for (const auto& t : triangles) {
        const RasterOutput drawn = drawAll({{positions[t[0]], positions[t[1]], positions[t[2]]}}, width, height);
        for (std::size_t i = 0; i < hits.size(); ++i) hits[i] += drawn.fragments.texels[i].triangle == 0;
    }
    return hits;
}

std::vector<std::array<std::uint32_t, 3>> gridTriangles(std::uint32_t n, Random& random)
{
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t y = 0; y < n; ++y)
        for (std::uint32_t x = 0; x < n; ++x) {
            std::uint32_t corner[4] = {y * (n + 1) + x, y * (n + 1) + x + 1, (y + 1) * (n + 1) + x + 1, (y + 1) * (n + 1) + x};
            const std::size_t turn = random() % 4;  // either diagonal, any first vertex, any winding
            for (std::size_t k = 1; k < 3; ++k) {
                std::array<std::uint32_t, 3> t{corner[turn], corner[(turn + k) % 4], corner[(turn + k + 1) % 4]};
                if (random() % 2) std::swap(t[random() % 3], t[random() % 3]);
                triangles.push_back(t);
            }
        }
    return triangles;
}

}  // namespace

TEST_CASE("shared edges: a mesh over the picture covers each centre exactly once", "[raster]")
{
    Random random(11);
    for (int round = 0; round < 60; ++round) {
        const std::uint32_t n = 2 + std::uint32_t(random() % 8);
        const float cell = 48.0f / float(n), jitter = 0.3f * cell;
        const bool onGrid = round % 2 == 0;
        std::vector<Vec4> positions;
        for (std::uint32_t y = 0; y <= n; ++y)
            for (std::uint32_t x = 0; x <= n; ++x) {
                const auto inner = [&](std::uint32_t i) { return i == 0 ? -4.0f : i == n ? 52.0f : cell * float(i) + uniform(random, -jitter, jitter); };
                float px = inner(x), py = inner(y);
                if (onGrid) px = std::round(2 * px) / 2, py = std::round(2 * py) / 2;
                positions.push_back(atPixel(px, py, 0.5f, std::ldexp(uniform(random, 0.5f, 1), int(random() % 6)), 48, 48));
            }
        const std::vector<int> hits = hitCounts(positions, gridTriangles(n, random), 48, 48);
        CAPTURE(round, n);
        REQUIRE(std::count(hits.begin(), hits.end(), 1) == 48 * 48);
    }
}

TEST_CASE("shared edges: a plane through the near plane and the guard band is watertight", "[raster]")
{
    // A tessellated plane below a tilted camera reaches behind it: triangles are cut by the near plane and, being thousands of pixels wide
    // there, by the guard band. Every centre whose ray meets the plane within the mesh is hit exactly once.
    Random random(12);
    long long tested = 0;
    for (int round = 0; round < 60; ++round) {
        const std::uint32_t n = 5;
        const float tilt = uniform(random, -0.8f, 0.3f), size = 12.0f, height = round % 3 == 0 ? 2e-4f : 1.0f;
        const float c = std::cos(tilt), s = std::sin(tilt), near = 1e-3f;
        std::vector<Vec4> positions;
        for (std::uint32_t iz = 0; iz <= n; ++iz)
            for (std::uint32_t ix = 0; ix <= n; ++ix) {
                const float jitter = size / float(n) * 0.3f;
                const auto along = [&](std::uint32_t i) {
                    const float border = i == 0 || i == n ? 0.0f : uniform(random, -jitter, jitter);
                    return (float(i) / float(n) * 2 - 1) * size + border;
                };
                const float x = along(ix), y = -height, z = along(iz);
                const float yEye = c * y + s * z, w = -(c * z - s * y);
                positions.push_back(Vec4(x, yEye, w - near, w));
            }
        const int width = 40, rows = 32;
        const std::vector<int> hits = hitCounts(positions, gridTriangles(n, random), width, rows);
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < width; ++x) {
                // Ray through the centre, back into the world.
                const double ex = (x + 0.5) / width * 2 - 1, ey = 1 - (y + 0.5) / rows * 2, ez = -1;
                const double wy = c * ey - s * ez, wz = s * ey + c * ez, t = -height / wy;
                const bool inside = wy < -1e-3 && t > near && std::abs(t * ex) < size * 0.98 && std::abs(t * wz) < size * 0.98;
                const int count = hits[std::size_t(y * width + x)];
                CAPTURE(round, x, y, tilt);
                if (inside) REQUIRE(count == 1);
                if (wy > 1e-3) REQUIRE(count == 0);
                tested += inside;
            }
    }
    CHECK(tested > 20000);
}

TEST_CASE("a picture of many triangles is its triangles merged one by one: LESS, ties to the first", "[raster]")
{
    Random random(21);
    for (int round = 0; round < 12; ++round) {
        const int width = 150, height = 90;
        std::vector<Triangle> triangles;
        for (int i = 0; i < 120; ++i) {
            Triangle t = makeTriangle(kKinds[random() % 8], random, width, height);
            if (i % 3 == 0)
                for (Vec4& v : t) v.z = 0.25f * v.w;                              // flat: exact ties with each other
            if (i % 7 == 0 && i > 0) t = triangles[random() % triangles.size()];  // the same once more
            triangles.push_back(t);
        }
        const RasterOutput whole = drawAll(triangles, width, height);
        Image<Fragment> merged(width, height);
        std::vector<float> depth(merged.texels.size(), kInfinity);
        for (std::uint32_t k = 0; k < triangles.size(); ++k) {
            const RasterOutput one = drawAll({triangles[k]}, width, height);
            for (std::size_t i = 0; i < depth.size(); ++i) {
                Fragment f = one.fragments.texels[i];
                if (f.triangle == kNoTriangle || !(f.depth < depth[i])) continue;
                depth[i] = f.depth;
                f.triangle = k;
                merged.texels[i] = f;
            }
        }
        REQUIRE(std::memcmp(merged.texels.data(), whole.fragments.texels.data(), merged.byteSize()) == 0);
    }
}

TEST_CASE("more triangles than one chunk keep submission order, and any number of threads gives the same bits", "[raster]")
{
    Random random(31);
    std::vector<Triangle> triangles;
    for (int i = 0; i < 20000; ++i) {
        Triangle t = makeTriangle(kKinds[random() % 8], random, 200, 130);
        if (i % 2)
            for (Vec4& v : t) v.z = 0.5f * v.w;
        triangles.push_back(t);
    }
    std::vector<RasterOutput> outputs;
    for (const int threads : {1, 2, 8}) {
        const ThreadLimit limit(threads);
        outputs.push_back(drawAll(triangles, 200, 130));
    }
    CHECK(sameBits(outputs[0], outputs[1]));
    CHECK(sameBits(outputs[0], outputs[2]));

    // Two full-screen triangles of equal depth, 10000 apart: the first one stays.
    const Triangle full{Vec4(-1, -1, 0, 1), Vec4(3, -1, 0, 1), Vec4(-1, 3, 0, 1)};
    triangles[100] = triangles[10100] = full;
    const RasterOutput tie = drawAll(triangles, 200, 130);
    for (const Fragment& f : tie.fragments.texels) REQUIRE((f.depth > 0.0f || f.triangle <= 100));
}

TEST_CASE("NaN and infinite positions drop the triangle, and only it", "[raster]")
{
    const Triangle good{Vec4(-1, -1, 0.5f, 1), Vec4(3, -1, 0.5f, 1), Vec4(-1, 3, 0.5f, 1)};
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity})
        for (int corner = 0; corner < 3; ++corner)
            for (int component = 0; component < 4; ++component) {
                Triangle t = good;
                t[std::size_t(corner)][component] = bad;
                const RasterOutput drawn = drawAll({t, good}, 8, 8);
                CAPTURE(bad, corner, component);
                REQUIRE(drawn.counts.dropped == 1);
                REQUIRE(drawn.counts.drawn == 1);
                for (const Fragment& f : drawn.fragments.texels) REQUIRE(f.triangle == 1);
            }
}

TEST_CASE("extreme finite positions neither trap nor leave the picture", "[raster]")
{
    Random random(41);
    const float values[] = {0.0f, -0.0f, 1.0f, -1.0f, 1e-45f, -1e-38f, 1e-20f, 3e38f, -3e38f, 1e20f, 0.5f};
    for (int i = 0; i < 20000; ++i) {
        Triangle t;
        for (Vec4& v : t)
            for (int k = 0; k < 4; ++k) v[k] = values[random() % 11];
        const RasterOutput drawn = drawAll({t}, 9, 5);
        for (const Fragment& f : drawn.fragments.texels)
            if (f.triangle != kNoTriangle) {
                CAPTURE(t[0].x, t[0].y, t[0].z, t[0].w, t[1].x, t[1].y, t[1].z, t[1].w, t[2].x, t[2].y, t[2].z, t[2].w, f.depth, f.b1, f.b2);
                REQUIRE((std::isfinite(f.depth) && std::isfinite(f.b1) && std::isfinite(f.b2)));
            }
    }
}

TEST_CASE("back faces are the clockwise ones in y-up, and only they are culled", "[raster]")
{
    const Triangle ccw{Vec4(-1, -1, 0.5f, 1), Vec4(1, -1, 0.5f, 1), Vec4(0, 1, 0.5f, 1)}, cw{ccw[0], ccw[2], ccw[1]};
    CHECK(drawAll({ccw}, 16, 16, {Cull::back}).counts.drawn == 1);
    CHECK(drawAll({cw}, 16, 16, {Cull::back}).counts.drawn == 0);
    CHECK(drawAll({cw}, 16, 16, {Cull::back}).counts.culled == 1);
    CHECK(drawAll({cw}, 16, 16, {Cull::none}).counts.drawn == 1);

    // Also when the near plane cuts them.
    Triangle cut = ccw;
    cut[2] = Vec4(0, 1, -0.5f, 0.25f);
    CHECK(drawAll({cut}, 16, 16, {Cull::back}).counts.drawn == 1);
    CHECK(drawAll({{cut[0], cut[2], cut[1]}}, 16, 16, {Cull::back}).counts.culled == 1);
    CHECK(drawAll({cut}, 16, 16).counts.clipped == 1);
}

TEST_CASE("clipped pieces keep the triangle's own barycentrics", "[raster]")
{
    // Position reconstructed from barycentrics must project back to the pixel and lie on the triangle's plane.
    Random random(51);
    int checked = 0;
    for (int i = 0; i < 4000; ++i) {
        const Triangle t = makeTriangle(Kind::nearClipped, random, 64, 64);
        const RasterOutput drawn = drawAll({t}, 64, 64);
        if (drawn.counts.clipped == 0) continue;
        for (int y = 0; y < 64; y += 7)
            for (int x = 0; x < 64; x += 7) {
                const Fragment& f = drawn.fragments.at(x, y);
                if (f.triangle == kNoTriangle) continue;
                const double b0 = 1.0 - double(f.b1) - double(f.b2);
                double p[4];
                for (int k = 0; k < 4; ++k) p[k] = b0 * t[0][k] + double(f.b1) * t[1][k] + double(f.b2) * t[2][k];
                // Snapping moves the triangle by up to 1/512 pixel; a triangle seen edge-on turns that into anything, so bound its slope.
                const double area = std::abs(double((t[1].x * t[0].w - t[0].x * t[1].w)) * double(t[2].y * t[0].w - t[0].y * t[2].w) -
                                             double((t[2].x * t[0].w - t[0].x * t[2].w)) * double(t[1].y * t[0].w - t[0].y * t[1].w));
                if (area < 0.05 || p[3] < 0.1) continue;
                CAPTURE(i, x, y, f.b1, f.b2);
                REQUIRE(std::abs((p[0] / p[3] + 1) * 32 - (x + 0.5)) < 0.1);
                REQUIRE(std::abs((1 - p[1] / p[3]) * 32 - (y + 0.5)) < 0.1);
                REQUIRE(std::abs(p[2] / p[3] - f.depth) < 0.01);
                ++checked;
            }
    }
    CHECK(checked > 2000);
}

TEST_CASE("the fragment test is asked only where marked, and a refused fragment shows what is behind", "[raster]")
{
    const Triangle front{Vec4(-1, -1, 0.25f, 1), Vec4(3, -1, 0.25f, 1), Vec4(-1, 3, 0.25f, 1)};
    Triangle back = front;
    for (Vec4& v : back) v.z = 0.75f;
    const std::vector<Vec4> positions{front[0], front[1], front[2], back[0], back[1], back[2]};
    const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {3, 4, 5}};
    const std::vector<std::uint8_t> tested{1, 0};
    std::atomic<int> asked = 0;
    const RasterOutput drawn = rasterize({positions, triangles, {}}, 16, 16, tested, [&](const Fragment& f) {
        ++asked;
        return f.triangle == 0 && f.b1 < 0.25f;
    });
    CHECK(asked == 256);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            // b1 = (x + 1) / 4 in clip space.
            const bool kept = (double(x) + 0.5) / 16 * 2 / 4 < 0.25;
            REQUIRE(drawn.fragments.at(x, y).triangle == (kept ? 0u : 1u));
        }
}

TEST_CASE("depths beyond 1 are drawn (no far clip), picture sizes outside the range are refused", "[raster]")
{
    const Triangle far{Vec4(-1, -1, 7, 1), Vec4(3, -1, 7, 1), Vec4(-1, 3, 7, 1)};
    CHECK(drawAll({far}, 4, 4).fragments.at(1, 1).depth == 7.0f);
    CHECK_THROWS_AS(drawAll({far}, 0, 4), InputError);
    CHECK_THROWS_AS(drawAll({far}, 4, 16385), InputError);
    CHECK(drawAll({}, 4, 4).fragments.at(0, 0).triangle == kNoTriangle);
}
