// Fig. 7's cones: directions, apertures and weights, which the paper does not print.
#include "conetrace/frame/cones.h"

#include "apps/validate/equations/check_run.h"
#include "apps/validate/equations/closed_forms.h"

namespace lrsm {
namespace {

constexpr double kPiDouble = 3.14159265358979323846;

void checkSix(CheckRun& run)
{
    ConeSettings settings;
    settings.march.estimator = Estimator::paper;
    settings.set.count = 6;
    settings.set.apertureScale = 1.0f;
    settings.set.rotation = Rotation::none;
    const ConeSet set = makeConeSet(settings);
    const auto worst = exhaust(6, [&](std::uint64_t i) {
        if (set.rings.size() != 2 || set.directions.size() != 6 * kRotations) return 1.0;
        const ConeRing& ring = set.rings[i ? 1 : 0];
        const oracle::Cone expected = oracle::coneOfSix(static_cast<int>(i));
        double error = std::max(std::abs(double(ring.weight) - expected.weight), std::abs(double(ring.tanHalf) - expected.tanHalf));
        for (int c = 0; c < 3; ++c) error = std::max(error, std::abs(double(set.directions[i][c]) - expected.axis[c]));
        return error;
    });
    run.add({.equation = "fig7",
             .function = "makeConeSet, the paper's six",
             .oracle = "1/4 and 3/20, 60 degrees, axes by sine and cosine",
             .domain = "all six",
             .bound = {"kConeSetMaxError", double(kConeSetMaxError)}},
            worst, "cone " + exactText(worst.input[0]));
}

/// Any count: each ring's weights are the integral of the cosine over it (exact whatever the rings), directions stay in their own share.
void checkAll(CheckRun& run)
{
    const auto worst = exhaust(256 * 2 * 3, [&](std::uint64_t i) {
        ConeSettings settings;
        settings.set.count = 1 + static_cast<int>(i % 256);
        settings.march.estimator = i / 256 % 2 ? Estimator::slab : Estimator::paper;
        settings.set.rotation = static_cast<Rotation>(i / 512);
        settings.set.apertureScale = 1.0f;
        const ConeSet set = makeConeSet(settings);
        double error = 0.0, total = 0.0, angle = 0.0, placed = 0.0;
        for (const ConeRing& ring : set.rings) {
            // Equal polar width (paper) or equal weight 1/count (slab).
            const double rings = double(set.rings.size()), h = kPiDouble / 2 / (2 * rings - 1), index = double(&ring - set.rings.data());
            const bool slab = settings.march.estimator == Estimator::slab;
            const double outer = slab           ? std::asin(std::sqrt(std::min(1.0, (placed + ring.count) / settings.set.count)))
                                 : rings == 1.0 ? kPiDouble / 2
                                                : (2 * index + 1) * h;
            const double a = std::sin(angle), b = std::sin(outer), weight = (b * b - a * a) / ring.count;
            // The cosine of an angle near the horizon is what arccos loses: angles to the root of it.
            error = std::max({error, std::abs(double(ring.weight) - weight), 0.1 * std::abs(double(ring.outerAngle) - outer),
                              0.1 * std::abs(double(ring.innerAngle) - angle)});
            const double half = slab           ? std::acos(1.0 - (std::cos(angle) - std::cos(outer)) / ring.count)
                                : rings == 1.0 ? (ring.count == 1 ? kPiDouble / 3 : kPiDouble / 4)
                                               : h;
            error = std::max(error, 0.1 * std::abs(double(ring.tanHalf) / std::tan(std::min(half, 1.4)) - 1.0));
            if (slab) error = std::max(error, 0.1 * std::abs(double(ring.axisAngle) - 0.5 * (angle + outer)));
            if (!slab) error = std::max(error, std::abs(double(ring.axisAngle) - (rings == 1.0 ? (ring.count == 1 ? 0.0 : kPiDouble / 4) : 2 * index * h)));
            total += ring.count * double(ring.weight);
            placed += ring.count;
            angle = outer;
        }
        if (placed != settings.set.count) return 1.0;
        return std::max(error, 0.1 * std::abs(total - 1.0));
    });
    run.add({.equation = "fig7",
             .function = "makeConeSet, rings of any count",
             .oracle = "integral of the cosine over each ring",
             .domain = "1 .. 256 cones, both estimators, all rotations",
             .errorKind = "absolute weight; tenth of angles and sums",
             .bound = {"kConeSetMaxError", double(kConeSetMaxError)}},
            worst,
            "count = " + std::to_string(1 + static_cast<int>(worst.input[0]) % 256) + ", case " + std::to_string(static_cast<int>(worst.input[0]) / 256));

    // Strata: cosine-weighted and stratified, so 16 rotations together integrate a quadratic of the direction well.
    const auto strata = exhaust(64, [&](std::uint64_t i) {
        ConeSettings settings;
        settings.set.count = 1 + static_cast<int>(i);
        settings.march.estimator = Estimator::slab;
        settings.set.rotation = Rotation::strata;
        const ConeSet set = makeConeSet(settings);
        double error = 0.0, square = 0.0;
        for (int r = 0; r < kRotations; ++r)
            for (const ConeRing& ring : set.rings)
                for (int k = 0; k < ring.count; ++k) {
                    const glm::dvec3 d(set.rotation(r)[std::size_t(ring.first + k)]);
                    square += d.z * d.z / (kRotations * settings.set.count);
                    // The r-th point of the set lies at (r + 1/2) / 16 of its stratum's area, at the bit-reversed share of its azimuth.
                    const int reversed = ((r & 1) << 3) | ((r & 2) << 1) | ((r & 4) >> 1) | ((r & 8) >> 3);
                    const double r2 = (ring.first + ring.count * (r + 0.5) / 16.0) / settings.set.count,
                                 azimuth = 2.0 * kPiDouble * (k + (reversed + 0.5) / 16.0) / ring.count;
                    error = std::max({error, std::abs(d.x - std::sqrt(r2) * std::cos(azimuth)), std::abs(d.y - std::sqrt(r2) * std::sin(azimuth)),
                                      std::abs(d.x * d.x + d.y * d.y + d.z * d.z - 1.0)});
                }
        return std::max(error, std::abs(square - 0.5));  // E[cos^2] of a cosine-weighted direction; the midpoint rule is exact in r^2
    });
    run.add({.equation = "fig7",
             .function = "makeConeSet, strata",
             .oracle = "Malley's disc with a Hammersley set, in double",
             .domain = "1 .. 64 cones, all 16 rotations",
             .bound = {"kConeSetMaxError", double(kConeSetMaxError)}},
            strata, "count = " + std::to_string(1 + static_cast<int>(strata.input[0])));
}

/// How many cones a ring holds: by solid angle, rounded cumulatively; and which of the 16 sets a pixel takes: the 4x4 ordered-dither matrix.
void checkCounts(CheckRun& run)
{
    const auto counts = exhaust(256, [](std::uint64_t i) {
        const int count = 1 + static_cast<int>(i);
        if (count <= 4) return ringCounts(count) == std::vector<int>{count} ? 0.0 : 1.0;
        const int rings = std::max(2, static_cast<int>(std::floor(kPiDouble / 2 / std::sqrt(2 * kPiDouble / count) + 0.5)));
        const double h = kPiDouble / 2 / (2 * rings - 1);
        std::vector<int> expected = {1};
        for (int ring = 1, placed = 1; ring < rings; ++ring) {
            // Solid angle from the cap's edge to the ring's outer one, over all beyond the cap.
            const double share = (std::cos(h) - std::cos((2 * ring + 1) * h)) / std::cos(h);
            const int upTo = ring + 1 == rings ? count : 1 + static_cast<int>(std::floor((count - 1) * share + 0.5));
            expected.push_back(upTo - placed);
            placed = upTo;
        }
        return ringCounts(count) == expected ? 0.0 : 1.0;
    });
    run.add(exactCheck("fig7", "ringCounts", "shares of solid angle in double", "1 .. 256 cones"), counts, "count = 1 + " + exactText(counts.input[0]));
    const auto pattern = exhaust(64, [](std::uint64_t i) {
        constexpr int kBayer[4][4] = {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
        const int x = static_cast<int>(i % 8), y = static_cast<int>(i / 8);
        return rotationOfPixel(x, y, Rotation::strata) == kBayer[y % 4][x % 4] && rotationOfPixel(x, y, Rotation::none) == 0 ? 0.0 : 1.0;
    });
    run.add(exactCheck("fig7", "rotationOfPixel", "the 4x4 ordered-dither matrix, written out", "8x8 pixels"), pattern, "pixel " + exactText(pattern.input[0]));
}

void checkSpecular(CheckRun& run)
{
    const SearchSpace<float, 1> roughness{{{{0.0f, 1.0f}}}, {{1.0f}, {0.0f}, {0.7598357f}}};
    const auto worst = findWorst(
        roughness, run.budget(20000),
        [](const auto& in) {
            ConeSettings settings;
            settings.specular.aperture = SpecularAperture::roughness;
            const double exact = oracle::specularTanHalf(in[0]);
            settings.specular.aperture = SpecularAperture::roughness;
            const double error = std::abs(double(specularTanHalf(settings, in[0])) - exact);
            settings.specular.aperture = SpecularAperture::fixed;
            settings.specular.apertureDegrees = 1.0f + 159.0f * in[0];
            const double fixed = std::tan(double(settings.specular.apertureDegrees) * kPiDouble / 360.0);
            return std::max(error, std::abs(double(specularTanHalf(settings, 0.3f)) / fixed - 1.0));
        },
        821);
    run.add({.equation = "fig7",
             .function = "specularTanHalf",
             .oracle = "tan(2 atan(roughness^2)), at most tan 60 degrees; tan of half the fixed angle",
             .domain = "roughness 0 .. 1; 1 .. 160 degrees",
             .errorKind = "absolute; relative if fixed",
             .bound = {"kSpecularTanMaxError", double(kSpecularTanMaxError)}},
            worst, inputText<float, 1>({"roughness"}, worst.input));
}

}  // namespace

void checkConeSets(CheckRun& run)
{
    checkSix(run);
    checkAll(run);
    checkCounts(run);
    checkSpecular(run);
}

}  // namespace lrsm
