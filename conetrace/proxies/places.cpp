#include "conetrace/proxies/places.h"

#include "core/base/parallel.h"
#include "core/base/rng.h"
#include "core/scene/brdf.h"
#include "core/scene/cut_polygon.h"

#include <algorithm>
#include <cmath>

namespace lrsm {
namespace {

using DVec3 = glm::dvec3;

constexpr std::size_t kTrianglesPerTask = 2048;
constexpr double kPlaceUnits = 0x1p20;           // of the reach's longest side: a place is told from its neighbour, and rounding moves none
constexpr std::uint32_t kPlaceKey = 0x70726f78;  // keeps the two kinds of hash apart
constexpr std::uint32_t kIndexKey = 0x6965735f;

/// The scene's triangles by one number.
class TriangleNumbers {
  public:
    explicit TriangleNumbers(const Scene& scene)
    {
        for (const Mesh& mesh : scene.meshes) first_.push_back(first_.back() + mesh.triangles.size());
    }
    std::size_t count() const { return first_.back(); }
    SurfaceHit operator[](std::size_t number) const
    {
        const auto after = std::upper_bound(first_.begin(), first_.end(), number);
        const auto mesh = static_cast<std::size_t>(after - first_.begin()) - 1;
        return {.mesh = static_cast<std::uint32_t>(mesh), .triangle = static_cast<std::uint32_t>(number - first_[mesh])};
    }

  private:
    std::vector<std::size_t> first_ = {0};
};

struct TrianglePiece {
    DVec3 corner[3];
    double area() const
    {
        const double doubled = glm::length(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
        return std::isfinite(doubled) ? 0.5 * doubled : 0.0;
    }
    DVec3 centroid() const { return (corner[0] + corner[1] + corner[2]) / 3.0; }
    DVec3 at(const glm::dvec2& b) const { return corner[0] + b.x * (corner[1] - corner[0]) + b.y * (corner[2] - corner[0]); }
};

TrianglePiece wholeTriangle(const Scene& scene, const SurfaceHit& hit)
{
    const Mesh& mesh = scene.meshes[hit.mesh];
    const auto& corners = mesh.triangles[hit.triangle];
    return {{DVec3(mesh.positions[corners[0]]), DVec3(mesh.positions[corners[1]]), DVec3(mesh.positions[corners[2]])}};
}

/// visit(piece) for what of a triangle lies within the reach: itself, or a fan of what the box leaves of it.
template <class Visit>
void forPieces(const Scene& scene, const SurfaceHit& hit, const Visit& visit)
{
    const TrianglePiece whole = wholeTriangle(scene, hit);
    const Aabb& reach = scene.reach;
    if (!reachIsPart(scene) || std::all_of(whole.corner, whole.corner + 3, [&](const DVec3& p) { return reach.contains(Vec3(p)); })) return visit(whole);
    CutPolygon polygon;
    for (const DVec3& p : whole.corner) polygon.push(p);
    for (int axis = 0; axis < 3; ++axis) polygon = cut(cut(polygon, axis, -1.0, double(reach.min[axis])), axis, 1.0, double(reach.max[axis]));
    for (std::size_t k = 2; k < polygon.count; ++k) visit(TrianglePiece{{polygon.corner[0], polygon.corner[k - 1], polygon.corner[k]}});
}

/// Where p lies in the triangle, as barycentrics of its corners 1 and 2.
glm::dvec2 barycentricsOf(const TrianglePiece& triangle, const DVec3& p)
{
    const DVec3 e1 = triangle.corner[1] - triangle.corner[0], e2 = triangle.corner[2] - triangle.corner[0], n = glm::cross(e1, e2), q = p - triangle.corner[0];
    const double area2 = glm::dot(n, n);
    return {glm::dot(glm::cross(q, e2), n) / area2, glm::dot(glm::cross(e1, q), n) / area2};
}

/// How many proxies each piece of surface gets, and puts them there.
class Placer {
  public:
    Placer(const Scene& scene, const ProxySettings& settings, TextureFilter filter, double area)
        : scene_(scene), settings_(settings), filter_(filter), area_(area), diameter_(2.0f * settings.radius * std::sqrt(float(area / settings.count) / kPi))
    {
    }

    std::uint32_t countOn(const TrianglePiece& piece, const SurfaceHit& hit) const
    {
        const double hash = settings_.hash == ProxyHash::position ? placeHash(piece.centroid(), extentOf(scene_)) : indexHash(hit.mesh, hit.triangle);
        return proxyCount(settings_.count * (piece.area() / area_), hash);
    }

