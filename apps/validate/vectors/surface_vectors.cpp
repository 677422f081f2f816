// Eq. 2 to 4 and 7: what an RSM texel reflects, and the direct sums that the paper states to replace them.
#include "apps/validate/equations/closed_forms.h"
#include "apps/validate/equations/exact_sums.h"
#include "apps/validate/equations/synthetic_maps.h"
#include "apps/validate/vectors/make_vectors.h"
#include "apps/validate/vectors/set_parts.h"

namespace lrsm {
namespace {

constexpr int kSumTexels = 16;
/// Of a weighted mean over kSumTexels in float32, cosines to the light of 0.09 and more: over the largest radiance, over 1.
constexpr NamedBound kMeanMaxError{"kFloatMeanMaxError", 1e-5}, kCountMaxError{"kFloatCountMaxError", 2e-6};
/// A texel this near to the sphere (m) may be on either side of it in float32.
constexpr double kNearSphere = 1e-4;

/// Texels about the origin. 0: all beyond the sphere, 1: all within it, 2: all seen from behind, 3: half of them exactly on the sphere, which belongs to it.
VectorCase directSum(int draw)
{
    SearchRandom random(1200 + static_cast<std::uint32_t>(draw));
    const Vec3 centre = draw < 4 ? Vec3(0.0f) : 0.3f * randomUnit(random), v = draw < 4 ? Vec3(0.0f, 0.0f, 1.0f) : randomUnit(random);
    const float radius = draw == 0 ? 0.25f : draw == 1 ? 4.0f : draw == 3 ? 0.5f : random.uniform(0.3f, 1.2f);
    VectorCase made{std::vector<std::vector<double>>(8), {}};
    std::vector<TexelSample> texels;
    for (int i = 0; i < kSumTexels; ++i) {
        const Vec3 toLight = randomUnit(random), normal = draw == 2 ? Vec3(0.0f, 0.0f, -1.0f) : glm::normalize(1.2f * toLight + randomUnit(random));
        Vec3 position = randomUnit(random) * random.uniform(draw == 0 ? 0.5f : 0.0f, 1.0f);
        if (draw == 3) position = Vec3(i % 2 ? 0.5f : 0.75f, 0.0f, 0.0f);
        const Vec3 radiance(random.uniform(0.0f, 4.0f), random.uniform(0.0f, 1.0f), random.uniform(0.0f, 0.01f));
        const float solidAngle = random.uniform(0.5f, 1.0f);
        texels.push_back(
            {glm::dvec3(position), glm::dvec3(normal), draw == 2 ? glm::dvec3(normal) : glm::dvec3(toLight), glm::dvec3(radiance), double(solidAngle)});
        const auto append = [&](std::size_t input, const std::vector<double>& values) {
            made.inputs[input].insert(made.inputs[input].end(), values.begin(), values.end());
        };
        append(0, wide(texels.back().position)), append(1, wide(texels.back().normal)), append(2, wide(texels.back().toLight));
        append(3, wide(radiance)), append(4, {double(solidAngle)});
    }
    made.inputs[5] = wide(centre), made.inputs[6] = {double(radius)}, made.inputs[7] = wide(v);

    VectorResult weights;
    double total = 0.0;
    for (const TexelSample& texel : texels) {
        if (draw != 3 && std::abs(double(radius) - glm::length(texel.position - glm::dvec3(centre))) < kNearSphere) return {};
        const double lit = glm::dot(texel.normal, texel.toLight),
                     weight = weightEq4(texel, glm::dvec3(v), insideSample(texel, glm::dvec3(centre), double(radius)));
        total += weight * texel.solidAngle;
        // Two dot products, each within three half ULPs of 1, and a division.
        weights.exact.push_back(weight), weights.allowed.push_back(4.0 * kHalfUlp * (1.0 + weight) / std::min(lit, 1.0));
        weights.ours.push_back(double(static_cast<float>(weight)));
    }
    if (total > 0.0 && total < 0.02 * kSumTexels) return {};  // nearly nothing is a badly conditioned mean
    made.results = {rounded(wide(radianceEq3(texels, glm::dvec3(centre), double(radius), glm::dvec3(v))), 4.0 * kMeanMaxError.value), weights,
                    rounded({visibilityEq7(texels, glm::dvec3(centre), double(radius))}, kCountMaxError.value)};
    return made;
}

}  // namespace

void addSurfaceVectors(std::vector<VectorSet>& sets)
{
    VectorSet& reflected = sets.emplace_back(
        VectorSet{.name = "reflected_radiance",
                  .meaning = "Eq. 2's integrand at an RSM texel, diffuse: rho L_d <n.l> / pi",
                  .inputs = {{"rho", {}, "", "albedo"}, {"l_d", {}, "W/m^2", "the light's irradiance on a plane that faces it"}, {"n_dot_l", {}, "", "cosine"}},
                  .outputs = {outputOf("2", {"eq2.reflected_radiance", {}, "W/(m^2 sr)", "outgoing radiance"},
                                       {"kReflectedRadianceMaxError", double(kReflectedRadianceMaxError)}, "relative")},
                  .kinds = {}});
    fillSet(
        reflected,
        SearchSpace<float, 3>{{{{1e-3f, 1.0f, Spacing::logarithmic}, {1e-6f, 1e6f, Spacing::logarithmic}, {1e-4f, 1.0f, Spacing::logarithmic}}},
                              {{1.0f, 1.0f, 1.0f}, {0.5f, 0.0f, 1.0f}}},
        [](const std::array<float, 3>& in) {
            const double exact = static_cast<double>(oracle::reflectedRadiance(in[0], in[1], in[2]));
            return VectorCase{{{double(in[0])}, {double(in[1])}, {double(in[2])}},
                              {single(exact, double(kReflectedRadianceMaxError) * exact, double(reflectedRadiance(Vec3(in[0]), Vec3(in[1]), in[2]).y))}};
        },
        1200);

    VectorSet& direct = sets.emplace_back(VectorSet{
        .name = "direct_sum",
        .meaning = "Eq. 3, 4 and 7 over 16 RSM texels, w = 1; a texel beyond the sphere is shadowed surface that faces the light (n = l)",
        .inputs = {{"position", {kSumTexels, 3}, "m", "x"},
                   {"normal", {kSumTexels, 3}, "", "n, unit"},
                   {"to_light", {kSumTexels, 3}, "", "l, unit"},
                   {"radiance", {kSumTexels, 3}, "W/(m^2 sr)", "rho L_d <n.l> / pi, RGB"},
                   {"solid_angle", {kSumTexels}, "", "d omega, up to a common factor"},
                   {"centre", {3}, "m", "x_c"},
                   {"radius", {}, "m", "r_c"},
                   {"to_receiver", {3}, "", "v, unit"}},
        .outputs = {outputOf("3", {"eq3.radiance", {3}, "W/(m^2 sr)", "sum of w' V radiance d omega over sum of w' d omega; 0 where that is 0"}, kMeanMaxError,
                             "relative to the largest radiance"),
                    outputOf("4", {"eq4.weight", {kSumTexels}, "", "w' = <n.v> / <n.l> within the sphere, <l.v> beyond it; at least 0"},
                             {"4 half ULPs", 4.0 * kHalfUlp}, "times (1 + w') / <n.l>"),
                    outputOf("7", {"eq7.visibility", {}, "", "share of the solid angle whose texels lie in the sphere, |x - x_c| <= r_c"}, kCountMaxError)},
        .kinds = {}});
    fillSet(
        direct, draws(4), [](const std::array<float, 1>& in) { return directSum(static_cast<int>(in[0])); }, 1210, kDrawCounts);
}

}  // namespace lrsm
