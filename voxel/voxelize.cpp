#include "voxel/voxelize.h"

#include "core/base/errors.h"
#include "core/base/memory.h"
#include "core/base/parallel.h"
#include "core/scene/check_scene.h"
#include "core/scene/invisible.h"
#include "voxel/cascades.h"
#include "voxel/voxelize_triangle.h"

#include <algorithm>
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

/// corners(i) gives the three world positions of triangle i; visit(i, setup, rows) is called in parallel, for parts of its rows if the triangle is big.
template <class Corners, class Visit>
void forTriangles(const VoxelGrid& grid, std::size_t count, Voxelization mode, NoArea noArea, const Corners& corners, const Visit& visit)
{
    struct Big {
        std::size_t triangle;
        TriangleSetup setup;
    };
    std::vector<std::vector<Big>> bigOfChunk((count + kTrianglesPerTask - 1) / kTrianglesPerTask);
    parallelFor(count, kTrianglesPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::array<Vec3, 3> p = corners(i);
            if (noArea == NoArea::skip && hasNoArea(p[0], p[1], p[2])) continue;
            const FixedPieces pieces = fixedFromWorld(p[0], p[1], p[2], grid);
            for (int k = 0; k < pieces.count; ++k) {
                const TriangleSetup setup = setUpTriangle(pieces.piece[std::size_t(k)], grid.resolution, mode);
                if (setup.empty) continue;
                if (setup.columnCount() > kBigTriangleColumns)
                    bigOfChunk[begin / kTrianglesPerTask].push_back({i, setup});
                else
                    visit(i, setup, setup.cells[setup.rowAxis]);
            }
        }
    });

    struct Task {
        const Big* big;
        Span rows;
    };
    std::vector<Task> tasks;
    for (const auto& chunk : bigOfChunk) {
        for (const Big& big : chunk) {
            const Span rows = big.setup.cells[big.setup.rowAxis];
            for (int row = rows.lo; row <= rows.hi; row += kRowsPerTask) tasks.push_back({&big, {row, std::min(row + kRowsPerTask - 1, rows.hi)}});
        }
    }
    parallelFor(tasks.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) visit(tasks[i].big->triangle, tasks[i].big->setup, tasks[i].rows);
    });
}

/// The same for all that a scene shows of the meshes that are `chosen(mesh)`: visit(mesh, triangle, setup, rows).
template <class Chosen, class Visit>
void forTrianglesOf(const Scene& scene, const VoxelGrid& grid, Voxelization mode, const Chosen& chosen, const Visit& visit)
{
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        const Mesh& mesh = scene.meshes[m];
        if (!chosen(m) || isDrawnNowhere(scene, mesh)) continue;
        const auto corners = [&](std::size_t i) {
            const auto& t = mesh.triangles[i];
            return std::array<Vec3, 3>{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
        };
        forTriangles(grid, mesh.triangles.size(), mode, NoArea::skip, corners,
                     [&](std::size_t i, const TriangleSetup& setup, Span rows) { visit(m, i, setup, rows); });
    }
}

constexpr auto kAllMeshes = [](std::size_t) { return true; };

template <class Chosen>
void addVoxels(BitGrid& bits, const Scene& scene, Voxelization mode, const Chosen& chosen)
{
    forTrianglesOf(scene, bits.grid, mode, chosen,
                   [&](std::size_t, std::size_t, const TriangleSetup& setup, Span rows) { voxelizeRows(setup, rows, mode, bits); });
}

}  // namespace

VoxelGrid gridOf(const Scene& scene, const VoxelSettings& settings)
{
    return fitVoxelGrid(settings.extent == Extent::reach && reachIsPart(scene) ? scene.reach : scene.bounds, settings.resolution);
}

std::vector<VoxelGrid> gridsOf(const Scene& scene, const VoxelSettings& settings, const Vec3& eye)
{
    return cascadeGrids(gridOf(scene, settings), settings.cascades, eye);
}

BitGrid voxelize(const Scene& scene, const VoxelSettings& settings)
{
    assert(std::has_single_bit(static_cast<unsigned>(settings.resolution)));
    return voxelize(scene, gridOf(scene, settings), settings.mode);
}

BitGrid voxelize(const Scene& scene, const VoxelGrid& grid, Voxelization mode)
{
    checkBounds(scene.bounds);
    BitGrid bits = emptyGrid(grid);
    addVoxels(bits, scene, mode, kAllMeshes);
    return bits;
}

BitGrid voxelizeAfter(StandingVoxels& last, const Scene& scene, const std::vector<std::string>& keys, const VoxelGrid& grid, Voxelization mode)
{
    assert(keys.size() == scene.meshes.size());
    checkBounds(scene.bounds);
    const bool comparable = last.grid == grid && last.meshes.size() == keys.size();
    std::vector<bool> same(keys.size());
    for (std::size_t m = 0; m < keys.size(); ++m) same[m] = comparable && last.meshes[m] == keys[m];

    bool holds = comparable && !last.bits.bricks.empty();
    for (std::size_t m = 0; m < keys.size() && holds; ++m) holds = same[m] || !last.standing[m];
    if (!holds) {
        last.standing = same;
        last.bits = {};
        if (std::find(same.begin(), same.end(), true) != same.end()) {
            last.bits = emptyGrid(grid);
            addVoxels(last.bits, scene, mode, [&](std::size_t m) { return last.standing[m]; });
        }
    }
    last.grid = grid;
    last.meshes = keys;

    BitGrid bits = last.bits.bricks.empty() ? emptyGrid(grid) : last.bits;
    addVoxels(bits, scene, mode, [&](std::size_t m) { return !last.standing[m]; });
    return bits;
}

void forEachFragment(const Scene& scene, const VoxelGrid& grid, Voxelization mode, const std::function<void(const BrickFragments&)>& visit)
{
    forTrianglesOf(scene, grid, mode, kAllMeshes, [&](std::size_t mesh, std::size_t triangle, const TriangleSetup& setup, Span rows) {
        forEachBrick(setup, rows, mode, grid.resolution, [&](std::size_t brick, std::uint64_t mask) {
            visit({.mesh = std::uint32_t(mesh), .triangle = std::uint32_t(triangle), .piece = setup.triangle, .brick = brick, .voxels = mask});
        });
    });
}

BitGrid voxelizeTriangles(const std::vector<Vec3>& corners, const VoxelGrid& grid, Voxelization mode)
{
    BitGrid bits = emptyGrid(grid);
    const auto cornersOf = [&](std::size_t i) { return std::array<Vec3, 3>{corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]}; };
    forTriangles(grid, corners.size() / 3, mode, NoArea::keep, cornersOf,
                 [&](std::size_t, const TriangleSetup& setup, Span rows) { voxelizeRows(setup, rows, mode, bits); });
    return bits;
}

}  // namespace lrsm
