// Eq. 2 as an RSM texel holds it, Eq. 3, 4 and 7 by direct sums, against closed forms; and how far Eq. 12 is from Eq. 7.
#include "core/scene/light.h"
#include "core/scene/shapes.h"
#include "lrsm/gaussian_visibility.h"
#include "lrsm/rsm.h"

#include "apps/validate/equations/check_run.h"
#include "apps/validate/equations/closed_forms.h"
#include "apps/validate/equations/exact_sums.h"
#include "apps/validate/equations/oracle.h"

namespace lrsm {
namespace {

using DVec3 = glm::dvec3;

void checkReflected(CheckRun& run)
{
    const SearchSpace<float, 3> space{{{{1e-3f, 1.0f, Spacing::logarithmic}, {1e-6f, 1e6f, Spacing::logarithmic}, {1e-4f, 1.0f, Spacing::logarithmic}}},
                                      {{1.0f, 1.0f, 1.0f}}};
    const auto worst = findWorst(
        space, run.budget(150000),
        [](const auto& in) {
            const long double exact = oracle::reflectedRadiance(in[0], in[1], in[2]);
            return static_cast<double>(std::abs(static_cast<long double>(reflectedRadiance(Vec3(in[0]), Vec3(in[1]), in[2]).y) / exact - 1.0L));
        },
        601);
    run.add({.equation = "2",
             .function = "reflectedRadiance",
             .oracle = "rho L_d <n.l> / pi in long double",
             .domain = "rho 1e-3 .. 1, L_d 1e-6 .. 1e6, <n.l> 1e-4 .. 1",
             .errorKind = "relative",
             .bound = {"kReflectedRadianceMaxError", double(kReflectedRadianceMaxError)},
             .nanoseconds = run.time(4096, [](std::size_t i) { return reflectedRadiance(Vec3(0.5f), Vec3(float(i)), 0.3f).x; })},
            worst, inputText<float, 3>({"rho", "L_d", "n.l"}, worst.input));
}

/// A whole RSM: the floor y = 0 under a spot light straight above it.
void checkFloor(CheckRun& run)
{
    constexpr double kHeight = 2.5, kInner = 0.3, kOuter = 0.6;
    const DVec3 rho(0.75, 0.5, 0.125), intensity(3.0, 20.0, 100.0);
    Scene scene;
    scene.materials.push_back(diffuseMaterial("floor", Vec3(rho), false));
    Mesh mesh;
    addQuad(mesh, {-5, 0, 5}, {5, 0, 5}, {5, 0, -5}, {-5, 0, -5});
    scene.meshes.push_back(mesh);
    updateBounds(scene);
    RsmSettings settings;
    settings.resolution = run.draws(1) > 0 ? 128 : 64;
    settings.storage = Storage::float32;
    const Rsm rsm = renderRsm(scene, spotLight({0, float(kHeight), 0}, {0, 0, 0}, Vec3(intensity), float(kInner), float(kOuter)), Requirements{}, settings);

    const int n = settings.resolution;
    const auto errorAt = [&](std::uint64_t i, bool depth) {
        const int x = static_cast<int>(i) % n, y = static_cast<int>(i) / n;
        const double tx = (2.0 * (x + 0.5) / n - 1.0) * std::tan(kOuter), ty = (2.0 * (y + 0.5) / n - 1.0) * std::tan(kOuter);
        const double cosine = 1.0 / std::sqrt(1.0 + tx * tx + ty * ty), r = kHeight / cosine;
        const RsmTexel& texel = rsm.texels.at(x, y);
        if (texel.coverage != 1.0f) return 1.0;
        if (depth)
            return std::max(std::abs(double(rsm.projection.depthNear) + double(rsm.depthLinear.at(x, y)) * double(rsm.projection.depthRange()) - r) / r,
                            std::abs(double(texel.nDotL) - cosine));
        const double ramp = std::clamp((cosine - std::cos(kOuter)) / (std::cos(kInner) - std::cos(kOuter)), 0.0, 1.0);
        double error = 0.0;
        for (int k = 0; k < 3; ++k)
            error = std::max(error, std::abs(double(texel.radiance[k]) / (rho[k] * intensity[k] / (kHeight * kHeight)) * double(oracle::kPi) -
                                             cosine * cosine * cosine * ramp * ramp));
        return error;
    };
    const auto texels = static_cast<std::uint64_t>(n) * static_cast<std::uint64_t>(n);
    const auto add = [&](const char* function, const char* kind, const NamedBound& bound, bool depth) {
        const auto worst = exhaust(texels, [&](std::uint64_t i) { return errorAt(i, depth); });
        const int at = static_cast<int>(worst.input[0]);
        run.add({.equation = "2",
                 .function = function,
                 .oracle = "closed form in double",
                 .domain = "every texel of a floor 2.5 m under a spot of 0.6 rad",
                 .errorKind = kind,
                 .bound = bound},
                worst, "texel " + std::to_string(at % n) + ", " + std::to_string(at / n));
    };
    add("renderRsm, radiance", "relative to the radiance below the light", {"kRsmRadianceMaxError", double(kRsmRadianceMaxError)}, false);
    add("renderRsm, depth and <n.l>", "relative depth, absolute <n.l>", {"kRsmDepthMaxError", double(kRsmDepthMaxError)}, true);
}

/// A square perspective map of the floor y = 0 from a light at height 2, looking down: texels, and what they cover of the floor.
std::vector<TexelSample> floorTexels(int n, double halfWidth, const DVec3& radiance)
{
    std::vector<TexelSample> texels;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const double a = 2.0 * (x + 0.5) / n - 1.0, b = 2.0 * (y + 0.5) / n - 1.0;
            TexelSample t;
            t.position = DVec3(2.0 * a * halfWidth, 0.0, 2.0 * b * halfWidth);
            t.toLight = glm::normalize(DVec3(0.0, 2.0, 0.0) - t.position);
            t.radiance = radiance;
            t.solidAngle = texelSolidAngle(a, b, halfWidth, n);
            texels.push_back(t);
        }
    return texels;
}

void checkSums(CheckRun& run)
{
    const int n = 256;
    // Eq. 4's Jacobian: r^2 d omega <n.v> / <n.l> with v = n adds up to the floor's area, d omega to the map's solid angle.
    const auto area = exhaust(8, [&](std::uint64_t i) {
        const double halfWidth = 0.1 * (1.0 + double(i)), edge = 4.0 * halfWidth;
        double sum = 0.0, angle = 0.0;
        for (const TexelSample& t : floorTexels(n, halfWidth, DVec3(1.0))) {
            const DVec3 toLight = DVec3(0.0, 2.0, 0.0) - t.position;
            sum += glm::dot(toLight, toLight) * t.solidAngle * weightEq4(t, DVec3(0.0, 1.0, 0.0), true);
            angle += t.solidAngle;
        }
        // A square pyramid of half-angle a: 4 asin(sin^2 a).
        const double sine = std::sin(std::atan(halfWidth));
        return std::max(std::abs(sum / (edge * edge) - 1.0), std::abs(angle / (4.0 * std::asin(sine * sine)) - 1.0));
    });
    run.add({.equation = "4",
             .function = "weightEq4, texelSolidAngle",
             .oracle = "area of the floor, solid angle of a pyramid",
             .domain = "maps of 256^2, half field of view 6 .. 39 degrees",
             .errorKind = "relative",
             .bound = {"kTexelSumMaxError", kTexelSumMaxError}},
            area, "halfWidth = 0.1 x (1 + " + exactText(area.input[0]) + ")");

    // Eq. 3 where every texel has the same radiance and lies inside: that radiance, for any v; and with an empty footprint: 0.
    SearchRandom random(611);
    const auto texels = floorTexels(64, 0.5, DVec3(3.0, 2.0, 1.0));
    const auto constant = exhaust(200, [&](std::uint64_t) {
        const DVec3 v = glm::normalize(DVec3(random.uniform(-1, 1), random.uniform(0.05f, 1), random.uniform(-1, 1)));
        return std::abs(radianceEq3(texels, DVec3(0.0), 3.0, v).x - 3.0) + glm::length(radianceEq3(texels, DVec3(0.0, 9.0, 0.0), 1.0, v));
    });
    run.add({.equation = "3",
             .function = "radianceEq3, constant radiance",
             .oracle = "that radiance; 0 outside the sample",
             .domain = "any v above the floor",
             .bound = {"kDirectSumMaxError", kDirectSumMaxError}},
            constant, "draw " + exactText(constant.input[0]));

    // Eq. 3 over two planes: w' weighs each by <n.v> / <n.l>. Light and solid angles equal, normals at angles a and b to the light, v at c.
    const auto wedge = exhaust(500, [&](std::uint64_t) {
        const double a = random.uniform(-1.4f, 1.4f), b = random.uniform(-1.4f, 1.4f), c = random.uniform(-1.5f, 1.5f);
        const auto facing = [](double angle) { return DVec3(std::sin(angle), std::cos(angle), 0.0); };
        const std::array<TexelSample, 3> three = {TexelSample{DVec3(0.0), facing(a), DVec3(0, 1, 0), DVec3(2.0), 0.25},
                                                  TexelSample{DVec3(0.0), facing(b), DVec3(0, 1, 0), DVec3(5.0), 0.5},
                                                  TexelSample{DVec3(9.0), facing(0.0), DVec3(0, 1, 0), DVec3(7.0), 0.125}};
        const double wa = 0.25 * std::max(0.0, std::cos(a - c)) / std::cos(a), wb = 0.5 * std::max(0.0, std::cos(b - c)) / std::cos(b),
                     outside = 0.125 * std::cos(c);
        return std::abs(radianceEq3(three, DVec3(0.0), 1.0, facing(c)).x - (2.0 * wa + 5.0 * wb) / (wa + wb + outside)) +
               std::abs(visibilityEq7(three, DVec3(0.0), 1.0) - 0.75 / 0.875);
    });
    run.add({.equation = "3",
             .function = "radianceEq3, two planes and a texel outside",
             .oracle = "closed form",
             .domain = "normals within 80 degrees of the light, any v",
             .bound = {"kThreeTexelSumMaxError", kThreeTexelSumMaxError}},
            wedge, "draw " + exactText(wedge.input[0]));

    // Eq. 7: a disc in a square of texels that face a parallel light.
    const auto disc = exhaust(40, [&](std::uint64_t i) {
        const double radius = 0.05 + 0.011 * double(i);
        std::vector<TexelSample> square;
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x)
                square.push_back({DVec3((x + 0.5) / n - 0.5, 0.0, (y + 0.5) / n - 0.5), DVec3(0, 1, 0), DVec3(0, 1, 0), DVec3(1.0), 1.0});
        return std::abs(visibilityEq7(square, DVec3(0.0), radius) - static_cast<double>(oracle::kPi) * radius * radius);
    });
    run.add({.equation = "7",
             .function = "visibilityEq7",
             .oracle = "area of the disc",
             .domain = "256^2 texels, radii 0.05 .. 0.48 of the map",
             .bound = {"kCountedDiscMaxError", kCountedDiscMaxError}},
            disc, "i = " + exactText(disc.input[0]));
}

