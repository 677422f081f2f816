// Light through a wall that no light passes: a closed room, lit on one side of a divider. The truth behind it is 0 exactly.
#include "conetrace/render.h"
#include "core/scene/shapes.h"

#include "catch.h"

using namespace lrsm;

namespace {

constexpr float kHalfRoom = 2.0f, kHeight = 3.0f;

/// A room of 4 m x 3 m x 4 m, a divider from x = `at` on, `thickness` metres thick (0: one double-sided sheet), and a lamp in its left half.
Scene dividedRoom(float at, float thickness)
{
    Scene scene;
    scene.name = "divided room";
    scene.materials = {diffuseMaterial("wall", Vec3(0.7f), true)};
    Mesh room;
    room.name = "room";
    addBox(room, Vec3(-kHalfRoom, 0.0f, -kHalfRoom), Vec3(kHalfRoom, kHeight, kHalfRoom), true);
    const auto sheet = [&](float x) {
        addQuad(room, Vec3(x, 0.0f, -kHalfRoom), Vec3(x, kHeight, -kHalfRoom), Vec3(x, kHeight, kHalfRoom), Vec3(x, 0.0f, kHalfRoom));
    };
    sheet(at);
    if (thickness > 0.0f) sheet(at + thickness);
    scene.meshes.push_back(std::move(room));
    const float open = 1.3f, intensity = 20.0f;  // radians; W/sr
    scene.lights = {spotLight(Vec3(-1.0f, 2.6f, 0.0f), Vec3(-1.0f, 0.0f, 0.0f), Vec3(intensity), open, open + 0.1f)};
    updateBounds(scene);
    return scene;
}

double meanIrradiance(const Scene& scene, const Vec3& eye, const Settings& settings)
{
    const Camera camera = lookAt(eye, Vec3(eye.x > 0.0f ? 0.5f : -0.5f, 1.5f, -2.0f), Vec3(0.0f, 1.0f, 0.0f), 0.8f);
    RenderOptions options;
    options.width = 32;
    options.height = 24;
    const Frame frame = renderFrame(scene, camera, settings, options);
    double sum = 0.0;
    for (const Vec3& e : frame.irradiance.texels) sum += double(e.x);
    return sum / double(frame.irradiance.texels.size());
}

}  // namespace

TEST_CASE("walls: what a lit room gives to the dark one behind a divider", "[conetrace][slab][leak]")
{
    Settings settings;
    settings.voxel.resolution = 64;
    settings.rsm.resolution = 128;
    const float voxel = 2.0f * kHalfRoom / 64.0f;
    // Each limit is 1.15 times what was measured: cones are wide, and a sheet without thickness is met by light that reaches around its foot.
    struct Row {
        float thicknessVoxels;
        double limit;
    };
    for (const Row& row : {Row{0.0f, 0.124}, Row{2.0f, 0.0262}, Row{4.0f, 0.0134}}) {
        double darkest = 0.0;
        for (const float phase : {0.0f, 0.375f, 0.75f}) {
            const Scene scene = dividedRoom(phase * voxel, row.thicknessVoxels * voxel);
            const double dark = meanIrradiance(scene, Vec3(1.9f, 1.5f, 1.9f), settings), lit = meanIrradiance(scene, Vec3(-1.9f, 1.5f, 1.9f), settings);
            darkest = std::max(darkest, dark / lit);
        }
        CAPTURE(row.thicknessVoxels, darkest);
        CHECK(darkest < row.limit);
        CHECK(darkest > 0.5 * row.limit);  // much better than stated: state it
    }
}
