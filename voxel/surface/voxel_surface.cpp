#include "voxel/surface/voxel_surface.h"

#include "core/base/memory.h"
#include "core/base/parallel.h"
#include "core/scene/brdf.h"
#include "core/scene/cut_polygon.h"
#include "voxel/voxelize.h"

#include <array>
#include <atomic>
#include <cassert>
#include <cmath>

namespace lrsm {
namespace {

using DVec3 = glm::dvec3;

enum Sum { kAlbedo = 0, kNormal = 3, kPosition = 6, kWeight = 9, kArea = 10, kSums = 11 };
using SurfelSums = std::array<std::int64_t, kSums>;

void addTo(std::int64_t& sum, double value)
{
    const auto term = static_cast<std::int64_t>(std::floor(value / kSurfaceSumUnit + 0.5));
    std::atomic_ref<std::int64_t>(sum).fetch_add(term, std::memory_order_relaxed);
}

void addTo(SurfelSums& sums, int first, const DVec3& value)
{
    for (int axis = 0; axis < 3; ++axis) addTo(sums[std::size_t(first + axis)], value[axis]);
}

struct Barycentric {
    double b1 = 0.0, b2 = 0.0;
};

/// The point of segment a + s e nearest to p.
double nearestOnSegment(const DVec3& a, const DVec3& e, const DVec3& p)
{
    const double length2 = glm::dot(e, e);
    return length2 > 0.0 ? glm::clamp(glm::dot(p - a, e) / length2, 0.0, 1.0) : 0.0;
}

/// The triangle's point nearest to p: its foot on the plane, or the nearest of the three edges' points.
Barycentric nearestPoint(const DVec3 (&t)[3], const DVec3& p)
{
    const DVec3 e1 = t[1] - t[0], e2 = t[2] - t[0], n = glm::cross(e1, e2);
    const double area2 = glm::dot(n, n);
    if (area2 > 0.0) {
        const DVec3 q = p - t[0];
        const double b1 = glm::dot(glm::cross(q, e2), n) / area2, b2 = glm::dot(glm::cross(e1, q), n) / area2;
        if (b1 >= 0.0 && b2 >= 0.0 && b1 + b2 <= 1.0) return {b1, b2};
    }
    const double onE1 = nearestOnSegment(t[0], e1, p), onE2 = nearestOnSegment(t[0], e2, p), onE3 = nearestOnSegment(t[1], t[2] - t[1], p);
    const Barycentric candidates[3] = {{onE1, 0.0}, {0.0, onE2}, {1.0 - onE3, onE3}};
    const auto distance2 = [&](const Barycentric& b) {
        const DVec3 d = t[0] + b.b1 * e1 + b.b2 * e2 - p;
        return glm::dot(d, d);
    };
    Barycentric best = candidates[0];
    for (const Barycentric& candidate : {candidates[1], candidates[2]})
        if (distance2(candidate) < distance2(best)) best = candidate;
    return best;
}

/// One triangle's part in the voxels' sums.
class FragmentAdder {
  public:
    FragmentAdder(const Scene& scene, const VoxelGrid& grid, TextureFilter filter, const BrickFragments& fragments)
        : scene_(scene), mesh_(scene.meshes[fragments.mesh]), filter_(filter), hit_{.mesh = fragments.mesh, .triangle = fragments.triangle}
    {
        constexpr double kUnit = 1.0 / (1 << kVoxelFractionBits);
        const auto& corners = mesh_.triangles[fragments.triangle];
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& v = fragments.piece.vertex[k];
            piece_[k] = DVec3(v[0], v[1], v[2]) * kUnit;
            whole_[k] = (DVec3(mesh_.positions[corners[k]]) - DVec3(grid.origin)) / double(grid.voxelSize);
        }
        front_ = Vec3(glm::normalize(glm::cross(whole_[1] - whole_[0], whole_[2] - whole_[0])));
        const Mat3 basis = basisFromNormal(front_);
        spacing_ = {basis[0] * grid.voxelSize, basis[1] * grid.voxelSize};
    }

