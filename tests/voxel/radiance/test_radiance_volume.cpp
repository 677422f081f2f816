#include "catch.h"

#include "voxel/radiance/octree_bytes.h"
#include "voxel/radiance/radiance_volume.h"

#include <random>

using namespace lrsm;

namespace {

using DVec3 = glm::dvec3;
using DVec4 = glm::dvec4;

/// A volume whose voxels are set by set(x, y, z), base texels by fill(x, y, z, radiance, normal).
template <class Set, class Fill>
RadianceVolume volumeOf(int n, const Set& set, const Fill& fill)
{
    BitGrid bits;
    bits.grid.resolution = n;
    bits.bricks.assign(predictBitGridBytes(n) / sizeof(std::uint64_t), 0);
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x)
                if (set(x, y, z)) bits.bricks[bits.brickIndex(x, y, z)] |= std::uint64_t(1) << BitGrid::bitIndex(x, y, z);
    RadianceVolume volume = darkVolume(bits);
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                if (!bits.occupied(x, y, z)) continue;
                Vec3 radiance(0.0f), normal(0.0f);
                fill(x, y, z, radiance, normal);
                const std::size_t i = volume.maps[0].texel(x, y, z);
                volume.base[i] = Vec4(radiance, 1.0f);
                volume.normals[i] = Vec4(normal, 0.0f);
            }
    return volume;
}

RadianceVolume randomVolume(int n, unsigned seed, double density)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    std::vector<bool> set(std::size_t(n) * std::size_t(n) * std::size_t(n));
    for (std::size_t i = 0; i < set.size(); ++i) set[i] = double(unit(random)) < density;
    return volumeOf(
        n, [&](int x, int y, int z) { return set[(std::size_t(z) * std::size_t(n) + std::size_t(y)) * std::size_t(n) + std::size_t(x)]; },
        [&](int, int, int, Vec3& radiance, Vec3& normal) {
            radiance = 8.0f * Vec3(unit(random), unit(random), unit(random));
            normal = Vec3(unit(random), unit(random), unit(random)) * 1.1f - 0.55f;
        });
}

VctSettings float32()
{
    VctSettings settings;
    settings.storage = Storage::float32;
    return settings;
}

/// Texel (x, y, z) of a level as seen by who travels along axis `axis` towards `sign`: the definition, recursively and in double.
DVec4 seen(const RadianceVolume& volume, double facing, int axis, int sign, int level, int x, int y, int z)
{
    if (level == 0) {
        const std::size_t i = volume.maps[0].texel(x, y, z);
        const DVec3 normal(volume.normals[i]);
        const DVec4 texel(volume.base[i]);
        return sign * normal[axis] > facing * std::sqrt(glm::dot(normal, normal)) ? DVec4(0, 0, 0, texel.w) : texel;
    }
    DVec4 sum(0.0);
    for (int v = 0; v < 2; ++v)
        for (int u = 0; u < 2; ++u) {
            int low[3] = {2 * x, 2 * y, 2 * z};
            low[(axis + 1) % 3] += u;
            low[(axis + 2) % 3] += v;
            DVec4 met[2];
            for (int k = 0; k < 2; ++k) {
                int at[3] = {low[0], low[1], low[2]};
                at[axis] += sign > 0 ? k : 1 - k;
                met[k] = seen(volume, facing, axis, sign, level - 1, at[0], at[1], at[2]);
            }
            sum += met[0] + (1.0 - met[0].w) * met[1];
        }
    return 0.25 * sum;
}

template <class Visit>
void forAll(const RadianceVolume& volume, int level, const Visit& visit)
{
    const int n = volume.maps[std::size_t(level)].resolution;
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) visit(x, y, z);
}

Vec4 faceAt(const RadianceVolume& volume, int level, int direction, int x, int y, int z)
{
    return volume.faces[std::size_t(level)][std::size_t(direction)][volume.maps[std::size_t(level)].texel(x, y, z)];
}

double largestError(const RadianceVolume& volume, double facing)
{
    double largest = 0.0;
    for (int level = 1; level < volume.levels(); ++level)
        for (int d = 0; d < kTravelDirections; ++d)
            forAll(volume, level, [&](int x, int y, int z) {
                const DVec4 error = DVec4(faceAt(volume, level, d, x, y, z)) - seen(volume, facing, d / 2, d & 1 ? -1 : 1, level, x, y, z);
                for (int k = 0; k < 4; ++k) largest = std::max(largest, std::abs(error[k]) / (k < 3 ? 8.0 : 1.0));
            });
    return largest;
}

}  // namespace

