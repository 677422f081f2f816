#pragma once

#include "reference/sobol.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

/// Densities over the rays of all lights: one unit square a light (light_map.h), each cut into texels, constant in a texel.
namespace lrsm {

/// A point of one light's square.
struct LightPoint {
    std::uint32_t light = 0;
    UnitPoint at;
};

/// side x side texels of each light's square, between cuts of its own along u and v: narrow where much is to be told apart.
class LightGrids {
  public:
    LightGrids() = default;
    /// Texels of one size.
    LightGrids(std::size_t lights, int side);
    /// Cuts at the quantiles of the points' marginal distributions, half and half with the uniform one.
    LightGrids(std::size_t lights, int side, std::span<const LightPoint> points);

    std::size_t lights() const { return axes_.size() / 2; }
    std::size_t side() const { return side_; }
    std::size_t texels() const { return lights() * side_ * side_; }
    /// texel = (light side + row) side + column; rows run along v.
    std::size_t texelOf(const LightPoint& point) const;
    /// The point at (u, v) of a texel, both in [0, 1).
    LightPoint pointIn(std::size_t texel, UnitPoint within) const;
    /// 1 / the texel's area.
    float perArea(std::size_t texel) const;

    const std::vector<std::vector<float>>& cuts() const { return axes_; }

  private:
    std::size_t side_ = 1;
    std::vector<std::vector<float>> axes_;  ///< [2 light + (0: u, 1: v)]: side + 1 cuts from 0 to 1
};

class LightDensity {
  public:
    LightDensity() = default;
    /// `weights`: one a texel, not negative, not all 0.
    LightDensity(std::shared_ptr<const LightGrids> grids, std::vector<float> weights);

    bool empty() const { return weights_.empty(); }
    const LightGrids& grids() const { return *grids_; }
    LightPoint draw(UnitPoint xi) const;
    /// Per unit of the square's area; the integral over all squares is 1.
    float operator()(const LightPoint& point) const { return inTexel(grids_->texelOf(point)); }
    float inTexel(std::size_t texel) const;

  private:
    std::shared_ptr<const LightGrids> grids_;
    std::vector<float> weights_;
    std::vector<double> within_;  ///< sums of the weights along each row up to and with a texel
    std::vector<double> rows_;    ///< sums of the rows up to and with a row, all lights' one after the other
};

}  // namespace lrsm
