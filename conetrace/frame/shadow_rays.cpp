#include "conetrace/frame/shadow_rays.h"

#include "conetrace/frame/light_grid.h"
#include "core/base/parallel.h"
#include "core/scene/brdf.h"

#include <utility>

namespace lrsm {
namespace {

constexpr double kReceiversPerCell = 2.0;  // measured: between 1 and 4 the time hardly changes
constexpr double kNearestOccluder = 1e-6;  // of the nearest receiver's distance: what is nearer to a light is inside its bulb
constexpr std::size_t kReceiversPerTask = 4096, kTrianglesPerTask = 512;
constexpr int kBands = 64;  // of the grid's rows, a task each
constexpr int kNarrow = 3;  // columns: fewer are tried all in every row

/// n . p - d: positive on one side.
struct Plane {
    DVec3 n{0.0};
    double d = 0.0;
    double at(const DVec3& p) const { return glm::dot(n, p) - d; }
};

/// Through the light and the edge from b to c. The same edge the other way round gives exactly the negative.
Plane edgePlane(const LightView& view, const DVec3& b, const DVec3& c)
{
    if (view.directional()) {
        const DVec3 n = glm::cross(view.forward(), c - b);
        return {n, glm::dot(n, 0.5 * (b + c))};
    }
    const DVec3 n = glm::cross(b - view.position(), c - view.position());
    return {n, glm::dot(n, view.position())};
}

/// What is dark behind one triangle: the points on the inner side of all four planes.
class ShadowVolume {
  public:
    ShadowVolume(const LightView& view, const std::array<DVec3, 3>& p)
    {
        const DVec3 n = glm::cross(p[1] - p[0], p[2] - p[0]);
        along_ = view.directional() ? glm::dot(n, view.forward()) : glm::dot(n, p[0] - view.position());
        const double side = along_ < 0.0 ? -1.0 : 1.0;
        face_ = {n * side, glm::dot(n, p[0]) * side};
        for (std::size_t i = 0; i < 3; ++i) {
            const Plane edge = edgePlane(view, p[(i + 1) % 3], p[(i + 2) % 3]);
            edges_[i] = {edge.n * side, edge.d * side};
        }
    }

    bool edgeOn() const { return along_ == 0.0; }
    bool frontLit() const { return along_ < 0.0; }
    bool contains(const DVec3& p) const { return edges_[0].at(p) >= 0.0 && edges_[1].at(p) >= 0.0 && edges_[2].at(p) >= 0.0 && face_.at(p) > 0.0; }

    /// b1, b2 of where the line from p to the light meets the triangle: as the volumes that it spans with the edges.
    Vec2 barycentrics(const DVec3& p) const
    {
        const double b0 = edges_[0].at(p), b1 = edges_[1].at(p), b2 = edges_[2].at(p), sum = b0 + b1 + b2;
        return sum > 0.0 ? Vec2(float(b1 / sum), float(b2 / sum)) : Vec2(0.0f);
    }

  private:
    Plane face_;                  ///< positive behind the triangle
    std::array<Plane, 3> edges_;  ///< [i] is opposite corner i
    double along_ = 0.0;          ///< its normal along the light's way: negative where the front is lit
};

/// The surfaces of a picture that a light may reach, sorted by the cells of a grid over its view.
struct Receivers {
    struct Cell {
        std::uint32_t begin = 0, end = 0;                       ///< of the receivers that nothing is known to darken
        float depth = -std::numeric_limits<float>::infinity();  ///< along the light's axis: none of them is farther
    };

    LightGrid grid;
    double nearest = 0.0;               ///< along the light's axis, metres
    std::vector<Vec3> origins;          ///< world: where the lines to the light start
    std::vector<std::uint32_t> pixels;  ///< of the picture
    std::vector<Cell> cells;

