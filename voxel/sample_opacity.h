#pragma once

#include "voxel/opacity_pyramid.h"

#include <cstring>

/// The filtered lookup, specialised on everything that does not change during a march: cone tracing makes on the order of a hundred million
/// lookups a frame. Written with GCC/clang vector extensions: lane by lane plain IEEE arithmetic, so both compilers give the same bits.
namespace lrsm {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));

namespace sampling {

/// a + f (b - a), 0 <= f < 1: exact at f = 0, for a == b and (rounding included) never outside [min(a, b), max(a, b)].
inline Float4 lerp(Float4 a, Float4 b, Float4 f) { return a + f * (b - a); }

inline Int4 floorToInt(Float4 t)
{
    const Int4 i = __builtin_convertvector(t, Int4);
    return i + (__builtin_convertvector(i, Float4) > t);
}

/// The lower texel of the 2x2x2 that a lookup blends, and the fractions toward the upper ones.
struct Footprint {
    int x, y, z;
    Float4 f;
};

/// Clamped to where all eight texels are border (also NaN), so that far coordinates stay in int's range.
template <FilterFraction fraction>
inline Footprint footprint(Float4 pVoxels, float texelsPerVoxel, int n)
{
    Float4 t = pVoxels * texelsPerVoxel - 0.5f;
    const Float4 low = Float4{} - 2.0f, high = Float4{} + float(n + 1);
    t = t > low ? t : low;
    t = t < high ? t : high;
    if constexpr (fraction == FilterFraction::fixed8)
        t = __builtin_convertvector(floorToInt(t * 256.0f + 0.5f), Float4) * (1.0f / 256.0f);
    const Int4 cell = floorToInt(t);
    return {cell[0], cell[1], cell[2], t - __builtin_convertvector(cell, Float4)};
}

/// Blends eight values: lower[k] and upper[k] are the texels at x and x + 1 of row k = dy + 2 dz. Over x, then y, then z.
inline float blendRows(Float4 lower, Float4 upper, Float4 f)
{
    const Float4 x = lerp(lower, upper, Float4{} + f[0]);
    const float y0 = x[0] + f[1] * (x[1] - x[0]);
    const float y1 = x[2] + f[1] * (x[3] - x[2]);
    return y0 + f[2] * (y1 - y0);
}

/// Four bytes to four floats.
inline Float4 widen(std::uint32_t bytes)
{
    const Int4 lanes = {std::int32_t(bytes & 255u), std::int32_t((bytes >> 8) & 255u), std::int32_t((bytes >> 16) & 255u), std::int32_t(bytes >> 24)};
    return __builtin_convertvector(lanes, Float4);
}

}  // namespace sampling

/// Values are blended as stored (0..255 or 0..1) over x, y, z and then level, scaled to density per level before the last, and divided by
/// 255 at the end (a correctly rounded division: a texel's centre gives its decoded value exactly). A float32 pyramid goes the same way.
template <Storage storage, OpacityAxes axes, FilterFraction fraction>
class OpacitySampler {
  public:
    explicit OpacitySampler(const OpacityPyramid& pyramid)
        : bricks_(pyramid.base.bricks.data()), emptyLevels_(pyramid.emptyLevels.data()), levelOffset_(pyramid.levelOffset.data()),
          resolution_(pyramid.base.frame.resolution), brickEdge_(std::size_t(BitGrid::bricksPerEdge(resolution_))),
          topLevel_(pyramid.levels() - 1)
    {
        if constexpr (storage == Storage::gpu)
            texels_ = pyramid.unorm8.data();
        else
            texels_ = pyramid.float32.data();
    }

    /// Quadrilinear lookup, as sampleOpacity.
    Vec3 operator()(const Vec3& pVoxels, float level) const
    {
        level = level > 0.0f ? level : 0.0f;
        level = level < float(topLevel_) ? level : float(topLevel_);
        if (empty(pVoxels, level)) return Vec3(0.0f);
        if constexpr (fraction == FilterFraction::fixed8) level = float(int(level * 256.0f + 0.5f)) * (1.0f / 256.0f);
        const int lower = int(level);
        const float f = level - float(lower);
        const Float4 p = {pVoxels.x, pVoxels.y, pVoxels.z, 0.0f};
        Float4 result = atLevel(p, lower);
        if (f > 0.0f) result = sampling::lerp(result, atLevel(p, lower + 1), Float4{} + f);
        return decoded(result);
    }