TEST_CASE("radiance mips: the definition in double, dense and sparse, any resolution", "[voxel][radiance]")
{
    for (const int n : {1, 2, 4, 8, 16})
        for (const double density : {0.02, 0.4}) {
            VctSettings settings = float32();
            RadianceVolume volume = randomVolume(n, unsigned(n), density);
            buildRadianceMips(volume, settings);
            CHECK(largestError(volume, double(settings.facing)) < 1e-6);

            settings.storage = Storage::gpu;
            RadianceVolume half = randomVolume(n, unsigned(n), density);
            buildRadianceMips(half, settings);
            CHECK(largestError(half, double(settings.facing)) < 0x1p-10 * half.levels());
        }
}

TEST_CASE("radiance mips: bricks are held where voxels are, absent texels are 0", "[voxel][radiance]")
{
    RadianceVolume volume = volumeOf(
        32, [](int x, int y, int z) { return x == 9 && y == 20 && z == 3; }, [](int, int, int, Vec3& radiance, Vec3&) { radiance = Vec3(64.0f); });
    buildRadianceMips(volume, float32());
    for (int level = 0; level < volume.levels(); ++level) CHECK(volume.maps[std::size_t(level)].coordinate.size() == 2);
    for (int level = 1; level < volume.levels(); ++level) {
        float sum = 0.0f;
        forAll(volume, level, [&](int x, int y, int z) { sum += faceAt(volume, level, 0, x, y, z).x; });
        CHECK(sum * float(1 << (2 * level)) == 64.0f);
        CHECK(faceAt(volume, level, 0, 9 >> level, 20 >> level, 3 >> level).x > 0.0f);
    }
}

TEST_CASE("radiance mips: in a furnace each texel has its opacity's share of L", "[voxel][radiance]")
{
    for (const Storage storage : {Storage::float32, Storage::gpu}) {
        VctSettings settings = float32();
        settings.storage = storage;
        settings.facing = 2.0f;
        RadianceVolume volume = randomVolume(16, 7, 0.1);
        for (Vec4& texel : volume.base) texel = Vec4(3.0f * texel.w, 2.0f * texel.w, texel.w, texel.w);
        buildRadianceMips(volume, settings);
        for (int level = 1; level < volume.levels(); ++level)
            for (int d = 0; d < kTravelDirections; ++d)
                forAll(volume, level, [&](int x, int y, int z) {
                    const Vec4 texel = faceAt(volume, level, d, x, y, z);
                    const float tolerance = storage == Storage::gpu ? 0x1p-10f * float(level) : 1e-6f;
                    REQUIRE(std::abs(texel.x - 3.0f * texel.w) <= 3.0f * tolerance);
                    REQUIRE(std::abs(texel.z - texel.w) <= tolerance);
                });
    }
}

TEST_CASE("radiance mips: a plane one voxel thick is opaque across, and a' = a - a^2/2 along", "[voxel][radiance]")
{
    RadianceVolume volume = volumeOf(
        64, [](int x, int, int) { return x == 21; }, [](int, int, int, Vec3& radiance, Vec3& normal) { radiance = Vec3(1.0f), normal = Vec3(1, 0, 0); });
    buildRadianceMips(volume, float32());
    const double printed[] = {1.0, 0.5, 0.375, 0.305, 0.258, 0.225};
    double along = 1.0;
    for (int level = 1; level < volume.levels(); ++level) {
        along = level == 1 ? 0.5 : along - 0.5 * along * along;
        if (level < 6) CHECK(along == Approx(printed[level]).margin(5e-4));
        const int x = 21 >> level;
        CHECK(faceAt(volume, level, 0, x, 0, 0).w == 1.0f);
        CHECK(faceAt(volume, level, 1, x, 0, 0).w == 1.0f);
        for (int d = 2; d < 6; ++d) CHECK(double(faceAt(volume, level, d, x, 0, 0).w) == Approx(along).epsilon(1e-6));
        CHECK(faceAt(volume, level, 0, x, 0, 0).x == 0.0f);  // who travels along +x meets its back
        CHECK(faceAt(volume, level, 1, x, 0, 0).x == 1.0f);
    }
}