    const Cell& at(int row, int column) const { return cells[std::size_t(row) * std::size_t(grid.columns()) + std::size_t(column)]; }
    Cell& at(int row, int column) { return cells[std::size_t(row) * std::size_t(grid.columns()) + std::size_t(column)]; }
};

/// A pixel before sorting.
struct Seen {
    float depth = std::numeric_limits<float>::quiet_NaN();  ///< not less than the receiver's; NaN: there is none
    std::uint32_t cell = 0;
    bool valid() const { return !std::isnan(depth); }
};

bool mayBeLit(const GBuffer& gbuffer, const LightSampler& light, std::size_t i)
{
    if (!gbuffer.covered(i)) return false;
    const LightSample sample = light(gbuffer.position.texels[i]);
    return sample.irradiance != Vec3(0.0f) && glm::dot(gbuffer.normal.texels[i], sample.toLight) > 0.0f &&
           glm::dot(gbuffer.geometricNormal.texels[i], sample.toLight) > 0.0f;
}

/// Offset of every surface in the scene that does not come from its own coordinates.
float sceneOffset(const Scene& scene)
{
    const Aabb& extent = extentOf(scene);
    const Vec3 largest = glm::max(glm::abs(extent.min), glm::abs(extent.max));
    return kShadowRaySceneOffset * std::max({largest.x, largest.y, largest.z});
}

Vec3 originOf(const GBuffer& gbuffer, std::size_t i, float offset)
{
    const Vec3 p = gbuffer.position.texels[i], a = glm::abs(p);
    return p + gbuffer.geometricNormal.texels[i] * (kShadowRayOffset * std::max({a.x, a.y, a.z}) + offset);
}

/// Finds the receivers, their depths and the grid over them.
LightGrid seeReceivers(const GBuffer& gbuffer, const Light& light, const LightView& view, float offset, std::vector<Seen>& seen)
{
    struct Bounds {
        DVec2 min{std::numeric_limits<double>::infinity()}, max{-std::numeric_limits<double>::infinity()};
        std::size_t count = 0;
    };
    const LightSampler sampler(light);
    std::vector<Bounds> parts((seen.size() + kReceiversPerTask - 1) / kReceiversPerTask);
    parallelFor(seen.size(), kReceiversPerTask, [&](std::size_t begin, std::size_t end) {
        Bounds& part = parts[begin / kReceiversPerTask];
        for (std::size_t i = begin; i < end; ++i) {
            if (!mayBeLit(gbuffer, sampler, i)) continue;
            const DVec3 p = view.toLightSpace(DVec3(originOf(gbuffer, i, offset)));
            if (!view.directional() && !(p.z > 0.0)) continue;
            const DVec2 onPlane = view.onPlane(p);
            part = {glm::min(part.min, onPlane), glm::max(part.max, onPlane), part.count + 1};
            seen[i].depth = std::nextafter(float(p.z), std::numeric_limits<float>::infinity());
        }
    });
    Bounds all;
    for (const Bounds& part : parts) all = {glm::min(all.min, part.min), glm::max(all.max, part.max), all.count + part.count};
    return all.count > 0 ? LightGrid(all.min, all.max, double(all.count) / kReceiversPerCell) : LightGrid();
}

/// Counting sort by cell, pixels in order within each.
Receivers sortReceivers(const Scene& scene, const GBuffer& gbuffer, const Light& light, const LightView& view)
{
    const float offset = sceneOffset(scene);
    std::vector<Seen> seen(gbuffer.objectId.texels.size());
    Receivers sorted;
    sorted.grid = seeReceivers(gbuffer, light, view, offset, seen);
    if (sorted.grid.cells() == 0) return sorted;
    parallelFor(seen.size(), kReceiversPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (seen[i].valid()) seen[i].cell = std::uint32_t(sorted.grid.cellOf(view.onPlane(view.toLightSpace(DVec3(originOf(gbuffer, i, offset))))));
    });
    sorted.cells.resize(sorted.grid.cells());
    sorted.nearest = std::numeric_limits<double>::infinity();
    for (const Seen& each : seen) {
        if (!each.valid()) continue;
        Receivers::Cell& cell = sorted.cells[each.cell];
        ++cell.end;
        cell.depth = std::max(cell.depth, each.depth);
        sorted.nearest = std::min(sorted.nearest, double(each.depth));
    }
    // Counts become begins; each receiver then moves its cell's end.
    std::uint32_t count = 0;
    for (Receivers::Cell& cell : sorted.cells) {
        cell.begin = count;
        count += std::exchange(cell.end, count);
    }
    sorted.origins.resize(count);
    sorted.pixels.resize(count);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (!seen[i].valid()) continue;
        const std::uint32_t at = sorted.cells[seen[i].cell].end++;
        sorted.origins[at] = originOf(gbuffer, i, offset);
        sorted.pixels[at] = static_cast<std::uint32_t>(i);
    }
    return sorted;
}