    /// Trilinear lookup, as sampleLevel.
    Vec3 atLevel(const Vec3& pVoxels, int level) const
    {
        if (empty(pVoxels, float(level))) return Vec3(0.0f);
        return decoded(atLevel(Float4{pVoxels.x, pVoxels.y, pVoxels.z, 0.0f}, level));
    }

    /// True only where the lookup at `level` is exactly 0: one byte read instead of sixteen texels.
    bool empty(const Vec3& p, float level) const
    {
        const float n = float(resolution_);
        if (!(p.x >= 0.0f && p.y >= 0.0f && p.z >= 0.0f && p.x < n && p.y < n && p.z < n)) return false;
        const std::size_t brick = (std::size_t(int(p.z) >> 2) * brickEdge_ + std::size_t(int(p.y) >> 2)) * brickEdge_ + std::size_t(int(p.x) >> 2);
        return level + 1.0f <= float(emptyLevels_[brick]);
    }

  private:
    using Texel = std::conditional_t<storage == Storage::gpu, std::uint8_t, float>;
    static constexpr float kOne = storage == Storage::gpu ? 255.0f : 1.0f;
    static constexpr std::size_t kChannels = axes == OpacityAxes::directional ? 3 : 1;

    static Vec3 decoded(Float4 v)
    {
        if constexpr (storage == Storage::gpu) v /= 255.0f;
        return {v[0], v[1], v[2]};
    }

    Float4 atLevel(Float4 p, int level) const
    {
        const int n = resolution_ >> level;
        const auto at = sampling::footprint<fraction>(p, 1.0f / float(1 << level), n);
        if (level == 0) return Float4{} + bits(at);
        const auto last = unsigned(n - 1);
        const bool inside = unsigned(at.x) < last && unsigned(at.y) < last && unsigned(at.z) < last;
        const auto size = std::size_t(n);
        const Texel* texels = texels_ + levelOffset_[level] * kChannels;
        if constexpr (axes == OpacityAxes::isotropic) {
            Float4 lower, upper;
            if (inside) {
                const Texel* t = texels + (std::size_t(at.z) * size + std::size_t(at.y)) * size + std::size_t(at.x);
                const Texel* tz = t + size * size;
                lower = Float4{float(t[0]), float(t[size]), float(tz[0]), float(tz[size])};
                upper = Float4{float(t[1]), float(t[size + 1]), float(tz[1]), float(tz[size + 1])};
            } else {
                for (int row = 0; row < 4; ++row) {
                    lower[row] = borderTexel(texels, n, at.x, at.y + (row & 1), at.z + (row >> 1), 0);
                    upper[row] = borderTexel(texels, n, at.x + 1, at.y + (row & 1), at.z + (row >> 1), 0);
                }
            }
            return Float4{} + sampling::blendRows(lower, upper, at.f);
        } else {
            Float4 corner[8];
            if (inside) {
                const Texel* t = texels + ((std::size_t(at.z) * size + std::size_t(at.y)) * size + std::size_t(at.x)) * 3;
                for (std::size_t k = 0; k < 8; ++k) corner[k] = load(t + ((k & 1) + ((k >> 1) & 1) * size + (k >> 2) * size * size) * 3);
            } else {
                for (int k = 0; k < 8; ++k)
                    for (int c = 0; c < 4; ++c)
                        corner[k][c] = c == 3 ? 0.0f : borderTexel(texels, n, at.x + (k & 1), at.y + ((k >> 1) & 1), at.z + (k >> 2), c);
            }
            const Float4 fx = Float4{} + at.f[0], fy = Float4{} + at.f[1], fz = Float4{} + at.f[2];
            const Float4 y0 = sampling::lerp(sampling::lerp(corner[0], corner[1], fx), sampling::lerp(corner[2], corner[3], fx), fy);
            const Float4 y1 = sampling::lerp(sampling::lerp(corner[4], corner[5], fx), sampling::lerp(corner[6], corner[7], fx), fy);
            return sampling::lerp(y0, y1, fz) * (1.0f / float(1 << std::min(level, 3)));
        }
    }

