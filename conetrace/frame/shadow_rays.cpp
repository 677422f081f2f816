#include "conetrace/frame/shadow_rays.h"

#include "conetrace/frame/light_grid.h"
#include "core/base/parallel.h"
#include "core/scene/brdf.h"

#include <numeric>

namespace lrsm {
namespace {

constexpr double kReceiversPerCell = 2.0;  // measured: between 1 and 4 the time hardly changes
constexpr double kNearestOccluder = 1e-6;  // of the nearest receiver's distance: what is nearer to a light is inside its bulb
constexpr std::size_t kReceiversPerTask = 4096, kTrianglesPerTask = 4096;
constexpr int kBands = 64;  // of the grid's rows, a task each

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
    LightGrid grid;
    double nearest = 0.0;                   ///< along the light's axis, metres
    std::vector<Vec3> origins;              ///< world: where the lines to the light start
    std::vector<std::uint32_t> pixels;      ///< of the picture
    std::vector<std::uint32_t> cellBegins;  ///< one more than cells
    std::vector<double> cellDepths;         ///< of a cell's farthest, along the light's axis
};

/// One receiver before sorting; depth is NaN where there is none.
struct Seen {
    DVec2 onPlane{0.0};
    double depth = std::numeric_limits<double>::quiet_NaN();
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

std::vector<Seen> seeReceivers(const Scene& scene, const GBuffer& gbuffer, const Light& light, const LightView& view)
{
    const LightSampler sampler(light);
    const float offset = sceneOffset(scene);
    std::vector<Seen> seen(gbuffer.objectId.texels.size());
    parallelFor(seen.size(), kReceiversPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!mayBeLit(gbuffer, sampler, i)) continue;
            const DVec3 p = view.toLightSpace(DVec3(originOf(gbuffer, i, offset)));
            if (view.directional() || p.z > 0.0) seen[i] = {view.onPlane(p), p.z};
        }
    });
    return seen;
}

LightGrid gridOver(const std::vector<Seen>& seen)
{
    constexpr double kInf = std::numeric_limits<double>::infinity();
    DVec2 min(kInf), max(-kInf);
    std::size_t count = 0;
    for (const Seen& each : seen) {
        if (!each.valid()) continue;
        min = glm::min(min, each.onPlane);
        max = glm::max(max, each.onPlane);
        ++count;
    }
    return count > 0 ? LightGrid(min, max, double(count) / kReceiversPerCell) : LightGrid();
}

/// Counting sort by cell, pixels in order within each.
Receivers sortReceivers(const Scene& scene, const GBuffer& gbuffer, const std::vector<Seen>& seen)
{
    Receivers sorted;
    sorted.grid = gridOver(seen);
    const LightGrid& grid = sorted.grid;
    sorted.cellBegins.assign(grid.cells() + 1, 0);
    if (grid.cells() == 0) return sorted;
    sorted.cellDepths.assign(grid.cells(), -std::numeric_limits<double>::infinity());
    sorted.nearest = std::numeric_limits<double>::infinity();
    std::vector<std::uint32_t> cells(seen.size());
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (!seen[i].valid()) continue;
        const std::size_t cell = grid.cellOf(seen[i].onPlane);
        cells[i] = static_cast<std::uint32_t>(cell);
        ++sorted.cellBegins[cell];
        sorted.cellDepths[cell] = std::max(sorted.cellDepths[cell], seen[i].depth);
        sorted.nearest = std::min(sorted.nearest, seen[i].depth);
    }
    // Begins become ends by the sum, and begins again as each receiver takes the last free place of its cell.
    std::partial_sum(sorted.cellBegins.begin(), sorted.cellBegins.end(), sorted.cellBegins.begin());
    sorted.origins.resize(sorted.cellBegins.back());
    sorted.pixels.resize(sorted.cellBegins.back());
    const float offset = sceneOffset(scene);
    for (std::size_t i = seen.size(); i-- > 0;) {
        if (!seen[i].valid()) continue;
        const std::size_t at = --sorted.cellBegins[cells[i]];
        sorted.origins[at] = originOf(gbuffer, i, offset);
        sorted.pixels[at] = static_cast<std::uint32_t>(i);
    }
    return sorted;
}

/// A triangle that may shadow something, and the rows of the grid that it touches.
struct Occluder {
    std::uint32_t mesh, triangle;
    LightGrid::Range rows;
};

class ShadowTracer {
  public:
    ShadowTracer(const Scene& scene, const LightView& view, const Receivers& receivers, bool alphaTest)
        : scene_(scene), view_(view), receivers_(receivers), alphaTest_(alphaTest)
    {
        for (std::size_t m = 0; m < scene.meshes.size(); ++m) findOccluders(static_cast<std::uint32_t>(m));
    }

