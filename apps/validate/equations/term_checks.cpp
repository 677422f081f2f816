// The terms of Algorithm 1 one by one: Eq. 8, 10, 11, Sec. 5's level, and the way into the light's space.
#include "lrsm/sample.h"

#include "apps/validate/equations/algorithm1_twin.h"
#include "apps/validate/equations/check_run.h"
#include "apps/validate/equations/closed_forms.h"
#include "apps/validate/equations/equation_inputs.h"
#include "apps/validate/equations/synthetic_maps.h"

namespace lrsm {
namespace {

/// Eq. 8.
void checkNormalTerm(CheckRun& run)
{
    const auto worst = findWorst(
        normalTermSpace(), run.budget(150000),
        [](const auto& in) {
            const auto [texel, v] = normalTermOf(in);
            return static_cast<double>(std::abs(oracle::normalTerm(texel, v) - static_cast<long double>(normalTerm(texel, v))));
        },
        401);
    const auto [texel, v] = normalTermOf(worst.input);
    run.add({.equation = "8",
             .function = "normalTerm",
             .oracle = "dot product and division in long double",
             .domain = "mean normals of length <= 1, alpha 2^-16 .. 1, unit v_c",
             .bound = {"kNormalTermMaxError", double(kNormalTermMaxError)},
             .nanoseconds = run.time(4096, [t = texel](std::size_t i) { return normalTerm(t, Vec3(float(i), 1.0f, 0.5f)); })},
            worst,
            inputText<float, 7>({"alpha n.x", "alpha n.y", "alpha n.z", "alpha", "v.x", "v.y", "v.z"},
                                {texel.normal.x, texel.normal.y, texel.normal.z, texel.normalAlpha, v.x, v.y, v.z}));

    const auto weights = exhaust(2 * 200, [](std::uint64_t i) {
        const auto mode = static_cast<Backface>(i % 2);
        const float n = float(i / 2) / 199.0f;
        const double exact = mode == Backface::cosine ? double(n) : n > 0.0f ? 1.0 : 0.0;
        return double(backfaceWeight(n, mode)) == exact ? 0.0 : 1.0;
    });
    run.add(exactCheck("8", "backfaceWeight", "N, H(N)", "N in [0, 1], both modes"), weights, "case " + exactText(weights.input[0]));
}

/// Eq. 10 and 11, from the premultiplied sums as they are given; and the floor, from what UNORM16 leaves of a flat texel.
void checkMoments(CheckRun& run)
{
    const auto text = [](const std::array<float, 3>& in) {
        const FilteredTexel t = momentsOf(in);
        return inputText<float, 3>({"alpha z", "alpha z^2", "alpha"}, {t.depth, t.depthSquared, t.depthAlpha});
    };
    const auto mean = findWorst(
        momentSpace(), run.budget(100000),
        [&](const auto& in) {
            const FilteredTexel t = momentsOf(in);
            return std::abs(static_cast<double>(static_cast<long double>(depthMoments(t).mean) - oracle::depthMean(t)));
        },
        402);
    run.add({.equation = "10",
             .function = "depthMoments, mean",
             .oracle = "division in long double",
             .domain = "depths in [0, 1], alpha 2^-16 .. 1",
             .bound = {"kDepthMeanMaxError", double(kDepthMeanMaxError)},
             .nanoseconds = run.time(4096,
                                     [&](std::size_t i) {
                                         return depthMoments(momentsOf({1.0f, float(i) / 4096.0f, 0.5f})).variance;
                                     })},
            mean, text(mean.input));
    const auto variance = findWorst(
        momentSpace(), run.budget(150000),
        [&](const auto& in) {
            const FilteredTexel t = momentsOf(in);
            const long double exact = oracle::depthVariance(t);
            const DepthMoments raw = depthMoments(t, -kInfinity), floored = depthMoments(t);
            if (raw.negative != (raw.variance < 0.0f)) return 1.0;
            return std::max(std::abs(static_cast<double>(raw.variance - exact)),
                            std::abs(static_cast<double>(floored.variance - std::max(exact, oracle::kVarianceFloor))));
        },
        403);
    run.add({.equation = "11",
             .function = "depthMoments, variance",
             .oracle = "E[z^2] - E[z]^2 in long double, floored at 2.5e-5",
             .domain = "depths in [0, 1], alpha 2^-16 .. 1",
             .bound = {"kDepthVarianceMaxError", double(kDepthVarianceMaxError)}},
            variance, text(variance.input));

    // The floor: a flat texel's moments, each rounded to UNORM16, leave a variance of nothing but rounding.
    const SearchSpace<float, 1> flat{{{{0.0f, 1.0f}}}, {{1.0f}, {0.0f}}};
    const auto left = findWorst(
        flat, run.budget(300000),
        [](const auto& in) {
            ConversionCounts counts;
            FilteredTexel t;
            t.depth = roundToUnorm16(in[0], counts);
            t.depthSquared = roundToUnorm16(in[0] * in[0], counts);
            t.depthAlpha = 1.0f;
            return std::abs(double(depthMoments(t, -kInfinity).variance));
        },
        404);
    run.add({.equation = "11",
             .function = "kVarianceFloor covers what UNORM16 leaves of a flat texel",
             .oracle = "the true variance, 0",
             .domain = "z in [0, 1]",
             .bound = {"kVarianceFloor", double(kVarianceFloor)}},
            left, inputText<float, 1>({"z"}, left.input));
    Worst<float, 1> slack = left;
    slack.error = double(kVarianceFloor) / left.error;
    slack.sum = 0.0;
    run.add({.equation = "11",
             .function = "kVarianceFloor is no larger than that needs",
             .oracle = "the row above",
             .domain = "z in [0, 1]",
             .errorKind = "floor over need",
             .bound = {"kVarianceFloorSlack", kVarianceFloorSlack}},
            slack, inputText<float, 1>({"z"}, slack.input));
}

/// Sec. 5.
void checkLevel(CheckRun& run)
{
    const auto worst = findWorst(
        levelSpace(), run.budget(150000),
        [](const auto& in) {
            return std::abs(double(lrsmLevel(in[0], in[1], in[2], in[3])) - twin::level(double(in[0]), double(in[1]), double(in[2]), double(in[3])));
        },
        405);
    run.add({.equation = "sec5",
             .function = "lrsmLevel",
             .oracle = "log2 in double",
             .domain = "diameters 1 mm .. 1 km, texels 0.1 mm .. 100 m, bias +-4",
             .errorKind = "levels",
             .bound = {"kLrsmLevelMaxError", double(kLrsmLevelMaxError)},
             .nanoseconds = run.time(4096, [](std::size_t i) { return lrsmLevel(0.1f + float(i), 0.3f, 0.0f, 0.0f); })},
            worst, inputText<float, 4>({"diameter", "texel", "bias", "min"}, worst.input));
    const auto zero = exhaust(3, [](std::uint64_t i) { return lrsmLevel(0.0f, 0.1f, 0.0f, float(i)) == float(i) ? 0.0 : 1.0; });
    run.add(exactCheck("sec5", "lrsmLevel, diameter 0", "minLevel", "minLevel 0, 1, 2"), zero, "minLevel = " + exactText(zero.input[0]));
}

void checkProjection(CheckRun& run)
{
    for (const bool spot : {false, true}) {
        const LightProjection projection = spot ? spotOverCube(512) : sunOverCube(512);
        const SearchSpace<float, 3> space{{{{-2.0f, 2.0f}, {-2.0f, 2.0f}, {-2.0f, 2.0f}}}, {{0.0f, 0.0f, 0.0f}, {2.0f, 2.0f, 2.0f}, {-2.0f, -2.0f, -2.0f}}};
        const auto worst = findWorst(
            space, run.budget(80000),
            [&](const auto& in) {
                const LightSpacePoint p = projectToLight(projection, Vec3(in[0], in[1], in[2]));
                const twin::Projected exact = twin::project(projection, twin::DVec3(in[0], in[1], in[2]));
                if (p.valid != exact.valid) return 1.0;
                return std::max({std::abs(double(p.u) - exact.u), std::abs(double(p.v) - exact.v), std::abs(double(p.depth) - exact.depth),
                                 std::abs(double(p.texelSize) / exact.texelSize - 1.0)});
            },
            406);
        run.add(
            {.equation = "sec5",
             .function = std::string("projectToLight, ") + (spot ? "spot" : "directional"),
             .oracle = "double",
             .domain = "points of a 4 m cube, lit from 2 .. 4 m",
             .errorKind = "absolute, u v depth; relative, texel",
             .bound = {spot ? "kProjectionMaxError" : "kDirectionalProjectionMaxError", double(spot ? kProjectionMaxError : kDirectionalProjectionMaxError)},
             .nanoseconds = run.time(4096, [&](std::size_t i) { return projectToLight(projection, Vec3(float(i) * 1e-3f, 0.1f, 0.2f)).u; })},
            worst, inputText<float, 3>({"x", "y", "z"}, worst.input));
    }
}

/// Where the maps lie: the scene's box fits, one texel to spare, the centre on whole texels; depths span the box.
void checkFit(CheckRun& run)
{
    SearchRandom random(450);
    const auto worst = exhaust(run.draws(300), [&](std::uint64_t) {
        Aabb box;
        const float x = random.uniform(-5.0f, 5.0f), y = random.uniform(-5.0f, 5.0f), z = random.uniform(-5.0f, 5.0f);
        box.include(Vec3(x, y, z));
        box.include(Vec3(x, y, z) + Vec3(random.uniform(1.0f, 9.0f), random.uniform(1.0f, 9.0f), random.uniform(1.0f, 9.0f)));
        Light light;
        light.type = LightType::directional;
        light.direction = Vec3(0.0f, -1.0f, 0.0f);
        light.up = Vec3(0.0f, 0.0f, 1.0f);
        const int n = 64;
        const LightProjection sun = fitLightProjection(light, box, n);
        const double width = std::max(double(box.max.x) - double(box.min.x), double(box.max.z) - double(box.min.z)), texel = width / (n - 1);
        double error = std::abs(double(sun.halfWidth) / (0.5 * texel * n) - 1.0);
        const double middle[2] = {0.5 * (double(box.min.x) + double(box.max.x)), 0.5 * (double(box.min.z) + double(box.max.z))};
        const double at[2] = {double(sun.position.x), double(sun.position.z)};
        for (int k = 0; k < 2; ++k)
            error = std::max({error, std::abs(at[k] / texel - std::round(at[k] / texel)) * 0.1, std::abs(at[k] - middle[k]) > 0.501 * texel ? 1.0 : 0.0});
        error = std::max({error, std::abs(double(sun.position.y) - double(box.max.y)), std::abs(double(sun.depthNear)),
                          std::abs(double(sun.depthFar) - (double(box.max.y) - double(box.min.y)))});

        light.type = LightType::spot;
        light.position = box.max + Vec3(1.0f, 2.0f, 0.5f);
        light.outerConeAngle = random.uniform(0.2f, 1.2f);
        const LightProjection spot = fitLightProjection(light, box, n);
        const glm::dvec3 near = glm::dvec3(box.max) - glm::dvec3(light.position), far = glm::dvec3(box.min) - glm::dvec3(light.position);
        error = std::max({error, std::abs(double(spot.halfWidth) / std::tan(double(light.outerConeAngle)) - 1.0),
                          std::abs(double(spot.depthNear) / glm::length(near) - 1.0), std::abs(double(spot.depthFar) / glm::length(far) - 1.0)});
        light.type = LightType::cubeFace;
        return fitLightProjection(light, box, n).halfWidth == 1.0f ? error : 1.0;
    });
    run.add({.equation = "sec5",
             .function = "fitLightProjection",
             .oracle = "the box in double",
             .domain = "boxes of 1 .. 9 m, sun, spot, cube face",
             .errorKind = "relative; metres; tenth of a texel",
             .bound = {"kFitMaxError", double(kFitMaxError)}},
            worst, "draw " + exactText(worst.input[0]));
}

}  // namespace

void checkTerms(CheckRun& run)
{
    checkNormalTerm(run);
    checkMoments(run);
    checkLevel(run);
    checkProjection(run);
    checkFit(run);
}

}  // namespace lrsm
