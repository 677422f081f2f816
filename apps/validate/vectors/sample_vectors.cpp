// Algorithm 1 term by term: Eq. 5, 8 to 12, Sec. 5's level, and the way into the light's space.
#include "apps/validate/equations/algorithm1_twin.h"
#include "apps/validate/equations/closed_forms.h"
#include "apps/validate/equations/equation_inputs.h"
#include "apps/validate/equations/oracle.h"
#include "apps/validate/equations/synthetic_maps.h"
#include "apps/validate/vectors/make_vectors.h"
#include "apps/validate/vectors/set_parts.h"
#include "lrsm/sample.h"

namespace lrsm {
namespace {

void addProduct(std::vector<VectorSet>& sets)
{
    VectorSet& set =
        sets.emplace_back(VectorSet{.name = "product",
                                    .meaning = "Eq. 5: outgoing radiance of one layer",
                                    .inputs = {{"r", {}, "W/(m^2 sr)", "R of Eq. 6"}, {"v", {}, "", "V of Eq. 12"}, {"n", {}, "", "N of Eq. 8"}},
                                    .outputs = {outputOf("5", {"eq5.radiance", {}, "W/(m^2 sr)", "R V N"}, {"4 half ULPs", 4.0 * kHalfUlp}, "relative")},
                                    .kinds = {}});
    fillSet(
        set, SearchSpace<float, 3>{{{{1e-6f, 1e4f, Spacing::logarithmic}, {1e-4f, 1.0f}, {1e-4f, 1.0f}}}, {{1.0f, 0.0f, 1.0f}, {1.0f, 1.0f, 0.0f}}},
        [](const std::array<float, 3>& in) {
            const double exact = double(in[0]) * double(in[1]) * double(in[2]);
            return VectorCase{{{double(in[0])}, {double(in[1])}, {double(in[2])}}, {single(exact, 4.0 * kHalfUlp * exact, double(in[0] * (in[1] * in[2])))}};
        },
        1300);
}

void addTerms(std::vector<VectorSet>& sets)
{
    VectorSet& normal = sets.emplace_back(
        VectorSet{.name = "normal_term",
                  .meaning = "Eq. 8: N of a filtered texel, backface=cosine",
                  .inputs = {{"alpha_n", {3}, "", "filtered alpha n"},
                             {"alpha", {}, "", "filtered alpha beside it"},
                             {"v", {3}, "", "v_c, unit, from sample to receiver"}},
                  .outputs = {outputOf("8", {"eq8.normal_term", {}, "", "max(0, <alpha n . v> / alpha); the mean normal is not made unit again"},
                                       {"kNormalTermMaxError", double(kNormalTermMaxError)})},
                  .kinds = {}});
    fillSet(
        normal, normalTermSpace(),
        [](const std::array<float, 7>& in) {
            const auto [texel, v] = normalTermOf(in);
            return VectorCase{{wide(texel.normal), {double(texel.normalAlpha)}, wide(v)},
                              {single(static_cast<double>(oracle::normalTerm(texel, v)), double(kNormalTermMaxError), double(normalTerm(texel, v)))}};
        },
        1310);

    VectorSet& moments = sets.emplace_back(VectorSet{
        .name = "depth_moments",
        .meaning = "Eq. 10 and 11 of a filtered texel; depths are warped to [0, 1] over the layer",
        .inputs = {{"alpha_z", {}, "", "filtered alpha z"}, {"alpha_z2", {}, "", "filtered alpha z^2"}, {"alpha", {}, "", "filtered alpha beside them"}},
        .outputs = {outputOf("10", {"eq10.mean", {}, "", "mu = alpha z / alpha"}, {"kDepthMeanMaxError", double(kDepthMeanMaxError)}),
                    outputOf("11", {"eq11.variance", {}, "", "sigma^2 = alpha z^2 / alpha - mu^2, at least 2.5e-5"},
                             {"kDepthVarianceMaxError", double(kDepthVarianceMaxError)})},
        .kinds = {}});
    fillSet(
        moments, momentSpace(),
        [](const std::array<float, 3>& in) {
            const FilteredTexel t = momentsOf(in);
            const DepthMoments ours = depthMoments(t);
            return VectorCase{{{double(t.depth)}, {double(t.depthSquared)}, {double(t.depthAlpha)}},
                              {single(static_cast<double>(oracle::depthMean(t)), double(kDepthMeanMaxError), double(ours.mean)),
                               single(static_cast<double>(std::max(oracle::depthVariance(t), oracle::kVarianceFloor)), double(kDepthVarianceMaxError),
                                      double(ours.variance))}};
        },
        1320);
}

/// Eq. 12: Phi, and the window; what half an ULP of the inputs does to a window over sigma is allowed besides.
void addVisibility(std::vector<VectorSet>& sets)
{
    const NormalCdf polynomial, table(GaussianMethod::table, kVectorTableEntries);
    VectorSet& phi = sets.emplace_back(
        VectorSet{.name = "normal_cdf",
                  .meaning = "the standard normal distribution function",
                  .inputs = {{"x", {}, "", ""}},
                  .outputs = {outputOf("12", {"eq12.phi", {}, "", "Phi(x), by a polynomial or erf"}, {"kPolynomialCdfMaxError", double(polynomial.maxError())}),
                              outputOf("12", {"eq12.phi_table", {}, "", "Phi(x), by a table of 1024 entries over [-5, 5]"},
                                       {"tableCdfMaxError(1024)", double(table.maxError())})},
                  .kinds = {}});
    SearchSpace<float, 1> space{{{{-8.0f, 8.0f}}}, {}};
    for (const float x : {0.0f, 1e-38f, 2.5f, 5.0f, 5.25f, 40.0f, 1e30f}) space.planted.insert(space.planted.end(), {{x}, {-x}});
    fillSet(
        phi, space,
        [&](const std::array<float, 1>& in) {
            const double exact = -oracle::phiError(double(in[0]), 0.0);
            return VectorCase{
                {{double(in[0])}},
                {single(exact, double(polynomial.maxError()), double(polynomial(in[0]))), single(exact, double(table.maxError()), double(table(in[0])))}};
        },
        1330);

    VectorSet& window = sets.emplace_back(VectorSet{
        .name = "visibility",
        .meaning = "Eq. 12: the part of N(mu, sigma^2) in [z_c - r_c, z_c + r_c]",
        .inputs = {{"mu", {}, "warped depth", "mean"},
                   {"sigma2", {}, "warped depth^2", "variance; 0: a step"},
                   {"z_c", {}, "warped depth", "centre"},
                   {"r_c", {}, "warped depth", "radius"}},
        .outputs = {outputOf("12", {"eq12.visibility", {}, "", "V, by a polynomial or erf; sigma^2 = 0: 1 inside, 0 outside, 1/2 on the edge"},
                             {"gaussianVisibilityMaxError", double(gaussianVisibilityMaxError(polynomial))}, "and half an ULP of the inputs over sigma"),
                    outputOf("12", {"eq12.visibility_table", {}, "", "V, by a table of 1024 entries over [-5, 5] (the paper's way)"},
                             {"gaussianVisibilityMaxError", double(gaussianVisibilityMaxError(table))}, "and half an ULP of the inputs over sigma")},
        .kinds = {}});
    const auto visibility = [&](const Window& w) {
        const double exact = -oracle::visibilityError(double(w.mu), double(w.sigma2), double(w.zc), double(w.rc), 0.0);
        const double reach = std::abs(double(w.mu)) + std::abs(double(w.zc)) + double(w.rc);
        constexpr double kSteepest = 0.3989422804014327;  // of Phi
        const double inputs = w.sigma2 > 0.0f ? 2.0 * kSteepest * kHalfUlp * reach / std::sqrt(double(w.sigma2)) : 0.0;
        const auto of = [&](const NormalCdf& cdf) {
            return single(exact, w.sigma2 > 0.0f ? double(gaussianVisibilityMaxError(cdf)) + inputs : 0.0,
                          double(gaussianVisibility(cdf, w.mu, w.sigma2, w.zc, w.rc)));
        };
        return VectorCase{{{double(w.mu)}, {double(w.sigma2)}, {double(w.zc)}, {double(w.rc)}}, {of(polynomial), of(table)}};
    };
    const float leastSigma = std::sqrt(kVarianceFloor);
    fillSet(
        window, windowSpace(leastSigma), [&](const std::array<float, 4>& in) { return visibility(windowOf(in)); }, 1340);
    for (const float rc : {0.125f, 0.25f, 0.5f}) addCase(window, CaseKind::extreme, visibility({0.5f, 0.0f, 0.25f, rc}));
}

/// Eq. 9: weights of a trilinear lookup as the sampler makes them.
void addWeights(std::vector<VectorSet>& sets)
{
    constexpr int kMapEdge = 8, kMapLevels = 4, kAll = 64 + 16 + 4 + 1;
    /// Each of u, v and level rounded to 1/256: half a step in each of three factors.
    constexpr double kFraction = 3.0 / 512.0;
    Lrsm map;
    map.baseResolution = kMapEdge;
    for (int n = kMapEdge; n >= 1; n /= 2) {
        map.levelOffset.push_back(map.texelsPerLayer);
        map.texelsPerLayer += std::size_t(n) * std::size_t(n);
    }
    VectorSet& set = sets.emplace_back(
        VectorSet{.name = "sampler_weights",
                  .meaning = "Eq. 9: each texel's weight in a trilinear lookup in a map of 8x8 texels with all mips (border 0, level clamped to 0 .. 3)",
                  .inputs = {{"u", {}, "", "[0, 1] over the map, to the right"}, {"v", {}, "", "[0, 1] over the map, downwards"}, {"level", {}, "", ""}},
                  .outputs = {outputOf("9", {"eq9.weights", {kAll}, "", "level 0 row by row (64), level 1 (16), level 2 (4), level 3 (1)"},
                                       {"kFootprintWeightMaxError", double(kFootprintWeightMaxError)}),
                              outputOf("9", {"eq9.weights_sampler", {kAll}, "", "the same by a GPU's sampler, fractions in 1/256 or finer"},
                                       {"kFootprintWeightMaxError + 3/512", double(kFootprintWeightMaxError) + kFraction})},
                  .kinds = {}});
    SearchSpace<float, 3> space{{{{-0.01f, 1.01f}, {-0.01f, 1.01f}, {-1.0f, 4.5f}}}, {}};
    for (int lod = 0; lod < kMapLevels; ++lod)
        for (const float cell : {0.0f, 0.5f, 1.0f, 1.5f}) space.planted.push_back({cell / float(kMapEdge >> lod), 0.3f, float(lod) + cell / 4.0f});
    fillSet(
        set, space,
        [&](const std::array<float, 3>& in) {
            const LrsmFootprint footprint = makeFootprint(map, in[0], in[1], in[2], FilterFraction::exact);
            std::vector<double> exact, ours(std::size_t(kAll), 0.0);
            for (int lod = 0; lod < kMapLevels; ++lod)
                for (int i = 0; i < (kMapEdge >> lod) * (kMapEdge >> lod); ++i)
                    exact.push_back(twin::weight(map, lod, i % (kMapEdge >> lod), i / (kMapEdge >> lod), double(in[0]), double(in[1]), double(in[2])));
            for (int tap = 0; tap < footprint.taps; ++tap) ours[footprint.texel[tap]] += double(footprint.weight[tap]);
            const double allowed = double(kFootprintWeightMaxError);
            return VectorCase{{{double(in[0])}, {double(in[1])}, {double(in[2])}}, {many(exact, allowed, ours), many(exact, allowed + kFraction, ours)}};
        },
        1350);
}

void addLevel(std::vector<VectorSet>& sets)
{
    VectorSet& set = sets.emplace_back(VectorSet{.name = "lrsm_level",
                                                 .meaning = "Sec. 5: mip level of the LRSM for a sphere; its texel is two RSM texels wide",
                                                 .inputs = {{"diameter", {}, "m", "of the sphere"},
                                                            {"texel", {}, "m", "edge of an RSM texel there"},
                                                            {"bias", {}, "levels", "rsm_level_bias"},
                                                            {"least", {}, "levels", "rsm_min_level"}},
                                                 .outputs = {outputOf("sec5", {"sec5.level", {}, "levels", "max(log2(diameter / (2 texel)) + bias, least)"},
                                                                      {"kLrsmLevelMaxError", double(kLrsmLevelMaxError)})},
                                                 .kinds = {}});
    fillSet(
        set, levelSpace(),
        [](const std::array<float, 4>& in) {
            const double exact = twin::level(double(in[0]), double(in[1]), double(in[2]), double(in[3]));
            return VectorCase{{{double(in[0])}, {double(in[1])}, {double(in[2])}, {double(in[3])}},
                              {single(exact, double(kLrsmLevelMaxError), double(lrsmLevel(in[0], in[1], in[2], in[3])))}};
        },
        1360);
}

void addProjection(std::vector<VectorSet>& sets)
{
    VectorSet& set = sets.emplace_back(VectorSet{
        .name = "projection",
        .meaning = "the way into a light's space: a sun (0) and a spot (1)",
        .inputs = {{"point", {3}, "m", "world"},
                   {"type", {}, "", "0 sun, 1 spot", Dtype::u1},
                   {"position", {3}, "m", "of the light; sun: centre of the near side"},
                   {"right", {3}, "", "unit"},
                   {"up", {3}, "", "unit"},
                   {"forward", {3}, "", "unit"},
                   {"half_width", {}, "", "sun: metres from the axis to the map's edge; spot: tan of half the field of view"},
                   {"depth_near", {}, "m", "depth 0"},
                   {"depth_far", {}, "m", "depth 1"},
                   {"resolution", {}, "texels", "of the RSM"}},
        .outputs = {outputOf("sec5", {"sec5.place", {3}, "", "u to the right and v downwards over the map; depth: along the axis (sun), distance (spot)"},
                             {"kProjectionMaxError", double(kProjectionMaxError)}, "absolute (sun: kDirectionalProjectionMaxError)"),
                    outputOf("sec5", {"sec5.texel_size", {}, "m", "edge of an RSM texel there, across the axis"},
                             {"kProjectionMaxError", double(kProjectionMaxError)}, "relative")},
        .kinds = {}});
    // The last axis chooses the light.
    fillSet(
        set, SearchSpace<float, 4>{{{{-2.0f, 2.0f}, {-2.0f, 2.0f}, {-2.0f, 2.0f}, {0.0f, 1.0f}}}, {{0.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f, 1.0f}}},
        [](const std::array<float, 4>& in) -> VectorCase {
            const bool spot = in[3] >= 0.5f;
            const LightProjection light = spot ? spotOverCube(512) : sunOverCube(512);
            const Vec3 p(in[0], in[1], in[2]);
            const twin::Projected exact = twin::project(light, glm::dvec3(p));
            const LightSpacePoint ours = projectToLight(light, p);
            if (!exact.valid) return {};
            const double allowed = double(spot ? kProjectionMaxError : kDirectionalProjectionMaxError);
            return {{wide(p),
                     {spot ? 1.0 : 0.0},
                     wide(light.position),
                     wide(light.right),
                     wide(light.up),
                     wide(light.forward),
                     {double(light.halfWidth)},
                     {double(light.depthNear)},
                     {double(light.depthFar)},
                     {double(light.resolution)}},
                    {many({exact.u, exact.v, exact.depth}, allowed, {double(ours.u), double(ours.v), double(ours.depth)}),
                     single(exact.texelSize, double(kProjectionMaxError) * exact.texelSize, double(ours.texelSize))}};
        },
        1370);
}

}  // namespace

void addSampleVectors(std::vector<VectorSet>& sets)
{
    addProduct(sets);
    addTerms(sets);
    addWeights(sets);
    addVisibility(sets);
    addLevel(sets);
    addProjection(sets);
}

}  // namespace lrsm
