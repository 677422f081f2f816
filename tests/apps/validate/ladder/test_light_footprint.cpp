#include "apps/validate/equations/synthetic_maps.h"
#include "apps/validate/ladder/light_footprint.h"
#include "catch.h"

#include <cmath>

using namespace lrsm;
using glm::dvec3;

namespace {

constexpr double kRootHalf = 0.70710678118654752;

/// Straight down on the square [-2, 2]^2 of the xz plane; depth 0 at y = 2, 1 at y = -2: metres = 4 depth.
LightProjection sunAbove(int resolution)
{
    LightProjection p = sunOverCube(resolution);
    p.halfWidth = 2.0f;
    return p;
}

/// A spot straight above a floor 2 m below it, 90 degrees wide: depth is distance.
Rsm spotMap(int resolution, const std::function<float(int i)>& radiance)
{
    LightProjection p = sunAbove(resolution);
    p.type = LightType::spot;
    p.halfWidth = 1.0f;
    return syntheticMap(p, [&](int i, int j) {
        const double x = (2.0 * i + 1.0) / resolution - 1.0, z = (2.0 * j + 1.0) / resolution - 1.0, length = std::sqrt(1.0 + x * x + z * z);
        return MapTexel{
            .depth = static_cast<float>(2.0 * length / 4.0), .radiance = Vec3(radiance(i)), .normal = Vec3(0, 1, 0), .nDotL = static_cast<float>(1.0 / length)};
    });
}

/// A map of the surface y = height(x, z) of unit normal n.
template <class Height>
Rsm surfaceMap(int resolution, Height height, const Vec3& n, const Vec3& radiance = Vec3(1.0f))
{
    return syntheticMap(sunAbove(resolution), [&](int i, int j) {
        const double x = 4.0 * (i + 0.5) / resolution - 2.0, z = 4.0 * (j + 0.5) / resolution - 2.0;
        return MapTexel{.depth = static_cast<float>((2.0 - height(x, z)) / 4.0), .radiance = radiance, .normal = n, .nDotL = n.y};
    });
}

FootprintRadiance footprint(const Rsm& rsm, const CoveredSphere& sphere, const LayerSettings& layers = layersOf(1, 1), const TermSettings& terms = {})
{
    return footprintRadiance(rsm, LayerModel(rsm, layers), terms, sphere, nullptr);
}

}  // namespace

TEST_CASE("where every assumption holds, every rung gives L: a lit wall that faces light and receiver, sphere centred on it",
          "[ladder][eq3][eq5][eq12][eq14][eq15]")
{
    const Rsm rsm = surfaceMap(
        512, [](double, double) { return 0.0; }, Vec3(0, 1, 0), Vec3(2.0f, 1.0f, 0.5f));
    const double radius = GENERATE(0.0005, 0.01, 0.3, 1.2);
    const LayerSettings layers = GENERATE(layersOf(1, 1), layersOf(3, 2));
    CAPTURE(radius, layers.depthLayers);
    const CoveredSphere sphere{dvec3(0.11, 0.0, -0.07), radius, dvec3(0, 1, 0)};
    const FootprintRadiance at = footprint(rsm, sphere, layers);
    const dvec3 expected(2.0, 1.0, 0.5);
    for (const dvec3& rung : {at.eq3, at.eq5, at.eq12, at.eq14, at.eq15})
        for (int c = 0; c < 3; ++c) CHECK(rung[c] == Approx(expected[c]).epsilon(1e-9));
    CHECK(at.slope == Approx(1.0));
    CHECK(at.layers == 1);
    CHECK(at.insideShare == Approx(1.0));

    if (radius > 0.5) return;  // the trilinear lookup would reach beyond the map
    ConeSettings cones;
    cones.gather.layerSelection = LayerSelection::centre;
    cones.gather.backface = Backface::cosine;
    const Lrsm lrsm = buildLrsm(rsm, layers);
    const ConeSample sample{Vec3(sphere.centre), static_cast<float>(radius), Vec3(0, 1, 0)};
    CHECK(twin::algorithm1(lrsm, twin::project(lrsm.projection, sphere.centre), sample, cones, 0.0).radiance.x == Approx(2.0).epsilon(1e-6));
    // Table 1's variance floor (warped) is wider than a sphere of half a millimetre in a depth range of 2^-16 of the light's.
    CHECK(double(sampleLrsm(lrsm, sample, cones, NormalCdf(GaussianMethod::exact)).x) == Approx(2.0).epsilon(1e-4));
}

