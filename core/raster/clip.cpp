#include "core/raster/clip.h"

#include <algorithm>
#include <cassert>

namespace lrsm::raster {

namespace {

/// Signed distance (any scale) to plane `plane` of the volume, >= 0 inside. Linear in the homogeneous position.
double planeDistance(const ClipVolume& volume, int plane, double x, double y, double z, double w)
{
    switch (plane) {
    case 0: return z;
    case 1: return w - kMinW;
    case 2: return volume.guardX * w + x;
    case 3: return volume.guardX * w - x;
    case 4: return volume.guardY * w + y;
    default: return volume.guardY * w - y;
    }
}

ClipVertex cutEdge(const ClipVolume& volume, int plane, const ClipVertex& in, const ClipVertex& out)
{
    // A vertex that its parents put inside may lie outside by a rounding: then the cut is at that vertex.
    const double dIn = std::max(0.0, planeDistance(volume, plane, in.x, in.y, in.z, in.w));
    const double dOut = planeDistance(volume, plane, out.x, out.y, out.z, out.w);
    const double t = dIn / (dIn - dOut);
    const auto mix = [t](double a, double b) { return a + t * (b - a); };

    ClipVertex cut{.x = mix(in.x, out.x),
                   .y = mix(in.y, out.y),
                   .z = mix(in.z, out.z),
                   .w = mix(in.w, out.w),
                   .b1 = mix(in.b1, out.b1),
                   .b2 = mix(in.b2, out.b2),
                   .outside = 0};
    // Cancellation must not put the new vertex behind the near or the eye's plane.
    cut.z = plane == 0 ? 0.0 : std::max(0.0, cut.z);
    cut.w = std::max(kMinW, cut.w);
    cut.outside = outsideBits(volume, cut.x, cut.y, cut.z, cut.w) & (in.outside | out.outside) & ~(1u << plane);
    return cut;
}

void cutByPlane(const ClipVolume& volume, int plane, ClipPolygon& polygon)
{
    const std::uint32_t bit = 1u << plane;
    ClipPolygon kept;
    for (int i = 0; i < polygon.count; ++i) {
        const ClipVertex& a = polygon.vertices[std::size_t(i)];
        const ClipVertex& b = polygon.vertices[std::size_t(i + 1 == polygon.count ? 0 : i + 1)];
        const bool aIn = !(a.outside & bit), bIn = !(b.outside & bit);
        assert(kept.count + 2 <= kMaxClipVertices + 1);
        if (aIn) kept.vertices[std::size_t(kept.count++)] = a;
        if (aIn != bIn) kept.vertices[std::size_t(kept.count++)] = aIn ? cutEdge(volume, plane, a, b) : cutEdge(volume, plane, b, a);
    }
    polygon = kept;
}

}  // namespace

std::uint32_t outsideBits(const ClipVolume& volume, double x, double y, double z, double w)
{
    std::uint32_t bits = 0;
    for (int plane = 0; plane < kClipPlanes; ++plane) bits |= std::uint32_t(planeDistance(volume, plane, x, y, z, w) < 0.0) << plane;
    bits |= std::uint32_t(x < -w) << 6 | std::uint32_t(x > w) << 7 | std::uint32_t(y < -w) << 8 | std::uint32_t(y > w) << 9;
    return bits;
}

void clipPolygon(const ClipVolume& volume, ClipPolygon& polygon)
{
    for (int plane = 0; plane < kClipPlanes && polygon.count > 0; ++plane) {
        std::uint32_t any = 0;
        for (int i = 0; i < polygon.count; ++i) any |= polygon.vertices[std::size_t(i)].outside;
        if (any & (1u << plane)) cutByPlane(volume, plane, polygon);
    }
    if (polygon.count < 3) polygon.count = 0;
}

}  // namespace lrsm::raster
