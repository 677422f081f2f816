// Light through a wall that no light passes: a closed room, lit on one side of a divider. The truth behind it is 0 exactly.
#include "conetrace/render.h"
#include "core/scene/shapes.h"
#include "core/settings/settings_table.h"

#include "catch.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

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

/// The most, over `phases` places of the divider within a voxel, that the dark room gets of the lit one's irradiance.
double mostDarkOverLit(const Settings& settings, float thicknessVoxels, int phases)
{
    const float voxel = 2.0f * kHalfRoom / float(settings.voxel.resolution);
    double most = 0.0;
    for (int phase = 0; phase < phases; ++phase) {
        const Scene scene = dividedRoom(float(phase) / float(phases) * voxel, thicknessVoxels * voxel);
        const double dark = meanIrradiance(scene, Vec3(1.9f, 1.5f, 1.9f), settings), lit = meanIrradiance(scene, Vec3(-1.9f, 1.5f, 1.9f), settings);
        most = std::max(most, dark / lit);
    }
    return most;
}

}  // namespace

TEST_CASE("walls: what a lit room gives to the dark one behind a divider", "[conetrace][slab][leak]")
{
    Settings settings;
    settings.voxel.resolution = 64;
    settings.rsm.resolution = 128;
    // Each limit is 1.15 times what was measured: cones are wide, and a sheet without thickness is met by light that reaches around its foot.
    struct Row {
        float thicknessVoxels;
        double limit;
    };
    for (const Row& row : {Row{0.0f, 0.124}, Row{2.0f, 0.0262}, Row{4.0f, 0.0134}}) {
        const double leak = mostDarkOverLit(settings, row.thicknessVoxels, 3);
        CAPTURE(row.thicknessVoxels, leak);
        CHECK(leak < row.limit);
        CHECK(leak > 0.5 * row.limit);  // much better than stated: state it
    }
}

// Some minutes; its lines are those of docs/accuracy.md.
TEST_CASE("walls: the leak over a divider's thickness", "[.long][conetrace][slab][leak]")
{
    // Limits, from a thickness of two voxels on, are 1.1 times what was measured.
    struct Row {
        const char* preset;
        int resolution;
        double limit;
    };
    for (const Row& row : {Row{"balanced", 256, 0.0215}, Row{"balanced", 512, 0.033}, Row{"fine", 256, 0.0118}, Row{"fine", 512, 0.0254},
                           Row{"rays", 256, 0.004}, Row{"rays", 512, 0.0054}}) {
        Settings settings = preset(row.preset);
        settings.voxel.resolution = row.resolution;
        std::ostringstream line;
        line << std::fixed << std::setprecision(2);
        for (const float thicknessVoxels : {0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 6.0f}) {
            const double leak = mostDarkOverLit(settings, thicknessVoxels, 8);
            line << " " << 100.0 * leak;
            if (thicknessVoxels >= 2.0f) CHECK(leak < row.limit);
        }
        WARN(row.preset << ", " << row.resolution << "^3, dark over lit in %, divider of 0, 1, 2, 3, 4, 6 voxels:" << line.str());
    }
}
