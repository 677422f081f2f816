#include "conetrace/caches/mapping.h"

#include "conetrace/caches/atlas.h"
#include "conetrace/caches/evaluate.h"
#include "tests/conetrace/caches/surfaces.h"

#include "catch.h"

#include <cmath>
#include <numbers>

using namespace lrsm;

namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

CacheSettings settingsOf(CacheMapping mapping, int resolution = 16)
{
    return {.resolution = resolution, .mapping = mapping, .storage = Storage::float32};
}

/// One cache that sees `radiance(direction)`, mips and table made from it.
template <class Radiance>
CacheAtlas cacheThatSees(const CacheSettings& settings, const CacheTables& tables, const Radiance& radiance)
{
    CacheAtlas atlas;
    atlas.resolution = settings.resolution;
    atlas.half = settings.storage == Storage::gpu;
    atlas.levels.emplace_back();
    ConversionCounts counts;
    for (const Vec3& direction : std::span(tables.directions).first(tables.texels()))
        atlas.levels[0].push_back(storedTexel(Vec4(radiance(direction)), settings, counts));
    return convolveCaches(std::move(atlas), tables, settings);
}

/// The integral of L <m.w> over the hemisphere, in double over a fine grid of equal areas.
template <class Radiance>
double irradianceOracle(const glm::dvec3& normal, const Radiance& radiance)
{
    constexpr int kRings = 400, kSpokes = 800;
    double sum = 0.0;
    for (int i = 0; i < kRings; ++i)
        for (int k = 0; k < kSpokes; ++k) {
            const double z = (i + 0.5) / kRings, s = std::sqrt(1.0 - z * z), phi = kTwoPi * (k + 0.5) / kSpokes;
            const glm::dvec3 w(s * std::cos(phi), s * std::sin(phi), z);
            sum += std::max(0.0, glm::dot(w, normal)) * double(radiance(Vec3(w)));
        }
    return sum * kTwoPi / (kRings * kSpokes);
}

}  // namespace

TEST_CASE("cache mapping: solid angles sum to 2 pi at each level, and are what the texels' corners span", "[caches]")
{
    const CacheMapping mapping = GENERATE(CacheMapping::equalArea, CacheMapping::octahedral);
    const int n = GENERATE(2, 16);
    CAPTURE(int(mapping), n);
    const CacheTables tables = makeCacheTables(settingsOf(mapping, n), Rotation::none);
    for (const std::vector<float>& level : tables.solidAngle) {
        double sum = 0.0;
        for (const float solidAngle : level) sum += double(solidAngle);
        CHECK(std::abs(sum - kTwoPi) < 1e-5);
    }
    CHECK(tables.solidAngle.back().size() == 1);
    if (mapping == CacheMapping::equalArea)
        for (const float solidAngle : tables.solidAngle[0]) REQUIRE(std::abs(double(solidAngle) * n * n / kTwoPi - 1.0) < 1e-6);

    // Van Oosterom and Strackee's triangles, 32^2 pairs a texel.
    const auto triangle = [](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        return 2.0 * std::abs(std::atan2(glm::dot(a, glm::cross(b, c)), 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a)));
    };
    constexpr int kCuts = 32;
    for (const int texel : {0, n / 2, n * n - 1}) {
        double sum = 0.0;
        for (int k = 0; k < kCuts * kCuts; ++k) {
            const auto at = [&](int i, int j) {
                return hemisphereFromSquare((texel % n + (k % kCuts + i) / double(kCuts)) / n, (texel / n + (k / kCuts + j) / double(kCuts)) / n, mapping);
            };
            sum += triangle(at(0, 0), at(1, 0), at(0, 1)) + triangle(at(1, 1), at(1, 0), at(0, 1));
        }
        CHECK(std::abs(sum / double(tables.solidAngle[0][std::size_t(texel)]) - 1.0) < (n == 2 ? 0.03 : 0.01));
    }
}

