#include "conetrace/frame/irradiance_filter.h"

#include "conetrace/frame/cones.h"
#include "tests/conetrace/frame/flat_plane.h"

#include "catch.h"

#include <random>

using namespace lrsm;

TEST_CASE("filter: a constant field stays constant, whatever the geometry", "[conetrace][filter]")
{
    GBuffer g = flatPlane(12, 9);
    g.normal.at(5, 5) = g.geometricNormal.at(5, 5) = Vec3(1, 0, 0);
    g.objectId.at(3, 3) = 0;
    const Image<Vec3> out = filterIrradiance(Image<Vec3>(12, 9, Vec3(0.3f, 7, 1e4f)), g);
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 12; ++x) {
            if (g.objectId.at(x, y) == 0) {
                CHECK(out.at(x, y) == Vec3(0));
                continue;
            }
            for (int c = 0; c < 3; ++c) CHECK(out.at(x, y)[c] == Approx(Vec3(0.3f, 7, 1e4f)[c]).epsilon(1e-6));
        }
}

TEST_CASE("filter: inside a plane each of the 16 rotations weighs exactly 1/16", "[conetrace][filter]")
{
    const GBuffer g = flatPlane(16, 16);
    for (int rotation = 0; rotation < kRotations; ++rotation) {
        Image<Vec3> only(16, 16);
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x)
                if (rotationOfPixel(x, y, Rotation::azimuth) == rotation) only.at(x, y) = Vec3(16);
        const Image<Vec3> out = filterIrradiance(only, g);
        for (int y = 2; y < 14; ++y)
            for (int x = 2; x < 14; ++x) REQUIRE(out.at(x, y).x == Approx(1));
    }
}

TEST_CASE("filter: light does not cross an edge, a step in depth, or an empty pixel", "[conetrace][filter]")
{
    const int kind = GENERATE(0, 1, 2);
    GBuffer g = flatPlane(12, 12);
    Image<Vec3> in(12, 12);
    for (int y = 0; y < 12; ++y)
        for (int x = 6; x < 12; ++x) {
            in.at(x, y) = Vec3(1);
            if (kind == 0) g.normal.at(x, y) = g.geometricNormal.at(x, y) = Vec3(0, 1, 0);
            if (kind == 1) g.position.at(x, y).z = 5;
            if (kind == 2) g.objectId.at(x, y) = 0;
        }
    const Image<Vec3> out = filterIrradiance(in, g);
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 6; ++x) CHECK(out.at(x, y) == Vec3(0));
}

TEST_CASE("filter: the picture holds the bits of its pixels one by one", "[conetrace][filter]")
{
    // Rough ground with steps, holes and normals of three kinds; neither edge is a multiple of the lanes, and the last rows are left alone.
    constexpr int kWidth = 37, kHeight = 23, kRows = 18;
    std::minstd_rand random(7);
    const auto at = [&](float low, float high) { return low + (high - low) * float(random() % 4096) / 4096.0f; };
    GBuffer g = flatPlane(kWidth, kHeight);
    Image<Vec3> in(kWidth, kHeight);
    for (std::size_t i = 0; i < in.texels.size(); ++i) {
        g.objectId.texels[i] = random() % 8 == 0 ? 0u : 1u;
        g.position.texels[i].z = at(0.0f, 0.15f) + (random() % 6 == 0 ? 3.0f : 0.0f);
        const Vec3 normal = glm::normalize(Vec3(at(-0.4f, 0.4f), at(-0.4f, 0.4f), 1.0f));
        g.normal.texels[i] = normal;
        g.geometricNormal.texels[i] = random() % 5 == 0 ? normal : Vec3(0, 0, 1);
        in.texels[i] = Vec3(at(0, 1), at(0, 100), at(0, 1e-3f));
    }
    const Image<Vec3> out = filterIrradiance(in, g, kRows);
    int filtered = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const Vec3 alone = !g.covered(in.index(x, y)) ? Vec3(0) : y < kRows ? filterPixel(in, g, kRows, x, y) : in.at(x, y);
            REQUIRE(out.at(x, y) == alone);
            filtered += alone != Vec3(0) && alone != in.at(x, y);
        }
    CHECK(filtered > kWidth * kRows / 2);
}
