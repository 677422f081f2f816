#pragma once

#include "core/base/image.h"
#include "core/base/math.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

/// How far a picture is from the reference, in numbers. r: reference, t: test; sums run over the pixels that count and all three channels.
namespace lrsm {

/// Which pixels count: 1 in `valid` (all when empty), and finite in both pictures. What is not finite is counted apart.
using PixelMask = Image<std::uint8_t>;

struct Metrics {
    std::uint64_t pixels = 0;                                 ///< that the sums below are over
    std::uint64_t notFiniteTest = 0, notFiniteReference = 0;  ///< pixels with a NaN or infinity, left out of everything else
    double meanReference = 0.0, meanTest = 0.0;
    double energyRatio = 1.0;  ///< sum t / sum r: 1 + signed mean error; 1 where both are black, infinite where only r is
    std::array<double, 3> channelRatio{1.0, 1.0, 1.0};
    double rmse = 0.0;     ///< sqrt(mean (t - r)^2) / mean r
    double mae = 0.0;      ///< mean |t - r| / mean r
    double relMse = 0.0;   ///< mean over pixels of |t - r|^2 / (|r|^2 + 3 (0.01 mean r)^2), without the worst 0.1 % of the pixels
    double largest = 0.0;  ///< largest |t - r| / mean r
};
/// Pictures of one size; the mask of that size or empty.
Metrics measure(const Image<Vec3>& reference, const Image<Vec3>& test, const PixelMask& valid = {});

/// The rectangle [x0, x1) x [y0, y1) of a picture.
struct Region {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};
/// columns x rows rectangles that share out the picture, row by row.
std::vector<Region> splitRegions(int width, int height, int columns, int rows);

/// One region's errors; rmse and mae are over the mean of the whole reference, so that a dark corner does not shout.
struct RegionMetrics {
    Region region;
    std::uint64_t pixels = 0;
    double meanReference = 0.0, energyRatio = 1.0, rmse = 0.0, mae = 0.0;
};
std::vector<RegionMetrics> measureRegions(const Image<Vec3>& reference, const Image<Vec3>& test, const std::vector<Region>& regions,
                                          const PixelMask& valid = {});

/// Pixels in the middle of 17 x 17 that show one plane: 1 there. Unit normals and positions, both 0 where nothing was drawn.
PixelMask flatParts(const Image<Vec3>& normal, const Image<Vec3>& position);

/// Stripes and blotches: the error's part between 3 and 17 pixels wide on flat parts, where the true light has next to none: rms of (mean over 3 x 3 - mean
/// over 17 x 17) of t - r over those pixels, over the mean of r there; nothing where there are none. The truth's noise is in it.
std::optional<double> bandError(const Image<Vec3>& reference, const Image<Vec3>& test, const PixelMask& flat);

/// Peak signal-to-noise ratio in dB of pictures as shown: values in [0, 1], peak 1. Infinite for equal pictures.
double psnr(const Image<Vec3>& referenceShown, const Image<Vec3>& testShown);

/// Mean structural similarity of the luma of pictures as shown: Wang, Bovik, Sheikh and Simoncelli, "Image Quality Assessment", IEEE TIP 13(4), 2004;
/// Gaussian window of 11 x 11, sigma 1.5, K1 = 0.01, K2 = 0.03, dynamic range 1. At the borders the window is cut and renormalised.
double ssim(const Image<Vec3>& referenceShown, const Image<Vec3>& testShown);

}  // namespace lrsm