/// A triangle that may shadow something, and the cells around those that it touches.
struct Occluder {
    std::uint32_t mesh, triangle;
    LightGrid::Range rows, columns;
};

/// Some of them, and the rows of all.
struct Occluders {
    std::vector<Occluder> each;
    LightGrid::Range rows{std::numeric_limits<int>::max(), -1};
};

bool overlap(const LightGrid::Range& a, const LightGrid::Range& b)
{
    return a.first <= b.last && b.first <= a.last;
}

class ShadowTracer {
  public:
    /// Takes the receivers that a triangle darkens out of their cells.
    ShadowTracer(const Scene& scene, const LightView& view, Receivers& receivers, bool alphaTest)
        : scene_(scene), view_(view), receivers_(receivers), alphaTest_(alphaTest)
    {
        for (std::size_t m = 0; m < scene.meshes.size(); ++m) findOccluders(static_cast<std::uint32_t>(m));
    }

    /// Marks what is dark in the rows of one band: no two bands share a cell.
    void darken(int band, Image<std::uint8_t>& visibility) const
    {
        const LightGrid& grid = receivers_.grid;
        const LightGrid::Range rows{grid.rows() * band / kBands, grid.rows() * (band + 1) / kBands - 1};
        for (const Occluders& chunk : occluders_) {
            if (!overlap(chunk.rows, rows)) continue;
            for (const Occluder& occluder : chunk.each)
                if (overlap(occluder.rows, rows)) darkenBehind(occluder, rows, visibility);
        }
    }

  private:
    std::array<DVec3, 3> cornersOf(std::uint32_t mesh, std::uint32_t triangle) const
    {
        const Mesh& m = scene_.meshes[mesh];
        const auto& t = m.triangles[triangle];
        return {DVec3(m.positions[t[0]]), DVec3(m.positions[t[1]]), DVec3(m.positions[t[2]])};
    }
    std::array<DVec3, 3> inLightSpace(const std::array<DVec3, 3>& p) const
    {
        return {view_.toLightSpace(p[0]), view_.toLightSpace(p[1]), view_.toLightSpace(p[2])};
    }
    Polygon polygonOf(const std::array<DVec3, 3>& inLightSpace) const { return lrsm::polygonOf(view_, inLightSpace, kNearestOccluder * receivers_.nearest); }
    static double nearestOf(const std::array<DVec3, 3>& inLightSpace) { return std::min({inLightSpace[0].z, inLightSpace[1].z, inLightSpace[2].z}); }

    /// Receivers in a row that a triangle so far away may darken?
    bool rowReaches(int row, const LightGrid::Range& columns, double nearest) const
    {
        for (int column = columns.first; column <= columns.last; ++column)
            if (receivers_.at(row, column).depth > nearest) return true;
        return false;
    }

