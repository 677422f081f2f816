// Properties that hold for every input, tried on inputs that rapidcheck makes up; a failure is shrunk and its seed printed.
#include "apps/validate/equations/synthetic_maps.h"
#include "conetrace/lrsm/march_paper.h"
#include "conetrace/lrsm/march_slab.h"
#include "lrsm/sample.h"

#include "catch.h"

#include <rapidcheck.h>
#include <cassert>
#include <cstdlib>

using namespace lrsm;

namespace {

/// The same inputs on every run; RC_PARAMS in the environment overrides it.
const bool kSeeded = setenv("RC_PARAMS", "seed=2014 max_success=200", 0) == 0;

/// In [low, high], on a lattice of 2^-20 of it: differences of such numbers are exact.
float between(float low, float high)
{
    assert(kSeeded);
    return low + (high - low) * static_cast<float>(*rc::gen::inRange(0, (1 << 20) + 1)) * 0x1p-20f;
}

NormalCdf anyCdf()
{
    return NormalCdf(*rc::gen::element(GaussianMethod::table, GaussianMethod::polynomial, GaussianMethod::exact), *rc::gen::inRange(2, 4096));
}

}  // namespace

TEST_CASE("properties of Eq. 12: in [0, 1], symmetric about the mean, growing with the radius, scale free", "[equations][property][eq12]")
{
    CHECK(rc::check("in [0, 1] and symmetric", [] {
        const NormalCdf phi = anyCdf();
        const float d = between(0.0f, 2.0f), sigma2 = between(0.0f, 0.5f), rc = between(0.0f, 3.0f);
        const float v = gaussianVisibility(phi, 1.0f, sigma2, 1.0f + d, rc);
        RC_ASSERT(v >= 0.0f && v <= 1.0f);
        RC_ASSERT(v == gaussianVisibility(phi, 1.0f, sigma2, 1.0f - d, rc));
    }));
    CHECK(rc::check("grows with the radius", [] {
        const NormalCdf phi = anyCdf();
        const float mu = between(0.0f, 1.0f), zc = between(-0.5f, 1.5f), sigma2 = between(0.0f, 0.5f), r = between(0.0f, 1.0f), more = between(0.0f, 1.0f);
        RC_ASSERT(gaussianVisibility(phi, mu, sigma2, zc, r + more) >= gaussianVisibility(phi, mu, sigma2, zc, r) - 2.0f * gaussianVisibilityMaxError(phi));
    }));
    CHECK(rc::check("depths times 2^k: the same bits", [] {
        const NormalCdf phi = anyCdf();
        const float scale = std::ldexp(1.0f, *rc::gen::inRange(-20, 21));
        const float mu = between(0.0f, 1.0f), zc = between(-0.5f, 1.5f), sigma2 = between(1e-4f, 0.5f), r = between(0.0f, 1.0f);
        RC_ASSERT(gaussianVisibility(phi, mu * scale, sigma2 * scale * scale, zc * scale, r * scale) == gaussianVisibility(phi, mu, sigma2, zc, r));
    }));
}

TEST_CASE("properties of Eq. 13 and 14: layers share out every texel", "[equations][property][eq13][eq14]")
{
    CHECK(rc::check("alphas of a partition sum to what is drawn, at every level", [] {
        const LayerSettings settings = layersOf(*rc::gen::inRange(1, 17), *rc::gen::inRange(1, 9));
        const Rsm rsm = syntheticRsm(8, *rc::gen::inRange(0u, 1000u), between(0.0f, 1.0f));
        const Lrsm lrsm = buildLrsm(rsm, settings);
        for (int lod = 0; lod < 3; ++lod)
            for (int i = 0; i < (4 >> lod) * (4 >> lod); ++i) {
                float alpha = 0.0f, drawn = 0.0f;
                for (int layer = 0; layer < lrsm.layers(); ++layer) alpha += lrsm.level(layer, lod)[i].depth[2];
                const int edge = 2 << lod, x = i % (4 >> lod) * edge, y = i / (4 >> lod) * edge;
                for (int k = 0; k < edge * edge; ++k) drawn += rsm.texels.at(x + k % edge, y + k / edge).coverage / float(edge * edge);
                RC_ASSERT(alpha == drawn);
            }
    }));
}

