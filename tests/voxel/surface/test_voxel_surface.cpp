#include "catch.h"

#include "core/base/parallel.h"
#include "core/scene/builtin_scenes.h"
#include "core/scene/shapes.h"
#include "voxel/surface/voxel_surface.h"
#include "voxel/voxelize.h"

#include <algorithm>
#include <mutex>
#include <random>
#include <set>

using namespace lrsm;

namespace {

VoxelSettings gridOf(int resolution, Voxelization mode)
{
    VoxelSettings settings;
    settings.resolution = resolution;
    settings.mode = mode;
    return settings;
}

VoxelSurface surfaceOf(const Scene& scene, const VoxelSettings& settings)
{
    return voxelSurface(scene, voxelize(scene, settings), settings, TextureFilter::trilinear);
}

/// A sheet in the plane x = `x`, 1 m wide, seen from +x and, if `both`, with another of its own from -x.
Scene sheet(float x, bool both)
{
    Scene scene;
    scene.materials = {diffuseMaterial("red", Vec3(0.75f, 0.25f, 0.125f)), diffuseMaterial("blue", Vec3(0.125f, 0.25f, 0.75f))};
    scene.meshes.resize(both ? 2 : 1);
    addQuad(scene.meshes[0], {x, 0, 0}, {x, 1, 0}, {x, 1, 1}, {x, 0, 1});
    if (both) {
        addQuad(scene.meshes[1], {x, 0, 0}, {x, 0, 1}, {x, 1, 1}, {x, 1, 0});
        scene.meshes[1].material = 1;
    }
    updateBounds(scene);
    return scene;
}

double totalArea(const Mesh& mesh)
{
    double area = 0.0;
    for (const auto& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
        area += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    return area;
}

}  // namespace

TEST_CASE("fragments: the voxels of voxelize, each once a triangle", "[voxel][surface]")
{
    for (const Voxelization mode : {Voxelization::conservative, Voxelization::thin, Voxelization::raster}) {
        const Scene scene = *makeBuiltinScene("cornell-box");
        const VoxelSettings settings = gridOf(64, mode);
        const BitGrid bits = voxelize(scene, settings);
        BitGrid met = bits;
        std::fill(met.bricks.begin(), met.bricks.end(), 0);
        std::set<std::tuple<std::uint32_t, std::uint32_t, std::size_t>> seen;
        std::size_t count = 0;
        std::mutex mutex;
        forEachFragment(scene, bits.grid, mode, [&](const BrickFragments& fragments) {
            const std::lock_guard lock(mutex);
            met.bricks[fragments.brick] |= fragments.voxels;
            forEachBit(fragments.voxels, [&](int bit) {
                ++count;
                seen.insert({fragments.mesh, fragments.triangle, 64 * fragments.brick + std::size_t(bit)});
            });
        });
        CHECK(met.bricks == bits.bricks);
        CHECK(count == seen.size());
    }
}

TEST_CASE("surfels: areas within voxels sum to the triangle's", "[voxel][surface]")
{
    std::mt19937 random(4);
    std::uniform_real_distribution<double> place(0.0, 6.0);
    for (int k = 0; k < 20; ++k) {
        glm::dvec3 t[3];
        for (glm::dvec3& p : t) p = {place(random), place(random), place(random)};
        double sum = 0.0;
        for (int z = 0; z < 6; ++z)
            for (int y = 0; y < 6; ++y)
                for (int x = 0; x < 6; ++x) sum += areaInVoxel(t, {x, y, z});
        CHECK(sum == Approx(0.5 * glm::length(glm::cross(t[1] - t[0], t[2] - t[0]))).epsilon(1e-12));
    }
    // And over a scene without faces between voxels, which would count in both: conservative voxels miss none of it.
    Scene scene;
    scene.materials = {diffuseMaterial("grey", Vec3(0.5f))};
    scene.meshes.resize(1);
    addSphere(scene.meshes[0], {0.1f, 0.2f, 0.3f}, 1.0f, 3);
    updateBounds(scene);
    const VoxelSettings settings = gridOf(32, Voxelization::conservative);
    const double face = double(voxelize(scene, settings).grid.voxelSize);
    double expected = 0.0, sum = 0.0;
    for (const Mesh& mesh : scene.meshes) expected += totalArea(mesh);
    for (const VoxelSurfel& surfel : surfaceOf(scene, settings).surfels) sum += double(surfel.area);
    CHECK(sum * face * face == Approx(expected).epsilon(1e-3));
}

TEST_CASE("surfels: a sheet keeps its normal and colour, two back to back cancel and mix", "[voxel][surface]")
{
    const VoxelSurface one = surfaceOf(sheet(0.0f, false), gridOf(32, Voxelization::thin));
    REQUIRE(one.surfels.size() > 500);
    for (const VoxelSurfel& surfel : one.surfels) {
        CHECK(std::abs(surfel.normal.x) == Approx(1.0f).margin(2e-4));
        CHECK_FALSE(normalCancels(surfel));
        CHECK(surfel.albedo.x == Approx(0.75f).margin(2e-4));
        CHECK(surfel.area <= 1.001f);
    }
    const VoxelSurface two = surfaceOf(sheet(0.0f, true), gridOf(32, Voxelization::thin));
    REQUIRE(two.surfels.size() == one.surfels.size());
    for (const VoxelSurfel& surfel : two.surfels) {
        CHECK(normalCancels(surfel));
        CHECK(surfel.albedo.x == Approx(0.4375f).margin(4e-4));
        CHECK(surfel.albedo.z == Approx(0.4375f).margin(4e-4));
    }
}

TEST_CASE("surfels: the same bits for any order of triangles and any number of threads", "[voxel][surface]")
{
    Scene scene = *makeBuiltinScene("atrium");
    const VoxelSettings settings = gridOf(64, Voxelization::thin);
    const auto bits = [&] { return hashOf(surfaceOf(scene, settings)); };
    const std::string first = bits();
    {
        const ThreadLimit limit(1);
        CHECK(bits() == first);
    }
    for (Mesh& mesh : scene.meshes) std::reverse(mesh.triangles.begin(), mesh.triangles.end());
    CHECK(bits() == first);
}

TEST_CASE("surfels: by count every triangle weighs the same", "[voxel][surface]")
{
    VoxelSettings settings = gridOf(8, Voxelization::thin);
    settings.surfaceWeight = VoxelWeight::count;
    Scene scene = sheet(0.0f, false);
    addQuad(scene.meshes[0], {0.2f, 0, 0}, {0.2f, 1, 0}, {0.2f, 1, 1}, {0.2f, 0, 1});  // so that no voxel ends near the first sheet
    // A speck of another colour beside the sheet, turned by 90 degrees.
    scene.meshes.emplace_back();
    addQuad(scene.meshes[1], {0.0f, 0.5f, 0.5f}, {0.0f, 0.5f, 0.51f}, {0.01f, 0.5f, 0.51f}, {0.01f, 0.5f, 0.5f});
    scene.meshes[1].material = 1;
    updateBounds(scene);
    const auto bluest = [&] {
        float most = 0.0f;
        for (const VoxelSurfel& surfel : surfaceOf(scene, settings).surfels) most = std::max(most, surfel.albedo.z);
        return most;
    };
    CHECK(bluest() > 0.3f);
    settings.surfaceWeight = VoxelWeight::area;
    CHECK(bluest() < 0.14f);
}
