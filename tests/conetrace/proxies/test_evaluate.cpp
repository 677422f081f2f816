#include "conetrace/proxies/evaluate.h"

#include "conetrace/proxies/vpl.h"
#include "core/scene/builtin_scenes.h"
#include "tests/conetrace/proxies/proxy_scenes.h"

#include "catch.h"

#include <cmath>
#include <map>
#include <numbers>

using namespace lrsm;
using namespace lrsm::test;

namespace {

constexpr double kPiDouble = std::numbers::pi;

/// By all of a cell's proxies, each once.
WholeCell allOf(const ProxyCells& cells, std::uint32_t cell, const LitSurface& surface, const VplSettings& vpl)
{
    return cellByProxies(cells, nullptr, cell, cells.first[cell + 1], surface, vpl);
}

/// Irradiance by all cells: what nothing hides.
Vec3 irradianceByAll(const ProxyCells& cells, const LitSurface& surface, const VplSettings& vpl, bool byProxies)
{
    Vec3 sum(0.0f);
    for (std::uint32_t cell = 0; cell < cells.grid.count(); ++cell)
        sum += (byProxies ? allOf(cells, cell, surface, vpl) : cellByHarmonics(cells.lights[cell], surface, vpl)).irradiance;
    return sum;
}

/// Configuration factor of two parallel unit squares, face to face at distance 1: Howell, catalog C-11, a = b = c = 1.
double facingSquares()
{
    const double x = 1.0, y = 1.0, x2 = 1.0 + x * x, y2 = 1.0 + y * y;
    return 2.0 / (kPiDouble * x * y) *
           (std::log(std::sqrt(x2 * y2 / (1.0 + x * x + y * y))) + x * std::sqrt(y2) * std::atan(x / std::sqrt(y2)) +
            y * std::sqrt(x2) * std::atan(y / std::sqrt(x2)) - x * std::atan(x) - y * std::atan(y));
}

}  // namespace

TEST_CASE("proxies: one disc on its axis gives pi L r^2 / (d^2 + r^2), at any distance", "[proxies]")
{
    const float distance = GENERATE(0.01f, 0.1f, 1.0f, 10.0f);
    PointProxies one;
    one.area = 0.3f;
    one.positions = {Vec3(0.5f)};
    one.normals = {Vec3(0, 0, 1)};
    const Scene scene = quadScene({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 1), Vec3(0, 1, 1)}});
    const ProxyCells cells = sortProxies(scene, one, shining(one, Vec3(1, 2, 3)), {.grid = 1});
    const LitSurface surface{.position = Vec3(0.5f, 0.5f, 0.5f + distance), .normal = Vec3(0, 0, -1)};
    const double r2 = 0.3 / kPiDouble, d2 = double(distance) * double(distance);
    CHECK(double(allOf(cells, 0, surface, {}).irradiance.z) == Approx(kPiDouble * 3.0 * r2 / (d2 + r2)).epsilon(1e-4));
    // Clamped, and bare.
    const double bare = 3.0 * 0.3 / d2;
    CHECK(double(allOf(cells, 0, surface, {.singularity = VplSingularity::none}).irradiance.z) == Approx(bare).epsilon(1e-4));
    CHECK(double(allOf(cells, 0, surface, {.singularity = VplSingularity::clamp, .clamp = 2.0f}).irradiance.z) ==
          Approx(std::min(bare, 3.0 * 2.0)).epsilon(1e-4));
}

TEST_CASE("proxies: between facing squares they give the closed form within 2 / sqrt N, by proxies, and by harmonics of small cells", "[proxies]")
{
    const int count = GENERATE(500, 4000);
    const Scene scene = quadScene({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}});  // front towards +z
    Scene reach = scene;
    reach.bounds.include(Vec3(1, 1, 1));
    const ProxySettings settings{.count = count, .grid = 16};
    const PointProxies proxies = placeProxies(scene, settings, TextureFilter::trilinear);
    const ProxyCells cells = sortProxies(reach, proxies, shining(proxies, Vec3(2.0f)), settings);
    double direct = 0.0, far = 0.0, order1 = 0.0;
    constexpr int kReceivers = 16;
    for (int j = 0; j < kReceivers; ++j)
        for (int i = 0; i < kReceivers; ++i) {
            const LitSurface surface{.position = Vec3((float(i) + 0.5f) / kReceivers, (float(j) + 0.5f) / kReceivers, 1.0f), .normal = Vec3(0, 0, -1)};
            direct += double(irradianceByAll(cells, surface, {}, true).x) / (kReceivers * kReceivers);
            far += double(irradianceByAll(cells, surface, {}, false).x) / (kReceivers * kReceivers);
            // Eq. 2 after l = 1 of each point: 1/4 + c/2 in place of its cosine c.
            for (const Vec3& p : proxies.positions) {
                const glm::dvec3 away = glm::dvec3(surface.position) - glm::dvec3(p);
                const double d2 = glm::dot(away, away), cosine = away.z / std::sqrt(d2);
                order1 += 2.0 / count * (0.25 + 0.5 * cosine) * cosine / d2 / (kReceivers * kReceivers);
            }
        }
    const double expected = kPiDouble * 2.0 * facingSquares();
    CHECK(facingSquares() == Approx(0.19982).epsilon(1e-3));
    CHECK(direct == Approx(expected).epsilon(2.0 / std::sqrt(double(count))));
    // Far cells lose a fifth of what faces them: 3/4 of its intensity at 0 degrees.
    CHECK(far == Approx(order1).epsilon(0.01));
    CHECK(far == Approx(0.78 * expected).epsilon(0.02));
}

