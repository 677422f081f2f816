#pragma once

#include "apps/validate/equations/algorithm1_twin.h"
#include "conetrace/lrsm/march.h"

/// Eq. 1 once more, in double: the paper's sum over spheres, and the slab estimator as docs/pipeline.md describes it. They share the structures of
/// settings and maps with the kernels, and no code; constants are written here a second time.
namespace lrsm::twin {

/// Opacity as a smooth function of place (base voxels) and mip level, instead of a pyramid: kernel and twin ask the same field.
struct OpacityField {
    DVec3 amplitude{0.02, 0.03, 0.05};
    DVec3 operator()(const DVec3& pVoxels, double level) const;
};

/// The field as the kernels' sampler.
struct FieldSampler {
    const OpacityField& field;
    Vec3 operator()(const Vec3& pVoxels, float level) const { return Vec3(field(DVec3(pVoxels), double(level))); }
};

struct March {
    DVec3 radiance{0.0};
    double opacity = 0.0;
    double toJump = 1.0;  ///< distance to the nearest decision that rounding could turn
};

/// Along a schedule as given: what its own rounding moves, makeSchedule's check says.
March marchPaper(const ConeWorld& world, const OpacityField& field, const ConeRay& ray, const MarchSchedule& schedule);
March marchSlab(const ConeWorld& world, const OpacityField& field, const ConeRay& ray, const MarchSchedule& schedule);

/// Eq. 1, front to back: what samples of opacity alpha and outgoing radiance L add up to.
struct FrontToBack {
    DVec3 radiance{0.0};
    double clear = 1.0;  ///< product of 1 - alpha so far
    void add(double alpha, const DVec3& outgoing)
    {
        radiance += clear * alpha * outgoing;
        clear *= 1.0 - alpha;
    }
};

/// One minus transmittance of `length` base voxels of a medium whose mip value is `density`.
double stepOpacity(double density, double length, const ConeSettings& settings);
double transmittance(double opticalDepth, const ConeSettings& settings);

}  // namespace lrsm::twin
