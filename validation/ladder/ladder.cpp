#include "validation/ladder/ladder.h"

#include "core/base/check.h"

namespace lrsm {

std::vector<RungInfo> radianceRungs()
{
    return {{"Eq. 2", "the surface integral itself: parallel rays along v_c, first hit inside the sphere, shadow rays to the lights"},
            {"Eq. 3, 4", "the RSM's texels in place of the surface: unlit parts are guessed to face the light"},
            {"Eq. 5-8", "product of three means, V by counting texels inside the sphere"},
            {"Eq. 10-12", "V by a Gaussian of the texels' mean and variance of depth"},
            {"Eq. 13, 14", "the same in each layer, all layers added"},
            {"Eq. 15", "only the layers that are selected, with their overlap and decay"},
            {"mips", "the footprint by pre-filtered mip chain and trilinear lookup, in float32"},
            {"Table 1", "RSM and LRSM in their storage: half and UNORM16, with the variance's floor"},
            {"Algorithm 1", "as shipped: its Gaussian, sampler fractions and float32 arithmetic"}};
}

std::vector<RungInfo> visibilityRungs()
{
    return {{"rays", "a bundle of rays through the triangles fills the cone's solid angle"},
            {"voxel rays", "the same rays through the bits of level 0, from the march's start on"},
            {"box mips", "the cone's steps, opacity from exact boxes as wide as the tap, in double"},
            {"cone", "as shipped: quadrilinear lookups in the stored mip chain"}};
}

const std::vector<double>& ladderProbabilities()
{
    static const std::vector<double> probabilities = {0.0, 0.01, 0.05, 0.1, 0.25, 0.5, 0.75, 0.9, 0.95, 0.99, 1.0};
    return probabilities;
}

LadderScene climbLadder(const Scene&, const Camera&, const Requirements&, const Settings&, const LadderOptions&)
{
    throw InputError("validate", "the ladder is not built yet");
}

}  // namespace lrsm
