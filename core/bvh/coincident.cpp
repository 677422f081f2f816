#include "core/bvh/coincident.h"

#include <algorithm>

namespace lrsm {
namespace {

using Corner = std::array<float, 3>;

/// A triangle by its corners alone.
struct Face {
    std::array<Corner, 3> corners;  ///< sorted
    bool turned = false;            ///< by sorting: the other winding
    std::uint32_t mesh = 0, triangle = 0;
};

Face faceOf(const Scene& scene, std::uint32_t m, std::uint32_t t)
{
    Face face{.corners = {}, .turned = false, .mesh = m, .triangle = t};
    const Mesh& mesh = scene.meshes[m];
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 p = mesh.positions[mesh.triangles[t][k]] + Vec3(0.0f);  // -0 is 0
        face.corners[k] = {p.x, p.y, p.z};
    }
    const auto order = [&](std::size_t a, std::size_t b) {
        if (!(face.corners[b] < face.corners[a])) return;
        std::swap(face.corners[a], face.corners[b]);
        face.turned = !face.turned;
    };
    order(0, 1);
    order(1, 2);
    order(0, 1);
    return face;
}

bool hasArea(const Face& face)
{
    return face.corners[0] < face.corners[1] && face.corners[1] < face.corners[2];  // false for NaN, too
}

/// Whatever ray or pixel meets `later` meets `first` there.
bool hides(const Scene& scene, const Face& first, const Face& later)
{
    const auto materialOf = [&](const Face& face) -> const Material& { return scene.materials[std::size_t(scene.meshes[face.mesh].material)]; };
    const Material &a = materialOf(first), &b = materialOf(later);
    return !a.alphaMask && (a.doubleSided || (!b.doubleSided && first.turned == later.turned));
}

}  // namespace

std::vector<std::vector<std::uint8_t>> hiddenTriangles(const Scene& scene)
{
    std::vector<Face> faces;
    faces.reserve(scene.triangleCount());
    for (std::uint32_t m = 0; m < scene.meshes.size(); ++m)
        for (std::uint32_t t = 0; t < scene.meshes[m].triangles.size(); ++t)
            if (const Face face = faceOf(scene, m, t); hasArea(face)) faces.push_back(face);
    std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
        return a.corners != b.corners ? a.corners < b.corners : a.mesh != b.mesh ? a.mesh < b.mesh : a.triangle < b.triangle;
    });

    std::vector<std::vector<std::uint8_t>> hidden(scene.meshes.size());
    for (std::size_t begin = 0, end = 0; begin < faces.size(); begin = end) {
        while (end < faces.size() && faces[end].corners == faces[begin].corners) ++end;
        for (std::size_t later = begin + 1; later < end; ++later) {
            const Face& face = faces[later];
            const auto first = faces.begin() + std::ptrdiff_t(begin);
            if (std::none_of(first, faces.begin() + std::ptrdiff_t(later), [&](const Face& earlier) { return hides(scene, earlier, face); })) continue;
            hidden[face.mesh].resize(scene.meshes[face.mesh].triangles.size(), 0);
            hidden[face.mesh][face.triangle] = 1;
        }
    }
    return hidden;
}

}  // namespace lrsm
