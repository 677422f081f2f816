#pragma once

#include "core/base/math.h"
#include "core/settings/settings.h"

#include <array>
#include <span>
#include <vector>

/// Cone sets over the hemisphere about a receiver's normal (z of the tangent frame of basisFromNormal).
///
/// The hemisphere is cut into rings of equal polar width: one cap of half-angle h about the normal, then rings of width 2h, with
/// h = 90 degrees / (2 rings - 1); each ring is shared evenly by its cones, which sit on its middle. Six cones give the paper's set: one of
/// 60 degrees about the normal, five of 60 degrees at 60 degrees from it. Sets of up to four cones have a single ring.
/// Each cone stands for its share of the ring, so the weights integrate the cosine exactly: sin^2(outer) - sin^2(inner), over the count.
namespace lrsm {

struct ConeRing {
    int count = 0;                               ///< cones in the ring
    int first = 0;                               ///< index of its first cone
    float innerAngle = 0.0f, outerAngle = 0.0f;  ///< polar, radians
    float axisAngle = 0.0f;                      ///< of the cones' axes
    float tanHalf = 0.0f;                        ///< tangent of the traced half-angle
    float weight = 0.0f;                         ///< of one cone; weights of all cones sum to 1
};

/// How many cones each ring holds, innermost first; sums to `count` (1..256).
std::vector<int> ringCounts(int count);

inline constexpr int kRotations = 16;  ///< directions alternate over blocks of 4x4 pixels

/// The directions of a frame: kRotations sets of the same cones, one for each pixel of a 4x4 block.
struct ConeSet {
    std::vector<ConeRing> rings;
    std::vector<Vec3> directions;  ///< tangent frame, unit; [rotation * count + cone]
    int count = 0;

    std::span<const Vec3> rotation(int index) const { return std::span(directions).subspan(std::size_t(index) * std::size_t(count), std::size_t(count)); }
};

/// `paper`: the set above, equal in all 16 rotations, turned by azimuth, or moved within each cone's share of its ring.
/// `slab`: strata of equal cosine weight 1/count (Malley's disc), the same rings; half-angle from the stratum's solid angle.
/// The traced half-angle is `apertureScale` times the cone's own (capped below 90 degrees).
/// Weights, directions and angles are those of exact arithmetic within kConeSetMaxError (outer angles and tangents ten times that).
inline constexpr float kConeSetMaxError = 1.5e-7f;
ConeSet makeConeSet(const ConeSettings& settings);

/// Where in its stratum, [0, 1)^2, a set of Rotation::strata looks: the 16 points of a Hammersley set, in the order of their bit-reversed index.
struct StratumPlace {
    double u, v;
};
StratumPlace stratumPlace(int rotation);

/// Which of the 16 rotations a pixel uses: a 4x4 ordered (bit-reversed) pattern, so that near pixels differ most.
int rotationOfPixel(int x, int y, Rotation rotation);

/// Tangent of the half-angle of the one specular cone: fixed, or 2 atan(alpha) of the GGX lobe: half of its microfacet normals lie within
/// atan(alpha) of the mean, and reflection doubles the angle. alpha = roughness^2. At most tan 60 degrees. Error <= kSpecularTanMaxError.
inline constexpr float kSpecularTanMaxError = 6e-7f;
float specularTanHalf(const ConeSettings& settings, float roughness);

}  // namespace lrsm
