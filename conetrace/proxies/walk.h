#pragma once

#include "conetrace/proxies/cells.h"

#include <algorithm>

/// A shadow ray through the cells: [P] Fig. 2 (d).
namespace lrsm {

/// Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", Eurographics 1987. visit(hash) for each cell that the ray meets, nearest first,
/// until it says true; tells whether it did. `direction` has any length; the ray may start outside.
template <class Visit>
bool walkCells(const CellGrid& grid, const Vec3& originWorld, const Vec3& direction, const Visit& visit)
{
    const Vec3 origin = grid.cellsFromWorld(originWorld);

    // Where it enters the grid's box, and where it leaves it.
    float enter = 0.0f, leave = kInfinity;
    Vec3 perCell(kInfinity);
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0.0f) {
            if (origin[axis] < 0.0f || origin[axis] > float(grid.size[axis])) return false;
            continue;
        }
        perCell[axis] = 1.0f / std::abs(direction[axis]);
        const float toLow = -origin[axis] / direction[axis], toHigh = (float(grid.size[axis]) - origin[axis]) / direction[axis];
        enter = std::max(enter, std::min(toLow, toHigh));
        leave = std::min(leave, std::max(toLow, toHigh));
    }
    if (!(enter <= leave)) return false;

    // The first cell, and how far it is to the next along each axis.
    const Vec3 from = origin + enter * direction;
    IVec3 cell = glm::clamp(IVec3(glm::floor(from)), IVec3(0), grid.size - 1);
    IVec3 step(0);
    Vec3 next(kInfinity);
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0.0f) continue;
        step[axis] = direction[axis] > 0.0f ? 1 : -1;
        const float border = float(cell[axis] + (step[axis] > 0 ? 1 : 0));
        next[axis] = (border - origin[axis]) / direction[axis];
    }

    // From cell to cell through the nearest face.
    for (;;) {
        if (visit(grid.hash(cell))) return true;
        const int axis = next.x <= next.y ? (next.x <= next.z ? 0 : 2) : (next.y <= next.z ? 1 : 2);
        cell[axis] += step[axis];
        if (cell[axis] < 0 || cell[axis] >= grid.size[axis]) return false;
        next[axis] += perCell[axis];
    }
}

/// A ray, and what tests of boxes take of it.
struct ShadowRay {
    Vec3 origin{0.0f}, direction{0.0f, 0.0f, 1.0f};
    Vec3 perDirection{kInfinity};  ///< 1 / direction
    ShadowRay(const Vec3& o, const Vec3& d) : origin(o), direction(d), perDirection(1.0f / d) {}
};

/// May it meet something within the box, at t >= 0? Of a ray that runs within one of its faces the answer may be either.
inline bool mayMeet(const ShadowRay& ray, const Aabb& box)
{
    const Vec3 a = (box.min - ray.origin) * ray.perDirection, b = (box.max - ray.origin) * ray.perDirection;
    float enter = 0.0f, leave = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
        enter = std::max(enter, std::min(a[axis], b[axis]));
        leave = std::min(leave, std::max(a[axis], b[axis]));
    }
    return !(enter > leave);
}

/// Of a ray and four discs: does it meet each, and where.
struct QuadHits {
    Float4 toPlane, along;  ///< n.(p - o), n.d: it meets the disc's plane at their quotient
    Int4 hits;
    QuadHits(const ProxyQuad& quad, const ShadowRay& ray, float radius2)
    {
        const Float4 dx = splat(ray.direction.x), dy = splat(ray.direction.y), dz = splat(ray.direction.z);
        const Float4 px = quad.x - splat(ray.origin.x), py = quad.y - splat(ray.origin.y), pz = quad.z - splat(ray.origin.z);
        toPlane = quad.nx * px + quad.ny * py + quad.nz * pz;
        along = quad.nx * dx + quad.ny * dy + quad.nz * dz;
        // |o + t d - p| <= r without the quotient.
        const Float4 ax = dx * toPlane - px * along, ay = dy * toPlane - py * along, az = dz * toPlane - pz * along;
        hits = (ax * ax + ay * ay + az * az <= radius2 * (along * along)) & (toPlane * along > splat(0.0f));
    }
};

/// Does a ray meet, at any t > 0, the disc of one of a cell's proxies? Which of them it is does not matter to a list.
inline bool meetsDisc(const ProxyCells& cells, std::uint32_t cell, const ShadowRay& ray)
{
    if (cells.first[cell] == cells.first[cell + 1] || !mayMeet(ray, cells.bounds[cell])) return false;
    const float radius2 = cells.discRadius * cells.discRadius;
    for (std::uint32_t q = cells.first[cell]; q < cells.first[cell + 1]; ++q) {
        const Int4 hits = QuadHits(cells.quads[q], ray, radius2).hits;
        if ((hits[0] | hits[1] | hits[2] | hits[3]) != 0) return true;
    }
    return false;
}

/// The nearest disc of such a cell along the ray, as its place in ProxyCells::numbers; the first of equals.
struct MetDisc {
    std::size_t slot = 0;
    float distance = kInfinity;  ///< of the ray's direction
};
inline MetDisc nearestDisc(const ProxyCells& cells, std::uint32_t cell, const ShadowRay& ray)
{
    const float radius2 = cells.discRadius * cells.discRadius;
    MetDisc met;
    for (std::uint32_t q = cells.first[cell]; q < cells.first[cell + 1]; ++q) {
        const QuadHits quad(cells.quads[q], ray, radius2);
        for (std::size_t k = 0; k < 4; ++k)
            if (quad.hits[k] != 0 && quad.toPlane[k] / quad.along[k] < met.distance) met = {std::size_t(q) * 4 + k, quad.toPlane[k] / quad.along[k]};
    }
    return met;
}

}  // namespace lrsm
