// Sec. 3.1: the opacity pyramid and its lookup.
#include "voxel/opacity_pyramid.h"

#include "apps/validate/equations/check_run.h"
#include "apps/validate/equations/synthetic_grids.h"
#include "apps/validate/equations/voxel_lookup.h"

namespace lrsm {
namespace {

/// UNORM8 of an exact value: round half up.
double stored(double exact, Storage storage)
{
    return storage == Storage::gpu ? std::floor(exact * 255.0 + 0.5) / 255.0 : exact;
}

/// Share of the (2^level)^2 columns along `axis` of a block that hold any occupied voxel.
double columnShare(const BitGrid& bits, int level, int axis, const IVec3& block)
{
    const int n = 1 << level;
    int hit = 0;
    for (int i = 0; i < n * n; ++i) {
        bool any = false;
        for (int k = 0; k < n && !any; ++k) {
            IVec3 p = block * n;
            p[axis] += k;
            p[(axis + 1) % 3] += i % n;
            p[(axis + 2) % 3] += i / n;
            any = bits.occupied(p.x, p.y, p.z);
        }
        hit += any ? 1 : 0;
    }
    return double(hit) / (n * n);
}

/// What a texel must hold, from the bits (directional levels 1 to 3) or from the stored level below.
double expectedTexel(const OpacityPyramid& pyramid, int level, int axis, const IVec3& p)
{
    if (pyramid.axes == OpacityAxes::directional && level <= 3) return stored(columnShare(pyramid.base, level, axis, p), pyramid.storage);
    double sum = 0.0, largest = 0.0;
    for (int k = 0; k < 8; ++k) {
        double child = double(pyramid.value(level - 1, axis, 2 * p.x + (k & 1), 2 * p.y + ((k >> 1) & 1), 2 * p.z + (k >> 2)));
        if (pyramid.storage == Storage::gpu) child = std::round(child * 255.0) / 255.0;  // the code, which the float stands for
        sum += child;
        largest = std::max(largest, child);
    }
    const double filtered = pyramid.mipFilter == MipFilter::mean ? sum / 8.0 : pyramid.mipFilter == MipFilter::max ? largest : std::min(1.0, sum / 4.0);
    return pyramid.storage == Storage::gpu ? std::floor(filtered * 255.0 + 0.5 + 1e-9) / 255.0 : filtered;
}

void checkLevels(CheckRun& run)
{
    Worst<double, 1> wrong;
    std::string at;
    for (const OpacityAxes axes : {OpacityAxes::isotropic, OpacityAxes::directional})
        for (const Storage storage : {Storage::gpu, Storage::float32})
            for (const MipFilter filter : {MipFilter::mean, MipFilter::coverage, MipFilter::max})
                for (const auto& [edge, density] : {std::pair(32, 0.003), {32, 0.1}, {32, 0.6}, {32, 1.0}, {2, 0.5}, {4, 0.3}, {8, 0.2}, {64, 0.002}}) {
                    const OpacityPyramid pyramid = pyramidOf(randomGrid(edge, density, 801), axes, storage, filter);
                    std::vector<IVec3> bad;
                    for (int level = 1; level < pyramid.levels(); ++level) {
                        const int n = edge >> level;
                        const auto found =
                            exhaust(std::uint64_t(n) * std::uint64_t(n) * std::uint64_t(n) * std::uint64_t(pyramid.channels()), [&](std::uint64_t i) {
                                const int c = pyramid.channels(), axis = static_cast<int>(i) % c, j = static_cast<int>(i) / c;
                                const IVec3 p(j % n, j / n % n, j / n / n);
                                // A float32 level adds its eight children in some order; a UNORM8 code is off by the division alone.
                                const double slack = 1.2e-7, expected = expectedTexel(pyramid, level, axis, p);
                                return std::abs(double(pyramid.value(level, axis, p.x, p.y, p.z)) - expected) <= slack * std::max(expected, 1e-3) ? 0.0 : 1.0;
                            });
                        if (found.error > wrong.error)
                            at = "axes " + std::to_string(int(axes)) + ", storage " + std::to_string(int(storage)) + ", filter " + std::to_string(int(filter)) +
                                 ", level " + std::to_string(level) + ", texel " + exactText(found.input[0]);
                        wrong.include(found);
                    }
                }
    run.add(exactCheck("sec3", "buildPyramid", "columns counted, means in double", "2^3 .. 64^3, density 0.002 .. 1, both axes, storages, all filters"), wrong,
            at);
    const auto scales = exhaust(6, [](std::uint64_t i) {
        OpacityPyramid pyramid;
        pyramid.axes = OpacityAxes::directional;
        constexpr float kScale[6] = {1.0f, 0.5f, 0.25f, 0.125f, 0.125f, 0.125f};
        const float directional = densityScale(pyramid, static_cast<int>(i));
        pyramid.axes = OpacityAxes::isotropic;
        return directional == kScale[i] && densityScale(pyramid, static_cast<int>(i)) == 1.0f ? 0.0 : 1.0;
    });
    run.add(exactCheck("sec3", "densityScale", "2^-min(level, 3)", "levels 0 .. 5"), scales, "level = " + exactText(scales.input[0]));
}

void checkLookup(CheckRun& run)
{
    Worst<float, 4> worst;
    std::string at;
    double nanoseconds = 0.0;
    for (const OpacityAxes axes : {OpacityAxes::isotropic, OpacityAxes::directional})
        for (const Storage storage : {Storage::gpu, Storage::float32}) {
            const OpacityPyramid pyramid = pyramidOf(randomGrid(32, 0.2, 811), axes, storage);
            SearchSpace<float, 4> space{{{{-1.0f, 33.0f}, {-1.0f, 33.0f}, {-1.0f, 33.0f}, {-0.5f, 5.5f}}}, {}};
            for (const float p : {0.0f, 0.5f, 4.0f, 16.5f, 31.5f, 32.0f})
                for (const float level : {0.0f, 1.0f, 2.5f, 5.0f}) space.planted.push_back({p, 16.0f, 32.0f - p, level});
            const auto found = findWorst(
                space, run.budget(25000),
                [&](const auto& in) {
                    const Vec3 got = sampleOpacity(pyramid, Vec3(in[0], in[1], in[2]), in[3], FilterFraction::exact);
                    const glm::dvec3 exact = oracle::lookup(pyramid, in);
                    return std::max({std::abs(double(got.x) - exact.x), std::abs(double(got.y) - exact.y), std::abs(double(got.z) - exact.z)});
                },
                812);
            if (found.error > worst.error)
                at = "axes " + std::to_string(int(axes)) + ", storage " + std::to_string(int(storage)) + ", " +
                     inputText<float, 4>({"x", "y", "z", "level"}, found.input);
            worst.include(found);
            nanoseconds = run.time(4096, [&](std::size_t i) {
                return sampleOpacity(pyramid, Vec3(float(i % 64) * 0.5f, float(i / 64) * 0.5f, 9.3f), 1.4f, FilterFraction::exact).x;
            });
        }
    run.add({.equation = "sec3",
             .function = "sampleOpacity",
             .oracle = "tents over the stored texels in double",
             .domain = "32^3 with its border, levels -0.5 .. 5.5, both axes and storages",
             .bound = {"kOpacityLookupMaxError", double(kOpacityLookupMaxError)},
             .nanoseconds = nanoseconds},
            worst, at);

    // Fractions in 1/256: less than half a step beside a lattice point is that point; on it the exact lookup is the answer.
    const OpacityPyramid pyramid = pyramidOf(randomGrid(32, 0.2, 811));
    const SearchSpace<float, 4> inside{{{{0.0f, 32.0f}, {0.0f, 32.0f}, {0.0f, 32.0f}, {0.0f, 5.0f}}}, {}};
    const auto snapped = findWorst(
        inside, run.budget(15000),
        [&](const std::array<float, 4>& in) {
            const int level = static_cast<int>(in[3]);
            const float step = std::ldexp(1.0f, level - 8);
            Vec3 p;
            for (int i = 0; i < 3; ++i) p[i] = std::floor(in[std::size_t(i)] / step) * step;
            const Vec3 on = sampleOpacity(pyramid, p, float(level), FilterFraction::fixed8),
                       exact = sampleOpacity(pyramid, p, float(level), FilterFraction::exact);
            const Vec3 beside = sampleOpacity(pyramid, p + Vec3(0.497f, -0.33f, 0.497f) * step, float(level), FilterFraction::fixed8);
            const float lod = std::floor(in[3] * 256.0f) / 256.0f;
            const auto atLevel = [&](float aside) { return sampleOpacity(pyramid, Vec3(16.5f), lod + aside / 256.0f, FilterFraction::fixed8); };
            return on == exact && on == beside && atLevel(0.497f) == atLevel(0.0f) && atLevel(-0.497f) == atLevel(0.0f) ? 0.0 : 1.0;
        },
        813);
    run.add(exactCheck("sec3", "sampleOpacity, fractions in 1/256", "the exact lookup at the nearest lattice point",
                       "lattice points of every level, and up to 0.497 of a step beside them"),
            snapped, inputText<float, 4>({"x", "y", "z", "level"}, snapped.input));
}

}  // namespace

void checkVoxels(CheckRun& run)
{
    checkLevels(run);
    checkLookup(run);
}

}  // namespace lrsm
