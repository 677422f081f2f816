#include "reference/flip.h"
#include "reference/metrics.h"
#include "reference/ztest.h"

#include "core/base/rng.h"

#include "catch.h"

#include <limits>

using namespace lrsm;

/// A picture with edges, gradients and colors.
static Image<Vec3> testPicture(int width = 96, int height = 64)
{
    Image<Vec3> picture(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float checker = ((x / 7) + (y / 5)) % 2 ? 0.55f : 0.15f;
            picture.at(x, y) = Vec3(checker, 0.2f + 0.5f * float(x) / float(width), 0.1f + 0.3f * float(y) / float(height));
        }
    return picture;
}

TEST_CASE("metrics of a picture with itself are those of no error", "[reference][metrics]")
{
    const Image<Vec3> picture = testPicture();
    const Metrics m = measure(picture, picture);
    CHECK(m.energyRatio == 1.0);
    CHECK(m.rmse == 0.0);
    CHECK(m.mae == 0.0);
    CHECK(m.relMse == 0.0);
    CHECK(psnr(picture, picture) == std::numeric_limits<double>::infinity());
    CHECK(ssim(picture, picture) == Approx(1.0).epsilon(1e-12));
    CHECK(poolFlip(flip(picture, picture)).max == 0.0);
}

TEST_CASE("planted: a gain of 2 % shows as energy, rmse over quadratic mean, and psnr in closed form", "[reference][metrics]")
{
    const Image<Vec3> picture = testPicture();
    Image<Vec3> gained = picture;
    double squares = 0.0, sum = 0.0;
    for (Vec3& v : gained.texels) {
        for (int c = 0; c < 3; ++c) {
            squares += double(v[c]) * double(v[c]);
            sum += double(v[c]);
        }
        v *= 1.02f;
    }
    const double values = 3.0 * double(picture.texels.size());
    const Metrics m = measure(picture, gained);
    CHECK(m.energyRatio == Approx(1.02).epsilon(1e-6));
    CHECK(m.rmse == Approx(0.02 * std::sqrt(squares / values) / (sum / values)).epsilon(1e-5));
    CHECK(m.mae == Approx(0.02).epsilon(1e-5));
    CHECK(psnr(picture, gained) == Approx(-10 * std::log10(4e-4 * squares / values)).epsilon(1e-4));
    for (const RegionMetrics& region : measureRegions(picture, gained, splitRegions(96, 64, 4, 4))) CHECK(region.energyRatio == Approx(1.02).epsilon(1e-6));
}

TEST_CASE("planted: a shift by one pixel is seen by every metric of structure, not by energy", "[reference][metrics]")
{
    const Image<Vec3> picture = testPicture();
    Image<Vec3> shifted = picture;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x) shifted.at(x, y) = picture.at((x + 95) % 96, y);
    const Metrics m = measure(picture, shifted);
    CHECK(m.energyRatio == Approx(1.0).epsilon(1e-6));
    CHECK(m.rmse > 0.1);
    CHECK(ssim(picture, shifted) < 0.95);
    CHECK(poolFlip(flip(picture, shifted)).mean > 0.03);
}

TEST_CASE("planted: a swapped channel is seen by the channels' energy, not by the whole's", "[reference][metrics]")
{
    const Image<Vec3> picture = testPicture();
    Image<Vec3> swapped = picture;
    for (Vec3& v : swapped.texels) std::swap(v.r, v.b);
    const Metrics m = measure(picture, swapped);
    CHECK(m.energyRatio == Approx(1.0).epsilon(1e-6));
    CHECK(std::abs(m.channelRatio[0] - 1.0) > 0.2);
    CHECK(m.channelRatio[1] == 1.0);
    CHECK(m.rmse > 0.1);
    CHECK(poolFlip(flip(picture, swapped)).mean > 0.1);
}

