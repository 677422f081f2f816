// Eq. 1: opacity of a step, transmittance, and the sum from front to back.
#include "apps/validate/equations/equation_inputs.h"
#include "apps/validate/equations/march_twin.h"
#include "apps/validate/vectors/make_vectors.h"
#include "apps/validate/vectors/set_parts.h"
#include "conetrace/lrsm/march_paper.h"

namespace lrsm {
namespace {

constexpr int kSpheres = 16;
/// Of a sum over kSpheres in float32, over its largest radiance: an ULP for each product and each sum.
constexpr NamedBound kFrontToBackMaxError{"kFrontToBackMaxError", 2e-6};

/// The sum as marchPaper adds it.
struct FloatSum {
    Vec3 radiance{0.0f};
    float clear = 1.0f;
};

VectorCase frontToBack(int draw)
{
    SearchRandom random(1100 + static_cast<std::uint32_t>(draw));
    VectorCase made{{{}, {}}, {}};
    twin::FrontToBack exact;
    FloatSum ours;
    const float opaque = draw == 0 ? 0.0f : draw == 1 ? 1.0f : draw == 2 ? 1e-4f : random.uniform(0.02f, 1.0f);
    for (int i = 0; i < kSpheres; ++i) {
        const float alpha = draw < 3 ? opaque : opaque * random.uniform(0.0f, 1.0f);
        const Vec3 radiance(random.uniform(0.0f, 4.0f), random.uniform(0.0f, 1.0f), random.uniform(0.0f, 0.01f));
        exact.add(double(alpha), glm::dvec3(radiance));
        ours.radiance += (ours.clear * alpha) * radiance;
        ours.clear *= 1.0f - alpha;
        made.inputs[0].push_back(double(alpha));
        for (const double c : wide(radiance)) made.inputs[1].push_back(c);
    }
    made.results = {many(wide(exact.radiance), 4.0 * kFrontToBackMaxError.value, wide(ours.radiance)),
                    single(1.0 - exact.clear, kFrontToBackMaxError.value, double(1.0f - ours.clear))};
    return made;
}

}  // namespace

void addMarchVectors(std::vector<VectorSet>& sets)
{
    VectorSet& sum = sets.emplace_back(VectorSet{
        .name = "front_to_back",
        .meaning = "Eq. 1: light and opacity of a cone of 16 spheres, the first nearest",
        .inputs = {{"alpha", {kSpheres}, "", "opacity of each sphere"}, {"radiance", {kSpheres, 3}, "W/(m^2 sr)", "outgoing radiance L of each sphere, RGB"}},
        .outputs = {outputOf("1", {"eq1.radiance", {3}, "W/(m^2 sr)", "sum over i of alpha_i L_i times the product over j < i of (1 - alpha_j)"},
                             kFrontToBackMaxError, "relative to the largest radiance"),
                    outputOf("1", {"eq1.opacity", {}, "", "1 - product of all (1 - alpha_i)"}, kFrontToBackMaxError)},
        .kinds = {}});
    fillSet(
        sum, draws(3), [](const std::array<float, 1>& in) { return frontToBack(static_cast<int>(in[0])); }, 1000, kDrawCounts);

    VectorSet& step = sets.emplace_back(VectorSet{
        .name = "step_opacity",
        .meaning = "Eq. 1's alpha of a step, opacity=density: 1 - (1 - a)^(k length), a at most 1",
        .inputs = {{"a", {}, "", "opacity that the voxels say, a base voxel"}, {"length", {}, "base voxels", "of the step"}, {"k", {}, "", "density_k"}},
        .outputs = {outputOf("1", {"eq1.step_opacity", {}, "", "alpha"}, {"kStepOpacityMaxError", double(kStepOpacityMaxError)},
                             "absolute, times max(1, k length / 16)"),
                    outputOf("1", {"eq1.step_opacity_gpu", {}, "", "alpha by a GPU's log2 and exp2: of a thin medium log2(1 - a) is their error"}, kGpuMaxError,
                             "of log2, and the bound above")},
        .kinds = {}});
    fillSet(
        step, stepSpace(),
        [](const std::array<float, 3>& in) {
            ConeSettings settings;
            settings.march.opacity = OpacityModel::density;
            settings.march.densityK = in[2];
            const double length = double(in[1]), allowed = double(kStepOpacityMaxError) * std::max(1.0, length * double(in[2]) / 16.0);
            const double exact = twin::stepOpacity(double(in[0]), length, settings), ours = double(stepOpacity(in[0], in[1], settings));
            constexpr double kLn2 = 0.6931471805599453;
            const double gpu = allowed + (1.0 - exact) * (length * double(in[2]) * kLn2 + 1.0) * kGpuMaxError.value;
            return VectorCase{{{double(in[0])}, {length}, {double(in[2])}}, {single(exact, allowed, ours), single(exact, gpu, ours)}};
        },
        1010);

    VectorSet& clear = sets.emplace_back(
        VectorSet{.name = "transmittance",
                  .meaning = "what is left of the light behind an optical depth, transmittance=exponential: exp(-k F)",
                  .inputs = {{"f", {}, "base voxels", "optical depth F"}, {"k", {}, "", "density_k"}},
                  .outputs = {outputOf("1", {"eq1.transmittance", {}, "", "exp(-k F)"}, {"kTransmittanceMaxError", double(kTransmittanceMaxError)})},
                  .kinds = {}});
    fillSet(
        clear, SearchSpace<float, 2>{{{{0.0f, 20.0f}, {0.25f, 4.0f}}}, {{0.0f, 1.0f}, {1.0f, 1.0f}}},
        [](const std::array<float, 2>& in) {
            ConeSettings settings;
            settings.march.transmittance = TransmittanceModel::exponential;
            settings.march.densityK = in[1];
            return VectorCase{{{double(in[0])}, {double(in[1])}},
                              {single(twin::transmittance(double(in[0]), settings), double(kTransmittanceMaxError), double(transmittanceOf(in[0], settings)))}};
        },
        1020);
}

}  // namespace lrsm
