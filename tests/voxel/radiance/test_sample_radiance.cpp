#include "catch.h"

#include "voxel/radiance/sample_radiance.h"

#include <random>

using namespace lrsm;

namespace {

using DVec3 = glm::dvec3;
using DVec4 = glm::dvec4;

/// Random voxels, the mips over them.
RadianceVolume speckled(int n, const VctSettings& settings)
{
    std::mt19937 random(17);
    BitGrid bits;
    bits.grid.resolution = n;
    bits.bricks.assign(predictBitGridBytes(n) / sizeof(std::uint64_t), 0);
    for (std::uint64_t& brick : bits.bricks)
        brick = random() % 3 == 0 ? (std::uint64_t(random()) << 32 | random()) & (std::uint64_t(random()) << 32 | random()) : 0;
    RadianceVolume volume = darkVolume(bits);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (std::size_t i = 0; i < volume.base.size(); ++i) {
        if (volume.base[i].w == 0.0f) continue;
        volume.base[i] = Vec4(4.0f * unit(random), 4.0f * unit(random), 4.0f * unit(random), 1.0f);
        volume.normals[i] = Vec4(unit(random) - 0.5f, unit(random) - 0.5f, unit(random) - 0.5f, 0.0f);
    }
    buildRadianceMips(volume, settings);
    return volume;
}

/// The header's words in double: all texels of the level under their tents.
DVec4 lookedUp(const RadianceVolume& volume, const VctSettings& settings, const DVec3& p, int level, const DVec3& d)
{
    const BrickMap& map = volume.maps[std::size_t(level)];
    DVec4 sum(0.0);
    for (int z = 0; z < map.resolution; ++z)
        for (int y = 0; y < map.resolution; ++y)
            for (int x = 0; x < map.resolution; ++x) {
                const DVec3 away = glm::abs(p / double(1 << level) - (DVec3(x, y, z) + 0.5));
                const DVec3 tent = glm::max(1.0 - away, 0.0);
                const double weight = tent.x * tent.y * tent.z;
                if (weight == 0.0) continue;
                const std::size_t i = map.texel(x, y, z);
                if (level == 0) {
                    const DVec3 normal(volume.normals[i]);
                    const DVec4 texel(volume.base[i]);
                    const bool dark = glm::dot(normal, d) > double(settings.facing) * glm::length(normal);
                    sum += weight * (dark ? DVec4(0, 0, 0, texel.w) : texel);
                    continue;
                }
                for (int axis = 0; axis < 3; ++axis) {
                    const double part = settings.weights == DirectionWeights::absolute ? std::abs(d[axis]) : d[axis] * d[axis];
                    sum += weight * part * DVec4(volume.faces[std::size_t(level)][std::size_t(2 * axis + (d[axis] < 0.0))][i]);
                }
            }
    return sum.w > 1.0 ? sum / sum.w : sum;
}

}  // namespace

TEST_CASE("radiance lookup: what the header says, in double, inside and beyond the grid", "[voxel][radiance]")
{
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
    for (const DirectionWeights weights : {DirectionWeights::absolute, DirectionWeights::squared}) {
        VctSettings settings;
        settings.weights = weights;
        const RadianceVolume volume = speckled(16, settings);
        double largest = 0.0;
        for (int k = 0; k < 3000; ++k) {
            const Vec3 p = 8.0f + 10.0f * Vec3(unit(random), unit(random), unit(random));
            const Vec3 d = glm::normalize(Vec3(unit(random), unit(random), unit(random)));
            const float level = 2.5f + 2.5f * unit(random);
            const RadianceLookup lookUp(volume, settings, FilterFraction::exact, d);
            const float clamped = std::min(level, 4.0f);
            const int lower = int(clamped);
            const double f = double(clamped) - lower;
            DVec4 expected = lookedUp(volume, settings, DVec3(p), lower, DVec3(d));
            if (f > 0.0) expected += f * (lookedUp(volume, settings, DVec3(p), lower + 1, DVec3(d)) - expected);
            const DVec4 error = glm::abs(DVec4(lookUp(p, level)) - expected) / DVec4(4.0, 4.0, 4.0, 1.0);
            largest = std::max({largest, error.x, error.y, error.z, error.w});
        }
        CAPTURE(largest);
        CHECK(largest < double(kRadianceLookupMaxError));
    }
}