    /// Marks what is dark in the rows of one band.
    void darken(int band, std::vector<std::uint8_t>& dark) const
    {
        const LightGrid& grid = receivers_.grid;
        const LightGrid::Range rows{grid.rows() * band / kBands, grid.rows() * (band + 1) / kBands - 1};
        if (rows.empty() || rowIsEmpty(rows)) return;
        for (const std::vector<Occluder>& chunk : occluders_)
            for (const Occluder& occluder : chunk)
                if (occluder.rows.first <= rows.last && occluder.rows.last >= rows.first) darkenBehind(occluder, rows, dark);
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
    Polygon polygonOf(const std::array<DVec3, 3>& p) const { return lrsm::polygonOf(view_, inLightSpace(p), kNearestOccluder * receivers_.nearest); }

    bool rowIsEmpty(const LightGrid::Range& rows) const
    {
        const auto columns = static_cast<std::size_t>(receivers_.grid.columns());
        return receivers_.cellBegins[std::size_t(rows.first) * columns] == receivers_.cellBegins[std::size_t(rows.last + 1) * columns];
    }

    void findOccluders(std::uint32_t m)
    {
        const Mesh& mesh = scene_.meshes[m];
        const std::size_t count = mesh.triangles.size(), first = occluders_.size();
        occluders_.resize(first + (count + kTrianglesPerTask - 1) / kTrianglesPerTask);
        parallelFor(count, kTrianglesPerTask, [&](std::size_t begin, std::size_t end) {
            std::vector<Occluder>& chunk = occluders_[first + begin / kTrianglesPerTask];
            for (std::size_t t = begin; t < end; ++t) {
                const Polygon polygon = polygonOf(cornersOf(m, static_cast<std::uint32_t>(t)));
                if (polygon.count == 0) continue;
                const LightGrid::Range rows = receivers_.grid.rowsOf(polygon);
                if (!rows.empty()) chunk.push_back({m, static_cast<std::uint32_t>(t), rows});
            }
        });
    }

    void darkenBehind(const Occluder& occluder, const LightGrid::Range& band, std::vector<std::uint8_t>& dark) const
    {
        const std::array<DVec3, 3> corners = cornersOf(occluder.mesh, occluder.triangle), p = inLightSpace(corners);
        const ShadowVolume volume(view_, corners);
        const Material& material = scene_.materials[std::size_t(scene_.meshes[occluder.mesh].material)];
        if (volume.edgeOn() || !(volume.frontLit() || material.doubleSided)) return;
        const Polygon polygon = polygonOf(corners);
        const double nearest = std::min({p[0].z, p[1].z, p[2].z});
        const bool masked = alphaTest_ && material.alphaMask;

        const LightGrid& grid = receivers_.grid;
        for (int row = std::max(band.first, occluder.rows.first); row <= std::min(band.last, occluder.rows.last); ++row) {
            const LightGrid::Range columns = grid.columnsOf(polygon, row);
            for (int column = columns.first; column <= columns.last; ++column) {
                const std::size_t cell = std::size_t(row) * std::size_t(grid.columns()) + std::size_t(column);
                if (receivers_.cellDepths[cell] <= nearest) continue;
                for (std::size_t i = receivers_.cellBegins[cell]; i < receivers_.cellBegins[cell + 1]; ++i) {
                    if (dark[i]) continue;
                    const DVec3 origin(receivers_.origins[i]);
                    dark[i] = volume.contains(origin) && (!masked || keeps(occluder, volume.barycentrics(origin)));
                }
            }
        }
    }

    bool keeps(const Occluder& occluder, const Vec2& b) const { return passesAlphaTest(scene_, {occluder.mesh, occluder.triangle, b.x, b.y}); }

    const Scene& scene_;
    const LightView& view_;
    const Receivers& receivers_;
    bool alphaTest_;
    std::vector<std::vector<Occluder>> occluders_;  ///< by chunks of triangles
};

}  // namespace

Image<std::uint8_t> traceShadowRays(const Scene& scene, const GBuffer& gbuffer, const Light& light, const Requirements& needs)
{
    Image<std::uint8_t> visibility(gbuffer.width, gbuffer.height, 1);
    const LightView view(light);
    const Receivers receivers = sortReceivers(scene, gbuffer, seeReceivers(scene, gbuffer, light, view));
    if (receivers.origins.empty()) return visibility;

    const ShadowTracer tracer(scene, view, receivers, needs.alphaTest);
    std::vector<std::uint8_t> dark(receivers.origins.size(), 0);
    parallelFor(kBands, 1, [&](std::size_t band, std::size_t) { tracer.darken(static_cast<int>(band), dark); });
    for (std::size_t i = 0; i < dark.size(); ++i)
        if (dark[i]) visibility.texels[receivers.pixels[i]] = 0;
    return visibility;
}

}  // namespace lrsm
