#pragma once

#include "core/base/math.h"

#include <array>

namespace lrsm {

/// A convex polygon that began as a triangle: six planes leave it nine corners at most.
struct CutPolygon {
    std::array<glm::dvec3, 9> corner;
    std::size_t count = 0;
    void push(const glm::dvec3& p)
    {
        if (count < corner.size()) corner[count++] = p;
    }
};

/// Keeps sign * (p[axis] - bound) <= 0 (Sutherland and Hodgman 1974, one side).
CutPolygon cut(const CutPolygon& in, int axis, double sign, double bound);

}  // namespace lrsm
