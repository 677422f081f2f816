#include "conetrace/frame/reduce.h"

#include "conetrace/render.h"
#include "core/scene/builtin_scenes.h"
#include "core/settings/settings_table.h"
#include "tests/conetrace/frame/flat_plane.h"

#include "catch.h"

#include <algorithm>
#include <set>

using namespace lrsm;

namespace {

/// Light that says where in the plane it was gathered.
Gathered gatheredAt(const GBuffer& g)
{
    Gathered light;
    light.irradiance = Image<Vec3>(g.width, g.height);
    light.opacity = Image<float>(g.width, g.height);
    for (std::size_t i = 0; i < light.irradiance.texels.size(); ++i) {
        const Vec3& p = g.position.texels[i];
        light.irradiance.texels[i] = Vec3(2 * p.x - p.y, p.x * p.y, 7);
        light.opacity.texels[i] = 0.25f * p.x;
    }
    return light;
}

Frame renderedWith(const char* scene, int divisor, bool plain, Settings s = {})
{
    s.voxel.resolution = 64;
    s.rsm.resolution = 128;
    s.cones.set.gatherDivisor = divisor;
    s.cones.set.filterPasses = 0;
    if (plain) s.cones.set.rotation = Rotation::none, s.cones.set.filter = false;
    const Scene built = *makeBuiltinScene(scene);
    return renderFrame(built, built.cameras[0], s, {.width = 61, .height = 37, .watch = {}, .method = {}});
}

}  // namespace

TEST_CASE("reduce: on a plane bilinear fields come back, from the first block's middle to the last's", "[conetrace][reduce]")
{
    const int divisor = GENERATE(2, 4);
    const int width = GENERATE(16, 19), height = 13;
    const GBuffer g = flatPlane(width, height);
    const ReducedGBuffer reduced = reduceGBuffer(g, divisor);
    CHECK(reduced.alone == 0);
    CHECK(reduced.gbuffer.width == (width + divisor - 1) / divisor);
    CHECK(reduced.gbuffer.height == reduced.blockRows);
    const Gathered full = upsample(gatheredAt(reduced.gbuffer), reduced, g), direct = gatheredAt(g);
    for (int y = divisor / 2; y < height; ++y)
        for (int x = divisor / 2; x < width; ++x) {
            const bool beyond = float(x) > g.position.texels[reduced.source.back()].x || float(y) > g.position.texels[reduced.source.back()].y;
            if (beyond) continue;
            INFO(x << ", " << y);
            for (int c = 0; c < 3; ++c) CHECK(full.irradiance.at(x, y)[c] == Approx(direct.irradiance.at(x, y)[c]).margin(1e-4));
            CHECK(full.opacity.at(x, y) == Approx(direct.opacity.at(x, y)).margin(1e-4));
        }
}

TEST_CASE("reduce: light does not cross an edge, and what is thinner than a block stands alone", "[conetrace][reduce]")
{
    GBuffer g = flatPlane(24, 16);
    for (int y = 0; y < g.height; ++y) {
        for (int x = 12; x < g.width; ++x) g.geometricNormal.at(x, y) = g.normal.at(x, y) = Vec3(1, 0, 0), g.position.at(x, y) = Vec3(12, y, x - 12);
        g.normal.at(5, y) = g.geometricNormal.at(5, y) = Vec3(0, 1, 0);  // a post one pixel wide, between two blocks' middles
    }
    const ReducedGBuffer reduced = reduceGBuffer(g, 4);
    std::set<std::uint32_t> seen(reduced.source.begin(), reduced.source.end());
    CHECK(seen.size() == reduced.source.size());
    for (int y = 0; y < g.height; ++y) CHECK(seen.count(std::uint32_t(g.position.index(5, y))) == 1);
    CHECK(reduced.alone == 16);

    Gathered light;
    light.irradiance = Image<Vec3>(reduced.gbuffer.width, reduced.gbuffer.height);
    for (std::size_t i = 0; i < reduced.source.size(); ++i) light.irradiance.texels[i] = reduced.gbuffer.normal.texels[i];
    const Gathered full = upsample(light, reduced, g);
    for (std::size_t i = 0; i < full.irradiance.texels.size(); ++i) CHECK(full.irradiance.texels[i] == g.normal.texels[i]);
}

TEST_CASE("reduce: a block's middle and what stands alone have the bits of a full gather, the rest lies between its neighbours", "[conetrace][reduce]")
{
    const char* scene = GENERATE("cornell-glossy", "atrium");
    const int divisor = GENERATE(2, 4);
    const Frame full = renderedWith(scene, 1, true), few = renderedWith(scene, divisor, true);
    const ReducedGBuffer reduced = reduceGBuffer(full.gbuffer, divisor);
    CHECK(reduced.alone > 0);
    CHECK(reduced.source.size() < full.irradiance.texels.size() / 2);
    for (const std::uint32_t pixel : reduced.source) REQUIRE(few.irradiance.texels[pixel] == full.irradiance.texels[pixel]);
    for (const std::uint32_t pixel : reduced.source) REQUIRE(few.indirectSpecular.texels[pixel] == full.indirectSpecular.texels[pixel]);
    const std::set<std::uint32_t> gathered(reduced.source.begin(), reduced.source.end());
    const Image<Vec3>& light = few.irradiance;
    for (int y = 0; y < light.height; ++y)
        for (int x = 0; x < light.width; ++x) {
            const std::size_t pixel = light.index(x, y);
            if (!few.gbuffer.covered(pixel) || gathered.count(std::uint32_t(pixel)) == 1) continue;
            float least = kInfinity, most = 0.0f;
            for (int ny = std::max(0, y - divisor); ny <= std::min(light.height - 1, y + divisor); ++ny)
                for (int nx = std::max(0, x - divisor); nx <= std::min(light.width - 1, x + divisor); ++nx) {
                    if (gathered.count(std::uint32_t(light.index(nx, ny))) == 0) continue;
                    least = std::min(least, light.at(nx, ny).y), most = std::max(most, light.at(nx, ny).y);
                }
            INFO(x << ", " << y);
            REQUIRE(light.texels[pixel].y >= least * (1.0f - 1e-6f));
            REQUIRE(light.texels[pixel].y <= most * (1.0f + 1e-6f));
        }
}

TEST_CASE("reduce: caches are placed by what all pixels see, whatever the divisor", "[conetrace][reduce]")
{
    CHECK(renderedWith("atrium", 2, true, preset("caches")).irradiance.texels == renderedWith("atrium", 1, true, preset("caches")).irradiance.texels);
}
