// Every real file against the table that other programs made of it.
#include "core/base/errors.h"
#include "core/scene/gltf.h"

#include "catch.h"
#include "scenes.h"

#include <fstream>
#include <map>
#include <sstream>

using namespace lrsm;

namespace {

using Row = std::map<std::string, std::string>;

std::vector<Row> readTable(const std::filesystem::path& path)
{
    std::ifstream stream(path);
    const auto cells = [](const std::string& line) {
        std::vector<std::string> result;
        std::istringstream in(line);
        for (std::string cell; std::getline(in, cell, '\t');) result.push_back(cell);
        return result;
    };
    std::string line;
    std::getline(stream, line);
    const std::vector<std::string> names = cells(line);
    std::vector<Row> rows;
    while (std::getline(stream, line)) {
        const std::vector<std::string> values = cells(line);
        Row row;
        for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = i < values.size() ? values[i] : "";
        rows.push_back(row);
    }
    return rows;
}

Vec3 vec3(const std::string& text)
{
    std::istringstream in(text);
    Vec3 v;
    in >> v.x >> v.y >> v.z;
    return v;
}

std::filesystem::path fileOf(const Row& row)
{
    return scenesFolder() / row.at("file").substr(4);  // "dev/..."
}

/// What every pass may rely on: parallel streams, unit normals and tangents, indices in range, decoded textures where used.
void checkStreams(const Scene& scene)
{
    for (const Mesh& mesh : scene.meshes) {
        const std::size_t n = mesh.positions.size();
        REQUIRE(mesh.normals.size() == n);
        for (const std::size_t size : {mesh.tangents.size(), mesh.uv0.size(), mesh.uv1.size(), mesh.colors.size()}) REQUIRE((size == 0 || size == n));
        float worst = 0.0f;
        for (const Vec3& normal : mesh.normals) worst = std::max(worst, std::abs(glm::length(normal) - 1.0f));
        for (const Vec4& tangent : mesh.tangents) worst = std::max(worst, std::abs(glm::length(Vec3(tangent)) - 1.0f));
        CHECK(worst < 1e-6f);
        std::uint32_t largest = 0;
        for (const auto& triangle : mesh.triangles)
            for (const std::uint32_t v : triangle) largest = std::max(largest, v);
        REQUIRE(largest < n);
        REQUIRE(std::size_t(mesh.material) < scene.materials.size());
        const Material& material = scene.materials[std::size_t(mesh.material)];
        for (const TextureUse* use : {&material.baseColorTexture, &material.metallicRoughnessTexture, &material.normalTexture}) {
            if (!*use) continue;
            CHECK_FALSE(scene.textures[std::size_t(use->texture)]->image.empty());
            CHECK_FALSE((use->uvSet == 1 ? mesh.uv1 : mesh.uv0).empty());
        }
    }
}

}  // namespace

TEST_CASE("every real file has the triangles, vertices and bounds that other programs counted", "[scene][gltf]")
{
    LRSM_NEED_SCENES();
    for (const Row& row : readTable(scenesFolder() / "SCENES.tsv")) {
        if (!std::filesystem::exists(fileOf(row))) continue;
        CAPTURE(row.at("file"));
        const Scene scene = loadGltf(fileOf(row).string(), {0.0f, -1});
        std::size_t vertices = 0;
        for (const Mesh& mesh : scene.meshes) vertices += mesh.positions.size();
        CHECK(scene.triangleCount() == std::stoul(row.at("triangles")));
        // Flat normals split the vertices.
        CHECK(vertices == (row.at("normals") == "yes" ? std::stoul(row.at("vertices")) : 3 * scene.triangleCount()));
        const Vec3 lo = vec3(row.at("bbox_min")), hi = vec3(row.at("bbox_max"));
        for (int axis = 0; axis < 3; ++axis) {
            CHECK(scene.bounds.min[axis] == Approx(lo[axis]).margin(6e-5));
            CHECK(scene.bounds.max[axis] == Approx(hi[axis]).margin(6e-5));
        }
        CHECK_FALSE(scene.lights.empty());
        CHECK_FALSE(scene.cameras.empty());
        checkStreams(scene);
    }
}
