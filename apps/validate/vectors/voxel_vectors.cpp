// Sec. 3.1's mips and lookup, and Fig. 7's cones.
#include "apps/validate/equations/closed_forms.h"
#include "apps/validate/equations/synthetic_grids.h"
#include "apps/validate/equations/voxel_lookup.h"
#include "apps/validate/vectors/make_vectors.h"
#include "apps/validate/vectors/set_parts.h"
#include "conetrace/frame/cones.h"
#include "voxel/sample_opacity.h"

namespace lrsm {
namespace {

constexpr int kGridEdge = 4;

/// A random grid of 4^3 voxels a case, and a place in it.
VectorCase lookUp(const std::array<float, 5>& in)
{
    const OpacityPyramid pyramid =
        pyramidOf(randomGrid(kGridEdge, 0.4, 1500 + static_cast<std::uint32_t>(in[4] * 7.0f)), OpacityAxes::isotropic, Storage::float32);
    VectorCase made{{{}, {}, {}, {double(in[0]), double(in[1]), double(in[2])}, {double(in[3])}}, {}};
    for (int level = 0; level < 3; ++level) {
        const int n = kGridEdge >> level;
        for (int i = 0; i < n * n * n; ++i) made.inputs[std::size_t(level)].push_back(double(pyramid.value(level, 0, i % n, i / n % n, i / n / n)));
    }
    const double exact = oracle::lookup(pyramid, {in[0], in[1], in[2], in[3]}).x;
    const double ours = double(sampleOpacity(pyramid, Vec3(in[0], in[1], in[2]), in[3], FilterFraction::exact).x);
    /// A place and a level each rounded to 1/256 by a sampler: half a step in each of four factors.
    constexpr double kFraction = 4.0 / 512.0;
    const double mean = made.inputs[2][0];
    double sum = 0.0;
    for (const double voxel : made.inputs[0]) sum += voxel;
    made.results = {single(exact, double(kOpacityLookupMaxError), ours), single(exact, double(kOpacityLookupMaxError) + kFraction, ours),
                    single(sum / (kGridEdge * kGridEdge * kGridEdge), kHalfUlp, mean)};
    return made;
}

}  // namespace

void addVoxelVectors(std::vector<VectorSet>& sets)
{
    VectorSet& lookup = sets.emplace_back(
        VectorSet{.name = "opacity_lookup",
                  .meaning = "Sec. 3.1: mean mips of 4^3 voxels, and their quadrilinear lookup (texel centres at +0.5, border 0, level clamped to 0 .. 2)",
                  .inputs = {{"level0", {4, 4, 4}, "", "voxels, [z][y][x]"},
                             {"level1", {2, 2, 2}, "", "mip"},
                             {"level2", {1, 1, 1}, "", "mip"},
                             {"place", {3}, "base voxels", "x, y, z from the grid's corner"},
                             {"level", {}, "", ""}},
                  .outputs = {outputOf("sec3", {"sec3.opacity", {}, "", "at the place and level"}, {"kOpacityLookupMaxError", double(kOpacityLookupMaxError)}),
                              outputOf("sec3", {"sec3.opacity_sampler", {}, "", "the same by a GPU's sampler, fractions in 1/256 or finer"},
                                       {"kOpacityLookupMaxError + 4/512", double(kOpacityLookupMaxError) + 4.0 / 512.0}),
                              outputOf("sec3", {"sec3.mean", {}, "", "level2 from level0 by means of 8, mip_filter=mean"}, {"half an ULP", kHalfUlp})},
                  .kinds = {}});
    fillSet(lookup,
            SearchSpace<float, 5>{{{{-1.0f, 5.0f}, {-1.0f, 5.0f}, {-1.0f, 5.0f}, {-0.5f, 2.5f}, {0.0f, 1.0f}}},
                                  {{0.5f, 1.5f, 2.0f, 0.0f, 0.5f}, {2.0f, 2.0f, 2.0f, 1.0f, 0.5f}}},
            lookUp, 1510);

    VectorSet& cones = sets.emplace_back(VectorSet{
        .name = "six_cones",
        .meaning = "Fig. 7: the paper's six diffuse cones, cone_count=6, rotation=none, estimator=paper; the first along +z, the normal",
        .inputs = {{"cone", {}, "", "its number", Dtype::u1}},
        .outputs = {outputOf("fig7", {"fig7.axis", {3}, "", "unit; five of them 60 degrees from the normal, the second in the xz plane"},
                             {"kConeSetMaxError", double(kConeSetMaxError)}),
                    outputOf("fig7", {"fig7.weight", {}, "", "1/4, and 3/20 for each of the others"}, {"kConeSetMaxError", double(kConeSetMaxError)})},
        .kinds = {}});
    ConeSettings settings;
    settings.march.estimator = Estimator::paper;
    settings.set.count = 6;
    settings.set.apertureScale = 1.0f;
    settings.set.rotation = Rotation::none;
    const ConeSet ours = makeConeSet(settings);
    for (int i = 0; i < 6; ++i) {
        const oracle::Cone exact = oracle::coneOfSix(i);
        addCase(cones, CaseKind::typical,
                {{{double(i)}},
                 {many({exact.axis[0], exact.axis[1], exact.axis[2]}, double(kConeSetMaxError), wide(ours.directions[std::size_t(i)])),
                  single(exact.weight, double(kConeSetMaxError), double(ours.rings[i ? 1 : 0].weight))}});
    }

    VectorSet& specular = sets.emplace_back(
        VectorSet{.name = "specular_aperture",
                  .meaning = "the specular cone's half angle, specular_aperture=roughness: 2 atan(roughness^2), at most 60 degrees",
                  .inputs = {{"roughness", {}, "", ""}},
                  .outputs = {outputOf("fig7", {"fig7.specular_tan", {}, "", "tan of the half angle"}, {"kSpecularTanMaxError", double(kSpecularTanMaxError)})},
                  .kinds = {}});
    fillSet(
        specular, SearchSpace<float, 1>{{{{0.0f, 1.0f}}}, {{0.7598357f}}},
        [](const std::array<float, 1>& in) {
            ConeSettings s;
            s.specular.aperture = SpecularAperture::roughness;
            return VectorCase{{{double(in[0])}}, {single(oracle::specularTanHalf(in[0]), double(kSpecularTanMaxError), double(specularTanHalf(s, in[0])))}};
        },
        1520);
}

}  // namespace lrsm