TEST_CASE("cache mapping: the square of a direction is where the direction came from, and its arctangent keeps its bound", "[caches]")
{
    const CacheMapping mapping = GENERATE(CacheMapping::equalArea, CacheMapping::octahedral);
    double worst = 0.0;
    for (int row = 0; row < 257; ++row)
        for (int column = 0; column < 257; ++column) {
            const double u = (column + 0.5) / 257, v = (row + 0.5) / 257;
            const glm::dvec3 direction = hemisphereFromSquare(u, v, mapping);
            REQUIRE(std::abs(glm::length(direction) - 1.0) < 1e-12);
            REQUIRE(direction.z >= 0.0);
            const Vec2 back = squareFromHemisphere(Vec3(direction), mapping);
            worst = std::max({worst, std::abs(double(back.x) - u), std::abs(double(back.y) - v)});
        }
    CHECK(worst < double(kSquareMaxError));
    CHECK(worst > 0.0);
    CHECK(squareFromHemisphere(Vec3(0, 0, 1), mapping) == Vec2(0.5f));
    CHECK(squareFromHemisphere(Vec3(0, 0, -1), mapping) == Vec2(0.5f));
    const Vec2 below = squareFromHemisphere(glm::normalize(Vec3(1.0f, 0.2f, -0.5f)), mapping),
               rim = squareFromHemisphere(glm::normalize(Vec3(1.0f, 0.2f, 0.0f)), mapping);
    CHECK(glm::length(below - rim) < 1e-5f);
    for (double t = -1.0; t <= 1.0; t += 1e-3)
        REQUIRE(std::abs(double(octantArcTangent(float(t))) - std::atan(double(float(t)))) < double(kOctantArcTangentMaxError));
}

TEST_CASE("caches convolved: constant radiance L is L in each mip and pi L for each normal, in half as well", "[caches]")
{
    CacheSettings settings = settingsOf(GENERATE(CacheMapping::equalArea, CacheMapping::octahedral), GENERATE(4, 16));
    settings.storage = GENERATE(Storage::gpu, Storage::float32);
    const bool half = settings.storage == Storage::gpu;
    const CacheTables tables = makeCacheTables(settings, Rotation::none);
    const CacheAtlas atlas = cacheThatSees(settings, tables, [](const Vec3&) { return 0.75f; });
    const double step = half ? 0x1p-10 : 2e-6;
    CHECK(atlas.levels.size() == std::size_t(std::log2(settings.resolution)) + 1);
    for (const auto& level : atlas.levels)
        for (const Vec4& texel : level) REQUIRE(std::abs(double(texel.y) / 0.75 - 1.0) < step * double(atlas.levels.size()));
    for (const Vec4& texel : atlas.diffuse) {
        REQUIRE(std::abs(double(texel.x) / (std::numbers::pi * 0.75) - 1.0) < step);
        REQUIRE(std::abs(double(texel.w) / 0.75 - 1.0) < step);
    }
}

TEST_CASE("caches convolved: a texel of any level is the mean by solid angle of what it covers, cache by cache", "[caches]")
{
    const CacheSettings settings = settingsOf(GENERATE(CacheMapping::equalArea, CacheMapping::octahedral));
    const CacheTables tables = makeCacheTables(settings, Rotation::none);
    CacheAtlas atlas;
    atlas.resolution = 16;
    atlas.half = false;
    atlas.levels.emplace_back();
    for (std::uint32_t i = 0; i < 2 * 256; ++i) atlas.levels[0].emplace_back(float((i * 2654435769u) >> 16) / 65536.0f, float(i % 16), float(i / 16), 1.0f);
    atlas = convolveCaches(std::move(atlas), tables, settings);
    for (std::size_t level = 1; level < 5; ++level) {
        const std::size_t n = 16u >> level, edge = 1u << level;
        for (std::size_t texel = 0; texel < 2 * n * n; ++texel) {
            const std::size_t cache = texel / (n * n), row = texel % (n * n) / n, column = texel % n;
            glm::dvec4 sum(0.0);
            double whole = 0.0;
            for (std::size_t k = 0; k < edge * edge; ++k) {
                const std::size_t from = (row * edge + k / edge) * 16 + column * edge + k % edge;
                sum += double(tables.solidAngle[0][from]) * glm::dvec4(atlas.levels[0][cache * 256 + from]);
                whole += double(tables.solidAngle[0][from]);
            }
            REQUIRE(glm::length(glm::dvec4(atlas.levels[level][texel]) - sum / whole) < 1e-5);
        }
    }
}

