#include "lrsm/sample.h"
#include "synthetic_rsm.h"

#include <catch.h>

using namespace lrsm;
using test::randomRsm;
using test::uniform;
using test::unitVector;

namespace {

/// A 4 m cube under a light from above: u and v span more than the cube, depth 0 at the top, 1 at the bottom.
LightProjection sunProjection(int resolution)
{
    Light sun;
    sun.type = LightType::directional;
    sun.direction = Vec3(0.0f, -1.0f, 0.0f);
    sun.up = Vec3(0.0f, 0.0f, 1.0f);
    Aabb box;
    box.include(Vec3(-2.0f));
    box.include(Vec3(2.0f));
    return fitLightProjection(sun, box, resolution);
}

Lrsm randomLrsm(const LayerSettings& settings, unsigned seed, float filled = 0.8f)
{
    Rsm rsm = randomRsm(64, seed, filled);
    rsm.projection = sunProjection(64);
    return buildLrsm(rsm, settings);
}

ConeSample randomSample(std::mt19937& random)
{
    ConeSample sample;
    sample.centre = Vec3{uniform(random, -2.1f, 2.1f), uniform(random, -2.0f, 2.0f), uniform(random, -2.1f, 2.1f)};
    sample.radius = std::ldexp(uniform(random, 0.5f, 1.0f), -static_cast<int>(random() % 7));
    sample.toReceiver = unitVector(random);
    return sample;
}

double phiTwin(double x)
{
    return 0.5 * std::erfc(-x / std::sqrt(2.0));
}

double smoothstepTwin(double t)
{
    return t <= 0.0 ? 0.0 : t >= 1.0 ? 1.0 : t * t * (3.0 - 2.0 * t);
}

double decayTwin(const LayerRange& r, double z)
{
    const double lo = r.depthMin, hi = r.depthMax, delta = r.delta;
    if (z < lo || z > hi || (z == hi && r.decayAtMax)) return 0.0;
    if (r.decayAtMin && z < lo + delta) return smoothstepTwin((z - lo) / delta);
    if (r.decayAtMax && z > hi - delta) return smoothstepTwin((hi - z) / delta);
    return 1.0;
}

/// Algorithm 1 in double, straight from the paper, on the filtered texel that the (separately tested) sampler gives.
struct Algorithm1 {
    double outgoing[3] = {};
    bool nearStep = false;  ///< a discontinuity (selection, backface step) within rounding: not comparable
};
Algorithm1 algorithm1Twin(const Lrsm& lrsm, const ConeSample& sample, const ConeSettings& settings)
{
    Algorithm1 result;
    const LightSpacePoint p = projectToLight(lrsm.projection, sample.centre);
    if (!p.valid || p.u < 0.0f || p.u > 1.0f || p.v < 0.0f || p.v > 1.0f) return result;
    const double level = std::max(std::log2(2.0 * sample.radius / (2.0 * p.texelSize)) + settings.rsmLevelBias, double(settings.rsmMinLevel));
    const double window = double(sample.radius) * settings.vRadiusScale / (double(lrsm.projection.depthFar) - lrsm.projection.depthNear);
    for (int l = 0; l < lrsm.layers(); ++l) {
        const LayerRange& range = lrsm.ranges[std::size_t(l)];
        double f = decayTwin(range, p.depth);
        if (settings.layerSelection == LayerSelection::touched) {
            const double gap = std::min(p.depth + window - range.depthMin, range.depthMax - (p.depth - window));
            f = gap >= 0.0 ? 1.0 : 0.0;
            result.nearStep = result.nearStep || std::abs(gap) < 1e-5;
        }
        if (!(f > 0.0)) continue;
        const FilteredTexel t = sampleLayer(lrsm, l, p.u, p.v, float(level), settings.filterFraction);
        if (t.depthAlpha == 0.0f || t.normalAlpha == 0.0f) continue;
        double n = 0.0;
        for (int c = 0; c < 3; ++c) n += double(t.normal[c]) / t.normalAlpha * double(sample.toReceiver[c]);
        if (std::abs(n) < 1e-5 && settings.backface == Backface::step) result.nearStep = true;
        if (n <= 0.0) continue;
        if (settings.backface == Backface::step) n = 1.0;
        const double mu = double(t.depth) / t.depthAlpha;
        const double sigma = std::sqrt(std::max(double(t.depthSquared) / t.depthAlpha - mu * mu, double(kVarianceFloor)));
        const double width = double(range.depthMax) - range.depthMin, z = (double(p.depth) - range.depthMin) / width, r = window / width;
        const double v = phiTwin((z + r - mu) / sigma) - phiTwin((z - r - mu) / sigma);
        for (int c = 0; c < 3; ++c) result.outgoing[c] += f * t.radiance[c] * v * n;
    }
    return result;
}

}  // namespace

