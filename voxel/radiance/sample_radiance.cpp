#include "voxel/radiance/sample_radiance.h"

#include "core/base/simd.h"

#include <algorithm>
#include <cmath>

namespace lrsm {
namespace {

Float4 texelAt(const std::vector<Vec4>& texels, std::size_t i)
{
    return loadFloat4(&texels[i].x);
}

Float4 mix(Float4 a, Float4 b, float f)
{
    return a + (b - a) * splat(f);
}

/// The eight texels about a place, and the fractions between them.
struct Tap {
    std::array<std::size_t, 8> texel;  ///< bit a: the higher along axis a; 0 (a zero) outside and where no brick is held
    Vec3 fraction{0.0f};
    bool empty = true;
};

Tap tapAt(const BrickMap& map, const Vec3& p, bool fixed8)
{
    Tap tap;
    const int n = map.resolution;
    std::array<std::array<int, 2>, 3> at;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(p[axis] > -1.0f && p[axis] < float(n) + 1.0f)) return tap;
        const float place = p[axis] - 0.5f, low = std::floor(place);
        tap.fraction[axis] = place - low;
        if (fixed8) tap.fraction[axis] = std::floor(tap.fraction[axis] * 256.0f + 0.5f) * (1.0f / 256.0f);
        at[std::size_t(axis)] = {int(low), int(low) + 1};
    }
    std::size_t held = 0;
    for (std::size_t k = 0; k < 8; ++k) {
        const int x = at[0][k & 1], y = at[1][(k >> 1) & 1], z = at[2][k >> 2];
        const bool inside = unsigned(x) < unsigned(n) && unsigned(y) < unsigned(n) && unsigned(z) < unsigned(n);
        tap.texel[k] = inside ? map.texel(x, y, z) : 0;
        held |= tap.texel[k] >= BrickMap::kTexels;
    }
    tap.empty = held == 0;
    return tap;
}

/// read(i) is the i-th texel.
template <class Read>
Float4 blended(const Tap& tap, const Read& read)
{
    const Vec3& f = tap.fraction;
    const Float4 y0z0 = mix(read(0), read(1), f.x), y1z0 = mix(read(2), read(3), f.x), y0z1 = mix(read(4), read(5), f.x), y1z1 = mix(read(6), read(7), f.x);
    return mix(mix(y0z0, y1z0, f.y), mix(y0z1, y1z1, f.y), f.z);
}

Vec4 toVec4(Float4 v)
{
    return {v[0], v[1], v[2], v[3]};
}

/// Linear between the two levels about `level`.
template <class LookUp>
Vec4 betweenLevels(const LookUp& lookUp, const Vec3& pVoxels, float level, int levels, bool fixed8)
{
    const float clamped = std::clamp(level, 0.0f, float(levels - 1));
    const float exact = fixed8 ? std::floor(clamped * 256.0f + 0.5f) * (1.0f / 256.0f) : clamped;
    const int lower = int(exact);
    const float f = exact - float(lower);
    const Vec4 fine = lookUp.atLevel(pVoxels, lower);
    if (!(f > 0.0f)) return fine;
    const Vec4 coarse = lookUp.atLevel(pVoxels, lower + 1);
    return fine + (coarse - fine) * f;
}

}  // namespace

RadianceLookup::RadianceLookup(const RadianceVolume& volume, const VctSettings& settings, FilterFraction fraction, const Vec3& direction)
    : volume_(volume),
      facing_(settings.facing),
      absolute_(settings.weights == DirectionWeights::absolute),
      fixed8_(fraction == FilterFraction::fixed8),
      direction_(direction)
{
    for (int axis = 0; axis < 3; ++axis) {
        const float d = direction[axis];
        faces_[std::size_t(axis)] = 2 * axis + (d < 0.0f ? 1 : 0);
        weights_[axis] = absolute_ ? std::abs(d) : d * d;
    }
}

Vec4 RadianceLookup::atLevel(const Vec3& pVoxels, int level) const
{
    const BrickMap& map = volume_.maps[std::size_t(level)];
    const Tap tap = tapAt(map, pVoxels * (1.0f / float(1 << level)), fixed8_);
    if (tap.empty) return Vec4(0.0f);
    if (level == 0)
        return toVec4(blended(tap, [&](std::size_t k) {
            const std::size_t i = tap.texel[k];
            const Float4 texel = texelAt(volume_.base, i);
            const Vec3 normal(volume_.normals[i]);
            return facesAway(glm::dot(normal, direction_), normal, facing_) ? Float4{0.0f, 0.0f, 0.0f, texel[3]} : texel;
        }));

    Float4 sum = splat(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<Vec4>& face = volume_.faces[std::size_t(level)][std::size_t(faces_[std::size_t(axis)])];
        sum += splat(weights_[axis]) * blended(tap, [&](std::size_t k) { return texelAt(face, tap.texel[k]); });
    }
    if (sum[3] > 1.0f) sum /= splat(sum[3]);
    return toVec4(sum);
}

Vec4 RadianceLookup::operator()(const Vec3& pVoxels, float level) const
{
    return betweenLevels(*this, pVoxels, level, volume_.levels(), fixed8_);
}

Vec4 IsotropicLookup::atLevel(const Vec3& pVoxels, int level) const
{
    const Tap tap = tapAt(volume_.maps[std::size_t(level)], pVoxels * (1.0f / float(1 << level)), fixed8_);
    if (tap.empty) return Vec4(0.0f);
    const std::vector<Vec4>& texels = volume_.levels[std::size_t(level)];
    return toVec4(blended(tap, [&](std::size_t k) { return texelAt(texels, tap.texel[k]); }));
}

Vec4 IsotropicLookup::operator()(const Vec3& pVoxels, float level) const
{
    return betweenLevels(*this, pVoxels, level, static_cast<int>(volume_.levels.size()), fixed8_);
}

}  // namespace lrsm
