// Lookups are held against tents in double in apps/validate/equations/voxel_checks.cpp; here is what holds to the bit.
#include "voxel/sample_opacity.h"

#include "apps/validate/equations/synthetic_grids.h"

#include "catch.h"

#include <cstring>

using namespace lrsm;

namespace {

struct Kind {
    OpacityAxes axes;
    Storage storage;
    FilterFraction fraction;
};

std::vector<Kind> allKinds()
{
    std::vector<Kind> kinds;
    for (const auto axes : {OpacityAxes::isotropic, OpacityAxes::directional})
        for (const auto storage : {Storage::gpu, Storage::float32})
            for (const auto fraction : {FilterFraction::exact, FilterFraction::fixed8}) kinds.push_back({axes, storage, fraction});
    return kinds;
}

OpacityPyramid pyramidOf(const Kind& kind, BitGrid bits)
{
    return lrsm::pyramidOf(std::move(bits), kind.axes, kind.storage);
}

bool sameBits(const Vec3& a, const Vec3& b)
{
    return std::memcmp(&a, &b, sizeof a) == 0;
}

struct Random : SearchRandom {
    Random() : SearchRandom(11) {}
    Vec3 point(float low, float high)
    {
        const float x = uniform(low, high), y = uniform(low, high), z = uniform(low, high);
        return {x, y, z};
    }
};

}  // namespace

TEST_CASE("the order of operations is fixed: x, y, z, level, then the division by 255, bit for bit", "[voxel][sampler][determinism]")
{
    const auto lerp = [](float a, float b, float f) { return a + f * (b - a); };
    for (const Kind& kind : allKinds()) {
        if (kind.fraction == FilterFraction::fixed8) continue;
        const OpacityPyramid pyramid = pyramidOf(kind, randomGrid(32, 0.2, 8));
        const float unit = kind.storage == Storage::gpu ? 255.0f : 1.0f;
        const auto blend = [&](const Vec3& p, int level, int axis) {
            const int n = pyramid.resolutionAt(level), channel = level > 0 && pyramid.channels() == 3 ? axis : 0;
            float f[3], row[4];
            int c[3];
            for (int i = 0; i < 3; ++i) {
                const float t = p[i] / float(1 << level) - 0.5f;
                c[i] = int(std::floor(t));
                f[i] = t - std::floor(t);
            }
            const auto texel = [&](int x, int y, int z) {
                if (x < 0 || y < 0 || z < 0 || x >= n || y >= n || z >= n) return 0.0f;
                const float value = pyramid.value(level, channel, x, y, z);
                return kind.storage == Storage::gpu ? std::round(value * 255.0f) : value;
            };
            for (int k = 0; k < 4; ++k) row[k] = lerp(texel(c[0], c[1] + (k & 1), c[2] + k / 2), texel(c[0] + 1, c[1] + (k & 1), c[2] + k / 2), f[0]);
            return lerp(lerp(row[0], row[1], f[1]), lerp(row[2], row[3], f[1]), f[2]) * densityScale(pyramid, level);
        };
        Random random;
        int different = 0;
        for (int i = 0; i < 4000; ++i) {
            const Vec3 p = random.point(-1.0f, 33.0f);
            const float level = random.uniform(0.0f, 4.99f);
            const int lower = int(level);
            Vec3 expected;
            for (int axis = 0; axis < 3; ++axis) expected[axis] = lerp(blend(p, lower, axis), blend(p, lower + 1, axis), level - float(lower)) / unit;
            different += !sameBits(expected, sampleOpacity(pyramid, p, level, kind.fraction));
        }
        CHECK(different == 0);
    }
}