    void findOccluders(std::uint32_t m)
    {
        const Mesh& mesh = scene_.meshes[m];
        const std::size_t count = mesh.triangles.size(), first = occluders_.size();
        occluders_.resize(first + (count + kTrianglesPerTask - 1) / kTrianglesPerTask);
        parallelFor(count, kTrianglesPerTask, [&](std::size_t begin, std::size_t end) {
            Occluders& chunk = occluders_[first + begin / kTrianglesPerTask];
            for (std::size_t t = begin; t < end; ++t) {
                const std::array<DVec3, 3> p = inLightSpace(cornersOf(m, static_cast<std::uint32_t>(t)));
                const Polygon polygon = polygonOf(p);
                if (polygon.count == 0) continue;
                LightGrid::Range rows = receivers_.grid.rowsOf(polygon);
                const LightGrid::Range columns = receivers_.grid.columnsOf(polygon);
                const double nearest = nearestOf(p);
                while (!rows.empty() && !rowReaches(rows.first, columns, nearest)) ++rows.first;
                while (!rows.empty() && !rowReaches(rows.last, columns, nearest)) --rows.last;
                if (rows.empty()) continue;
                chunk.each.push_back({m, static_cast<std::uint32_t>(t), rows, columns});
                chunk.rows = {std::min(chunk.rows.first, rows.first), std::max(chunk.rows.last, rows.last)};
            }
        });
    }

    void darkenBehind(const Occluder& occluder, const LightGrid::Range& band, Image<std::uint8_t>& visibility) const
    {
        const std::array<DVec3, 3> corners = cornersOf(occluder.mesh, occluder.triangle), p = inLightSpace(corners);
        const ShadowVolume volume(view_, corners);
        const Material& material = scene_.materials[std::size_t(scene_.meshes[occluder.mesh].material)];
        if (volume.edgeOn() || !(volume.frontLit() || material.doubleSided)) return;
        const Polygon polygon = polygonOf(p);
        const double nearest = nearestOf(p);
        const bool masked = alphaTest_ && material.alphaMask;
        const auto darkens = [&](const DVec3& origin) { return volume.contains(origin) && (!masked || keeps(occluder, volume.barycentrics(origin))); };

        const bool narrow = occluder.columns.last - occluder.columns.first < kNarrow;
        for (int row = std::max(band.first, occluder.rows.first); row <= std::min(band.last, occluder.rows.last); ++row) {
            const LightGrid::Range columns = narrow ? occluder.columns : receivers_.grid.columnsOf(polygon, row);
            for (int column = columns.first; column <= columns.last; ++column) {
                Receivers::Cell& cell = receivers_.at(row, column);
                if (cell.depth <= nearest) continue;
                for (std::uint32_t i = cell.begin; i < cell.end;) {
                    if (!darkens(DVec3(receivers_.origins[i]))) {
                        ++i;
                        continue;
                    }
                    visibility.texels[receivers_.pixels[i]] = 0;
                    --cell.end;  // the last takes its place
                    receivers_.origins[i] = receivers_.origins[cell.end];
                    receivers_.pixels[i] = receivers_.pixels[cell.end];
                }
            }
        }
    }

    bool keeps(const Occluder& occluder, const Vec2& b) const { return passesAlphaTest(scene_, {occluder.mesh, occluder.triangle, b.x, b.y}); }

    const Scene& scene_;
    const LightView& view_;
    Receivers& receivers_;
    bool alphaTest_;
    std::vector<Occluders> occluders_;  ///< by chunks of triangles
};

}  // namespace

Image<std::uint8_t> traceShadowRays(const Scene& scene, const GBuffer& gbuffer, const Light& light, const Requirements& needs)
{
    Image<std::uint8_t> visibility(gbuffer.width, gbuffer.height, 1);
    const LightView view(light);
    Receivers receivers = sortReceivers(scene, gbuffer, light, view);
    if (receivers.origins.empty()) return visibility;

    const ShadowTracer tracer(scene, view, receivers, needs.alphaTest);
    parallelFor(kBands, 1, [&](std::size_t band, std::size_t) { tracer.darken(static_cast<int>(band), visibility); });
    return visibility;
}

}  // namespace lrsm
