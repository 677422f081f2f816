#pragma once

#include "voxel/cascades.h"
#include "voxel/opacity_pyramid.h"
#include "voxel/sampling_vectors.h"

#include <algorithm>

/// The filtered lookup, specialised on everything that does not change during a march: cone tracing makes on the order of a hundred million
/// lookups a frame.
namespace lrsm {

/// Values are blended as stored (0..255 or 0..1) over x, y and z, scaled to density per base voxel, blended over the level, and divided by
/// 255 at the end (a correctly rounded division: a texel's centre gives its decoded value exactly). A float32 pyramid goes the same way.
template <Storage storage, OpacityAxes axes, FilterFraction fraction>
class OpacitySampler {
  public:
    explicit OpacitySampler(const OpacityPyramid& pyramid)
        : bricks_(pyramid.base.bricks.data()),
          emptyLevels_(pyramid.emptyLevels.data()),
          levelOffset_(pyramid.levelOffset.data()),
          resolution_(pyramid.base.grid.resolution),
          brickEdge_(std::size_t(BitGrid::bricksPerEdge(resolution_))),
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
        const Float4 p = {pVoxels.x, pVoxels.y, pVoxels.z, 0.0f};
        if (knownEmpty(p, level)) return Vec3(0.0f);
        if constexpr (fraction == FilterFraction::fixed8) level = float(int(level * 256.0f + 0.5f)) * (1.0f / 256.0f);
        const int lower = int(level);
        const float f = level - float(lower);
        Float4 result = blended(p, lower);
        if (f > 0.0f) result = sampling::lerp(result, blended(p, lower + 1), splat(f));
        return decoded(result);
    }

    /// Trilinear lookup, as sampleLevel.
    Vec3 atLevel(const Vec3& pVoxels, int level) const
    {
        const Float4 p = {pVoxels.x, pVoxels.y, pVoxels.z, 0.0f};
        return knownEmpty(p, float(level)) ? Vec3(0.0f) : decoded(blended(p, level));
    }

    /// True only where the lookup at `level` is exactly 0: one byte read instead of sixteen texels. The lookups above ask it themselves.
    bool empty(const Vec3& pVoxels, float level) const { return knownEmpty(Float4{pVoxels.x, pVoxels.y, pVoxels.z, 0.0f}, level); }

  private:
    using Texel = std::conditional_t<storage == Storage::gpu, std::uint8_t, float>;
    static constexpr float kOne = storage == Storage::gpu ? 255.0f : 1.0f;
    static constexpr std::size_t kChannels = axes == OpacityAxes::directional ? 3 : 1;

    static Vec3 decoded(Float4 v)
    {
        if constexpr (storage == Storage::gpu) v /= splat(255.0f);
        return {v[0], v[1], v[2]};
    }

    bool knownEmpty(Float4 p, float level) const
    {
        if (!sampling::all((p >= splat(0.0f)) & (p < splat(float(resolution_))))) return false;
        const Int4 brick = __builtin_convertvector(p, Int4) >> 2;
        return level + 1.0f <= float(emptyLevels_[(std::size_t(brick[2]) * brickEdge_ + std::size_t(brick[1])) * brickEdge_ + std::size_t(brick[0])]);
    }

    /// All lanes of an isotropic value are equal.
    Float4 blended(Float4 p, int level) const
    {
        const int n = resolution_ >> level;
        const auto at = sampling::footprint<fraction>(p, sampling::inversePower(level), n);
        if (level == 0) return splat(blendedBits(at));

        const auto last = unsigned(n - 1);
        const bool inside = unsigned(at.cell[0]) < last && unsigned(at.cell[1]) < last && unsigned(at.cell[2]) < last;
        const Texel* texels = texels_ + levelOffset_[level] * kChannels;
        if constexpr (axes == OpacityAxes::isotropic) {
            return splat(inside ? blendedInside(texels, n, at) : blendedAtBorder(texels, n, at));
        } else {
            return (inside ? blendedInside(texels, n, at) : blendedAtBorder(texels, n, at)) * splat(sampling::inversePower(std::min(level, 3)));
        }
    }

    /// All eight texels exist. A directional texel is loaded with one value more, which is there: the next texel's or the next level's
    /// (the last level, 1x1x1, always goes the border's way).
    static auto blendedInside(const Texel* texels, int n, const sampling::Footprint& at)
    {
        const auto size = std::size_t(n);
        const Texel* row = texels + ((std::size_t(at.cell[2]) * size + std::size_t(at.cell[1])) * size + std::size_t(at.cell[0])) * kChannels;
        const std::size_t dy = size * kChannels, dz = size * dy;
        const Texel* const rows[4] = {row, row + dy, row + dz, row + dz + dy};
        if constexpr (axes == OpacityAxes::isotropic) {
            Float4 lower, upper;
            sampling::loadPairs(rows, lower, upper);
            return sampling::blendRows(lower, upper, at.f);
        } else {
            Float4 corner[8];
            for (int k = 0; k < 8; ++k) corner[k] = sampling::loadFour(rows[k >> 1] + 3 * (k & 1));
            return sampling::blendCorners(corner, at.f);
        }
    }

