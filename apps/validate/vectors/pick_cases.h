#pragma once

#include "apps/validate/equations/worst_case.h"
#include "apps/validate/vectors/vector_set.h"

#include <utility>

/// Which points of a domain become the cases of a set. Deterministic: fixed streams, as the searches of worst_case.h.
namespace lrsm {

struct CaseCounts {
    std::size_t typical = 128, worst = 32;
    std::uint64_t search = 1500;  ///< points of the sweep, and as many steps of climbs
};

namespace detail {

/// The hardest points seen so far, hardest first; of equal ones the first.
template <class T, std::size_t N>
class Hardest {
  public:
    explicit Hardest(std::size_t most) : most_(most) {}
    void offer(double hardness, const std::array<T, N>& point)
    {
        if (!(hardness > 0.0) || (points_.size() == most_ && !(hardness > points_.back().first))) return;
        if (std::any_of(points_.begin(), points_.end(), [&](const auto& p) { return p.second == point; })) return;
        const auto place = std::find_if(points_.begin(), points_.end(), [&](const auto& p) { return hardness > p.first; });
        points_.insert(place, {hardness, point});
        if (points_.size() > most_) points_.pop_back();
    }
    const std::vector<std::pair<double, std::array<T, N>>>& points() const { return points_; }

  private:
    std::size_t most_;
    std::vector<std::pair<double, std::array<T, N>>> points_;
};

/// Every corner of the domain.
template <class T, std::size_t N>
std::vector<std::array<T, N>> cornersOf(const SearchSpace<T, N>& space)
{
    std::vector<std::array<T, N>> corners;
    for (std::size_t corner = 0; corner < (std::size_t(1) << N); ++corner) {
        std::array<T, N> point;
        for (std::size_t axis = 0; axis < N; ++axis) point[axis] = alongAxis(space.axes[axis], (corner >> axis) & 1u ? 1.0 : 0.0);
        corners.push_back(point);
    }
    return corners;
}

}  // namespace detail

/// Adds the cases that `evaluate` (point -> VectorCase) makes of typical, worst and extreme points of the space.
template <class T, std::size_t N, class Evaluate>
void fillSet(VectorSet& set, const SearchSpace<T, N>& space, const Evaluate& evaluate, std::uint32_t stream, const CaseCounts& counts = {})
{
    const auto add = [&](CaseKind kind, const std::array<T, N>& point) {
        const VectorCase made = evaluate(point);
        if (!made.results.empty()) addCase(set, kind, made);
    };
    SearchRandom random(stream);
    for (std::size_t i = 0; i < counts.typical; ++i) {
        std::array<T, N> point;
        for (std::size_t axis = 0; axis < N; ++axis) point[axis] = detail::alongAxis(space.axes[axis], random.unit());
        add(CaseKind::typical, point);
    }
    detail::Hardest<T, N> hardest(counts.worst);
    findWorst(
        space, {counts.search, counts.search},
        [&](const std::array<T, N>& point) {
            const double hard = hardness(evaluate(point));
            hardest.offer(hard, point);
            return hard;
        },
        stream + 1);
    for (const auto& [hard, point] : hardest.points()) add(CaseKind::worst, point);
    for (const auto& point : space.planted) add(CaseKind::extreme, point);
    for (const auto& point : detail::cornersOf(space)) add(CaseKind::extreme, point);
}

}  // namespace lrsm