TEST_CASE("planted: one NaN pixel is counted and poisons no number", "[reference][metrics]")
{
    const Image<Vec3> picture = testPicture();
    Image<Vec3> broken = picture;
    broken.at(5, 7).g = std::numeric_limits<float>::quiet_NaN();
    const Metrics m = measure(picture, broken);
    CHECK(m.notFiniteTest == 1);
    CHECK(m.notFiniteReference == 0);
    CHECK(m.pixels == picture.texels.size() - 1);
    CHECK(m.rmse == 0.0);
    CHECK(std::isfinite(poolFlip(flip(picture, broken)).mean));
    CHECK(std::isfinite(poolFlip(hdrFlip(picture, broken, {-1, 1, 2})).mean));
    CHECK(measure(broken, picture).notFiniteReference == 1);
}

TEST_CASE("planted: a missing strip stands out in its region and in FLIP's weighted median", "[reference][metrics]")
{
    const Image<Vec3> picture = testPicture();
    Image<Vec3> missing = picture;
    for (int y = 0; y < 16; ++y)
        for (int x = 48; x < 72; ++x) missing.at(x, y) = Vec3(0.02f);
    const auto regions = measureRegions(picture, missing, splitRegions(96, 64, 4, 4));
    for (std::size_t i = 0; i < regions.size(); ++i) {
        CAPTURE(i);
        if (i == 2)
            CHECK(regions[i].energyRatio < 0.1);
        else
            CHECK(regions[i].energyRatio == 1.0);
    }
    const FlipPool pool = poolFlip(flip(picture, missing));
    CHECK(pool.weightedMedian > 0.3);
    CHECK(pool.weightedMedian > 3.0 * pool.mean);
}

TEST_CASE("regions share out the picture exactly", "[reference][metrics]")
{
    const auto regions = splitRegions(101, 67, 4, 3);
    Image<int> covered(101, 67);
    for (const Region& r : regions)
        for (int y = r.y0; y < r.y1; ++y)
            for (int x = r.x0; x < r.x1; ++x) ++covered.at(x, y);
    CHECK(std::all_of(covered.texels.begin(), covered.texels.end(), [](int n) { return n == 1; }));
}

TEST_CASE("pixels outside the mask count nowhere", "[reference][metrics]")
{
    const Image<Vec3> picture = testPicture();
    Image<Vec3> other = picture;
    PixelMask mask(96, 64, 1);
    for (int x = 0; x < 96; ++x) {
        other.at(x, 3) = Vec3(9.0f);
        mask.at(x, 3) = 0;
    }
    CHECK(measure(picture, other, mask).rmse == 0.0);
    CHECK(measure(picture, other).rmse > 0.0);
}

TEST_CASE("ssim of independent noise added to a flat picture follows its formula", "[reference][metrics]")
{
    // Both pictures: luma 0.5 plus independent noise of variance s: (2 m^2 + C1)(0 + C2) / ((2 m^2 + C1)(2 s + C2)), covariance 0 in the mean.
    Image<Vec3> a(128, 128), b(128, 128);
    for (std::uint32_t i = 0; i < a.texels.size(); ++i) {
        const Philox4 w = philox({i, 0, 0, 0}, {1, 2});
        a.texels[i] = Vec3(0.5f + 0.1f * (unitFloat(w[0]) - 0.5f));
        b.texels[i] = Vec3(0.5f + 0.1f * (unitFloat(w[1]) - 0.5f));
    }
    // The window's weights (sum of squares 0.035) take their share off the variance.
    const double s = 0.01 / 12.0 * (1.0 - 0.035);
    CHECK(ssim(a, b) == Approx(0.0009 / (2 * s + 0.0009)).epsilon(0.08));
}

