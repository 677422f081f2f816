#include "conetrace/frame/cones.h"

#include "catch.h"

#include <cmath>
#include <set>

using namespace lrsm;

namespace {

constexpr double kPiD = 3.14159265358979323846;

ConeSettings settingsFor(Estimator estimator, int count, Rotation rotation)
{
    ConeSettings settings;
    settings.estimator = estimator;
    settings.count = count;
    settings.rotation = rotation;
    settings.apertureScale = 1.0f;
    return settings;
}

}  // namespace

TEST_CASE("cones: six of the paper: 60 degrees wide, one about the normal, five at 60 degrees, 1/4 and 3/20", "[conetrace][cones]")
{
    const ConeSet set = makeConeSet(settingsFor(Estimator::paper, 6, Rotation::none));
    REQUIRE(set.rings.size() == 2);
    CHECK(set.rings[0].weight == Approx(0.25).epsilon(1e-6));
    CHECK(set.rings[1].weight == Approx(0.15).epsilon(1e-6));
    for (const ConeRing& ring : set.rings) CHECK(ring.tanHalf == Approx(std::tan(kPiD / 6)).epsilon(1e-6));
    CHECK(set.directions[0] == Vec3(0, 0, 1));
    for (int k = 0; k < 5; ++k) {
        const Vec3 d = set.directions[std::size_t(1 + k)];
        CHECK(d.x == Approx(std::sin(kPiD / 3) * std::cos(2 * kPiD * k / 5)).margin(1e-6));
        CHECK(d.y == Approx(std::sin(kPiD / 3) * std::sin(2 * kPiD * k / 5)).margin(1e-6));
        CHECK(d.z == Approx(0.5).margin(1e-6));
    }
}

TEST_CASE("cones: for every count the weights sum to 1 and the rings cover the hemisphere once", "[conetrace][cones]")
{
    for (int count = 1; count <= 256; ++count) {
        for (const Estimator estimator : {Estimator::paper, Estimator::slab}) {
            const ConeSet set = makeConeSet(settingsFor(estimator, count, Rotation::strata));
            CAPTURE(count);
            int total = 0;
            double weight = 0, angle = 0;
            for (const ConeRing& ring : set.rings) {
                REQUIRE(ring.count > 0);
                REQUIRE(ring.first == total);
                REQUIRE(double(ring.innerAngle) == Approx(angle).margin(1e-6));
                REQUIRE(ring.tanHalf > 0.0f);
                angle = double(ring.outerAngle);
                total += ring.count;
                weight += ring.count * double(ring.weight);
                // The exact integral of the cosine over the ring.
                const double a = std::sin(double(ring.innerAngle)), b = std::sin(double(ring.outerAngle));
                REQUIRE(ring.count * double(ring.weight) == Approx(b * b - a * a).margin(1e-5));
            }
            REQUIRE(total == count);
            REQUIRE(weight == Approx(1).epsilon(1e-5));
            REQUIRE(angle == Approx(kPiD / 2).epsilon(1e-6));
        }
    }
}

TEST_CASE("cones: strata keep every direction in its own cone's share, and the 16 rotations fill it evenly", "[conetrace][cones]")
{
    const int count = GENERATE(1, 4, 6, 9, 16, 32);
    const ConeSet set = makeConeSet(settingsFor(Estimator::slab, count, Rotation::strata));
    double cosine = 0, cosine2 = 0, sideways = 0;
    for (int rotation = 0; rotation < kRotations; ++rotation) {
        for (const ConeRing& ring : set.rings) {
            for (int k = 0; k < ring.count; ++k) {
                const Vec3 d = set.rotation(rotation)[std::size_t(ring.first + k)];
                REQUIRE(glm::length(d) == Approx(1).epsilon(1e-6));
                const double polar = std::acos(std::min(1.0, double(d.z)));
                REQUIRE(polar >= double(ring.innerAngle) - 1e-4);
                REQUIRE(polar <= double(ring.outerAngle) + 1e-4);
                const double azimuth = std::fmod(std::atan2(double(d.y), double(d.x)) + 2 * kPiD, 2 * kPiD) * ring.count / (2 * kPiD);
                REQUIRE(static_cast<int>(azimuth) % ring.count == k);
                cosine += double(d.z);
                cosine2 += double(d.z) * double(d.z);
                sideways += double(d.x);
            }
        }
    }
    // Cosine-weighted means: E[cos] = 2/3, E[cos^2] = 1/2, E[x] = 0.
    const double n = kRotations * count;
    CHECK(cosine / n == Approx(2.0 / 3.0).margin(0.004));
    CHECK(cosine2 / n == Approx(0.5).margin(0.004));
    CHECK(sideways / n == Approx(0).margin(0.02));
}

TEST_CASE("cones: every 4x4 block, wherever it starts, sees each rotation once", "[conetrace][cones]")
{
    for (int oy = 0; oy < 4; ++oy)
        for (int ox = 0; ox < 4; ++ox) {
            std::set<int> seen;
            for (int y = 0; y < 4; ++y)
                for (int x = 0; x < 4; ++x) seen.insert(rotationOfPixel(ox + x, oy + y, Rotation::azimuth));
            CHECK(seen.size() == 16);
            CHECK(*seen.begin() == 0);
            CHECK(*seen.rbegin() == 15);
        }
    CHECK(rotationOfPixel(3, 2, Rotation::none) == 0);
}

TEST_CASE("cones: the specular aperture is 2 atan(alpha), or fixed", "[conetrace][cones]")
{
    ConeSettings settings;
    settings.specularAperture = SpecularAperture::roughness;
    for (const float roughness : {0.0f, 0.1f, 0.3f, 0.5f})
        CHECK(double(specularTanHalf(settings, roughness)) == Approx(std::tan(2 * std::atan(double(roughness * roughness)))).margin(1e-6));
    CHECK(double(specularTanHalf(settings, 1.0f)) == Approx(std::sqrt(3.0)));
    settings.specularAperture = SpecularAperture::fixed;
    settings.specularApertureDegrees = 10.0f;
    CHECK(double(specularTanHalf(settings, 0.7f)) == Approx(std::tan(5 * kPiD / 180)));
}
