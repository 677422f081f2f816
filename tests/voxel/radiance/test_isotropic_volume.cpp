#include "catch.h"

#include "voxel/radiance/isotropic_volume.h"
#include "voxel/radiance/sample_radiance.h"

#include <random>

using namespace lrsm;

namespace {

using DVec3 = glm::dvec3;
using DVec4 = glm::dvec4;

constexpr double kBrightest = 8.0;

template <class Texel>
IsotropicVolume volumeOf(int n, const Texel& texel)
{
    BitGrid bits;
    bits.grid.resolution = n;
    bits.bricks.assign(predictBitGridBytes(n) / sizeof(std::uint64_t), 0);
    std::vector<Vec4> dense;
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                dense.push_back(texel(x, y, z));
                if (dense.back().w > 0.0f) bits.bricks[bits.brickIndex(x, y, z)] |= std::uint64_t(1) << BitGrid::bitIndex(x, y, z);
            }
    IsotropicVolume volume;
    volume.maps = mapBricks(bits);
    std::vector<Vec4>& base = volume.levels.emplace_back(volume.maps[0].texelCount(), Vec4(0.0f));
    forTexels(volume.maps[0], [&](const IVec3& at, std::size_t place, std::size_t) {
        base[place] = dense[(std::size_t(at.z) * std::size_t(n) + std::size_t(at.y)) * std::size_t(n) + std::size_t(at.x)];
    });
    return volume;
}

IsotropicVolume randomVolume(int n, unsigned seed, float density, const CacheSettings& settings)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    IsotropicVolume volume = volumeOf(n, [&](int, int, int) {
        if (unit(random) >= density) return Vec4(0.0f);
        return Vec4(float(kBrightest) * Vec3(unit(random), unit(random), unit(random)), 1.0f);
    });
    ConversionCounts counts;
    for (Vec4& texel : volume.levels[0]) texel = storedTexel(texel, settings.storage, settings.halfRounding, counts);
    prefilterRadiance(volume, settings);
    return volume;
}

Vec4 texelAt(const IsotropicVolume& volume, int level, int x, int y, int z)
{
    const BrickMap& map = volume.maps[std::size_t(level)];
    const bool inside = x >= 0 && y >= 0 && z >= 0 && x < map.resolution && y < map.resolution && z < map.resolution;
    return inside ? volume.levels[std::size_t(level)][map.texel(x, y, z)] : Vec4(0.0f);
}

/// The definition, recursively and in double: opacity a quarter of the sum of eight, at most 1; radiance the mean by opacity, times a.
DVec4 covered(const IsotropicVolume& volume, int level, int x, int y, int z)
{
    if (level == 0) return DVec4(texelAt(volume, 0, x, y, z));
    double opacity = 0.0;
    DVec3 radiance(0.0);
    for (int k = 0; k < 8; ++k) {
        const DVec4 child = covered(volume, level - 1, 2 * x + (k & 1), 2 * y + (k >> 1 & 1), 2 * z + (k >> 2));
        opacity += child.w;
        radiance += DVec3(child);
    }
    if (opacity == 0.0) return DVec4(0.0);
    const double a = std::min(1.0, 0.25 * opacity);
    return DVec4(radiance / opacity * a, a);
}

template <class Visit>
void forAll(const IsotropicVolume& volume, int level, const Visit& visit)
{
    const int n = volume.maps[std::size_t(level)].resolution;
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) visit(x, y, z);
}

}  // namespace

TEST_CASE("isotropic mips: surface coverage as defined in double, dense and sparse", "[voxel][radiance]")
{
    for (const int n : {1, 4, 16})
        for (const float density : {0.02f, 0.4f})
            for (const Storage storage : {Storage::float32, Storage::gpu}) {
                const IsotropicVolume volume = randomVolume(n, unsigned(n), density, {.storage = storage});
                double largest = 0.0;
                for (int level = 1; level < int(volume.levels.size()); ++level)
                    forAll(volume, level, [&](int x, int y, int z) {
                        const DVec4 error = DVec4(texelAt(volume, level, x, y, z)) - covered(volume, level, x, y, z);
                        for (int k = 0; k < 4; ++k) largest = std::max(largest, std::abs(error[k]) / (k < 3 ? kBrightest : 1.0));
                    });
                const double perLevel = storage == Storage::gpu ? 0x1p-10 : double(kCoverageMaxError);
                CHECK(largest <= perLevel * double(volume.levels.size() - 1));
            }
}

