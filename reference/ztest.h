#pragma once

#include "reference/metrics.h"

/// Is the difference of two pictures more than the noise of the truth explains?
namespace lrsm {

struct ZTest {
    std::uint64_t values = 0;   ///< pixels times channels with a usable variance
    std::uint64_t certain = 0;  ///< values that differ although their variance is 0
    double rms = 0.0;           ///< sqrt(mean z^2); 1 when noise alone explains the difference and the variances are right
    double largest = 0.0;       ///< largest |z|
    double beyond3 = 0.0;       ///< fraction of |z| > 3; 0.0027 for Gaussian noise
    double noise = 0.0;         ///< sqrt(mean variance) / mean r: the truth's own RMSE / mean
    double pValue = 1.0;        ///< of the largest |z| among so many (Sidak's correction), Gaussian tails
};

/// z = (t - r) / sqrt(variance), per pixel and channel. `variance` is that of the difference: the reference's, plus the test's if it has one.
ZTest zTest(const Image<Vec3>& reference, const Image<Vec3>& test, const Image<Vec3>& variance, const PixelMask& valid = {});

/// Means over whole blocks of block x block pixels (cut ones at the border are dropped) and the variance of those means, for independent
/// pixels: the noise averages out and its tails become Gaussian, so that small systematic errors show. Values to feed zTest.
struct BlockMeans {
    Image<Vec3> reference, test, variance;
};
BlockMeans averageBlocks(const Image<Vec3>& reference, const Image<Vec3>& test, const Image<Vec3>& variance, int block, const PixelMask& valid = {});

}  // namespace lrsm
