#pragma once

#include "core/base/math.h"

#include <array>
#include <span>
#include <vector>

/// The three directions that a tile's normals need: [C] Sec. 3.2, "Adapting to Normals".
namespace lrsm {

inline constexpr int kNormalBins = 16;         ///< edge of the octahedral histogram
inline constexpr float kNormalSharpness = 30;  ///< of its blur, exp(30 (n_i.n_j - 1)): half at 12 degrees

/// Bin of a unit normal, row * kNormalBins + column: the whole sphere as an octahedron unfolded to a square.
int normalBin(const Vec3& normal);
/// Unit direction of a bin's middle.
Vec3 normalOfBin(int bin);

/// Three axes, most important first.
using NormalAxes = std::array<Vec3, 3>;

/// Blur and selection as tables over pairs of bins; made once a frame, in double.
class NormalAxisFinder {
  public:
    NormalAxisFinder();

    /// Of the normals counted by bin. A direction's weight w is the blurred count over the number of pixels ([C] does not say in which unit w is; with bare
    /// counts the 1 below is nothing, and the second axis stands beside the first). Thrice the largest is taken (ties: the lowest bin), and each time all
    /// weights are lowered by likeness to it: w := (w + 1) (1 - |n.n_best|^8). The weight of what was taken is 0 then.
    NormalAxes axesOf(std::span<const std::uint32_t> counts) const;

  private:
    std::vector<float> blur_, unlike_;  ///< exp(30 (n_i.n_j - 1)); 1 - |n_i.n_j|^8; [i * bins + j]
};

/// Axis with the largest |n.a| (ties: the first), and whether n points against it: 2 axis + (n.a < 0).
int axisOf(const Vec3& normal, const NormalAxes& axes);

}  // namespace lrsm