TEST_CASE("proxies: within a furnace of radiance L every lobe sees L, and irradiance is pi L within 2 %", "[proxies]")
{
    const Scene scene = *makeBuiltinScene("furnace");
    const ProxySettings settings{.count = 20000, .grid = 8};
    const PointProxies proxies = placeProxies(scene, settings, TextureFilter::trilinear);
    const ProxyCells cells = sortProxies(scene, proxies, shining(proxies, Vec3(0.5f)), settings);
    std::mt19937 random(1);
    for (int k = 0; k < 8; ++k) {
        const Vec3 out = randomUnit(random);
        const LitSurface surface{.position = out * 0.9f, .normal = -out, .mirror = glm::normalize(-out + 0.5f * randomUnit(random))};
        CHECK(double(irradianceByAll(cells, surface, {}, true).y) == Approx(0.5 * kPiDouble).epsilon(0.02));
        const VplLobeWeight lobe({}, phongExponent(0.3f));
        for (const bool byProxies : {true, false}) {
            LobeSum sum;
            for (std::uint32_t cell = 0; cell < cells.grid.count(); ++cell) {
                const LobeSum own =
                    byProxies ? lobeByProxies(cells, nullptr, cell, surface, {}, lobe) : lobeByHarmonics(cells.lights[cell], cells.area, surface, {}, lobe);
                sum.radiance += own.radiance;
                sum.weight += own.weight;
            }
            CHECK(double(sum.radiance.y / sum.weight) == Approx(0.5).epsilon(1e-4));
            // By proxies the sum over weights is the lobe's integral, which pp_lobe_norm=lobe divides by.
            if (byProxies) CHECK(double(sum.weight) == Approx(lobeIntegral({}, double(phongExponent(0.3f)))).epsilon(0.1));
        }
    }
}

TEST_CASE("proxies: a cell's form factor is the closed form of its surface, lit or not, and what is seen of it counts by the rays that met it", "[proxies]")
{
    // A square far away, half of its proxies dark: F = cos cos' A / (pi d^2).
    const Scene scene = quadScene({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}});
    const ProxySettings settings{.count = 1000, .grid = 1};
    const PointProxies proxies = placeProxies(scene, settings, TextureFilter::trilinear);
    ProxyLight light = shining(proxies, Vec3(2.0f, 1.0f, 0.0f));
    for (std::size_t i = 0; i < proxies.size(); i += 2) light.radiance[i] = Vec3(0.0f);
    const ProxyCells cells = sortProxies(scene, proxies, light, settings);
    const LitSurface surface{.position = Vec3(0.5f, 0.5f, 20.0f), .normal = Vec3(0, 0, -1)};
    const double factor = 1.0 / (kPiDouble * 400.0);
    const WholeCell exact = allOf(cells, 0, surface, {}), far = cellByHarmonics(cells.lights[0], surface, {});
    CHECK(double(exact.formFactor) == Approx(factor).epsilon(0.01));
    CHECK(double(far.formFactor) == Approx(0.75 * factor).epsilon(0.01));  // order 1 at 0 degrees
    // Rays find a third of it: half of that shines, whichever way f and F are summed.
    for (const WholeCell& whole : {exact, far}) {
        const Vec3 seen = irradianceOfSeen(cells.lights[0], whole, float(factor / 3.0));
        CHECK(double(seen.x) == Approx(kPiDouble * factor / 3.0).epsilon(0.01));
        CHECK(double(seen.y) == Approx(kPiDouble * factor / 6.0).epsilon(0.01));
        CHECK(seen.z == 0.0f);
    }
}

TEST_CASE("proxies: what harmonics say of a cell's radiance is no more than its brightest proxy's", "[proxies]")
{
    // Two walls back to back: the one that shines looks away, order 1 of both sees little area and much light.
    const Scene scene = quadScene({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, {Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(1, 0, 0)}});
    const ProxySettings settings{.count = 400, .grid = 1};
    const PointProxies proxies = placeProxies(scene, settings, TextureFilter::trilinear);
    ProxyLight light = shining(proxies, Vec3(3.0f));
    for (std::size_t i = 0; i < proxies.size(); ++i)
        if (proxies.normals[i].z < 0.0f) light.radiance[i] = Vec3(0.0f);
    const ProxyCells cells = sortProxies(scene, proxies, light, settings);
    CHECK(cells.lights[0].brightest == Vec3(3.0f));
    std::mt19937 random(7);
    std::size_t bounded = 0;
    for (int k = 0; k < 50; ++k) {
        const Vec3 away = randomUnit(random);
        const LitSurface surface{.position = Vec3(0.5f) + 5.0f * away, .normal = -away};
        const Vec3 seen = irradianceOfSeen(cells.lights[0], cellByHarmonics(cells.lights[0], surface, {}), 0.25f);
        REQUIRE(double(seen.x) <= 0.25 * kPiDouble * 3.0 * 1.0001);
        bounded += double(seen.x) > 0.2499 * kPiDouble * 3.0 ? 1 : 0;
    }
    CHECK(bounded > 5);
    CHECK(irradianceOfSeen(cells.lights[0], {.irradiance = Vec3(1.0f), .formFactor = 0.0f}, 0.5f).y == Approx(0.5 * kPiDouble * 3.0));
    CHECK(irradianceOfSeen(cells.lights[0], {}, 0.5f) == Vec3(0.0f));
}

