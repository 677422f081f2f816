#pragma once

#include "apps/validate/equations/layer_model.h"
#include "core/bvh/embree_scene.h"

#include <glm/glm.hpp>

/// Eq. 3 to 15 by brute force over the RSM texels that a cone sample covers, in double. Shares no code with lrsm/sample.h, prefilter.cpp or footprint.h:
/// it reads texels, the light's place and the settings.
namespace lrsm {

/// Sums over texels, weighted by solid angle (w of Eq. 9 is a box over the sphere's Omega).
struct TexelSums {
    double weight = 0.0;  ///< of texels that hold a surface
    glm::dvec3 radiance{0.0};
    glm::dvec3 normal{0.0};
    double z = 0.0, z2 = 0.0;  ///< metres from z_c
    TexelSums& operator+=(const TexelSums& other);
};

/// L of one light at the brute-force rungs.
struct FootprintRadiance {
    glm::dvec3 eq3{0.0}, eq5{0.0}, eq12{0.0}, eq14{0.0}, eq15{0.0};
    double slope = 1.0;        ///< mean <n.l> of the texels inside the sphere; of all texels where none is inside
    int layers = 0;            ///< layers of Eq. 15 that hold a texel of the footprint
    double insideShare = 0.0;  ///< weight of texels inside the sphere over that of all of Omega
};

/// What the settings say about the terms.
struct TermSettings {
    LayerSelection selection = LayerSelection::centre;
    Backface backface = Backface::cosine;
    double vRadiusScale = 1.0;
    static TermSettings of(const ConeSettings& cones) { return {cones.gather.layerSelection, cones.gather.backface, double(cones.gather.vRadiusScale)}; }
};

struct CoveredSphere {
    glm::dvec3 centre{0.0};
    double radius = 0.0;
    glm::dvec3 toReceiver{0.0, 1.0, 0.0};
};

/// A stretch of a cone taken as a cylinder.
struct CoveredBeam {
    glm::dvec3 middle{0.0}, direction{0.0, 0.0, 1.0};  ///< direction unit, away from the receiver
    double radius = 0.0, length = 0.0;
};

/// Emission of the texels inside a beam: sum of R <n.v> dA over the beam's cross-section, dA = r^2 domega / <n.l> (Eq. 4's Jacobian, r^2 kept). What faces
/// away counts 0, nothing hides anything. Lattice as for footprintRadiance.
glm::dvec3 beamEmission(const Rsm& rsm, const CoveredBeam& beam);

/// N of Eq. 8 as the `backface` setting weighs it.
double facingTerm(const TermSettings& terms, double cosine);

/// Eq. 12 in double, without a floor: a variance of 0 is a step with 1/2 on its edge. `distance` is z_c - mean; all metres.
double gaussianShare(double distance, double variance, double radius);

/// All brute-force rungs of one light at one sphere.
///
/// Omega is the set of light rays that meet the sphere, also where they pass the map by (out to one map's width beside it) or a texel drew nothing: there
/// is no surface known. Texels are taken by their centre's ray; where fewer than 16 lie across the sphere each is divided evenly, so that a sphere within one
/// texel reads that texel. What is missing counts as follows:
/// - Eq. 3, 4: like every ray that does not end inside the sphere, as unlit surface with n = l (the paper's second assumption);
/// - Eq. 5 on: as radiance 0 in R (A of Eq. 14), not at all in V and n-bar (Sec. 5 normalises them by alpha).
/// V(x, v) of Eq. 4 is visibility within the sphere, by rays if `embree` is given, for at most 32x32 blocks of texels; else 1. 1/<n.l> is capped at 1000.
/// r^2 is left out, as in the paper.
FootprintRadiance footprintRadiance(const Rsm& rsm, const LayerModel& layers, const TermSettings& terms, const CoveredSphere& sphere,
                                    const EmbreeScene* embree);

}  // namespace lrsm