TEST_CASE("a texel's centre gives its stored value exactly, whole levels equal sampleLevel", "[voxel][sampler]")
{
    for (const Kind& kind : allKinds()) {
        const OpacityPyramid pyramid = pyramidOf(kind, randomGrid(32, 0.1, 5));
        int wrong = 0;
        for (int level = 0; level < pyramid.levels(); ++level) {
            const int n = pyramid.resolutionAt(level);
            for (int z = 0; z < n; ++z)
                for (int y = 0; y < n; ++y)
                    for (int x = 0; x < n; ++x) {
                        const Vec3 p = (Vec3(float(x), float(y), float(z)) + 0.5f) * float(1 << level);
                        const Vec3 got = sampleLevel(pyramid, p, level, kind.fraction);
                        for (int axis = 0; axis < 3; ++axis) {
                            const int channel = kind.axes == OpacityAxes::directional && level > 0 ? axis : 0;
                            wrong += got[axis] != pyramid.value(level, channel, x, y, z) * densityScale(pyramid, level);
                        }
                        wrong += !sameBits(got, sampleOpacity(pyramid, p, float(level), kind.fraction));
                    }
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("a constant field stays constant away from the border", "[voxel][sampler]")
{
    for (const Kind& kind : allKinds()) {
        const OpacityPyramid pyramid = pyramidOf(kind, gridOf(32, [](int, int, int) { return true; }));
        Random random;
        int wrong = 0;
        for (int i = 0; i < 2000; ++i) {
            const int level = i % 4;
            const float margin = 0.5f * float(1 << level);
            const Vec3 got = sampleLevel(pyramid, random.point(margin, 32.0f - margin), level, kind.fraction);
            wrong += !sameBits(got, Vec3(densityScale(pyramid, level)));
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("lookups stay within the texels they blend and are monotone from one texel to the next", "[voxel][sampler]")
{
    for (const Kind& kind : allKinds()) {
        const OpacityPyramid pyramid = pyramidOf(kind, randomGrid(32, 0.15, 6));
        Random random;
        int outside = 0, backwards = 0;
        for (int i = 0; i < 400; ++i) {
            const int level = int(random.word() % 4u), n = pyramid.resolutionAt(level);
            const int axis = int(random.word() % 3u);
            const float size = float(1 << level);
            Vec3 p;
            for (int k = 0; k < 3; ++k) p[k] = (float(random.word() % unsigned(n)) + 0.5f) * size;
            const Vec3 from = sampleLevel(pyramid, p, level, kind.fraction);
            Vec3 end = p;
            end[axis] += size;
            const Vec3 to = sampleLevel(pyramid, end, level, kind.fraction);
            Vec3 previous = from;
            for (int step = 1; step <= 600; ++step) {
                Vec3 q = p;
                q[axis] += size * (float(step) / 600.0f);
                const Vec3 got = sampleLevel(pyramid, q, level, kind.fraction);
                for (int c = 0; c < 3; ++c) {
                    outside += got[c] < std::min(from[c], to[c]) || got[c] > std::max(from[c], to[c]);
                    backwards += to[c] >= from[c] ? got[c] < previous[c] : got[c] > previous[c];
                }
                previous = got;
            }
        }
        CHECK(outside == 0);
        CHECK(backwards == 0);

        for (int i = 0; i < 4000; ++i) {
            const Vec3 got = sampleOpacity(pyramid, random.point(-2.0f, 34.0f), random.uniform(0.0f, 5.0f), kind.fraction);
            for (int c = 0; c < 3; ++c) outside += got[c] < 0.0f || got[c] > 1.0f;
        }
        CHECK(outside == 0);
    }
}

TEST_CASE("fixed8 knows 256 positions between two texels", "[voxel][sampler]")
{
    const Kind kind{OpacityAxes::isotropic, Storage::float32, FilterFraction::fixed8};
    const OpacityPyramid pyramid = pyramidOf(kind, gridOf(8, [](int x, int, int) { return x >= 4; }));
    int wrong = 0;
    for (int i = 0; i <= 4096; ++i) {
        const float got = sampleLevel(pyramid, Vec3(3.5f + float(i) / 4096.0f, 4.5f, 4.5f), 0, kind.fraction).x;
        wrong += got != std::floor(float(i) / 16.0f + 0.5f) / 256.0f;
    }
    CHECK(wrong == 0);
}

TEST_CASE("the empty-space shortcut changes no bit and finds what is empty", "[voxel][sampler][empty]")
{
    for (const Kind& kind : allKinds()) {
        for (const int n : {2, 8, 64}) {
            for (const double density : {0.0, 4.0 / (double(n) * n * n), 0.002}) {
                const OpacityPyramid fast = pyramidOf(kind, randomGrid(n, density, unsigned(n) + 3u));
                OpacityPyramid slow = fast;
                std::fill(slow.emptyLevels.begin(), slow.emptyLevels.end(), std::uint8_t(0));
                Random random;
                int different = 0;
                for (int i = 0; i < 1500; ++i) {
                    Vec3 p = random.point(-1.0f, float(n) + 1.0f);
                    if (i % 3 == 0) p = glm::round(p * 2.0f) * 0.5f;  // exactly on texel edges and centres
                    const float level = i % 2 ? random.uniform(0.0f, float(fast.levels() - 1)) : float(i / 2 % fast.levels());
                    different += !sameBits(sampleOpacity(fast, p, level, kind.fraction), sampleOpacity(slow, p, level, kind.fraction));
                }
                INFO(n << "^3, density " << density);
                CHECK(different == 0);
            }
        }
    }

    // One voxel in a corner of 64^3: a point 20 voxels away is known to be empty up to level 3 (8-voxel texels), not at level 5.
    const Kind kind{OpacityAxes::isotropic, Storage::gpu, FilterFraction::exact};
    const OpacityPyramid lone = pyramidOf(kind, gridOf(64, [](int x, int y, int z) { return x == 0 && y == 0 && z == 0; }));
    withOpacitySampler(lone, FilterFraction::exact, [](const auto& sample) {
        CHECK(sample.empty(Vec3(20.0f), 3.0f));
        CHECK_FALSE(sample.empty(Vec3(20.0f), 5.0f));
        CHECK(sample.empty(Vec3(6.0f), 1.0f));  // brick 1: levels 0 and 1 read voxels 2.. and 3..
        CHECK_FALSE(sample.empty(Vec3(6.0f), 2.0f));
        CHECK_FALSE(sample.empty(Vec3(1.0f), 0.0f));
        CHECK_FALSE(sample.empty(Vec3(-1.0f), 0.0f));  // outside: not asked
    });
}

TEST_CASE("far, infinite and NaN coordinates read the border", "[voxel][sampler]")
{
    const float bad[] = {1e30f, -1e30f, kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN(), 40.0f, -9.0f};
    for (const Kind& kind : allKinds()) {
        const OpacityPyramid pyramid = pyramidOf(kind, gridOf(16, [](int, int, int) { return true; }));
        for (const float b : bad)
            for (int axis = 0; axis < 3; ++axis) {
                Vec3 p(8.0f);
                p[axis] = b;
                CHECK(sampleOpacity(pyramid, p, 1.3f, kind.fraction) == Vec3(0.0f));
            }
        CHECK(sampleOpacity(pyramid, Vec3(8.0f), -5.0f, kind.fraction).x == 1.0f);
        CHECK(sameBits(sampleOpacity(pyramid, Vec3(8.0f), 99.0f, kind.fraction), sampleLevel(pyramid, Vec3(8.0f), 4, kind.fraction)));
    }
}
