#include "conetrace/caches/normal_axes.h"

#include "core/base/elementary.h"

#include <cmath>

namespace lrsm {
namespace {

constexpr int kBins = kNormalBins * kNormalBins;

int cell(float coordinate)
{
    return std::clamp(static_cast<int>((0.5f + 0.5f * coordinate) * float(kNormalBins)), 0, kNormalBins - 1);
}

/// The lower half of the octahedron, folded outwards; its own inverse.
Vec2 fold(float x, float y)
{
    return {std::copysign(1.0f - std::abs(y), x), std::copysign(1.0f - std::abs(x), y)};
}

}  // namespace

int normalBin(const Vec3& normal)
{
    const float sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
    Vec2 p(normal.x / sum, normal.y / sum);
    if (normal.z < 0.0f) p = fold(p.x, p.y);
    return cell(p.y) * kNormalBins + cell(p.x);
}

Vec3 normalOfBin(int bin)
{
    const auto middle = [](int i) { return 2.0f * (float(i) + 0.5f) / float(kNormalBins) - 1.0f; };
    const Vec2 p(middle(bin % kNormalBins), middle(bin / kNormalBins));
    const float z = 1.0f - std::abs(p.x) - std::abs(p.y);
    const Vec2 xy = z < 0.0f ? fold(p.x, p.y) : p;
    return Vec3(glm::normalize(glm::dvec3(xy.x, xy.y, z)));
}

NormalAxisFinder::NormalAxisFinder() : blur_(kBins * kBins), unlike_(kBins * kBins)
{
    constexpr double kLog2e = 1.44269504088896340736;
    std::vector<glm::dvec3> directions;
    for (int i = 0; i < kBins; ++i) directions.push_back(glm::normalize(glm::dvec3(normalOfBin(i))));
    for (std::size_t i = 0; i < kBins; ++i)
        for (std::size_t j = 0; j < kBins; ++j) {
            const double cosine = i == j ? 1.0 : glm::dot(directions[i], directions[j]);
            const double c2 = cosine * cosine, c4 = c2 * c2;
            blur_[i * kBins + j] = static_cast<float>(exp2Exact(kLog2e * double(kNormalSharpness) * (cosine - 1.0)));
            unlike_[i * kBins + j] = static_cast<float>(1.0 - c4 * c4);
        }
}

NormalAxes NormalAxisFinder::axesOf(std::span<const std::uint32_t> counts) const
{
    std::uint32_t pixels = 0;
    for (const std::uint32_t count : counts) pixels += count;
    // Few bins are filled: each adds its row.
    std::array<float, kBins> weight{};
    for (std::size_t j = 0; j < kBins; ++j) {
        if (counts[j] == 0) continue;
        const float share = static_cast<float>(counts[j]) / static_cast<float>(pixels);
        for (std::size_t i = 0; i < kBins; ++i) weight[i] += share * blur_[j * kBins + i];
    }
    NormalAxes axes;
    for (Vec3& axis : axes) {
        const auto best = static_cast<std::size_t>(std::max_element(weight.begin(), weight.end()) - weight.begin());
        axis = normalOfBin(static_cast<int>(best));
        for (std::size_t i = 0; i < kBins; ++i) weight[i] = (weight[i] + 1.0f) * unlike_[best * kBins + i];
    }
    return axes;
}

int axisOf(const Vec3& normal, const NormalAxes& axes)
{
    int best = 0;
    float most = -1.0f;
    for (int k = 0; k < 3; ++k) {
        const float cosine = glm::dot(normal, axes[std::size_t(k)]);
        if (!(std::abs(cosine) > most)) continue;
        most = std::abs(cosine);
        best = 2 * k + (cosine < 0.0f ? 1 : 0);
    }
    return best;
}

}  // namespace lrsm