TEST_CASE("properties of the sampler: weights sum to 1 inside, never more, and are never negative", "[equations][property][eq9]")
{
    const Lrsm lrsm = buildLrsm(syntheticRsm(64, 11, 1.0f), layersOf(1, 1));
    CHECK(rc::check([&] {
        const auto fraction = *rc::gen::element(FilterFraction::exact, FilterFraction::fixed8);
        const float level = between(0.0f, 5.0f), u = between(-0.2f, 1.2f), v = between(-0.2f, 1.2f);
        const LrsmFootprint footprint = makeFootprint(lrsm, u, v, level, fraction);
        double sum = 0.0;
        for (int tap = 0; tap < footprint.taps; ++tap) {
            RC_ASSERT(footprint.weight[tap] >= 0.0f);
            RC_ASSERT(footprint.texel[tap] < lrsm.texelsPerLayer);
            sum += double(footprint.weight[tap]);
        }
        RC_ASSERT(sum <= 1.0 + 4.0 * double(kFootprintWeightMaxError));
        const double rim = 0.5 / double(lrsm.resolutionAt(std::min(static_cast<int>(level) + 1, lrsm.levels() - 1)));
        const bool inside = std::min(std::min(double(u), 1.0 - double(u)), std::min(double(v), 1.0 - double(v))) > rim + 1e-3;
        if (inside) RC_ASSERT(std::abs(sum - 1.0) <= 4.0 * double(kFootprintWeightMaxError));
    }));
    CHECK(rc::check("the level grows with the radius, by one for twice of it", [] {
        const float radius = between(0.001f, 8.0f), texel = between(0.001f, 1.0f), more = between(1.0f, 4.0f);
        RC_ASSERT(lrsmLevel(radius * more, texel, 0.0f, 0.0f) >= lrsmLevel(radius, texel, 0.0f, 0.0f) - 2.0f * kLrsmLevelMaxError);
        const float once = lrsmLevel(radius, texel, 20.0f, 0.0f), twice = lrsmLevel(2.0f * radius, texel, 20.0f, 0.0f);
        RC_ASSERT(std::abs(twice - once - 1.0f) <= 2.0f * kLrsmLevelMaxError);
    }));
}

TEST_CASE("properties of Algorithm 1: light times 2^k is 2^k times the radiance, and nothing exceeds the map", "[equations][property][algorithm1]")
{
    Rsm rsm = syntheticRsm(32, 12);
    rsm.projection = sunOverCube(32);
    const Lrsm lrsm = buildLrsm(rsm, layersOf(2, 2));
    CHECK(rc::check([&] {
        const float scale = std::ldexp(1.0f, *rc::gen::inRange(-20, 21));
        Lrsm scaled = lrsm;
        for (LrsmTexel& texel : scaled.texels)
            for (float& value : texel.radiance) value *= scale;
        const ConeSample cone{Vec3(between(-2.1f, 2.1f), between(-2.0f, 2.0f), between(-2.1f, 2.1f)), between(0.01f, 2.0f), Vec3(0.6f, 0.8f, 0.0f)};
        ConeSettings cones;
        cones.gather.backface = *rc::gen::element(Backface::cosine, Backface::step);
        const NormalCdf phi;
        const Vec3 once = sampleLrsm(lrsm, cone, cones, phi);
        RC_ASSERT(sampleLrsm(scaled, cone, cones, phi) == once * scale);
        RC_ASSERT(once.x >= 0.0f && double(once.x) <= kSyntheticRadiance * 1.0001);
    }));
}

TEST_CASE("properties of Eq. 1: opacity composes, and transmittance never grows", "[equations][property][eq1]")
{
    ConeSettings settings;
    settings.march.opacity = OpacityModel::density;
    CHECK(rc::check("two steps are one of the sum of their lengths", [&] {
        ConeSettings s = settings;
        s.march.densityK = between(0.25f, 4.0f);
        const float a = between(0.0f, 1.0f), one = between(0.01f, 4.0f), two = between(0.01f, 4.0f);
        const double apart = (1.0 - double(stepOpacity(a, one, s))) * (1.0 - double(stepOpacity(a, two, s))),
                     together = 1.0 - double(stepOpacity(a, one + two, s));
        RC_ASSERT(std::abs(apart - together) <= 3.0 * double(kStepOpacityMaxError) * std::max(1.0, double(s.march.densityK * (one + two)) / 16.0));
    }));
    CHECK(rc::check("in [0, 1] and growing with density and length", [&] {
        const float a = between(0.0f, 1.0f), more = between(a, 1.0f), length = between(0.01f, 8.0f), longer = between(1.0f, 4.0f);
        const float opacity = stepOpacity(a, length, settings);
        RC_ASSERT(opacity >= 0.0f && opacity <= 1.0f);
        RC_ASSERT(stepOpacity(more, length, settings) >= opacity - 4.0f * kStepOpacityMaxError);
        RC_ASSERT(stepOpacity(a, length * longer, settings) >= opacity - 4.0f * kStepOpacityMaxError);
    }));
    CHECK(rc::check("transmittance is 1 in clear air, falls, and stays within [0, 1]", [&] {
        ConeSettings s = settings;
        s.march.transmittance = *rc::gen::element(TransmittanceModel::linear, TransmittanceModel::exponential);
        const float depth = between(0.0f, 8.0f), more = between(0.0f, 8.0f), t = transmittanceOf(depth, s);
        RC_ASSERT(transmittanceOf(0.0f, s) == 1.0f);
        RC_ASSERT(t >= 0.0f && t <= 1.0f);
        RC_ASSERT(transmittanceOf(depth + more, s) <= t + kTransmittanceMaxError);
    }));
}