TEST_CASE("Algorithm 1 equals its double-precision twin with every setting", "[lrsm][algorithm1][eq5][eq8][eq12][eq14][eq15]")
{
    ConeSettings settings;
    LayerSettings layers;
    layers.depthLayers = GENERATE(1, 3);
    layers.storage = GENERATE(Storage::gpu, Storage::float32);
    settings.backface = GENERATE(Backface::cosine, Backface::step);
    settings.layerSelection = GENERATE(LayerSelection::centre, LayerSelection::touched);
    layers.overlap = settings.layerSelection == LayerSelection::centre ? 0.2f : 0.0f;
    settings.gaussian = GENERATE(GaussianMethod::table, GaussianMethod::polynomial, GaussianMethod::exact);
    settings.vRadiusScale = GENERATE(1.0f, 1.5f);
    settings.rsmLevelBias = settings.vRadiusScale == 1.0f ? 0.0f : -0.5f;
    settings.rsmMinLevel = settings.backface == Backface::step ? 1.25f : 0.0f;
    const NormalCdf phi(settings.gaussian, 4096);
    const Lrsm lrsm = randomLrsm(layers, 41);

    std::mt19937 random(42);
    int compared = 0, lit = 0;
    for (int i = 0; i < 400; ++i) {
        const ConeSample sample = randomSample(random);
        const Algorithm1 expected = algorithm1Twin(lrsm, sample, settings);
        if (expected.nearStep) continue;
        std::vector<LayerTerms> terms;
        const Vec3 actual = sampleLrsm(lrsm, sample, settings, phi, &terms);
        CAPTURE(i, sample.centre.x, sample.centre.y, sample.centre.z, sample.radius);
        Vec3 sum(0.0f);
        for (const LayerTerms& t : terms) sum += t.outgoing;
        for (int c = 0; c < 3; ++c) {
            // The level's fast logarithm, warped depths and sigma are float: 1e-4 of a radiance of at most 4 a layer.
            REQUIRE(std::abs(double(actual[c]) - expected.outgoing[c]) <= 4e-4);
            REQUIRE(actual[c] == sum[c]);
        }
        ++compared;
        lit += actual.x > 0.01f ? 1 : 0;
        REQUIRE(sampleLrsm(lrsm, sample, settings, phi) == actual);
    }
    CHECK(compared > 350);
    CHECK(lit > 30);
}

TEST_CASE("a flat wall facing the light: L = R V N in closed form", "[lrsm][eq5]")
{
    Rsm rsm = test::flatRsm(64, 0.5f, Vec3(2.0f, 1.0f, 0.5f), Vec3(0.0f, 1.0f, 0.0f));
    rsm.projection = sunProjection(64);
    LayerSettings layers;
    layers.fitRanges = false;
    layers.depthLayers = layers.normalLayers = 1;
    layers.storage = Storage::float32;
    const Lrsm lrsm = buildLrsm(rsm, layers);
    ConeSettings settings;
    settings.backface = Backface::cosine;
    const NormalCdf phi;
    const Vec3 v = glm::normalize(Vec3(1.0f, 2.0f, 0.5f));
    const float range = lrsm.projection.depthRange(), surface = 2.0f - (lrsm.projection.depthNear + 0.5f * range) + lrsm.projection.depthNear;
    for (const float offset : {0.0f, 0.1f, 0.2f, -0.3f}) {
        const ConeSample sample{Vec3(0.1f, surface - offset, 0.2f), 0.2f, v};
        const double sigma = std::sqrt(double(kVarianceFloor)), d = std::abs(offset) / range, r = 0.2 / range;
        const double visibility = phiTwin((r - d) / sigma) - phiTwin((-r - d) / sigma);
        const Vec3 radiance = sampleLrsm(lrsm, sample, settings, phi);
        CHECK(radiance.x == Approx(2.0 * visibility * double(v.y)).margin(2e-4));
        CHECK(radiance.z == Approx(0.5 * visibility * double(v.y)).margin(1e-4));
    }
}

