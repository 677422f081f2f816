#include "core/raster/draw_scene.h"

#include "core/base/parallel.h"

#include <algorithm>

namespace lrsm {

namespace {

/// The scene as the rasterizer wants it: one vertex and one triangle array.
struct Submission {
    std::vector<Vec4> clipPositions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Cull> cull;
    std::vector<std::uint8_t> tested;  ///< empty: no alpha test anywhere
    std::vector<std::uint32_t> firstVertex, firstTriangle;
};

/// Distance of a perspective projection's near plane along its axis; 0 for an orthographic one.
double nearPlaneOf(const Mat4& m)
{
    const glm::dvec3 z(m[0][2], m[1][2], m[2][2]), w(m[0][3], m[1][3], m[2][3]);
    const double z2 = glm::dot(z, z), w2 = glm::dot(w, w);
    return w2 > 0.0 && z2 > 0.0 ? double(m[3][3]) - double(m[3][2]) * std::sqrt(w2 / z2) : 0.0;
}

/// Vertices for which one rounding of w moves the near plane's cut by more than a thousandth.
std::vector<FarVertex> farVertices(const Scene& scene, const Mat4& clipFromWorld, const Submission& all)
{
    constexpr double kNearPlanes = 0x1p14;
    std::vector<FarVertex> far;
    const double limit = kNearPlanes * nearPlaneOf(clipFromWorld);
    if (!(limit > 0.0)) return far;
    const glm::dmat4 exact(clipFromWorld);
    for (std::size_t m = 0; m < scene.meshes.size(); ++m)
        for (std::size_t i = 0; i < scene.meshes[m].positions.size(); ++i) {
            const auto vertex = std::uint32_t(all.firstVertex[m] + i);
            if (std::abs(double(all.clipPositions[vertex].w)) > limit)
                far.push_back({vertex, exact * glm::dvec4(glm::dvec3(scene.meshes[m].positions[i]), 1.0)});
        }
    return far;
}

Submission layOut(const Scene& scene, bool alphaTest)
{
    Submission all;
    std::uint32_t vertices = 0, triangles = 0;
    bool anyMask = false;
    for (const Mesh& mesh : scene.meshes) {
        all.firstVertex.push_back(vertices);
        all.firstTriangle.push_back(triangles);
        vertices += static_cast<std::uint32_t>(mesh.positions.size());
        triangles += static_cast<std::uint32_t>(mesh.triangles.size());
        anyMask = anyMask || scene.materials[std::size_t(mesh.material)].alphaMask;
    }
    all.firstTriangle.push_back(triangles);
    all.clipPositions.resize(vertices);
    all.triangles.resize(triangles);
    all.cull.resize(triangles);
    if (alphaTest && anyMask) all.tested.resize(triangles);
    return all;
}

}  // namespace

SceneFragments drawScene(const Scene& scene, const Mat4& clipFromWorld, const Requirements& needs, int width, int height)
{
    Submission all = layOut(scene, needs.alphaTest);
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        const Mesh& mesh = scene.meshes[m];
        const Material& material = scene.materials[std::size_t(mesh.material)];
        const std::uint32_t v0 = all.firstVertex[m], t0 = all.firstTriangle[m];
        parallelFor(mesh.positions.size(), 16384, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) all.clipPositions[v0 + i] = clipFromWorld * Vec4(mesh.positions[i], 1.0f);
        });
        parallelFor(mesh.triangles.size(), 16384, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                for (std::size_t k = 0; k < 3; ++k) all.triangles[t0 + i][k] = v0 + mesh.triangles[i][k];
        });
        std::fill_n(all.cull.begin() + t0, mesh.triangles.size(), material.doubleSided ? Cull::none : Cull::back);
        if (!all.tested.empty()) std::fill_n(all.tested.begin() + t0, mesh.triangles.size(), std::uint8_t(material.alphaMask));
    }

    const std::vector<FarVertex> far = farVertices(scene, clipFromWorld, all);
    RasterOutput drawn = rasterize({.clipPositions = all.clipPositions, .triangles = all.triangles, .cull = all.cull, .far = far}, width, height, all.tested,
                                   [&](const Fragment& fragment) { return passesAlphaTest(scene, hitOf(all.firstTriangle, fragment)); });
    return {std::move(drawn.fragments), drawn.counts, std::move(all.firstTriangle)};
}

SurfaceHit hitOf(const std::vector<std::uint32_t>& firstTriangle, const Fragment& fragment)
{
    const auto next = std::upper_bound(firstTriangle.begin(), firstTriangle.end(), fragment.triangle);
    const auto mesh = static_cast<std::uint32_t>(next - firstTriangle.begin() - 1);
    return {.mesh = mesh, .triangle = fragment.triangle - firstTriangle[mesh], .b1 = fragment.b1, .b2 = fragment.b2};
}

}  // namespace lrsm
