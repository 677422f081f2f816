#include "voxel/voxelize.h"

#include "core/base/errors.h"
#include "core/base/memory.h"
#include "core/base/parallel.h"
#include "core/scene/check_scene.h"
#include "core/scene/invisible.h"
#include "voxel/voxelize_triangle.h"

#include <bit>
#include <cassert>
#include <new>

namespace lrsm {
namespace {

constexpr std::size_t kTrianglesPerTask = 1024;
constexpr std::size_t kBigTriangleColumns = 16384;  ///< above: split by rows, so that two triangles of a floor keep all cores busy
constexpr int kRowsPerTask = 16;

BitGrid emptyGrid(const VoxelGrid& grid)
{
    BitGrid bits;
    bits.grid = grid;
    const auto edge = std::size_t(BitGrid::bricksPerEdge(grid.resolution));
    requireMemory(edge * edge * edge * sizeof(std::uint64_t), "voxel grid", "lower voxel_resolution");
    try {
        bits.bricks.assign(edge * edge * edge, 0);
    } catch (const std::bad_alloc&) {
        throw MachineError("voxel grid", "no memory for " + std::to_string(edge * edge * edge * 8) + " bytes; lower voxel.resolution");
    }
    return bits;
}

/// No wider than the rounding of its corners: what joins strips of triangles, or has collapsed. Neither eye nor light ever meets it, so no cone must.
/// NaN passes: fixedFromWorld drops it.
bool hasNoArea(const Vec3& a, const Vec3& b, const Vec3& c)
{
    constexpr double kRoundings = 0x1p-22;  // four units in the last place
    using DVec3 = glm::dvec3;
    const DVec3 ab = DVec3(b) - DVec3(a), ac = DVec3(c) - DVec3(a), bc = ac - ab, normal = glm::cross(ab, ac);
    const double longest2 = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
    const Vec3 largest = glm::max(glm::max(glm::abs(a), glm::abs(b)), glm::abs(c));
    const double rounding = kRoundings * double(std::max({largest.x, largest.y, largest.z}));
    return glm::dot(normal, normal) <= rounding * rounding * longest2;
}

enum class NoArea { skip, keep };

/// corners(i) gives the three world positions of triangle i.
template <class Corners>
void voxelizeInto(BitGrid& bits, std::size_t count, Voxelization mode, NoArea noArea, const Corners& corners)
{
    std::vector<std::vector<TriangleSetup>> bigOfChunk((count + kTrianglesPerTask - 1) / kTrianglesPerTask);
    parallelFor(count, kTrianglesPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::array<Vec3, 3> p = corners(i);
            if (noArea == NoArea::skip && hasNoArea(p[0], p[1], p[2])) continue;
            const FixedPieces pieces = fixedFromWorld(p[0], p[1], p[2], bits.grid);
            for (int k = 0; k < pieces.count; ++k) {
                const TriangleSetup setup = setUpTriangle(pieces.piece[std::size_t(k)], bits.grid.resolution, mode);
                if (setup.empty) continue;
                if (setup.columnCount() > kBigTriangleColumns)
                    bigOfChunk[begin / kTrianglesPerTask].push_back(setup);
                else
                    voxelizeRows(setup, setup.cells[setup.rowAxis], mode, bits);
            }
        }
    });

    struct Task {
        const TriangleSetup* setup;
        Span rows;
    };
    std::vector<Task> tasks;
    for (const auto& big : bigOfChunk) {
        for (const TriangleSetup& setup : big) {
            const Span rows = setup.cells[setup.rowAxis];
            for (int row = rows.lo; row <= rows.hi; row += kRowsPerTask) tasks.push_back({&setup, {row, std::min(row + kRowsPerTask - 1, rows.hi)}});
        }
    }
    parallelFor(tasks.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) voxelizeRows(*tasks[i].setup, tasks[i].rows, mode, bits);
    });
}

}  // namespace

VoxelGrid gridOf(const Scene& scene, const VoxelSettings& settings)
{
    return fitVoxelGrid(settings.extent == Extent::reach && reachIsPart(scene) ? scene.reach : scene.bounds, settings.resolution);
}

BitGrid voxelize(const Scene& scene, const VoxelSettings& settings)
{
    assert(std::has_single_bit(static_cast<unsigned>(settings.resolution)));
    checkBounds(scene.bounds);
    BitGrid bits = emptyGrid(gridOf(scene, settings));
    for (const Mesh& mesh : scene.meshes) {
        if (isDrawnNowhere(scene, mesh)) continue;
        voxelizeInto(bits, mesh.triangles.size(), settings.mode, NoArea::skip, [&](std::size_t i) {
            const auto& t = mesh.triangles[i];
            return std::array<Vec3, 3>{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
        });
    }
    return bits;
}

BitGrid voxelizeTriangles(const std::vector<Vec3>& corners, const VoxelGrid& grid, Voxelization mode)
{
    BitGrid bits = emptyGrid(grid);
    voxelizeInto(bits, corners.size() / 3, mode, NoArea::keep, [&](std::size_t i) {
        return std::array<Vec3, 3>{corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]};
    });
    return bits;
}

}  // namespace lrsm