TEST_CASE("proxies: each counts in its cell's mean radiance as often as rays met it, and one that none met counts nothing", "[proxies]")
{
    // A square far away. Of four proxies one shines 2, one 6, one 100, and one is dark.
    const Scene scene = quadScene({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}});
    PointProxies proxies;
    proxies.area = 0.25f;
    proxies.positions = {Vec3(0.25f, 0.25f, 0), Vec3(0.75f, 0.25f, 0), Vec3(0.25f, 0.75f, 0), Vec3(0.75f, 0.75f, 0)};
    proxies.normals.assign(4, Vec3(0, 0, 1));
    ProxyLight light = shining(proxies, Vec3(2.0f));
    light.radiance = {Vec3(2.0f), Vec3(6.0f), Vec3(100.0f), Vec3(0.0f)};
    const ProxyCells cells = sortProxies(scene, proxies, light, {.grid = 1});
    const std::map<std::uint32_t, std::uint32_t> met = {{0, 3}, {1, 1}, {2, 0}, {3, 4}};
    std::vector<std::uint32_t> hits(cells.numbers.size(), 0);
    for (std::size_t slot = 0; slot < hits.size(); ++slot)
        if (cells.numbers[slot] != kNoProxy) hits[slot] = met.at(cells.numbers[slot]);
    const WeighedProxies seen = weighProxies(cells, hits);
    CHECK(seen.lights[0].brightest == Vec3(6.0f));
    CHECK(double(seen.lights[0].litArea) == Approx(0.5));
    const LitSurface surface{.position = Vec3(0.5f, 0.5f, 50.0f), .normal = Vec3(0, 0, -1)};
    for (const WholeCell& whole : {cellByProxies(cells, &seen, 0, cells.first[1], surface, {}), cellByHarmonics(seen.lights[0], surface, {})})
        CHECK(double(irradianceOfSeen(seen.lights[0], whole, 0.5f).x) == Approx(0.5 * kPiDouble * (3.0 * 2.0 + 6.0) / 8.0).epsilon(1e-3));
    const LitSurface glossy{.position = surface.position, .normal = surface.normal, .mirror = Vec3(0, 0, -1)};
    const LobeSum lobe = lobeByProxies(cells, &seen, 0, glossy, {}, VplLobeWeight({}, 1.0f));
    CHECK(double(lobe.radiance.x / lobe.weight) == Approx((3.0 * 2.0 + 6.0) / 8.0).epsilon(1e-3));
}

TEST_CASE("virtual lights: Eq. 7 and its integral against double precision", "[proxies]")
{
    const float exponent = GENERATE(0.0f, 1.0f, 10.0f, 50.0f, 400.0f), sigma = GENERATE(0.1f, 0.25f, 1.0f);
    const VplLobe kind = GENERATE(VplLobe::gaussian, VplLobe::phong);
    const VplSettings settings{.lobe = kind, .sigma = sigma};
    const VplLobeWeight weight(settings, exponent);
    const auto exact = [&](double cosine) {
        const double p = cosine > 0.0 ? std::pow(cosine, double(exponent)) : exponent == 0.0f ? 0.0 : 0.0;
        const double off = (1.0 - p) / double(sigma);
        return kind == VplLobe::phong ? p : std::exp(-0.5 * off * off) / (double(sigma) * std::sqrt(2.0 * kPiDouble));
    };
    double integral = 0.0;
    constexpr int kSteps = 200000;
    for (int k = 0; k < kSteps; ++k) integral += exact((k + 0.5) / kSteps) * 2.0 * kPiDouble / kSteps;
    CHECK(lobeIntegral(settings, double(exponent)) == Approx(integral).epsilon(kLobeIntegralMaxError));
    for (int k = -20; k <= 100; ++k) {
        const double cosine = k / 100.0;
        REQUIRE(std::abs(double(weight.ofCosine(float(cosine))) - exact(cosine)) <= double(kLobeWeightMaxError) * exact(1.0));
    }
}

TEST_CASE("virtual lights: a lobe's exponent is that of GGX's alpha = (2n + 1)^-1/2", "[proxies]")
{
    CHECK(phongExponent(0.31544f) == Approx(50.0f).epsilon(1e-3));
    CHECK(phongExponent(0.4671f) == Approx(10.0f).epsilon(1e-3));
    CHECK(phongExponent(1.0f) == 0.0f);
}
