#pragma once

#include <array>
#include <cstdint>

/// Homogeneous clipping of one triangle (internal to the rasterizer).
///
/// Watertight by construction: a cut edge's new vertex is computed from its inside to its outside end, whatever the triangle's winding, so
/// that both triangles of a shared edge get the same bits; and whether a new vertex lies outside a later plane hangs on its parents alone.
namespace lrsm::raster {

/// The viewport's centre lies at most this far from a kept vertex, in pixels along x or y: keeps in-tile edge values in 32 bits.
inline constexpr double kGuardBandPixels = 16384.0;
/// Largest picture edge for which the guard band lies outside the picture.
inline constexpr int kMaxPictureSize = 16384;
/// Vertices nearer than this to the eye's plane are cut; keeps 1/w finite. Far below any near plane in use.
inline constexpr double kMinW = 1e-20;

/// Planes of the clip volume, in the order they are cut. Bits 0-5 need a cut; the picture's own borders only serve trivial rejection.
enum Outside : std::uint32_t {
    kOutsideNear = 1u << 0,
    kOutsideW = 1u << 1,
    kOutsideGuard = 0xfu << 2,  // -x, +x, -y, +y
    kMustClip = 0x3fu,
    kOutsidePicture = 0xfu << 6,  // -x, +x, -y, +y
    kNotFinite = 1u << 10,
};
inline constexpr int kClipPlanes = 6;
inline constexpr int kMaxClipVertices = 3 + kClipPlanes;

struct ClipVertex {
    double x = 0.0, y = 0.0, z = 0.0, w = 1.0;
    double b1 = 0.0, b2 = 0.0;  ///< barycentrics in the triangle being clipped
    std::uint32_t outside = 0;  ///< Outside bits
};

struct ClipVolume {
    double guardX = 1.0, guardY = 1.0;  ///< guard band in units of w
    ClipVolume(int width, int height) : guardX(2.0 * kGuardBandPixels / width), guardY(2.0 * kGuardBandPixels / height) {}
};

/// All Outside bits of a finite position.
std::uint32_t outsideBits(const ClipVolume& volume, double x, double y, double z, double w);

struct ClipPolygon {
    std::array<ClipVertex, kMaxClipVertices> vertices;
    int count = 0;
};

/// Cuts the polygon (a triangle on entry) by every plane that one of its vertices is outside of. Leaves count == 0 when nothing is left.
void clipPolygon(const ClipVolume& volume, ClipPolygon& polygon);

}  // namespace lrsm::raster
