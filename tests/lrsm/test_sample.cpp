// Algorithm 1 and its terms are held against a twin in double in apps/validate/equations/{sample,term}_checks.cpp; here are the traps.
#include "lrsm/sample.h"

#include "apps/validate/equations/synthetic_maps.h"

#include <catch.h>

using namespace lrsm;

TEST_CASE("the layers' terms that --pixel prints sum to the sample, and asking for them changes no bit", "[lrsm][algorithm1]")
{
    Rsm rsm = syntheticRsm(64, 41);
    rsm.projection = sunOverCube(64);
    const Lrsm lrsm = buildLrsm(rsm, LayerSettings{});
    const NormalCdf phi;
    SearchRandom random(42);
    int lit = 0;
    for (int i = 0; i < 400; ++i) {
        const float x = random.uniform(-3.0f, 3.0f), y = random.uniform(-2.0f, 2.0f);
        const ConeSample sample{Vec3(x, y, random.uniform(-2.1f, 2.1f)), random.uniform(0.01f, 1.0f), randomUnit(random)};
        std::vector<LayerTerms> terms;
        const Vec3 radiance = sampleLrsm(lrsm, sample, ConeSettings{}, phi, &terms);
        Vec3 sum(0.0f);
        for (const LayerTerms& t : terms) sum += t.outgoing;
        REQUIRE(radiance == sum);
        REQUIRE(sampleLrsm(lrsm, sample, ConeSettings{}, phi) == radiance);
        if (std::abs(x) > 2.2f) REQUIRE(terms.empty());  // beside the map
        lit += radiance.x > 0.01f ? 1 : 0;
    }
    CHECK(lit > 30);
}

TEST_CASE("the mip level: one LRSM texel is two RSM texels, and a minimum below 0 is taken", "[lrsm][sec5]")
{
    CHECK(lrsmLevel(2.0f * 0.25f, 0.25f, 0.0f, -10.0f) == 0.0f);
    CHECK(lrsmLevel(0.0f, 0.25f, 0.0f, 0.5f) == 0.5f);
}

TEST_CASE("moments and normal term where alpha is 0, where z is flat and where z^2 is one ULP short", "[lrsm][eq8][eq10][eq11]")
{
    FilteredTexel texel;
    texel.normal = Vec3(0.0f, 1.0f, 0.0f);
    texel.depth = texel.depthSquared = 0.5f;
    CHECK(normalTerm(texel, Vec3(0.0f, 1.0f, 0.0f)) == 0.0f);
    CHECK(depthMoments(texel).mean == 0.0f);
    CHECK_FALSE(depthMoments(texel).negative);
    texel.depthAlpha = 0.5f;
    texel.depth = 0.25f;
    texel.depthSquared = 0.125f;  // z = 1/2 exactly
    CHECK(depthMoments(texel, 0.0f).variance == 0.0f);
    CHECK_FALSE(depthMoments(texel).negative);
    texel.depthSquared = std::nextafter(0.125f, 0.0f);
    CHECK(depthMoments(texel).negative);
    CHECK(depthMoments(texel).variance == kVarianceFloor);
    CHECK(depthMoments(texel, -kInfinity).variance < 0.0f);
}
