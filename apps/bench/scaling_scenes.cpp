#include "apps/bench/scaling_scenes.h"

#include "core/base/elementary.h"
#include "core/base/errors.h"

namespace lrsm {
namespace {

/// Weights of a triangle's corners at (column, row) of its grid. Powers of two make them exact; on an edge the far corner's is 0, so that
/// both neighbours add the same two products.
struct Weights {
    float a, b, c;
};

template <class T>
T mixed(const std::vector<T>& stream, const std::array<std::uint32_t, 3>& corners, const Weights& w)
{
    return (stream[corners[0]] * w.a + stream[corners[1]] * w.b) + stream[corners[2]] * w.c;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from, const std::array<std::uint32_t, 3>& corners, const Weights& w)
{
    if (!from.empty()) to.push_back(mixed(from, corners, w));
}

void appendVertex(Mesh& to, const Mesh& from, const std::array<std::uint32_t, 3>& corners, const Weights& w)
{
    append(to.positions, from.positions, corners, w);
    append(to.uv0, from.uv0, corners, w);
    append(to.uv1, from.uv1, corners, w);
    append(to.colors, from.colors, corners, w);
    const Vec3 normal = mixed(from.normals, corners, w);
    const float length = glm::length(normal);
    to.normals.push_back(length > 0.0f ? normal / length : from.normals[corners[0]]);
    if (!from.tangents.empty()) {
        const Vec4 tangent = mixed(from.tangents, corners, w);
        const float size = glm::length(Vec3(tangent));
        const Vec4& first = from.tangents[corners[0]];
        to.tangents.push_back(size > 0.0f ? Vec4(Vec3(tangent) / size, first.w) : first);
    }
}

/// Vertices of row r (0 .. n) begin at r (r + 1) / 2; row r runs from corner side a-b to side a-c.
void appendTriangle(Mesh& to, const Mesh& from, const std::array<std::uint32_t, 3>& corners, int n)
{
    const auto first = static_cast<std::uint32_t>(to.positions.size());
    const float unit = 1.0f / static_cast<float>(n);
    for (int row = 0; row <= n; ++row)
        for (int column = 0; column <= row; ++column)
            appendVertex(to, from, corners, {static_cast<float>(n - row) * unit, static_cast<float>(row - column) * unit, static_cast<float>(column) * unit});
    const auto at = [&](int row, int column) { return first + static_cast<std::uint32_t>(row * (row + 1) / 2 + column); };
    for (int row = 0; row < n; ++row)
        for (int column = 0; column <= row; ++column) {
            to.triangles.push_back({at(row, column), at(row + 1, column), at(row + 1, column + 1)});
            if (column < row) to.triangles.push_back({at(row, column), at(row + 1, column + 1), at(row, column + 1)});
        }
}

}  // namespace

Scene subdivided(const Scene& scene, int doublings)
{
    constexpr int kMaxDoublings = 10;
    constexpr std::size_t kMaxTriangles = std::size_t(1) << 31;
    if (doublings < 0 || doublings > kMaxDoublings) throw InputError("doublings " + std::to_string(doublings), "must be 0 .. 10");
    const int n = 1 << doublings;
    const std::size_t factor = std::size_t(n) * std::size_t(n);
    if (scene.triangleCount() > kMaxTriangles / factor) throw InputError(scene.name, "would have more than 2^31 triangles; use fewer doublings");
    Scene finer = scene;
    if (doublings == 0) return finer;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        const Mesh& from = scene.meshes[m];
        Mesh to;
        to.name = from.name;
        to.material = from.material;
        to.triangles.reserve(from.triangles.size() * factor);
        for (const auto& corners : from.triangles) appendTriangle(to, from, corners, n);
        finer.meshes[m] = std::move(to);
    }
    return finer;
}

Scene withLightSplit(const Scene& scene, int count)
{
    if (scene.lights.empty()) throw InputError(scene.name, "has no light to split");
    if (count < 1 || count > 64) throw InputError("lights " + std::to_string(count), "must be 1 .. 64");
    constexpr float kTilt = 0.1f;
    constexpr double kTwoPi = 6.28318530717958647693;
    const Light whole = scene.lights.front();
    const Vec3 side = glm::cross(whole.up, whole.direction);
    Scene split = scene;
    split.lights.clear();
    for (int i = 0; i < count; ++i) {
        Light light = whole;
        light.name = whole.name + " part " + std::to_string(i);
        light.intensity = whole.intensity / static_cast<float>(count);
        if (count > 1 && whole.type != LightType::cubeFace) {
            const SinCos turn = sinCos(kTwoPi * i / count);
            light.direction = glm::normalize(whole.direction + kTilt * (static_cast<float>(turn.cos) * whole.up + static_cast<float>(turn.sin) * side));
            light.up = glm::normalize(whole.up - glm::dot(whole.up, light.direction) * light.direction);
        }
        split.lights.push_back(light);
    }
    return split;
}

}  // namespace lrsm
