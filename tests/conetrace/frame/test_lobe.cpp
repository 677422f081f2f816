#include "conetrace/frame/lobe.h"

#include "conetrace/frame/cones.h"
#include "conetrace/frame/irradiance_filter.h"
#include "core/scene/brdf.h"
#include "tests/conetrace/frame/flat_plane.h"

#include "catch.h"

using namespace lrsm;

namespace {

ConeSettings sampling()
{
    ConeSettings settings;
    settings.specular.direction = SpecularDirection::lobe;
    settings.set.rotation = Rotation::strata;
    return settings;
}

constexpr double kMeanDirectionError = 0.045;  ///< of sixteen points: .040 at most, at a slant of 73 degrees

/// Reflected light of F0 = 1, and its mean direction, by a fine grid over the hemisphere: brute force with the lobe itself.
struct Reflected {
    glm::dvec3 direction{0.0};
    double albedo = 0.0;
};
Reflected integrate(const Vec3& toEye, float roughness)
{
    Surface surface;
    surface.normal = surface.geometricNormal = Vec3(0, 0, 1);
    surface.specularColor = Vec3(1.0f);
    surface.roughness = roughness;
    constexpr int kPolar = 600, kAzimuth = 720;
    Reflected sum;
    for (int i = 0; i < kPolar; ++i)
        for (int k = 0; k < kAzimuth; ++k) {
            const double z = (i + 0.5) / kPolar, r = std::sqrt(1.0 - z * z), phi = 2.0 * 3.14159265358979323846 * (k + 0.5) / kAzimuth;
            const glm::dvec3 l(r * std::cos(phi), r * std::sin(phi), z);
            const double reflected = double(evaluateSpecular(surface, Vec3(l), toEye).x) * 2.0 * 3.14159265358979323846 / (kPolar * kAzimuth);
            sum.albedo += reflected;
            sum.direction += reflected * l;
        }
    sum.direction /= sum.albedo;
    return sum;
}

}  // namespace

TEST_CASE("lobe: sixteen points stand for the lobe: its albedo and its mean direction", "[conetrace][lobe]")
{
    const SpecularLobes lobes(sampling());
    for (const float roughness : {0.25f, 0.4f, 0.6f})
        for (const float cosine : {1.0f, 0.7f, 0.3f}) {
            const Vec3 toEye(std::sqrt(1.0f - cosine * cosine), 0.0f, cosine);
            glm::dvec3 direction(0.0);
            double weight = 0.0;
            for (int rotation = 0; rotation < kRotations; ++rotation) {
                const LobeDirection lobe = lobes.direction(Vec3(0, 0, 1), toEye, roughness, rotation);
                CHECK(double(glm::length(lobe.direction)) == Approx(1.0).epsilon(1e-6));
                if (lobe.direction.z <= 0.0f) CHECK(lobe.weight == 0.0f);
                direction += double(lobe.weight) * glm::dvec3(lobe.direction);
                weight += double(lobe.weight);
            }
            const Reflected exact = integrate(toEye, roughness);
            CAPTURE(roughness, cosine, direction.x / weight, direction.z / weight, exact.direction.x, exact.direction.z);
            CHECK(weight / kRotations == Approx(exact.albedo).epsilon(0.02));
            CHECK(glm::length(direction / weight - exact.direction) < kMeanDirectionError);
        }
}

TEST_CASE("lobe: a smooth surface, a set that does not turn, and the paper's cone look where a mirror does", "[conetrace][lobe]")
{
    const Vec3 normal(0, 0, 1), toEye = glm::normalize(Vec3(1, 2, 3)), mirror(-toEye.x, -toEye.y, toEye.z);
    const auto looksAtMirror = [&](const ConeSettings& settings, float roughness) {
        const LobeDirection lobe = SpecularLobes(settings).direction(normal, toEye, roughness, 5);
        return lobe.weight == 1.0f && glm::length(lobe.direction - mirror) < 1e-6f;
    };
    ConeSettings settings = sampling();
    CHECK(looksAtMirror(settings, 0.19f));
    CHECK_FALSE(looksAtMirror(settings, 0.21f));
    settings.set.rotation = Rotation::none;
    CHECK(looksAtMirror(settings, 0.5f));
    settings = sampling();
    settings.specular.direction = SpecularDirection::mirror;
    CHECK(looksAtMirror(settings, 0.5f));
}

TEST_CASE("lobe: the filter is a weighted mean over wide lobes alone", "[conetrace][lobe][filter]")
{
    constexpr int kWidth = 12, kHeight = 9, kNarrowFrom = 6;
    GBuffer g = flatPlane(kWidth, kHeight);
    g.roughness = Image<float>(kWidth, kHeight, 0.4f);
    Image<Vec3> specular(kWidth, kHeight);
    Image<float> weight(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const bool narrow = x >= kNarrowFrom, blind = (x + y) % 3 == 0;
            if (narrow) g.roughness.at(x, y) = 0.1f;
            weight.at(x, y) = blind && !narrow ? 0.0f : 0.5f + 0.1f * float(x);
            specular.at(x, y) = narrow ? Vec3(float(y), 1.0f, 2.0f) : blind ? Vec3(100.0f) : Vec3(3.0f);
        }
    const Image<Vec3> out = filterSpecular(specular, weight, g, kHeight);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            if (x >= kNarrowFrom)
                CHECK(out.at(x, y) == specular.at(x, y));
            else
                CHECK(out.at(x, y).x == Approx(3.0f).epsilon(1e-6));
        }

    // Two pixels of a strip: the mean is that of L by weight.
    GBuffer strip = flatPlane(2, 1);
    strip.roughness = Image<float>(2, 1, 0.4f);
    Image<Vec3> pair(2, 1);
    Image<float> counts(2, 1);
    pair.at(0, 0) = Vec3(1.0f), pair.at(1, 0) = Vec3(5.0f);
    counts.at(0, 0) = 3.0f, counts.at(1, 0) = 1.0f;
    CHECK(filterSpecular(pair, counts, strip, 1).at(0, 0).x == Approx(2.0f));
}