/// Eq. 12 in place of Eq. 7. Depths of one footprint have mean 0 and a spread of 1; the window is any.
void checkGaussianModel(CheckRun& run)
{
    const SearchSpace<double, 2> windows{{{{-3.0, 3.0}, {0.0, 4.0}}}, {{0.0, 1.0}, {0.0, 0.5}, {1.0, 1.0}}};
    const auto slopeError = [](double zc, double rc) {
        const double exact = std::max(0.0, std::min(zc + rc, 1.0) - std::max(zc - rc, -1.0)) / 2.0;  // uniform on [-1, 1]
        return gaussianVisibilityExact(0.0, 1.0 / 3.0, zc, rc) - exact;
    };
    const auto edgeError = [](double zc, double rc) {
        const double exact = (std::abs(-1.0 - zc) <= rc ? 0.5 : 0.0) + (std::abs(1.0 - zc) <= rc ? 0.5 : 0.0);  // half at -1, half at 1
        return gaussianVisibilityExact(0.0, 1.0, zc, rc) - exact;
    };
    const auto slope = findWorst(
        windows, run.budget(30000), [&](const auto& in) { return std::abs(slopeError(in[0], in[1])); }, 621);
    run.add({.equation = "12",
             .function = "Eq. 12 for Eq. 7, a sloped plane",
             .oracle = "uniform depths, closed form",
             .domain = "any window",
             .errorKind = "absolute, of the model",
             .bound = {"kGaussianForSlopeMaxError", kGaussianForSlopeMaxError}},
            slope, inputText<double, 2>({"zc / half range", "rc / half range"}, slope.input));
    const auto edge = findWorst(
        windows, run.budget(30000), [&](const auto& in) { return std::abs(edgeError(in[0], in[1])); }, 622);
    run.add({.equation = "12",
             .function = "Eq. 12 for Eq. 7, two depths in one footprint",
             .oracle = "two halves, closed form",
             .domain = "any window",
             .errorKind = "absolute, of the model",
             .bound = {"kGaussianForEdgeMaxError", kGaussianForEdgeMaxError}},
            edge, inputText<double, 2>({"zc / half gap", "rc / half gap"}, edge.input));

    ChartSeries onSlope{.label = "sloped plane"}, onEdge{.label = "two depths"};
    for (int i = 0; i <= 200; ++i) {
        const double rc = 0.0125 * i;
        onSlope.x.push_back(rc), onSlope.y.push_back(slopeError(0.0, rc));
        onEdge.x.push_back(rc), onEdge.y.push_back(edgeError(0.0, rc));
    }
    run.add({"12",
             {.title = "Eq. 12 in place of Eq. 7: V minus the exact fraction, window about the mean",
              .xLabel = "r_c over half the depth range",
              .yLabel = "error of V",
              .series = {onSlope, onEdge}}});
}

}  // namespace

void checkDirectSums(CheckRun& run)
{
    checkReflected(run);
    checkFloor(run);
    checkSums(run);
    checkGaussianModel(run);
}

}  // namespace lrsm