TEST_CASE("z-test: noise of the stated variance passes, half of it hidden or a gain fails", "[reference][ztest]")
{
    const Image<Vec3> truth = testPicture();
    Image<Vec3> noisy = truth, variance(96, 64, Vec3(1e-4f));
    for (std::uint32_t i = 0; i < noisy.texels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            // Sum of 12 uniforms: variance 1, tails lighter than Gaussian.
            float sum = -6.0f;
            for (std::uint32_t k = 0; k < 3; ++k)
                for (const std::uint32_t word : philox({i, std::uint32_t(c), k, 0}, {3, 4})) sum += unitFloat(word);
            noisy.texels[i][c] += 0.01f * sum;
        }
    const ZTest z = zTest(noisy, truth, variance);
    CHECK(z.values == 96u * 64u * 3u);
    CHECK(z.rms == Approx(1.0).margin(6.5 / std::sqrt(2.0 * 96 * 64 * 3)));  // 6.5 standard errors
    CHECK(z.beyond3 < 0.006);
    CHECK(z.pValue > 1e-6);
    CHECK(z.noise == Approx(0.01 / measure(noisy, truth).meanReference).epsilon(1e-4));

    Image<Vec3> gained = truth;
    for (Vec3& v : gained.texels) v *= 1.02f;
    // 2 % of 0.35 is less than one standard error of a pixel, and 8 x 8 pixels' mean tells it all the same.
    const BlockMeans blocks = averageBlocks(noisy, gained, variance, 8);
    CHECK(zTest(blocks.reference, blocks.test, blocks.variance).rms > 3.0);
    CHECK(zTest(noisy, truth, Image<Vec3>(96, 64, Vec3(2.5e-5f))).rms > 1.9);
    CHECK(zTest(noisy, truth, Image<Vec3>(96, 64)).certain > 0);
}

TEST_CASE("automatic exposures bring the brightest and the median pixel to 0.85 of the tone curve", "[reference][flip]")
{
    Image<Vec3> picture(5, 1);
    for (int x = 0; x < 5; ++x) picture.at(x, 0) = Vec3(std::exp2(float(x)));  // median 4, brightest 16
    const FlipExposures e = automaticFlipExposures(picture);
    CHECK(e.stop - e.start == Approx(2.0));
    CHECK(e.count == 2);
    const double x = 16.0 * std::exp2(e.start) * 0.6;
    CHECK((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14) == Approx(0.85).epsilon(1e-6));
    CHECK(automaticFlipExposures(Image<Vec3>(4, 4)) == FlipExposures{0, 0, 1});
}

TEST_CASE("band error: a stripe on a flat part counts, a slope, an offset and what is not flat do not", "[reference][metrics][band]")
{
    constexpr int n = 64;
    Image<Vec3> normal(n, n, Vec3(0, 0, 1)), position(n, n), reference(n, n, Vec3(2)), test = reference;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) position.at(x, y) = Vec3(x, y, 0);
    const PixelMask flat = flatParts(normal, position);
    CHECK(flat.at(8, 8) == 1);
    CHECK(flat.at(7, 30) == 0);
    CHECK(flat.at(n - 9, n - 9) == 1);

    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) test.at(x, y) = Vec3(3.0f + 0.01f * float(x));
    CHECK(bandError(reference, test, flat).value() == Approx(0.0).margin(1e-6));

    // A wave of 12 pixels: a mean over 2 k + 1 pixels leaves sin((2 k + 1) a) / ((2 k + 1) sin a) of it, a = pi / 12.
    const double a = 3.14159265358979 / 12, kept = std::sin(3 * a) / (3 * std::sin(a)) - std::sin(17 * a) / (17 * std::sin(a));
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) test.at(x, y) = Vec3(2.0f + 0.2f * float(std::sin(2 * a * x)));
    CHECK(bandError(reference, test, flat).value() == Approx(0.1 * kept / std::sqrt(2.0)).epsilon(0.01));

    for (int y = 0; y < n; ++y) normal.at(32, y) = Vec3(1, 0, 0);
    const PixelMask parted = flatParts(normal, position);
    CHECK(parted.at(24, 30) == 0);
    CHECK(parted.at(23, 30) == 1);
    CHECK_FALSE(bandError(reference, test, PixelMask(n, n)).has_value());
    for (int y = 0; y < n; ++y)
        for (int x = 40; x < n; ++x) position.at(x, y).z = 5.0f;
    CHECK(flatParts(normal, position).at(41, 30) == 0);
}
