#include "reference/metrics.h"

#include <cmath>

namespace lrsm {
namespace {

using DVec3 = glm::dvec3;

constexpr int kBandReach = 8;  ///< pixels

/// a / b with 0 / 0 = 1.
double ratio(double a, double b)
{
    return a == b ? 1.0 : a / b;
}

/// a / b with 0 / 0 = 0.
double share(double a, double b)
{
    return a == 0.0 ? 0.0 : a / b;
}

bool counts(const PixelMask& valid, std::size_t pixel)
{
    return valid.empty() || valid.texels[pixel] != 0;
}

double sum(const DVec3& v)
{
    return v.x + v.y + v.z;
}

double luma(const Vec3& v)
{
    return 0.2126 * double(v.x) + 0.7152 * double(v.y) + 0.0722 * double(v.z);
}

double meanRelativeSquare(const Image<Vec3>& reference, const Image<Vec3>& test, const std::vector<std::size_t>& pixels, double mean)
{
    constexpr double trimmed = 0.001;
    const double floor = 3.0 * (0.01 * mean) * (0.01 * mean);
    std::vector<double> errors;
    for (const std::size_t i : pixels) {
        const DVec3 r(reference.texels[i]), difference = DVec3(test.texels[i]) - r;
        errors.push_back(share(glm::dot(difference, difference), glm::dot(r, r) + floor));
    }
    std::sort(errors.begin(), errors.end());
    errors.resize(errors.size() - std::size_t(trimmed * double(errors.size())));
    double total = 0.0;
    for (const double error : errors) total += error;
    return share(total, double(errors.size()));
}

}  // namespace

Metrics measure(const Image<Vec3>& reference, const Image<Vec3>& test, const PixelMask& valid)
{
    Metrics m;
    DVec3 sumReference(0.0), sumTest(0.0);
    double squares = 0.0, absolutes = 0.0, largest = 0.0;
    std::vector<std::size_t> pixels;
    for (std::size_t i = 0; i < reference.texels.size(); ++i) {
        const bool finiteReference = isFinite(reference.texels[i]), finiteTest = isFinite(test.texels[i]);
        m.notFiniteReference += !finiteReference;  // counted wherever they are
        m.notFiniteTest += !finiteTest;
        if (!finiteReference || !finiteTest || !counts(valid, i)) continue;
        const DVec3 r(reference.texels[i]), t(test.texels[i]), difference = t - r, distance = glm::abs(difference);
        sumReference += r;
        sumTest += t;
        squares += glm::dot(difference, difference);
        absolutes += sum(distance);
        largest = std::max({largest, distance.x, distance.y, distance.z});
        pixels.push_back(i);
    }
    m.pixels = pixels.size();
    const double values = 3.0 * double(m.pixels);
    m.meanReference = share(sum(sumReference), values);
    m.meanTest = share(sum(sumTest), values);
    m.energyRatio = ratio(m.meanTest, m.meanReference);
    for (int c = 0; c < 3; ++c) m.channelRatio[std::size_t(c)] = ratio(sumTest[c], sumReference[c]);
    m.rmse = share(std::sqrt(share(squares, values)), m.meanReference);
    m.mae = share(share(absolutes, values), m.meanReference);
    m.largest = share(largest, m.meanReference);
    m.relMse = meanRelativeSquare(reference, test, pixels, m.meanReference);
    return m;
}

std::vector<Region> splitRegions(int width, int height, int columns, int rows)
{
    std::vector<Region> regions;
    const auto border = [](int size, int parts, int i) { return int(std::int64_t(size) * i / parts); };
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            regions.push_back({border(width, columns, x), border(height, rows, y), border(width, columns, x + 1), border(height, rows, y + 1)});
    return regions;
}

std::vector<RegionMetrics> measureRegions(const Image<Vec3>& reference, const Image<Vec3>& test, const std::vector<Region>& regions, const PixelMask& valid)
{
    const double mean = measure(reference, test, valid).meanReference;
    std::vector<RegionMetrics> result;
    for (const Region& region : regions) {
        RegionMetrics m{region};
        double sumReference = 0.0, sumTest = 0.0, squares = 0.0, absolutes = 0.0;
        for (int y = region.y0; y < region.y1; ++y)
            for (int x = region.x0; x < region.x1; ++x) {
                const std::size_t i = reference.index(x, y);
                if (!counts(valid, i) || !isFinite(reference.texels[i]) || !isFinite(test.texels[i])) continue;
                const DVec3 r(reference.texels[i]), t(test.texels[i]), difference = t - r;
                sumReference += sum(r);
                sumTest += sum(t);
                squares += glm::dot(difference, difference);
                absolutes += sum(glm::abs(difference));
                ++m.pixels;
            }
        const double values = 3.0 * double(m.pixels);
        m.meanReference = share(sumReference, values);
        m.energyRatio = ratio(sumTest, sumReference);
        m.rmse = share(std::sqrt(share(squares, values)), mean);
        m.mae = share(share(absolutes, values), mean);
        result.push_back(m);
    }
    return result;
}

PixelMask flatParts(const Image<Vec3>& normal, const Image<Vec3>& position)
{
    constexpr float sameCosine = 0.999f, offPlane = 0.01f;  // of the distance between the two points
    PixelMask flat(normal.width, normal.height);
    for (int y = kBandReach; y < normal.height - kBandReach; ++y)
        for (int x = kBandReach; x < normal.width - kBandReach; ++x) {
            const Vec3 n = normal.at(x, y), p = position.at(x, y);
            bool one = n != Vec3(0.0f);
            for (int dy = -kBandReach; one && dy <= kBandReach; ++dy)
                for (int dx = -kBandReach; one && dx <= kBandReach; ++dx) {
                    const Vec3 between = position.at(x + dx, y + dy) - p;
                    one = glm::dot(normal.at(x + dx, y + dy), n) > sameCosine && std::abs(glm::dot(between, n)) <= offPlane * glm::length(between);
                }
            flat.at(x, y) = one ? 1 : 0;
        }
    return flat;
}

std::optional<double> bandError(const Image<Vec3>& reference, const Image<Vec3>& test, const PixelMask& flat)
{
    double squares = 0.0, light = 0.0;
    std::uint64_t pixels = 0;
    const auto boxMean = [&](int x, int y, int reach) {
        DVec3 total(0.0);
        for (int dy = -reach; dy <= reach; ++dy)
            for (int dx = -reach; dx <= reach; ++dx) total += DVec3(test.at(x + dx, y + dy)) - DVec3(reference.at(x + dx, y + dy));
        return total / double((2 * reach + 1) * (2 * reach + 1));
    };
    for (int y = kBandReach; y < flat.height - kBandReach; ++y)
        for (int x = kBandReach; x < flat.width - kBandReach; ++x) {
            if (!flat.at(x, y)) continue;
            const DVec3 band = boxMean(x, y, 1) - boxMean(x, y, kBandReach);
            if (!std::isfinite(sum(band))) continue;
            squares += glm::dot(band, band);
            light += sum(DVec3(reference.at(x, y)));
            ++pixels;
        }
    if (pixels == 0 || light == 0.0) return {};
    const double count = 3.0 * double(pixels);
    return std::sqrt(squares / count) / (light / count);
}

double psnr(const Image<Vec3>& reference, const Image<Vec3>& test)
{
    double squares = 0.0;
    for (std::size_t i = 0; i < reference.texels.size(); ++i) {
        const DVec3 difference = DVec3(test.texels[i]) - DVec3(reference.texels[i]);
        squares += glm::dot(difference, difference);
    }
    return -10.0 * std::log10(squares / (3.0 * double(reference.texels.size())));
}

double ssim(const Image<Vec3>& reference, const Image<Vec3>& test)
{
    constexpr int radius = 5;
    constexpr double sigma = 1.5, c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    std::array<double, 2 * radius + 1> window{};
    for (int k = -radius; k <= radius; ++k) window[std::size_t(k + radius)] = std::exp(-k * k / (2.0 * sigma * sigma));

    // Moments under the window, separably: weight, x, y, x^2, y^2, xy.
    using Moments = std::array<double, 6>;
    const int width = reference.width, height = reference.height;
    Image<Moments> rows(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int k = std::max(-radius, -x); k <= std::min(radius, width - 1 - x); ++k) {
                const double w = window[std::size_t(k + radius)], r = luma(reference.at(x + k, y)), t = luma(test.at(x + k, y));
                const Moments terms = {w, w * r, w * t, w * r * r, w * t * t, w * r * t};
                for (std::size_t i = 0; i < 6; ++i) rows.at(x, y)[i] += terms[i];
            }
    double total = 0.0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            Moments m{};
            for (int k = std::max(-radius, -y); k <= std::min(radius, height - 1 - y); ++k)
                for (std::size_t i = 0; i < 6; ++i) m[i] += window[std::size_t(k + radius)] * rows.at(x, y + k)[i];
            const double r = m[1] / m[0], t = m[2] / m[0];
            const double varianceR = m[3] / m[0] - r * r, varianceT = m[4] / m[0] - t * t, covariance = m[5] / m[0] - r * t;
            total += (2 * r * t + c1) * (2 * covariance + c2) / ((r * r + t * t + c1) * (varianceR + varianceT + c2));
        }
    return total / (double(width) * double(height));
}

}  // namespace lrsm