TEST_CASE("outside the map or behind the light nothing contributes, inside out nothing is culled by mistake", "[lrsm][algorithm1]")
{
    const Lrsm lrsm = randomLrsm(LayerSettings{}, 43, 1.0f);
    const NormalCdf phi;
    ConeSettings settings;
    ConeSample sample{Vec3(0.0f), 1.5f, Vec3(0.0f, 1.0f, 0.0f)};
    CHECK(projectToLight(lrsm.projection, sample.centre).valid);
    std::vector<LayerTerms> terms;
    for (const Vec3& centre : {Vec3(-9.0f, 0.0f, 0.0f), Vec3(0.0f, 0.0f, 9.0f), Vec3(3.0f, 0.0f, 3.0f)}) {
        sample.centre = centre;
        CHECK(sampleLrsm(lrsm, sample, settings, phi, &terms) == Vec3(0.0f));
        CHECK(terms.empty());
    }

    Rsm rsm = randomRsm(16, 44);
    rsm.projection.type = LightType::spot;
    rsm.projection.forward = Vec3(0.0f, 0.0f, -1.0f);
    rsm.projection.depthFar = 10.0f;
    rsm.projection.resolution = 16;
    const Lrsm spot = buildLrsm(rsm, LayerSettings{});
    sample.centre = Vec3(0.0f, 0.0f, 3.0f);
    sample.radius = 20.0f;  // would touch every layer
    CHECK(sampleLrsm(spot, sample, settings, phi, &terms) == Vec3(0.0f));
    CHECK(terms.empty());
}

TEST_CASE("dropping empty layers changes no bit of a sample", "[lrsm][algorithm1]")
{
    LayerSettings layers;
    layers.depthLayers = 8;
    layers.normalLayers = 4;
    layers.fitRanges = false;  // depths of 0.2..0.9 leave the first and last slices empty
    const Lrsm dropped = randomLrsm(layers, 45);
    layers.dropEmpty = false;
    const Lrsm kept = randomLrsm(layers, 45);
    REQUIRE(dropped.layers() < kept.layers());
    const NormalCdf phi;
    std::mt19937 random(46);
    for (int i = 0; i < 300; ++i) {
        const ConeSample sample = randomSample(random);
        REQUIRE(sampleLrsm(dropped, sample, ConeSettings{}, phi) == sampleLrsm(kept, sample, ConeSettings{}, phi));
    }
    layers.dropEmpty = true;
    const Lrsm none = randomLrsm(layers, 45, 0.0f);
    REQUIRE(none.layers() == 0);
    CHECK(sampleLrsm(none, randomSample(random), ConeSettings{}, phi) == Vec3(0.0f));
}

TEST_CASE("light scaled by 2^k scales every sample exactly", "[lrsm][invariance]")
{
    LayerSettings layers;
    layers.storage = Storage::float32;
    const Lrsm lrsm = randomLrsm(layers, 47);
    Lrsm scaled = lrsm;
    for (LrsmTexel& texel : scaled.texels)
        for (int c = 0; c < 3; ++c) texel.radiance[c] *= 0x1p12f;
    const NormalCdf phi;
    std::mt19937 random(48);
    for (int i = 0; i < 300; ++i) {
        const ConeSample sample = randomSample(random);
        REQUIRE(sampleLrsm(scaled, sample, ConeSettings{}, phi) == sampleLrsm(lrsm, sample, ConeSettings{}, phi) * 0x1p12f);
    }
}