TEST_CASE("isotropic mips: a wall stays opaque at every level and keeps its radiance, a furnace has its opacity's share of L", "[voxel][radiance]")
{
    IsotropicVolume wall = volumeOf(64, [](int x, int, int) { return x == 21 ? Vec4(3.0f, 2.0f, 1.0f, 1.0f) : Vec4(0.0f); });
    prefilterRadiance(wall, {.storage = Storage::float32});
    for (int level = 0; level < 7; ++level) CHECK(texelAt(wall, level, 21 >> level, 0, 0) == Vec4(3.0f, 2.0f, 1.0f, 1.0f));

    std::mt19937 random(5);
    IsotropicVolume furnace = volumeOf(16, [&](int, int, int) { return random() % 12 == 0 ? Vec4(2.0f, 2.0f, 2.0f, 1.0f) : Vec4(0.0f); });
    prefilterRadiance(furnace, {.storage = Storage::float32});
    bool part = false;
    for (int level = 1; level < 5; ++level)
        forAll(furnace, level, [&](int x, int y, int z) {
            const Vec4 texel = texelAt(furnace, level, x, y, z);
            REQUIRE(texel.x == Approx(2.0f * texel.w).epsilon(1e-6));
            part = part || (texel.w > 0.0f && texel.w < 1.0f);
        });
    CHECK(part);
}

TEST_CASE("isotropic lookup: quadrilinear, against all texels weighed by their tents in double", "[voxel][radiance]")
{
    const IsotropicVolume volume = randomVolume(16, 9, 0.3f, {.storage = Storage::gpu});
    const IsotropicLookup lookUp(volume, FilterFraction::exact);
    const auto tents = [&](const Vec3& p, int level) {
        DVec4 sum(0.0);
        forAll(volume, level, [&](int x, int y, int z) {
            const DVec3 away = glm::abs(DVec3(p) / double(1 << level) - (DVec3(x, y, z) + 0.5));
            const DVec3 tent = glm::max(1.0 - away, DVec3(0.0));
            sum += tent.x * tent.y * tent.z * DVec4(texelAt(volume, level, x, y, z));
        });
        return sum;
    };
    std::mt19937 random(2);
    std::uniform_real_distribution<float> place(-1.0f, 17.0f), any(-0.5f, 4.5f);
    for (int i = 0; i < 200; ++i) {
        const Vec3 p(place(random), place(random), place(random));
        const float level = any(random), clamped = std::clamp(level, 0.0f, 4.0f);
        const int lower = std::min(int(clamped), 3);
        const double f = double(clamped) - lower;
        const DVec4 expected = (1.0 - f) * tents(p, lower) + f * tents(p, lower + 1);
        const DVec4 error = DVec4(lookUp(p, level)) - expected;
        for (int k = 0; k < 4; ++k) REQUIRE(std::abs(error[k]) <= double(kRadianceLookupMaxError) * (k < 3 ? kBrightest : 1.0));
    }
}

TEST_CASE("isotropic volume: bytes of a dense grid on a GPU, and as predicted here", "[voxel][radiance]")
{
    CHECK(IsotropicVolume::predictGpuBytes(128) == 8u * (128u * 128 * 128 * 8 - 1) / 7);
    const IsotropicVolume volume = randomVolume(32, 1, 0.001f, {});
    CHECK(bytesOf(volume) == predictIsotropicBytes(volume.maps));
    CHECK(gpuBytesOf(volume) == IsotropicVolume::predictGpuBytes(32));
}