TEST_CASE("radiance mips: light in one layer across is kept, no world's light grows with the level", "[voxel][radiance]")
{
    const auto total = [](const RadianceVolume& volume, int level, int d) {
        double sum = 0.0;
        forAll(volume, level, [&](int x, int y, int z) { sum += double(faceAt(volume, level, d, x, y, z).y); });
        return sum * double(1 << (2 * level));
    };
    VctSettings settings = float32();
    settings.facing = 2.0f;
    std::mt19937 random(3);
    std::vector<bool> set(32 * 32);
    for (std::size_t i = 0; i < set.size(); ++i) set[i] = random() % 3 == 0;
    double lit = 0.0;
    RadianceVolume layer = volumeOf(
        32, [&](int x, int y, int z) { return z == 13 && set[std::size_t(32 * y + x)]; },
        [&](int x, int, int, Vec3& radiance, Vec3&) { radiance = Vec3(float(x)), lit += double(x); });
    buildRadianceMips(layer, settings);
    for (int level = 1; level < layer.levels(); ++level)
        for (const int d : {4, 5}) CHECK(total(layer, level, d) == Approx(lit).epsilon(1e-6));

    RadianceVolume volume = randomVolume(32, 11, 0.1);
    buildRadianceMips(volume, settings);
    for (int d = 0; d < kTravelDirections; ++d)
        for (int level = 2; level < volume.levels(); ++level) CHECK(total(volume, level, d) <= total(volume, level - 1, d) * (1.0 + 1e-6));
}

TEST_CASE("radiance mips: a mirrored world has mirrored volumes, bit for bit", "[voxel][radiance]")
{
    const RadianceVolume base = randomVolume(16, 5, 0.3);
    for (int axis = 0; axis < 3; ++axis) {
        const auto mirrored = [&](int x, int y, int z) {
            IVec3 p(x, y, z);
            p[axis] = 15 - p[axis];
            return p;
        };
        const auto at = [&](const IVec3& p) { return base.maps[0].texel(p.x, p.y, p.z); };
        RadianceVolume there = volumeOf(
            16, [&](int x, int y, int z) { return base.base[at(mirrored(x, y, z))].w > 0.0f; },
            [&](int x, int y, int z, Vec3& radiance, Vec3& normal) {
                radiance = Vec3(base.base[at(mirrored(x, y, z))]);
                normal = Vec3(base.normals[at(mirrored(x, y, z))]);
                normal[axis] = -normal[axis];
            });
        RadianceVolume here = base;
        buildRadianceMips(here, {});
        buildRadianceMips(there, {});
        for (int level = 1; level < here.levels(); ++level)
            for (int d = 0; d < kTravelDirections; ++d)
                forAll(here, level, [&](int x, int y, int z) {
                    IVec3 p(x, y, z);
                    p[axis] = here.maps[std::size_t(level)].resolution - 1 - p[axis];
                    REQUIRE(faceAt(here, level, d, x, y, z) == faceAt(there, level, d / 2 == axis ? d ^ 1 : d, p.x, p.y, p.z));
                });
    }
}

TEST_CASE("radiance volume: bytes as the paper counts them, and as predicted", "[voxel][radiance]")
{
    CHECK(RadianceVolume::predictGpuBytes(128) == 16u * 128 * 128 * 128 + 48u * (128u * 128 * 128 - 1) / 7);
    CHECK(double(RadianceVolume::predictGpuBytes(512)) == Approx(3067.8e6).epsilon(2e-5));
    for (const double density : {0.001, 0.5}) {
        RadianceVolume volume = randomVolume(32, 1, density);
        const std::size_t predicted = predictRadianceBytes(volume.maps);
        buildRadianceMips(volume, {});
        CHECK(bytesOf(volume) == predicted);
        CHECK(gpuBytesOf(volume) == RadianceVolume::predictGpuBytes(32));
        CHECK(predicted <= predictDenseRadianceBytes(32));
        if (density == 0.5) CHECK(predicted == predictDenseRadianceBytes(32));
    }
}

TEST_CASE("octree bytes: one voxel is a path from the root, a full grid has every node", "[voxel][radiance]")
{
    BitGrid bits;
    bits.grid.resolution = 16;
    bits.bricks.assign(predictBitGridBytes(16) / sizeof(std::uint64_t), 0);
    bits.bricks[bits.brickIndex(13, 2, 7)] = std::uint64_t(1) << BitGrid::bitIndex(13, 2, 7);
    CHECK(countOccupiedTexels(bits) == std::vector<std::size_t>{1, 1, 1, 1, 1});
    const OctreeBytes path = octreeBytes(countOccupiedTexels(bits), 16);
    CHECK(path.occupiedOnly == 16 + 4 * 52);
    CHECK(path.tilesOfEight == 8 * 16 + (1 + 3 * 8) * 52);
    CHECK(path.bricks == (1 + 3 * 8) * (36 + 27 * 16));

    bits.bricks.assign(bits.bricks.size(), ~std::uint64_t(0));
    CHECK(countOccupiedTexels(bits) == std::vector<std::size_t>{4096, 512, 64, 8, 1});
    const OctreeBytes full = octreeBytes(countOccupiedTexels(bits), 16);
    CHECK(full.tilesOfEight == full.occupiedOnly);
    CHECK(full.occupiedOnly == full.dense + 585 * 4);  // but for the links
}