TEST_CASE("the mip level is log2 of the diameter in LRSM texels, biased and clamped", "[lrsm][sec5]")
{
    std::mt19937 random(49);
    for (int i = 0; i < 2000; ++i) {
        const float diameter = std::ldexp(uniform(random, 0.5f, 1.0f), 8 - static_cast<int>(random() % 16)), texel = uniform(random, 1e-3f, 0.1f);
        const float bias = uniform(random, -2.0f, 2.0f), least = uniform(random, 0.0f, 3.0f);
        const double expected = std::max(std::log2(double(diameter) / (2.0 * texel)) + double(bias), double(least));
        REQUIRE(double(lrsmLevel(diameter, texel, bias, least)) == Approx(expected).margin(3e-6));
    }
    CHECK(lrsmLevel(2.0f * 0.25f, 0.25f, 0.0f, -10.0f) == 0.0f);  // one LRSM texel is two RSM texels
    CHECK(lrsmLevel(0.0f, 0.25f, 0.0f, 0.5f) == 0.5f);
}

TEST_CASE("the normal term divides by alpha alone and culls back faces", "[lrsm][eq8]")
{
    std::mt19937 random(50);
    for (int i = 0; i < 2000; ++i) {
        FilteredTexel texel;
        texel.normalAlpha = uniform(random, 1e-3f, 1.0f);
        texel.normal = unitVector(random) * texel.normalAlpha * uniform(random);
        const Vec3 v = unitVector(random);
        double expected = 0.0;
        for (int c = 0; c < 3; ++c) expected += double(texel.normal[c]) / texel.normalAlpha * double(v[c]);
        REQUIRE(double(normalTerm(texel, v)) == Approx(std::max(0.0, expected)).margin(double(kNormalTermMaxError)));
    }
    FilteredTexel empty;
    empty.normal = Vec3(0.0f, 1.0f, 0.0f);
    CHECK(normalTerm(empty, Vec3(0.0f, 1.0f, 0.0f)) == 0.0f);  // planted: alpha 0

    CHECK(backfaceWeight(0.1f, Backface::cosine) == 0.1f);
    CHECK(backfaceWeight(1e-6f, Backface::step) == 1.0f);
    for (const Backface mode : {Backface::cosine, Backface::step}) CHECK(backfaceWeight(0.0f, mode) == 0.0f);
}

TEST_CASE("depth moments equal their double twin; zero, negative and empty cases", "[lrsm][eq10][eq11]")
{
    std::mt19937 random(51);
    for (int i = 0; i < 2000; ++i) {
        // Two depths in one footprint, of which a fraction is in the layer.
        const double a = uniform(random), b = uniform(random), share = uniform(random), alpha = uniform(random, 0.05f, 1.0f);
        FilteredTexel texel;
        texel.depthAlpha = float(alpha);
        texel.depth = float(alpha * (share * a + (1.0 - share) * b));
        texel.depthSquared = float(alpha * (share * a * a + (1.0 - share) * b * b));
        const DepthMoments moments = depthMoments(texel, -kInfinity);
        REQUIRE(double(moments.mean) == Approx(share * a + (1.0 - share) * b).margin(2e-7));
        REQUIRE(double(moments.variance) == Approx(share * (1.0 - share) * (a - b) * (a - b)).margin(6e-7));
        REQUIRE(moments.negative == (moments.variance < 0.0f));
        REQUIRE(depthMoments(texel).variance == std::max(moments.variance, kVarianceFloor));
    }
    FilteredTexel texel;
    texel.depth = texel.depthSquared = 0.5f;  // planted: alpha 0
    CHECK(depthMoments(texel).mean == 0.0f);
    CHECK_FALSE(depthMoments(texel).negative);
    texel = FilteredTexel{};
    texel.depthAlpha = 0.5f;
    texel.depth = 0.25f;
    texel.depthSquared = 0.125f;  // flat: z = 1/2 exactly
    CHECK(depthMoments(texel, 0.0f).variance == 0.0f);
    CHECK_FALSE(depthMoments(texel).negative);
    texel.depthSquared = std::nextafter(0.125f, 0.0f);  // planted: z^2 one ULP short
    CHECK(depthMoments(texel).negative);
    CHECK(depthMoments(texel).variance == kVarianceFloor);
    CHECK(depthMoments(texel, -kInfinity).variance < 0.0f);
}
