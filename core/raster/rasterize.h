#pragma once

#include "core/base/counters.h"
#include "core/base/image.h"
#include "core/base/math.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>

/// Software rasterizer after the D3D11.3 functional specification, shared by RSM and G-buffer.
///
/// Clip space: x, y in [-w, w] (y up), z in [0, w] with 0 at the near plane. Vertices are snapped to 1/256 pixel, nearest even; culling and
/// attribute set-up use the snapped positions; coverage is by 64-bit integer edge functions, sampled at pixel centres with the top-left rule;
/// depth z/w in float, LESS, ties go to the triangle submitted first. Triangles are clipped homogeneously at the near plane (and at a guard
/// band far outside the picture, so that any finite triangle fits the integer range). There is no far clip. A NaN position drops the triangle.
namespace lrsm {

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

/// |depth - exact| <= this times the triangle's largest |z/w|: one rounding at the vertices, one at the pixel.
inline constexpr float kRasterDepthMaxError = 0x1.1p-23f;
/// |b1 - exact|, |b2 - exact| of an unclipped triangle, against the snapped corners' own perspective.
inline constexpr float kRasterBarycentricMaxError = 0x1p-22f;

/// One covered pixel: which triangle and where on it. Attributes are set up later, one visible fragment a pixel.
struct Fragment {
    std::uint32_t triangle = kNoTriangle;  ///< index in submission order
    float b1 = 0.0f, b2 = 0.0f;            ///< perspective-correct barycentrics of vertices 1 and 2; b0 = 1 - b1 - b2
    float depth = 1.0f;                    ///< z/w
};

enum class Cull { none, back };  ///< back: clockwise on screen (y down) is dropped, i.e. counter-clockwise in y-up is the front

/// A vertex so far behind the near plane that float32 cannot say how much z and w differ: clipping at that plane goes by this position.
struct FarVertex {
    std::uint32_t vertex = 0;
    glm::dvec4 clipPosition{0.0};
};

struct RasterInput {
    std::span<const Vec4> clipPositions;                      ///< one a vertex
    std::span<const std::array<std::uint32_t, 3>> triangles;  ///< into clipPositions
    std::span<const Cull> cull;                               ///< one a triangle; empty: Cull::none for all
    std::span<const FarVertex> far = {};                      ///< ascending; may be empty
};

struct RasterCounts {
    std::uint64_t submitted = 0;  ///< triangles
    std::uint64_t drawn = 0;      ///< that reach set-up after clipping and culling, in the picture
    std::uint64_t clipped = 0;    ///< cut by the near plane or guard band
    std::uint64_t culled = 0;     ///< back faces and zero area after snapping
    std::uint64_t dropped = 0;    ///< NaN or infinite positions
};

inline Counters countersOf(const RasterCounts& counts)
{
    return {{"triangles_submitted", static_cast<double>(counts.submitted)},
            {"triangles_drawn", static_cast<double>(counts.drawn)},
            {"triangles_clipped", static_cast<double>(counts.clipped)},
            {"triangles_culled", static_cast<double>(counts.culled)},
            {"triangles_dropped", static_cast<double>(counts.dropped)}};
}

struct RasterOutput {
    Image<Fragment> fragments;
    RasterCounts counts;
};

/// Keeps the fragment? Called for covered samples that pass the depth test, for triangles marked in `tested`; must be thread-safe.
using FragmentTest = std::function<bool(const Fragment&)>;

/// Indices must be in range; width and height 1..16384 (InputError). Parallel over tiles; same bits for any number of threads. `tested` (one flag a triangle,
/// empty: none) says where `test` is consulted.
RasterOutput rasterize(const RasterInput& input, int width, int height, std::span<const std::uint8_t> tested = {}, const FragmentTest& test = {});

}  // namespace lrsm