    void add(const IVec3& voxel, VoxelWeight weighting, SurfelSums& sums)
    {
        const DVec3 corner(voxel);
        const Barycentric at = nearestPoint(whole_, corner + 0.5);
        hit_.b1 = float(at.b1);
        hit_.b2 = float(at.b2);
        const Surface surface = evaluateSurface(scene_, hit_, front_, filter_ == TextureFilter::trilinear ? &spacing_ : nullptr);
        const DVec3 place = whole_[0] + at.b1 * (whole_[1] - whole_[0]) + at.b2 * (whole_[2] - whole_[0]) - corner;
        const double area = areaInVoxel(piece_, voxel), weight = weighting == VoxelWeight::area ? std::max(area, kLeastFragmentArea) : 1.0;
        addTo(sums, kAlbedo, weight * DVec3(surface.albedo));
        addTo(sums, kNormal, weight * DVec3(surface.normal));
        addTo(sums, kPosition, weight * glm::clamp(place, 0.0, 1.0));
        addTo(sums[kWeight], weight);
        addTo(sums[kArea], area);
    }

  private:
    const Scene& scene_;
    const Mesh& mesh_;
    TextureFilter filter_;
    SurfaceHit hit_;
    DVec3 piece_[3], whole_[3];  ///< voxels
    Vec3 front_{0.0f};
    PixelSpacing spacing_;
};

VoxelSurfel surfelOf(const SurfelSums& sums)
{
    if (sums[kWeight] <= 0) return {};
    const auto mean = [&](int first) {
        const double w = double(sums[kWeight]);
        const auto at = [&](int axis) { return float(double(sums[std::size_t(first + axis)]) / w); };
        return Vec3(at(0), at(1), at(2));
    };
    return {.albedo = mean(kAlbedo), .normal = mean(kNormal), .position = mean(kPosition), .area = float(double(sums[kArea]) * kSurfaceSumUnit)};
}

}  // namespace

double areaInVoxel(const glm::dvec3 (&triangle)[3], const IVec3& corner)
{
    CutPolygon polygon;
    for (const DVec3& p : triangle) polygon.push(p - DVec3(corner));
    for (int axis = 0; axis < 3; ++axis) polygon = cut(cut(polygon, axis, -1.0, 0.0), axis, 1.0, 1.0);
    DVec3 doubled(0.0);
    for (std::size_t k = 2; k < polygon.count; ++k) doubled += glm::cross(polygon.corner[k - 1] - polygon.corner[0], polygon.corner[k] - polygon.corner[0]);
    return 0.5 * glm::length(doubled);
}

VoxelSurface voxelSurface(const Scene& scene, const BitGrid& bits, const VoxelSettings& settings, TextureFilter textureFilter)
{
    VoxelSurface surface;
    surface.resolution = bits.grid.resolution;
    surface.index = indexVoxels(bits);
    const std::size_t count = surface.index.count();
    requireMemory(count * (sizeof(SurfelSums) + sizeof(VoxelSurfel)), "voxel surface", "lower voxel_resolution");
    std::vector<SurfelSums> sums(count, SurfelSums{});
    forEachFragment(scene, bits.grid, settings.mode, [&](const BrickFragments& fragments) {
        FragmentAdder adder(scene, bits.grid, textureFilter, fragments);
        forEachBit(fragments.voxels, [&](int bit) {
            adder.add(voxelOf(bits, fragments.brick, bit), settings.surfaceWeight, sums[surface.index.at(bits, fragments.brick, bit)]);
        });
    });
    surface.surfels.resize(count);
    constexpr std::size_t kGrain = 4096;
    parallelFor(count, kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) surface.surfels[i] = surfelOf(sums[i]);
    });
    return surface;
}

}  // namespace lrsm
