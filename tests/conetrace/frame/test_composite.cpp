#include "conetrace/frame/composite.h"
#include "conetrace/frame/specular_albedo.h"
#include "core/scene/brdf.h"
#include "core/scene/shapes.h"

#include "catch.h"

#include <cmath>

using namespace lrsm;

namespace {

constexpr double kPiDouble = 3.14159265358979323846;

/// The white furnace by brute force: integral of f_s <n.l> over the hemisphere, in double, in polar coordinates about the mirror direction,
/// the polar angle cubed so that narrow lobes get points enough. Shares nothing with the kernel but the lobe itself.
double directionalAlbedo(float specular, double nDotV, float roughness)
{
    Surface surface;
    surface.normal = surface.geometricNormal = Vec3(0, 0, 1);
    surface.specularColor = Vec3(specular);
    surface.roughness = roughness;
    const double sinV = std::sqrt(1 - nDotV * nDotV);
    const Vec3 v(float(sinV), 0, float(nDotV));
    const glm::dvec3 mirror(-sinV, 0, nDotV), side(0, 1, 0), up = glm::cross(mirror, side);
    constexpr int kPolar = 256, kAzimuth = 192;
    double sum = 0;
    for (int i = 0; i < kPolar; ++i) {
        const double s = (i + 0.5) / kPolar, angle = kPiDouble * s * s * s, dAngle = kPiDouble * 3 * s * s / kPolar;
        for (int k = 0; k < kAzimuth; ++k) {
            const double azimuth = 2 * kPiDouble * (k + 0.5) / kAzimuth;
            const glm::dvec3 l = std::cos(angle) * mirror + std::sin(angle) * (std::cos(azimuth) * side + std::sin(azimuth) * up);
            if (l.z > 0) sum += double(evaluateSpecular(surface, Vec3(l), v).x) * std::sin(angle) * dAngle * (2 * kPiDouble / kAzimuth);
        }
    }
    return sum;
}

}  // namespace

TEST_CASE("white furnace: scale and bias are the lobe's directional albedo, on and between the table's nodes", "[conetrace][composite][furnace]")
{
    const SpecularAlbedo lobe;
    for (const float roughness : {0.2f, 4.0f / 15.0f, 0.3f, 0.5f, 0.77f, 1.0f})
        for (const float nDotV : {0.05f, 0.13f, 0.3f, 0.5f, 0.7f, 0.95f, 1.0f})
            for (const float specular : {1.0f, 0.5f, 0.04f}) {
                CAPTURE(roughness, nDotV, specular);
                const double exact = directionalAlbedo(specular, double(nDotV), roughness);
                const double got = double(lobe(Vec3(specular), nDotV, roughness).x);
                REQUIRE(got == Approx(exact).epsilon(double(kSpecularAlbedoMaxError)));
                REQUIRE(got <= 1.0);  // a furnace reflects no more than it holds
            }
}

TEST_CASE("specular albedo: linear in F0, a channel at a time, a smooth mirror reflects all but Fresnel's part", "[conetrace][composite]")
{
    const SpecularAlbedo lobe;
    const Vec3 mixed = lobe(Vec3(0.1f, 0.5f, 0.9f), 0.6f, 0.5f);
    for (int c = 0; c < 3; ++c) {
        const float f0 = 0.1f + 0.4f * float(c);
        const Vec3 alone = lobe(Vec3(f0), 0.6f, 0.5f);
        CHECK(double(mixed[c]) == Approx(double(alone.x)).epsilon(1e-5));
    }
    CHECK(double(mixed.y) == Approx(0.5 * double(mixed.x + mixed.z)).epsilon(1e-5));
    for (const double cosine : {0.3, 0.6, 1.0}) {
        const double schlick = 0.04 + 0.96 * std::pow(1 - cosine, 5);
        CHECK(double(lobe(Vec3(0.04f), float(cosine), 0.0f).x) == Approx(schlick).epsilon(0.02));
    }
    CHECK(lobe(Vec3(1.0f), -0.5f, 2.0f) == lobe(Vec3(1.0f), 0.0f, 1.0f));  // out of range is the range's end
}

