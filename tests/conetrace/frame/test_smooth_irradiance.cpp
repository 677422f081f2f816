#include "conetrace/frame/smooth_irradiance.h"

#include "catch.h"

#include <random>

using namespace lrsm;

namespace {

/// A floor z = 0 seen from above, one metre a pixel; from column `wallAt` on a wall that rises along z, one metre a pixel.
GBuffer corner(int width, int height, int wallAt)
{
    GBuffer g;
    g.width = width;
    g.height = height;
    g.position = g.geometricNormal = g.normal = Image<Vec3>(width, height);
    g.objectId = Image<std::uint32_t>(width, height, 1u);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const bool wall = x >= wallAt;
            g.position.at(x, y) = wall ? Vec3(wallAt, y, x - wallAt + 1) : Vec3(x, y, 0);
            g.normal.at(x, y) = g.geometricNormal.at(x, y) = wall ? Vec3(-1, 0, 0) : Vec3(0, 0, 1);
        }
    return g;
}

}  // namespace

TEST_CASE("smoothing: a constant field stays constant, up to the corner", "[conetrace][smooth]")
{
    const GBuffer g = corner(64, 24, 40);
    const Image<Vec3> out = smoothIrradiance(Image<Vec3>(64, 24, Vec3(0.3f, 7, 1e4f)), g, 3);
    for (const Vec3& e : out.texels)
        for (int c = 0; c < 3; ++c) REQUIRE(e[c] == Approx(Vec3(0.3f, 7, 1e4f)[c]).epsilon(1e-6));
}

TEST_CASE("smoothing: on an open floor a point spreads as the product of tents says", "[conetrace][smooth]")
{
    const GBuffer g = corner(96, 96, 96);
    Image<Vec3> in(96, 96);
    in.at(48, 48) = Vec3(1);
    const Image<Vec3> out = smoothIrradiance(in, g, 2);
    CHECK(out.at(48, 48).x == Approx(0.5 * 0.5 * 0.5 * 0.5));
    // Tents 4 and 8 apart: weights of -12, -8, -4, 0, 4, 8, 12 along an axis, in 1/16.
    const double weights[] = {1, 2, 3, 4, 3, 2, 1};
    for (int i = -3; i <= 3; ++i) {
        CAPTURE(i);
        CHECK(out.at(48 + 4 * i, 48).x == Approx(weights[i + 3] / 16 * 4 / 16));
        CHECK(out.at(48, 48 + 4 * i).x == Approx(weights[i + 3] / 16 * 4 / 16));
    }
    CHECK(out.at(49, 48).x == 0.0f);
}

TEST_CASE("smoothing: light does not cross the corner, and moves less along it the nearer it is", "[conetrace][smooth]")
{
    const GBuffer g = corner(96, 48, 64);
    Image<Vec3> in(96, 48);
    for (int y = 0; y < 48; ++y)
        for (int x = 64; x < 96; ++x) in.at(x, y) = Vec3(1);
    const Image<Vec3> out = smoothIrradiance(in, g, 3);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) REQUIRE(out.at(x, y) == Vec3(0));

    // A tap 4 m off weighs less than on an open floor where a wall stands 6 m away, and nothing where one stands a metre away.
    const auto moved = [&](int x) {
        Image<Vec3> point(96, 48);
        point.at(x, 24) = Vec3(1);
        return 1.0f - smoothIrradiance(point, g, 1).at(x, 24).x;
    };
    CHECK(moved(63) == 0.0f);
    CHECK(moved(20) > moved(50));
    CHECK(moved(50) > moved(58));
    CHECK(moved(20) > 0.5f);
}

TEST_CASE("smoothing: light does not cross a thin wall seen from its edge", "[conetrace][smooth]")
{
    // One column of the floor is the edge of a wall far above it: the floor goes on behind, in the same plane.
    GBuffer g = corner(96, 48, 96);
    Image<Vec3> in(96, 48);
    for (int y = 0; y < 48; ++y) {
        g.position.at(48, y) = Vec3(48, y, 30);
        for (int x = 49; x < 96; ++x) in.at(x, y) = Vec3(1);
    }
    const Image<Vec3> out = smoothIrradiance(in, g, 3);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 96; ++x) REQUIRE(out.at(x, y).x == Approx(x > 48 ? 1.0 : 0.0).margin(1e-6));
}

TEST_CASE("smoothing: light does not cross a step that is low beside the distance of its taps", "[conetrace][smooth]")
{
    GBuffer g = corner(96, 48, 96);
    Image<Vec3> in(96, 48);
    const bool alongX = GENERATE(false, true);
    const auto isUp = [&](int x, int y) { return alongX ? x > 48 : y > 24; };
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 96; ++x) {
            if (!isUp(x, y)) continue;
            g.position.at(x, y).z = 0.3f;  // four pixels away less than a tenth of the distance
            in.at(x, y) = Vec3(1);
        }
    const Image<Vec3> out = smoothIrradiance(in, g, 2);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 96; ++x) REQUIRE(out.at(x, y).x == (isUp(x, y) ? 1.0f : 0.0f));
}

