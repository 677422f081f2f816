#include "reference/flip.h"

#include "core/base/parallel.h"

#include <cmath>
#include <numeric>
#include <vector>

namespace lrsm {
namespace {

using DVec3 = glm::dvec3;
constexpr double kPiD = 3.14159265358979323846;

// Color spaces (4.1). XYZ of the sRGB primaries under D65; GLM's matrices are given column by column.
const glm::dmat3 kXyzFromRgb(0.4123907992659595, 0.2126390058715104, 0.0193308187155918, 0.3575843393838780, 0.7151686787677559, 0.1191947797946260,
                             0.1804807884018343, 0.0721923153607337, 0.9505321522496608);

DVec3 whiteXyz()
{
    return kXyzFromRgb * DVec3(1.0);
}

/// YCxCz: CIELAB without its cube roots, so that filtering is linear.
DVec3 yCxCzFromRgb(const DVec3& rgb)
{
    const DVec3 n = (kXyzFromRgb * rgb) / whiteXyz();
    return {116.0 * n.y - 16.0, 500.0 * (n.x - n.y), 200.0 * (n.y - n.z)};
}

DVec3 rgbFromYCxCz(const DVec3& c)
{
    const double y = (c.x + 16.0) / 116.0;
    static const glm::dmat3 rgbFromXyz = glm::inverse(kXyzFromRgb);
    return rgbFromXyz * (DVec3(y + c.y / 500.0, y, y - c.z / 200.0) * whiteXyz());
}

/// CIELAB with the chroma scaled by the Hunt effect: colors look more colorful where it is bright.
DVec3 huntLabFromRgb(const DVec3& rgb)
{
    const DVec3 n = (kXyzFromRgb * rgb) / whiteXyz();
    constexpr double delta = 6.0 / 29.0;
    const auto f = [](double t) { return t > delta * delta * delta ? std::cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0; };
    const double l = 116.0 * f(n.y) - 16.0;
    return {l, 0.01 * l * 500.0 * (f(n.x) - f(n.y)), 0.01 * l * 200.0 * (f(n.y) - f(n.z))};
}

/// HyAB distance (4.1.3), which keeps its meaning for large differences.
double hyab(const DVec3& a, const DVec3& b)
{
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

/// Samples of f at -radius..radius pixels.
template <class F>
std::vector<double> kernel(int radius, const F& f)
{
    std::vector<double> values;
    for (int x = -radius; x <= radius; ++x) values.push_back(f(double(x)));
    return values;
}

double total(const std::vector<double>& values)
{
    return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Convolution along x, then along y; pixels beyond the border repeat it.
Image<double> convolve(const Image<double>& image, const std::vector<double>& alongX, const std::vector<double>& alongY)
{
    const int radiusX = int(alongX.size()) / 2, radiusY = int(alongY.size()) / 2;
    Image<double> rows(image.width, image.height), result(image.width, image.height);
    parallelFor(std::size_t(image.height), 8, [&](std::size_t begin, std::size_t end) {
        for (int y = int(begin); y < int(end); ++y)
            for (int x = 0; x < image.width; ++x) {
                double sum = 0.0;
                for (int k = -radiusX; k <= radiusX; ++k) sum += alongX[std::size_t(k + radiusX)] * image.at(std::clamp(x + k, 0, image.width - 1), y);
                rows.at(x, y) = sum;
            }
    });
    parallelFor(std::size_t(image.height), 8, [&](std::size_t begin, std::size_t end) {
        for (int y = int(begin); y < int(end); ++y)
            for (int x = 0; x < image.width; ++x) {
                double sum = 0.0;
                for (int k = -radiusY; k <= radiusY; ++k) sum += alongY[std::size_t(k + radiusY)] * rows.at(x, std::clamp(y + k, 0, image.height - 1));
                result.at(x, y) = sum;
            }
    });
    return result;
}

/// One term of a contrast sensitivity function in the image plane (4.1.1): a sqrt(pi/b) exp(-pi^2 x^2 / b), x in degrees.
struct CsfTerm {
    double a, b;
};

/// The eye's low-pass filter for one channel: a sum of two-dimensional Gaussians of total weight 1.
Image<double> filterByCsf(const Image<double>& channel, const std::vector<CsfTerm>& terms, double pixelsPerDegree)
{
    constexpr double widest = 0.04;  // the largest b of all channels sets the radius: three standard deviations
    const int radius = int(std::ceil(3.0 * std::sqrt(widest / (2.0 * kPiD * kPiD)) * pixelsPerDegree));
    std::vector<std::vector<double>> kernels;
    double weight = 0.0;
    for (const CsfTerm& term : terms) {
        kernels.push_back(kernel(radius, [&](double x) {
            const double degrees = x / pixelsPerDegree;
            return std::sqrt(term.a * std::sqrt(kPiD / term.b)) * std::exp(-kPiD * kPiD * degrees * degrees / term.b);
        }));
        weight += total(kernels.back()) * total(kernels.back());
    }
    Image<double> sum(channel.width, channel.height);
    for (const std::vector<double>& k : kernels) {
        const Image<double> part = convolve(channel, k, k);
        for (std::size_t i = 0; i < sum.texels.size(); ++i) sum.texels[i] += part.texels[i] / weight;
    }
    return sum;
}

Image<double> channelOf(const Image<Vec3>& picture, int component)
{
    Image<double> channel(picture.width, picture.height);
    for (std::size_t i = 0; i < channel.texels.size(); ++i) channel.texels[i] = yCxCzFromRgb(DVec3(picture.texels[i]))[component];
    return channel;
}

/// What the eye sees of the colors: filtered, back in the display's gamut, perceptually uniform.
Image<DVec3> seenColors(const Image<Vec3>& picture, double pixelsPerDegree)
{
    const Image<double> achromatic = filterByCsf(channelOf(picture, 0), {{1.0, 0.0047}}, pixelsPerDegree);
    const Image<double> redGreen = filterByCsf(channelOf(picture, 1), {{1.0, 0.0053}}, pixelsPerDegree);
    const Image<double> blueYellow = filterByCsf(channelOf(picture, 2), {{34.1, 0.04}, {13.5, 0.025}}, pixelsPerDegree);
    Image<DVec3> seen(picture.width, picture.height);
    for (std::size_t i = 0; i < seen.texels.size(); ++i) {
        const DVec3 rgb = rgbFromYCxCz({achromatic.texels[i], redGreen.texels[i], blueYellow.texels[i]});
        seen.texels[i] = huntLabFromRgb(glm::clamp(rgb, DVec3(0.0), DVec3(1.0)));
    }
    return seen;
}

/// Color difference in [0, 1] (4.1.4): HyAB^0.7, its small part stretched over [0, 0.95].
double colorError(const DVec3& a, const DVec3& b, double largest)
{
    constexpr double exponent = 0.7, knee = 0.4, kneeError = 0.95;
    const double distance = std::pow(hyab(a, b), exponent);
    if (distance < knee * largest) return kneeError / (knee * largest) * distance;
    return kneeError + (distance - knee * largest) / (largest - knee * largest) * (1.0 - kneeError);
}

/// Scales the positive values to sum 1 and the negative ones to sum -1.
void balance(std::vector<double>& values)
{
    double positive = 0.0, negative = 0.0;
    for (const double v : values) (v > 0.0 ? positive : negative) += v;
    for (double& v : values) v /= v > 0.0 ? positive : -negative;
}

/// Strength of edges and points in the achromatic channel (4.2): first and second derivatives of a Gaussian.
struct Features {
    Image<double> edge, point;
};
Features detectFeatures(const Image<Vec3>& picture, double pixelsPerDegree)
{
    constexpr double widthDegrees = 0.082;
    const double sd = 0.5 * widthDegrees * pixelsPerDegree;
    const int radius = int(std::ceil(3.0 * sd));
    const auto gaussian = [&](double x) { return std::exp(-x * x / (2.0 * sd * sd)); };
    std::vector<double> smooth = kernel(radius, gaussian), first = kernel(radius, [&](double x) { return -x * gaussian(x); }),
                        second = kernel(radius, [&](double x) { return (x * x / (sd * sd) - 1.0) * gaussian(x); });
    const double smoothTotal = total(smooth);
    for (double& v : smooth) v /= smoothTotal;
    balance(first);
    balance(second);

    Image<double> y = channelOf(picture, 0);
    for (double& v : y.texels) v = (v + 16.0) / 116.0;
    const auto magnitude = [&](const std::vector<double>& derivative) {
        Image<double> alongX = convolve(y, derivative, smooth);
        const Image<double> alongY = convolve(y, smooth, derivative);
        for (std::size_t i = 0; i < alongX.texels.size(); ++i) alongX.texels[i] = std::hypot(alongX.texels[i], alongY.texels[i]);
        return alongX;
    };
    return {magnitude(first), magnitude(second)};
}

Image<Vec3> clipped(const Image<Vec3>& picture)
{
    Image<Vec3> result = picture;
    for (Vec3& v : result.texels)
        for (int c = 0; c < 3; ++c) v[c] = v[c] > 0.0f ? std::min(v[c], 1.0f) : 0.0f;  // NaN fails the comparison
    return result;
}

/// Coefficients of the ACES fit with the exposure of 0.6 built in: (a x^2 + b x) / (c x^2 + d x + e).
constexpr double kAcesA = 0.6 * 0.6 * 2.51, kAcesB = 0.6 * 0.03, kAcesC = 0.6 * 0.6 * 2.43, kAcesD = 0.6 * 0.59, kAcesE = 0.14;

Image<Vec3> toneMapped(const Image<Vec3>& picture, double stops)
{
    const double gain = std::exp2(stops);
    Image<Vec3> result = picture;
    for (Vec3& v : result.texels)
        for (int c = 0; c < 3; ++c) {
            const double x = gain * std::max(double(v[c]), 0.0);
            v[c] = std::isinf(x) ? 1.0f : float((kAcesA * x * x + kAcesB * x) / (kAcesC * x * x + kAcesD * x + kAcesE));
        }
    return result;
}

}  // namespace

Image<float> flip(const Image<Vec3>& referenceIn, const Image<Vec3>& testIn, double pixelsPerDegree)
{
    const Image<Vec3> reference = clipped(referenceIn), test = clipped(testIn);
    const Image<DVec3> seenReference = seenColors(reference, pixelsPerDegree), seenTest = seenColors(test, pixelsPerDegree);
    const Features inReference = detectFeatures(reference, pixelsPerDegree), inTest = detectFeatures(test, pixelsPerDegree);
    const double largest = std::pow(hyab(huntLabFromRgb({0, 1, 0}), huntLabFromRgb({0, 0, 1})), 0.7);

    Image<float> errors(reference.width, reference.height);
    for (std::size_t i = 0; i < errors.texels.size(); ++i) {
        const double feature =
            std::max(std::abs(inReference.edge.texels[i] - inTest.edge.texels[i]), std::abs(inReference.point.texels[i] - inTest.point.texels[i]));
        const double featureError = std::clamp(std::sqrt(feature / std::sqrt(2.0)), 0.0, 1.0);
        errors.texels[i] = float(std::pow(colorError(seenReference.texels[i], seenTest.texels[i], largest), 1.0 - featureError));
    }
    return errors;
}

FlipExposures automaticFlipExposures(const Image<Vec3>& reference)
{
    // x where the tone curve reaches 0.85: (a - 0.85 c) x^2 + (b - 0.85 d) x - 0.85 e = 0.
    constexpr double level = 0.85, a = kAcesA - level * kAcesC, b = kAcesB - level * kAcesD, c = -level * kAcesE;
    const double x = (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);

    std::vector<double> luminances;
    for (const Vec3& v : reference.texels) {
        const double y = (kXyzFromRgb * DVec3(v)).y;
        if (std::isfinite(y)) luminances.push_back(y);
    }
    if (luminances.empty()) return {0.0, 0.0, 1};
    std::sort(luminances.begin(), luminances.end());
    const double brightest = luminances.back(), median = std::max(luminances[luminances.size() / 2], 1e-4 * brightest);
    if (!(brightest > 0.0)) return {0.0, 0.0, 1};
    const double start = std::log2(x / brightest), stop = std::log2(x / median);
    return {start, stop, std::max(2, int(std::ceil(stop - start)))};
}

Image<float> hdrFlip(const Image<Vec3>& reference, const Image<Vec3>& test, const FlipExposures& exposures, double pixelsPerDegree)
{
    Image<float> errors(reference.width, reference.height);
    for (int e = 0; e < exposures.count; ++e) {
        const double stops = exposures.count == 1 ? exposures.start : exposures.start + (exposures.stop - exposures.start) * e / (exposures.count - 1);
        const Image<float> at = flip(toneMapped(reference, stops), toneMapped(test, stops), pixelsPerDegree);
        for (std::size_t i = 0; i < errors.texels.size(); ++i) errors.texels[i] = std::max(errors.texels[i], at.texels[i]);
    }
    return errors;
}

FlipPool poolFlip(const Image<float>& errors)
{
    std::vector<float> sorted = errors.texels;
    std::sort(sorted.begin(), sorted.end());
    const double sum = std::accumulate(sorted.begin(), sorted.end(), 0.0);
    const auto quantile = [&](double fraction) {
        double running = 0.0;
        for (const float error : sorted) {
            running += double(error);
            if (running >= fraction * sum) return double(error);
        }
        return sorted.empty() ? 0.0 : double(sorted.back());
    };
    FlipPool pool;
    if (sorted.empty()) return pool;
    pool.mean = sum / double(sorted.size());
    pool.weightedMedian = quantile(0.5);
    pool.firstWeightedQuartile = quantile(0.25);
    pool.thirdWeightedQuartile = quantile(0.75);
    pool.min = double(sorted.front());
    pool.max = double(sorted.back());
    return pool;
}

}  // namespace lrsm