namespace {

/// Four pixels: a diffuse one, a glossy one seen at 60 degrees, one without a specular part, and an empty one.
GBuffer fourPixels()
{
    GBuffer g;
    g.width = 4;
    g.height = 1;
    g.position = Image<Vec3>(4, 1);
    g.normal = g.geometricNormal = Image<Vec3>(4, 1, Vec3(0, 0, 1));
    g.albedo = Image<Vec3>(4, 1, Vec3(0.25f, 0.5f, 1.0f));
    g.specularColor = Image<Vec3>(4, 1);
    g.roughness = Image<float>(4, 1, 0.5f);
    g.objectId = Image<std::uint32_t>(4, 1, 1u);
    g.specularColor.at(1, 0) = Vec3(0.04f, 0.5f, 1.0f);
    g.objectId.at(3, 0) = 0;
    return g;
}

}  // namespace

TEST_CASE("shading: albedo E / pi, and the lobe's albedo times the specular cone's radiance", "[conetrace][composite]")
{
    const GBuffer g = fourPixels();
    const Camera camera = lookAt(Vec3(std::sqrt(0.75f), 0, 0.5f), Vec3(0), Vec3(0, 1, 0), 1.0f);  // <n.v> = 1/2 at the origin
    const Vec3 irradiance(3.0f, 2.0f, 1.0f), radiance(2.0f, 4.0f, 8.0f);
    const IndirectLight light = shadeIndirect(g, camera, Image<Vec3>(4, 1, irradiance), Image<Vec3>(4, 1, radiance));
    for (int x = 0; x < 3; ++x)
        for (int c = 0; c < 3; ++c)
            CHECK(double(light.diffuse.at(x, 0)[c]) == Approx(double(g.albedo.at(x, 0)[c]) * double(irradiance[c]) / kPiDouble).epsilon(1e-6));
    for (int c = 0; c < 3; ++c) {
        const double albedo = directionalAlbedo(g.specularColor.at(1, 0)[c], 0.5, 0.5f);
        CHECK(double(light.specular.at(1, 0)[c]) == Approx(albedo * double(radiance[c])).epsilon(double(kSpecularAlbedoMaxError)));
    }
    CHECK(light.specular.at(0, 0) == Vec3(0.0f));
    CHECK(light.diffuse.at(3, 0) == Vec3(0.0f));
    CHECK(light.specular.at(3, 0) == Vec3(0.0f));

    // A scene without a specular part has no cone, and the same diffuse light.
    const IndirectLight plain = shadeIndirect(g, camera, Image<Vec3>(4, 1, irradiance), Image<Vec3>());
    CHECK(plain.diffuse.texels == light.diffuse.texels);
    CHECK(plain.specular.at(1, 0) == Vec3(0.0f));
}

TEST_CASE("composite: the sum of its three parts, pixel by pixel", "[conetrace][composite]")
{
    IndirectLight indirect{Image<Vec3>(3, 2), Image<Vec3>(3, 2)};
    Image<Vec3> direct(3, 2);
    for (std::size_t i = 0; i < 6; ++i) {
        direct.texels[i] = Vec3(1.0f, 2.0f, 4.0f) * float(i);
        indirect.diffuse.texels[i] = Vec3(16.0f, 0.5f, 0.25f);
        indirect.specular.texels[i] = Vec3(0.0f, 64.0f, float(i) * 128.0f);
    }
    const Image<Vec3> sum = composite(direct, indirect);
    for (std::size_t i = 0; i < 6; ++i) {
        const auto k = float(i);
        CHECK(sum.texels[i] == Vec3(k + 16.0f, 2 * k + 64.5f, 132 * k + 0.25f));  // exact: few bits each
    }
}