TEST_CASE("smoothing: a gradient stays as it is up to the corner", "[conetrace][smooth]")
{
    const GBuffer g = corner(96, 48, 64);
    Image<Vec3> in(96, 48);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 96; ++x) in.at(x, y) = Vec3(float(2 + x), 5.0f + 0.5f * float(y), float(100 - x));
    const Image<Vec3> out = smoothIrradiance(in, g, 3);
    for (std::size_t i = 0; i < in.texels.size(); ++i)
        for (int c = 0; c < 3; ++c) REQUIRE(out.texels[i][c] == Approx(in.texels[i][c]).epsilon(1e-5));
}

TEST_CASE("smoothing: a mirrored picture is smoothed to the mirrored one", "[conetrace][smooth]")
{
    const auto mirrored = [](const auto& image) {
        auto out = image;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) out.at(x, y) = image.at(image.width - 1 - x, y);
        return out;
    };
    const GBuffer g = corner(96, 48, 64);
    GBuffer turned = g;
    turned.position = mirrored(g.position);
    turned.normal = turned.geometricNormal = mirrored(g.normal);
    Image<Vec3> in(96, 48);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 96; ++x) in.at(x, y) = Vec3(float(x * x), float((x * 7 + y * 3) % 11), 1.0f);
    const Image<Vec3> out = smoothIrradiance(in, g, 3), back = mirrored(smoothIrradiance(mirrored(in), turned, 3));
    for (std::size_t i = 0; i < out.texels.size(); ++i)
        for (int c = 0; c < 3; ++c) REQUIRE(back.texels[i][c] == Approx(out.texels[i][c]).epsilon(1e-5).margin(1e-5));
}

TEST_CASE("smoothing: nearness falls with the distance of a wall, and an open floor has none", "[conetrace][smooth]")
{
    // Scaling the world scales distances: nearness times size is the same.
    GBuffer g = corner(192, 192, 128);
    const Image<float> nearness = nearnessOf(g);
    CHECK(nearness.at(10, 96) < 0.02f);
    CHECK(nearness.at(127, 96) > nearness.at(120, 96));
    CHECK(nearness.at(120, 96) > nearness.at(100, 96));
    for (Vec3& p : g.position.texels) p *= 4.0f;
    const Image<float> larger = nearnessOf(g);
    for (std::size_t i = 0; i < larger.texels.size(); ++i) REQUIRE(larger.texels[i] == Approx(nearness.texels[i] / 4).margin(1e-7));
    for (const float v : nearnessOf(corner(32, 32, 32)).texels) REQUIRE(v == 0.0f);
}

TEST_CASE("smoothing: nearness is that of each pixel alone", "[conetrace][smooth]")
{
    // Scattered points and holes, wider than the farthest step; the width is no multiple of the lanes.
    GBuffer g = corner(541, 270, 200);
    std::minstd_rand random(3);
    for (std::size_t i = 0; i < g.position.texels.size(); ++i) {
        if (random() % 4 == 0) g.objectId.texels[i] = 0;
        g.position.texels[i].z += float(random() % 1024) / 512.0f;
    }
    const Image<float> nearness = nearnessOf(g);
    for (int y = 0; y < g.height; y += 7)
        for (int x = 0; x < g.width; ++x) {
            const std::size_t centre = nearness.index(x, y);
            float mean = 0.0f;
            for (int d = 0; d < 9 && g.covered(centre); ++d) {
                const int order[9] = {5, 8, 7, 6, 3, 0, 1, 2, 4}, dx = order[d] % 3 - 1, dy = order[d] / 3 - 1;
                float sum = 0.0f, horizon = 0.1f;
                for (int step = 2; step <= 256 && (dx != 0 || dy != 0); step *= 2) {
                    const int nx = x + dx * step, ny = y + dy * step;
                    if (nx < 0 || ny < 0 || nx >= g.width || ny >= g.height || g.objectId.at(nx, ny) == 0) continue;
                    const Vec3 between = g.position.at(nx, ny) - g.position.at(x, y);
                    const float distance = glm::length(between), sine = glm::dot(between, g.geometricNormal.at(x, y)) / distance;
                    if (sine > horizon) sum += (sine * sine - horizon * horizon) / distance;
                    horizon = std::max(horizon, sine);
                }
                mean += sum;
            }
            REQUIRE(nearness.texels[centre] == mean / 8.0f);
        }
}