    /// Some texels are border: they count as 0.
    static auto blendedAtBorder(const Texel* texels, int n, const sampling::Footprint& at)
    {
        const int last = n - 1;
        std::size_t offset[3][2];  // x, y, z; lower, upper: clamped into the level
        bool exists[3][2];
        std::size_t stride = kChannels;
        for (int axis = 0; axis < 3; ++axis, stride *= std::size_t(n)) {
            for (int k = 0; k < 2; ++k) {
                const int i = at.cell[axis] + k;
                exists[axis][k] = i >= 0 && i <= last;
                offset[axis][k] = std::size_t(std::clamp(i, 0, last)) * stride;
            }
        }
        Float4 corner[8];
        for (int k = 0; k < 8; ++k) {
            const int dx = k & 1, dy = (k >> 1) & 1, dz = k >> 2;
            const Texel* t = texels + offset[0][dx] + offset[1][dy] + offset[2][dz];
            const Int4 mask = Int4{} - std::int32_t(exists[0][dx] && exists[1][dy] && exists[2][dz]);
            if constexpr (axes == OpacityAxes::isotropic)
                corner[k] = sampling::keep(mask, splat(float(t[0])));
            else
                corner[k] = sampling::keep(mask, sampling::loadThree(t));
        }
        if constexpr (axes == OpacityAxes::isotropic)
            return sampling::blendCorners(corner, at.f)[0];
        else
            return sampling::blendCorners(corner, at.f);
    }

    /// Level 0, blended; the same for all axes.
    float blendedBits(const sampling::Footprint& at) const
    {
        const auto last = unsigned(resolution_ - 1);
        const bool inside = unsigned(at.cell[0]) < last && unsigned(at.cell[1]) < last && unsigned(at.cell[2]) < last;
        const std::uint32_t bits = inside ? bitsInside(at.cell[0], at.cell[1], at.cell[2]) : bitsAtBorder(at.cell[0], at.cell[1], at.cell[2]);
        if (bits == 0) return 0.0f;
        if (bits == 0x330033u) return kOne;
        const Int4 pattern = Int4{} + std::int32_t(bits);
        const Float4 lower = sampling::keep((pattern & Int4{0x1, 0x10, 0x10000, 0x100000}) != 0, splat(kOne));
        const Float4 upper = sampling::keep((pattern & Int4{0x2, 0x20, 0x20000, 0x200000}) != 0, splat(kOne));
        return sampling::blendRows(lower, upper, at.f);
    }

    /// The 2x2x2 bits from (x, y, z) as they would lie in one brick: dx + 4 dy + 16 dz.
    std::uint32_t bitsInside(int x, int y, int z) const
    {
        const int bx = x & 3, by = y & 3, bz = z & 3;
        const std::size_t row = brickEdge_, slice = brickEdge_ * brickEdge_;
        const std::uint64_t* brick = bricks_ + std::size_t(z >> 2) * slice + std::size_t(y >> 2) * row + std::size_t(x >> 2);
        if (bx != 3 && by != 3 && bz != 3) return std::uint32_t(*brick >> (bx + 4 * by + 16 * bz)) & 0x330033u;

        std::uint32_t bits = 0;
        const std::size_t nextX = bx == 3;
        for (int k = 0; k < 4; ++k) {
            const int yk = by + (k & 1), zk = bz + (k >> 1);
            const std::uint64_t* b = brick + (yk == 4 ? row : 0) + (zk == 4 ? slice : 0);
            const int shift = 4 * (yk & 3) + 16 * (zk & 3);
            const auto nibble = std::uint32_t(b[0] >> shift) & 15u;
            const auto nextNibble = std::uint32_t(b[nextX] >> shift) & 15u;
            bits |= (((nibble | (nextNibble << 4)) >> bx) & 3u) << (4 * (k & 1) + 16 * (k >> 1));
        }
        return bits;
    }

    std::uint32_t bitsAtBorder(int x, int y, int z) const
    {
        std::uint32_t bits = 0;
        const auto n = unsigned(resolution_);
        for (int k = 0; k < 8; ++k) {
            const int dx = k & 1, dy = (k >> 1) & 1, dz = k >> 2;
            const int i = x + dx, j = y + dy, l = z + dz;
            if (unsigned(i) >= n || unsigned(j) >= n || unsigned(l) >= n) continue;
            const std::uint64_t brick = bricks_[(std::size_t(l >> 2) * brickEdge_ + std::size_t(j >> 2)) * brickEdge_ + std::size_t(i >> 2)];
            bits |= (std::uint32_t(brick >> BitGrid::bitIndex(i, j, l)) & 1u) << (dx + 4 * dy + 16 * dz);
        }
        return bits;
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

/// sampleOpacity in its parts: visit(value) for each cascade that answers. Their sum is the lookup.
template <class Visit>
void forOpacityParts(const OpacityPyramid& pyramid, const Vec3& pVoxels, float level, FilterFraction fraction, const Visit& visit)
{
    forCascades(pyramid, pVoxels, level, [&](const OpacityPyramid& cascade, const Vec3& p, float cascadeLevel, float factor) {
        visit(withOpacitySampler(cascade, fraction, [&](const auto& sample) { return sample(p, cascadeLevel); }) * factor);
    });
}

}  // namespace lrsm