TEST_CASE("Eq. 3: a sphere h above a lit plane sees the part of its shadow that the plane's disk fills, Eq. 12 steps", "[ladder][eq3][eq12]")
{
    const double radius = 0.8, h = GENERATE(0.2, 0.4, 0.7);
    const Rsm rsm = surfaceMap(
        1024, [](double, double) { return 0.0; }, Vec3(0, 1, 0));
    const FootprintRadiance at = footprint(rsm, {dvec3(0.0, h, 0.0), radius, dvec3(0, 1, 0)});
    const double disk = 1.0 - h * h / (radius * radius);
    CHECK(at.eq3.x == Approx(disk).margin(2e-3));  // 400 texels across
    CHECK(at.eq5.x == Approx(disk).margin(2e-3));
    CHECK(at.eq12.x == Approx(1.0));  // variance 0, |h| < r
}

TEST_CASE("Eq. 4: the Jacobian 1 / <n.l> gives slanted surface its area, the guess n = l weighs the rest", "[ladder][eq3]")
{
    const double tan = GENERATE(0.5, 1.0, 2.0), cosine = 1.0 / std::sqrt(1.0 + tan * tan);
    const Vec3 n(static_cast<float>(-tan * cosine), static_cast<float>(cosine), 0.0f);
    const Rsm rsm = surfaceMap(
        1024, [tan](double x, double) { return tan * x; }, n);
    const CoveredSphere fromLight{dvec3(0.0), 0.5, dvec3(0, 1, 0)}, fromNormal{dvec3(0.0), 0.5, dvec3(n)};
    // The sphere's disk of the plane covers `cosine` of its shadow.
    CHECK(footprint(rsm, fromLight).eq3.x == Approx(cosine).margin(3e-3));
    CHECK(footprint(rsm, fromNormal).eq3.x == Approx(1.0 / (1.0 + cosine * (1.0 - cosine))).margin(3e-3));
    CHECK(footprint(rsm, fromNormal).slope == Approx(cosine).epsilon(1e-6));
    // Eq. 5 has N = <n.v> and V by counting.
    CHECK(footprint(rsm, fromLight).eq5.x == Approx(cosine * cosine).margin(3e-3));
    CHECK(footprint(rsm, fromNormal).eq5.x == Approx(cosine).margin(3e-3));
}

TEST_CASE("Eq. 12 errs by up to 0.11 on a slope (depths evenly spread) and by 0.68 where two planes share a footprint", "[ladder][eq12]")
{
    // Depths even over [-1, 1]: V is r, the Gaussian says erf(r sqrt(3 / 2)).
    double worst = 0.0;
    for (int i = 1; i <= 1000; ++i) {
        const double r = i / 1000.0, v = gaussianShare(0.0, 1.0 / 3.0, r);
        CHECK(v == Approx(std::erf(r * std::sqrt(1.5))).margin(1e-12));
        worst = std::max(worst, std::abs(v - r));
    }
    CHECK(worst == Approx(0.114).margin(0.001));

    // Two planes of equal area just out of the sphere's reach: nothing is inside, and the Gaussian's one sigma is.
    const double radius = 0.5, reach = radius * 1.001;
    const Rsm rsm = surfaceMap(
        512, [reach](double x, double) { return x < 0.0 ? reach : -reach; }, Vec3(0, 1, 0));
    const CoveredSphere sphere{dvec3(0.0), radius, dvec3(0, 1, 0)};
    const FootprintRadiance one = footprint(rsm, sphere);
    CHECK(one.eq5.x == 0.0);
    CHECK(one.eq12.x == Approx(std::erf(kRootHalf / 1.001)).margin(2e-3));
    CHECK(one.eq12.x == Approx(0.68).margin(0.005));

    // Two layers keep them apart: that is what layers are for.
    LayerSettings two = layersOf(2, 1);
    CHECK(footprint(rsm, sphere, two).eq14.x == 0.0);
    CHECK(footprint(rsm, sphere, two).eq12.x == Approx(one.eq12.x));
}

TEST_CASE("Eq. 15 loses the layers that do not hold z_c, unless every touched one is taken", "[ladder][eq15]")
{
    // Planes 0.1 above and below a sphere centred a little above the cut between their layers.
    const Rsm rsm = surfaceMap(
        256, [](double x, double) { return x < 0.0 ? 0.1 : -0.1; }, Vec3(0, 1, 0));
    const CoveredSphere sphere{dvec3(0.0, 0.01, 0.0), 0.5, dvec3(0, 1, 0)};
    LayerSettings two = layersOf(2, 1);
    const FootprintRadiance centre = footprint(rsm, sphere, two);
    CHECK(centre.eq14.x == Approx(1.0).margin(1e-3));
    CHECK(centre.eq15.x == Approx(0.5).margin(1e-2));
    CHECK(centre.layers == 1);
    TermSettings touched;
    touched.selection = LayerSelection::touched;
    CHECK(footprint(rsm, sphere, two, touched).eq15.x == Approx(1.0).margin(1e-3));

    // Overlap: z_c in the middle of the overlap of both, each fades to k(1/2) = 1/2, and both hold both planes only if the planes lie in the overlap.
    two.overlap = 0.5f;
    const FootprintRadiance faded = footprint(rsm, {dvec3(0.0), 0.5, dvec3(0, 1, 0)}, two);
    CHECK(faded.eq15.x == Approx(0.5).margin(1e-2));
    CHECK(faded.layers == 2);
}

