#include "reference/light_density.h"

#include "reference/search.h"

#include <algorithm>
#include <array>

namespace lrsm {
namespace {

constexpr int kBins = 256;  // of a marginal distribution; no texel is narrower than 1 / (side kBins / 2)
constexpr float kBelowOne = 0x1.fffffep-1f;

std::vector<float> uniformCuts(std::size_t side)
{
    std::vector<float> cuts(side + 1);
    for (std::size_t i = 0; i <= side; ++i) cuts[i] = float(double(i) / double(side));
    return cuts;
}

/// Where F(x) = i / side, F half uniform and half as counted, linear within a bin.
std::vector<float> quantileCuts(std::size_t side, const std::array<std::uint64_t, kBins>& counts, std::uint64_t total)
{
    std::vector<float> cuts = uniformCuts(side);
    double below = 0.0;
    std::size_t i = 1;
    for (int bin = 0; bin < kBins; ++bin) {
        const double mass = 0.5 / kBins + 0.5 * double(counts[std::size_t(bin)]) / double(total);
        for (; i < side && double(i) / double(side) < below + mass; ++i) cuts[i] = float((bin + (double(i) / double(side) - below) / mass) / kBins);
        below += mass;
    }
    return cuts;
}

std::size_t intervalOf(const std::vector<float>& cuts, float x)
{
    return countUpTo(std::span(cuts).subspan(1, cuts.size() - 2), x);
}

float pointBetween(float begin, float end, float fraction)
{
    return std::min(begin + (end - begin) * fraction, kBelowOne);
}

/// The interval of ascending sums that x, in [0, last sum), falls into, and where.
std::size_t invert(std::span<const double> sums, double x, float& fraction)
{
    const std::size_t at = std::min(countUpTo(sums, x), sums.size() - 1);
    const double below = at > 0 ? sums[at - 1] : 0.0, width = sums[at] - below;
    fraction = width > 0.0 ? std::clamp(float((x - below) / width), 0.0f, kBelowOne) : 0.0f;
    return at;
}

}  // namespace

LightGrids::LightGrids(std::size_t lights, int side) : side_(std::size_t(side)), axes_(2 * lights, uniformCuts(std::size_t(side))) {}

LightGrids::LightGrids(std::size_t lights, int side, std::span<const LightPoint> points) : LightGrids(lights, side)
{
    std::vector<std::array<std::uint64_t, kBins>> counts(2 * lights);
    std::vector<std::uint64_t> totals(lights);
    for (const LightPoint& point : points) {
        ++counts[2 * point.light][std::size_t(point.at.u * kBins)];
        ++counts[2 * point.light + 1][std::size_t(point.at.v * kBins)];
        ++totals[point.light];
    }
    for (std::size_t axis = 0; axis < axes_.size(); ++axis)
        if (totals[axis / 2] > 0) axes_[axis] = quantileCuts(side_, counts[axis], totals[axis / 2]);
}

std::size_t LightGrids::texelOf(const LightPoint& point) const
{
    const std::size_t column = intervalOf(axes_[2 * point.light], point.at.u), row = intervalOf(axes_[2 * point.light + 1], point.at.v);
    return (point.light * side_ + row) * side_ + column;
}

LightPoint LightGrids::pointIn(std::size_t texel, UnitPoint within) const
{
    const std::size_t column = texel % side_, row = texel / side_ % side_, light = texel / (side_ * side_);
    const std::vector<float>&u = axes_[2 * light], &v = axes_[2 * light + 1];
    return {std::uint32_t(light), {pointBetween(u[column], u[column + 1], within.u), pointBetween(v[row], v[row + 1], within.v)}};
}

float LightGrids::perArea(std::size_t texel) const
{
    const std::size_t column = texel % side_, row = texel / side_ % side_, light = texel / (side_ * side_);
    const std::vector<float>&u = axes_[2 * light], &v = axes_[2 * light + 1];
    return 1.0f / ((u[column + 1] - u[column]) * (v[row + 1] - v[row]));
}

LightDensity::LightDensity(std::shared_ptr<const LightGrids> grids, std::vector<float> weights)
    : grids_(std::move(grids)), weights_(std::move(weights)), within_(weights_.size())
{
    const std::size_t side = grids_->side();
    rows_.reserve(weights_.size() / side);
    double above = 0.0;
    for (std::size_t row = 0; row < weights_.size(); row += side) {
        double sum = 0.0;
        for (std::size_t i = row; i < row + side; ++i) within_[i] = sum += double(weights_[i]);
        rows_.push_back(above += sum);
    }
}

LightPoint LightDensity::draw(UnitPoint xi) const
{
    const std::size_t side = grids_->side();
    UnitPoint within;
    const std::size_t row = invert(rows_, double(xi.v) * rows_.back(), within.v);
    const std::span<const double> sums(within_.data() + row * side, side);
    const std::size_t column = invert(sums, double(xi.u) * sums.back(), within.u);
    return grids_->pointIn(row * side + column, within);
}

float LightDensity::inTexel(std::size_t texel) const
{
    return float(double(weights_[texel]) / rows_.back()) * grids_->perArea(texel);
}

}  // namespace lrsm