TEST_CASE("caches convolved: irradiance of a half-lit hemisphere, of L = cos and of a sky, for the axis and for tilted normals", "[caches]")
{
    const CacheMapping mapping = GENERATE(CacheMapping::equalArea, CacheMapping::octahedral);
    CacheSettings settings = settingsOf(mapping);
    settings.horizon = CacheHorizon::black;  // the integral as it is
    const CacheTables tables = makeCacheTables(settings, Rotation::none);
    const GBuffer nothing;
    const Camera camera;
    const PixelClusters clusters;
    const CachePlaces places = test::placesOf({Vec3(0, 0, 1)});
    const auto irradiance = [&](const Vec3& normal, const auto& radiance) {
        const CacheAtlas atlas = cacheThatSees(settings, tables, radiance);
        const CacheWorld world{.gbuffer = nothing, .camera = camera, .clusters = clusters, .places = places, .atlas = atlas, .settings = settings};
        // Through the frame of the axis: turned by what basisFromNormal makes of it.
        return double(diffuseOf(world, 0, basisFromNormal(places.normals[0]) * normal).x);
    };
    const auto half = [](const Vec3& w) { return w.x > 1e-6f ? 1.0f : w.x < -1e-6f ? 0.0f : 0.5f; };
    const auto cosine = [](const Vec3& w) { return w.z; };
    const auto sky = [](const Vec3& w) { return 0.5f + 0.25f * w.x - 0.125f * w.y * w.z; };
    CHECK(std::abs(irradiance(Vec3(0, 0, 1), half) / (std::numbers::pi / 2) - 1.0) < 0.005);
    CHECK(std::abs(irradiance(Vec3(0, 0, 1), cosine) / (kTwoPi / 3) - 1.0) < 0.005);
    for (const Vec3& normal : {Vec3(0.0f, 0.0f, 1.0f), glm::normalize(Vec3(0.5f, 0.3f, 0.8f)), glm::normalize(Vec3(-0.2f, 0.7f, 0.6f))})
        CHECK(std::abs(irradiance(normal, sky) / irradianceOracle(glm::dvec3(normal), sky) - 1.0) < 0.02);
}

TEST_CASE("caches: the level of a lobe is that of its solid angle", "[caches]")
{
    for (float roughness = 0.02f; roughness <= 1.0f; roughness += 0.02f) {
        const double alpha = double(roughness) * double(roughness), n = (1.0 / (alpha * alpha) - 1.0) / 2.0;
        const auto level = [&](double omega) { return std::clamp(0.5 * std::log2(omega * 256.0 / kTwoPi), 0.0, 4.0); };
        CAPTURE(roughness);
        CHECK(std::abs(double(lobeLevel(roughness, 16, CacheLobe::equivalent)) - level(kTwoPi * (2 * n + 1) / ((n + 1) * (n + 1)))) <
              double(kLobeLevelMaxError));
        CHECK(std::abs(double(lobeLevel(roughness, 16, CacheLobe::cutoff)) - level(kTwoPi * (1.0 - std::pow(0.01, 1.0 / n)))) < double(kLobeLevelMaxError));
    }
    // [C]'s exponents 50 and 150 at N = 16.
    CHECK(lobeLevel(0.3153f, 16, CacheLobe::equivalent) == Approx(1.66f).margin(0.01));
    CHECK(lobeLevel(0.3153f, 16, CacheLobe::cutoff) == Approx(2.25f).margin(0.01));
    CHECK(lobeLevel(0.0f, 16, CacheLobe::equivalent) == 0.0f);
    CHECK(lobeLevel(1.0f, 16, CacheLobe::cutoff) == 4.0f);
}
