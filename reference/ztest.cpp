#include "reference/ztest.h"

#include <cmath>

namespace lrsm {
namespace {

constexpr double kStorage = 0x1p-22;  // relative; two roundings of a mean and one of its variance

}  // namespace

ZTest zTest(const Image<Vec3>& reference, const Image<Vec3>& test, const Image<Vec3>& variance, const PixelMask& valid)
{
    ZTest result;
    double squares = 0.0, variances = 0.0, sum = 0.0;
    std::uint64_t beyond3 = 0, all = 0;
    for (std::size_t i = 0; i < reference.texels.size(); ++i) {
        if ((!valid.empty() && !valid.texels[i]) || !isFinite(reference.texels[i]) || !isFinite(test.texels[i])) continue;
        for (int c = 0; c < 3; ++c) {
            const double r = double(reference.texels[i][c]), difference = double(test.texels[i][c]) - r, v = double(variance.texels[i][c]);
            if (!std::isfinite(v)) continue;
            ++all;
            variances += v;
            sum += r;
            // Below what float32 storage can tell apart there is no noise to measure by.
            if (!(v > kStorage * kStorage * r * r) || !(v > 0.0)) {
                result.certain += std::abs(difference) > kStorage * std::abs(r);
                continue;
            }
            const double z2 = difference * difference / v;
            ++result.values;
            squares += z2;
            beyond3 += z2 > 9.0;
            result.largest = std::max(result.largest, std::sqrt(z2));
        }
    }
    if (all > 0 && variances > 0.0) result.noise = std::sqrt(variances / double(all)) / (sum / double(all));
    if (result.values == 0) return result;
    const auto n = double(result.values);
    result.rms = std::sqrt(squares / n);
    result.beyond3 = double(beyond3) / n;
    // 1 - (1 - p)^n without cancellation.
    result.pValue = -std::expm1(n * std::log1p(-std::min(std::erfc(result.largest / std::sqrt(2.0)), 1.0 - 1e-16)));
    return result;
}

BlockMeans averageBlocks(const Image<Vec3>& reference, const Image<Vec3>& test, const Image<Vec3>& variance, int block, const PixelMask& valid)
{
    const int columns = reference.width / block, rows = reference.height / block;
    BlockMeans means{{columns, rows}, {columns, rows}, {columns, rows}};
    for (int by = 0; by < rows; ++by)
        for (int bx = 0; bx < columns; ++bx) {
            glm::dvec3 r(0.0), t(0.0), v(0.0);
            double count = 0.0;
            for (int y = by * block; y < (by + 1) * block; ++y)
                for (int x = bx * block; x < (bx + 1) * block; ++x) {
                    const std::size_t i = reference.index(x, y);
                    if (!valid.empty() && !valid.texels[i]) continue;
                    r += glm::dvec3(reference.texels[i]);
                    t += glm::dvec3(test.texels[i]);
                    v += glm::dvec3(variance.texels[i]);
                    ++count;
                }
            if (count == 0.0) continue;
            means.reference.at(bx, by) = Vec3(r / count);
            means.test.at(bx, by) = Vec3(t / count);
            means.variance.at(bx, by) = Vec3(v / (count * count));
        }
    return means;
}

}  // namespace lrsm