    void place(const SurfaceHit& triangle, PointProxies& out) const
    {
        forPieces(scene_, triangle, [&](const TrianglePiece& piece) {
            const std::uint32_t count = countOn(piece, triangle);
            for (std::uint32_t i = 1; i <= count; ++i) placeOne(piece, triangle, trianglePoint(halton(i, 2), halton(i, 3)), out);
        });
    }

  private:
    void placeOne(const TrianglePiece& piece, SurfaceHit hit, const glm::dvec2& b, PointProxies& out) const
    {
        const TrianglePiece whole = wholeTriangle(scene_, hit);
        const glm::dvec2 at = barycentricsOf(whole, piece.at(b));
        hit.b1 = float(at.x);
        hit.b2 = float(at.y);
        if (!passesAlphaTest(scene_, hit)) return;
        const Vec3 front(glm::normalize(glm::cross(whole.corner[1] - whole.corner[0], whole.corner[2] - whole.corner[0])));
        const Mat3 basis = basisFromNormal(front);
        const PixelSpacing spacing{basis[0] * diameter_, basis[1] * diameter_};
        const Surface surface = evaluateSurface(scene_, hit, front, filter_ == TextureFilter::trilinear ? &spacing : nullptr);
        out.positions.push_back(surface.position);
        out.normals.push_back(front);
        out.shadingNormals.push_back(surface.normal);
        out.albedos.push_back(surface.albedo);
        out.doubleSided.push_back(scene_.materials[std::size_t(scene_.meshes[hit.mesh].material)].doubleSided ? 1 : 0);
    }

    const Scene& scene_;
    const ProxySettings& settings_;
    TextureFilter filter_;
    double area_;
    float diameter_;  ///< of a disc that occludes: what of a texture a proxy stands for
};

template <class T>
void append(std::vector<T>& to, const std::vector<T>& more)
{
    to.insert(to.end(), more.begin(), more.end());
}

/// Sums in the order of the chunks, whatever their threads.
double areaOf(const Scene& scene, const TriangleNumbers& triangles)
{
    std::vector<double> partial(triangles.count() / kTrianglesPerTask + 1, 0.0);
    parallelFor(triangles.count(), kTrianglesPerTask, [&](std::size_t begin, std::size_t end) {
        double& sum = partial[begin / kTrianglesPerTask];
        for (std::size_t i = begin; i < end; ++i) forPieces(scene, triangles[i], [&](const TrianglePiece& piece) { sum += piece.area(); });
    });
    double area = 0.0;
    for (const double part : partial) area += part;
    return area;
}

}  // namespace

double placeHash(const glm::dvec3& centroid, const Aabb& reach)
{
    const DVec3 place = (centroid - DVec3(reach.min)) * (kPlaceUnits / double(reach.longestSide()));
    const auto unit = [](double x) { return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(x))); };
    return double(philox({unit(place.x), unit(place.y), unit(place.z), 0}, {kPlaceKey, 0})[0]) * 0x1p-32;
}

double indexHash(std::uint32_t mesh, std::uint32_t triangle)
{
    return double(philox({mesh, triangle, 0, 0}, {kIndexKey, 0})[0]) * 0x1p-32;
}

double halton(std::uint32_t i, std::uint32_t base)
{
    // Digits in reverse, as a whole number over a power of the base: one rounding.
    std::uint64_t reversed = 0, scale = 1;
    for (; i > 0; i /= base) {
        reversed = reversed * base + i % base;
        scale *= base;
    }
    return double(reversed) / double(scale);
}

glm::dvec2 trianglePoint(double u, double v)
{
    const double root = std::sqrt(u);
    return {1.0 - root, v * root};
}

PointProxies placeProxies(const Scene& scene, const ProxySettings& settings, TextureFilter textureFilter)
{
    PointProxies out;
    const TriangleNumbers triangles(scene);
    const double area = areaOf(scene, triangles);
    if (!(area > 0.0)) return out;
    out.area = float(area / settings.count);

    const Placer placer(scene, settings, textureFilter, area);
    std::vector<PointProxies> chunks(triangles.count() / kTrianglesPerTask + 1);
    parallelFor(triangles.count(), kTrianglesPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) placer.place(triangles[i], chunks[begin / kTrianglesPerTask]);
    });
    for (const PointProxies& chunk : chunks) {
        append(out.positions, chunk.positions);
        append(out.normals, chunk.normals);
        append(out.shadingNormals, chunk.shadingNormals);
        append(out.albedos, chunk.albedos);
        append(out.doubleSided, chunk.doubleSided);
    }
    return out;
}

}  // namespace lrsm