TEST_CASE("missing texels: unlit in Eq. 3, no light but no share of V and N from Eq. 5 on, beside the map as well", "[ladder][eq3][eq5]")
{
    Rsm rsm = surfaceMap(
        512, [](double, double) { return 0.0; }, Vec3(0, 1, 0));
    for (int j = 0; j < 512; ++j)
        for (int i = 0; i < 256; ++i) rsm.texels.at(i, j) = {};
    const CoveredSphere half{dvec3(0.0), 0.6, dvec3(0, 1, 0)};
    const FootprintRadiance holes = footprint(rsm, half);
    for (const dvec3& rung : {holes.eq3, holes.eq5, holes.eq12, holes.eq14, holes.eq15}) CHECK(rung.x == Approx(0.5).margin(1e-3));

    const Rsm whole = surfaceMap(
        512, [](double, double) { return 0.0; }, Vec3(0, 1, 0));
    const FootprintRadiance border = footprint(whole, {dvec3(2.0, 0.0, 0.0), 0.6, dvec3(0, 1, 0)});
    for (const dvec3& rung : {border.eq3, border.eq5, border.eq12, border.eq14, border.eq15}) CHECK(rung.x == Approx(0.5).margin(1e-3));
    CHECK(footprint(whole, {dvec3(5.0, 0.0, 0.0), 0.6, dvec3(0, 1, 0)}).eq3.x == 0.0);
}

TEST_CASE("a point light's footprint: solid angles, distances, and spheres about the light itself", "[ladder][eq3][eq5]")
{
    const Rsm rsm = spotMap(512, [](int i) { return i < 256 ? 1.0f : 3.0f; });
    // Centred on the seam between the two halves: half of either. The sphere's disk of the floor is all but all of its shadow.
    const FootprintRadiance seam = footprint(rsm, {dvec3(0.0, 0.0, 0.3), 0.4, dvec3(0, 1, 0)});
    CHECK(seam.insideShare > 0.95);
    CHECK(seam.eq5.x == Approx(2.0 * seam.insideShare).margin(1e-3));
    CHECK(seam.eq3.x == Approx(2.0 * seam.insideShare).margin(0.05));

    // All map: the solid angle of x < 0 and of x > 0 are equal.
    const FootprintRadiance all = footprint(rsm, {dvec3(0.0, 2.0, 0.0), 10.0, dvec3(0, 1, 0)});
    CHECK(all.insideShare > 0.1);
    CHECK(all.eq5.x == Approx(2.0 * all.insideShare).epsilon(1e-2));
}

TEST_CASE("the texels in a beam: a lit plane through it emits L at any slant, part of it in part of the beam, the rest nothing", "[ladder][emission]")
{
    const double tan = GENERATE(0.0, 0.5, 2.0), cosine = 1.0 / std::sqrt(1.0 + tan * tan);
    const Vec3 n(static_cast<float>(-tan * cosine), static_cast<float>(cosine), 0.0f);
    const Rsm rsm = surfaceMap(
        1024, [tan](double x, double) { return tan * x; }, n, Vec3(2.0f, 1.0f, 0.5f));
    const dvec3 down(0.0, -1.0, 0.0), slanted = glm::normalize(dvec3(0.6, -1.0, 0.3));
    CHECK(beamEmission(rsm, {dvec3(0.0), down, 0.3, 3.0}).x == Approx(2.0).epsilon(0.01));
    CHECK(beamEmission(rsm, {dvec3(0.1, 0.1 * tan, 0.0), slanted, 0.2, 3.0}).z == Approx(0.5).epsilon(0.02));
    CHECK(beamEmission(rsm, {dvec3(0.0), -down, 0.3, 3.0}).x == 0.0);                                       // from behind
    CHECK(beamEmission(rsm, {dvec3(0.0, 3.0, 0.0), down, 0.3, 2.0}).x == 0.0);                              // clear air
    CHECK(beamEmission(rsm, {dvec3(2.0, 2.0 * tan, 0.0), down, 0.3, 3.0}).x == Approx(1.0).epsilon(0.02));  // half of it beside the map
    if (tan > 0.0)  // the segment ends at the beam's middle: half of the plane is before it
        CHECK(beamEmission(rsm, {dvec3(0.0, 0.75, 0.0), down, 0.3, 1.5}).x == Approx(1.0).epsilon(0.02));

    const Rsm spot = spotMap(512, [](int) { return 1.0f; });
    CHECK(beamEmission(spot, {dvec3(0.7, 0.0, -0.5), slanted, 0.25, 2.0}).x == Approx(1.0).epsilon(0.02));
}