    static float borderTexel(const Texel* texels, int n, int x, int y, int z, int channel)
    {
        const auto un = unsigned(n);
        if (unsigned(x) >= un || unsigned(y) >= un || unsigned(z) >= un) return 0.0f;
        const auto size = std::size_t(n);
        return float(texels[((std::size_t(z) * size + std::size_t(y)) * size + std::size_t(x)) * kChannels + std::size_t(channel)]);
    }

    /// A directional texel and one value beyond it, which the next level always holds (1x1x1 lookups take the border's way).
    static Float4 load(const Texel* texel)
    {
        if constexpr (storage == Storage::gpu) {
            std::uint32_t bytes;
            std::memcpy(&bytes, texel, sizeof bytes);
            return sampling::widen(bytes);
        } else {
            Float4 values;
            std::memcpy(&values, texel, sizeof values);
            return values;
        }
    }

    std::uint32_t voxelBit(int x, int y, int z) const
    {
        const auto n = unsigned(resolution_);
        if (unsigned(x) >= n || unsigned(y) >= n || unsigned(z) >= n) return 0;
        const std::size_t brick = (std::size_t(z >> 2) * brickEdge_ + std::size_t(y >> 2)) * brickEdge_ + std::size_t(x >> 2);
        return std::uint32_t(bricks_[brick] >> BitGrid::bitIndex(x, y, z)) & 1u;
    }

    /// Level 0. The eight bits as they lie in a brick: dx + 4 dy + 16 dz.
    float bits(const sampling::Footprint& at) const
    {
        std::uint32_t pattern = 0;
        for (int k = 0; k < 8; ++k) {
            const int dx = k & 1, dy = (k >> 1) & 1, dz = k >> 2;
            pattern |= voxelBit(at.x + dx, at.y + dy, at.z + dz) << (dx + 4 * dy + 16 * dz);
        }
        if (pattern == 0) return 0.0f;
        if (pattern == 0x330033u) return kOne;
        Float4 lower, upper;
        for (int row = 0; row < 4; ++row) {
            const int shift = 4 * (row & 1) + 16 * (row >> 1);
            lower[row] = (pattern >> shift) & 1u ? kOne : 0.0f;
            upper[row] = (pattern >> shift) & 2u ? kOne : 0.0f;
        }
        return sampling::blendRows(lower, upper, at.f);
    }

    const std::uint64_t* bricks_;
    const std::uint8_t* emptyLevels_;
    const std::size_t* levelOffset_;
    const Texel* texels_;
    int resolution_;
    std::size_t brickEdge_;
    int topLevel_;
};

/// visit(sampler) with the OpacitySampler for this pyramid.
template <class Visit>
decltype(auto) withOpacitySampler(const OpacityPyramid& pyramid, FilterFraction fraction, Visit&& visit)
{
    const auto withFraction = [&]<Storage storage, OpacityAxes axes>() -> decltype(auto) {
        if (fraction == FilterFraction::exact) return visit(OpacitySampler<storage, axes, FilterFraction::exact>(pyramid));
        return visit(OpacitySampler<storage, axes, FilterFraction::fixed8>(pyramid));
    };
    if (pyramid.storage == Storage::gpu) {
        if (pyramid.axes == OpacityAxes::isotropic) return withFraction.template operator()<Storage::gpu, OpacityAxes::isotropic>();
        return withFraction.template operator()<Storage::gpu, OpacityAxes::directional>();
    }
    if (pyramid.axes == OpacityAxes::isotropic) return withFraction.template operator()<Storage::float32, OpacityAxes::isotropic>();
    return withFraction.template operator()<Storage::float32, OpacityAxes::directional>();
}

}  // namespace lrsm
