#include "apps/info/advice.h"

#include "conetrace/render.h"
#include "core/scene/builtin_scenes.h"
#include "core/scene/shapes.h"
#include "core/settings/settings_table.h"

#include <catch.h>

#include <random>

using namespace lrsm;

namespace {

/// Square of side 2 m at height y, facing up.
void addFloor(Scene& scene, float y, float side = 2.0f, float x = 0.0f)
{
    if (scene.meshes.empty()) {
        scene.materials.push_back(diffuseMaterial("grey", Vec3(0.5f), true));
        scene.meshes.emplace_back();
    }
    const float h = 0.5f * side;
    addQuad(scene.meshes[0], Vec3(x - h, y, h), Vec3(x + h, y, h), Vec3(x + h, y, -h), Vec3(x - h, y, -h));
    updateBounds(scene);
}

Scene floorScene()
{
    Scene scene;
    addFloor(scene, 0.0f);
    scene.lights.push_back(directionalLight(Vec3(0, -1, 0), Vec3(1.0f)));
    scene.cameras.push_back(lookAt(Vec3(0, 3, 4), Vec3(0), Vec3(0, 1, 0), 0.6f));
    return scene;
}

Settings adviceSettings()
{
    Settings settings;
    settings.voxel.resolution = 64;
    settings.rsm.resolution = 128;
    return settings;
}

SceneAnalysis analysisOf(const Scene& scene, const Settings& settings)
{
    return analyseScene(scene, scene.cameras.at(0), analyseRequirements(scene, settings.force), settings, 48, 27);
}

const Advice* adviceOn(const std::vector<Advice>& advice, const std::string& key)
{
    for (const Advice& change : advice)
        if (change.key == key) return &change;
    return nullptr;
}

Frame adviceFrame(const Scene& scene, const Settings& settings)
{
    RenderOptions options;
    options.width = 40;
    options.height = 24;
    return renderFrame(scene, scene.cameras.at(0), settings, options);
}

}  // namespace

TEST_CASE("texels and taps are as wide as geometry says, and one plane moves nothing when its layers are merged", "[sweep][advice]")
{
    const SceneAnalysis found = analysisOf(floorScene(), adviceSettings());
    REQUIRE(found.lights.size() == 1);
    CHECK(found.lights[0].litTexels == found.lights[0].texels);
    CHECK(found.lights[0].texelSize == Approx(2.0 * 2.0 / 127).epsilon(1e-4));  // one texel of 128 is left for snapping
    CHECK(found.lights[0].moved < 1e-3);
    CHECK(found.finestTap == Approx(2.0 / 60).epsilon(1e-4));  // a voxel
}

TEST_CASE("a spot's texels grow with the distance along its axis", "[sweep][advice]")
{
    Scene scene = floorScene();
    scene.lights = {spotLight(Vec3(0, 4, 0), Vec3(0, 0, 0), Vec3(1.0f), 0.1f, 0.15f)};
    const double edge = 2.0 * 2.0 * 4.0 * std::tan(0.15) / 128.0;
    const SceneAnalysis found = analysisOf(scene, adviceSettings());
    CHECK(found.lights[0].texelSize == Approx(edge).epsilon(1e-3));
    // The corners of the map are outside of the light's cone.
    CHECK(double(found.lights[0].litTexels) / double(found.lights[0].texels) == Approx(3.14159265 / 4).epsilon(0.02));
}

TEST_CASE("a plane that faces the camera covers the picture, half a plane half of it", "[sweep][advice]")
{
    Scene scene = floorScene();
    scene.cameras = {lookAt(Vec3(0, 5, 0), Vec3(0), Vec3(0, 0, -1), 0.2f)};
    CHECK(analysisOf(scene, adviceSettings()).coveredFraction == Approx(1.0));
    scene.cameras = {lookAt(Vec3(1, 5, 0), Vec3(1, 0, 0), Vec3(0, 0, -1), 0.1f)};
    CHECK(analysisOf(scene, adviceSettings()).coveredFraction == Approx(0.5));
}

TEST_CASE("advice: one layer for one plane, two for stacked ones", "[sweep][advice]")
{
    Scene scene = floorScene();
    Settings settings = adviceSettings();
    scene.lights = {directionalLight(Vec3(0.1f, -1.0f, 0.05f), Vec3(1.0f))};  // depths slope over both slices, and only a footprint on the cut holds two
    auto advice = adviseSettings(scene, analysisOf(scene, settings), settings, 48, 27);
    REQUIRE(adviceOn(advice, "depth_layers"));
    CHECK(adviceOn(advice, "depth_layers")->to == "1");
    CHECK(adviceOn(advice, "depth_layers")->predictedMemoryRatio < 1.0);
    scene.lights = {directionalLight(Vec3(0, -1, 0), Vec3(1.0f))};

    // A fringe of small squares over the floor: most footprints hold two depths.
    for (int i = 0; i < 20; ++i) addFloor(scene, 0.6f, 0.05f, -0.95f + 0.1f * float(i));
    settings = adviceSettings();
    CHECK(adviceOn(adviseSettings(scene, analysisOf(scene, settings), settings, 48, 27), "depth_layers") == nullptr);
}

TEST_CASE("advice: the finer of map and voxels is wasted", "[sweep][advice]")
{
    const Scene scene = floorScene();
    Settings settings = adviceSettings();
    settings.rsm.resolution = 1024;  // LRSM texels 2 m / 511, voxels 2 m / 60
    auto advice = adviseSettings(scene, analysisOf(scene, settings), settings, 48, 27);
    REQUIRE(adviceOn(advice, "rsm_resolution"));
    CHECK(adviceOn(advice, "rsm_resolution")->from == "1024");
    CHECK(adviceOn(advice, "rsm_resolution")->to == "128");  // ratio 0.117, 0.235, 0.47: halved while at most 1/2
    CHECK(adviceOn(advice, "rsm_resolution")->predictedMemoryRatio < 0.5);
    CHECK(adviceOn(advice, "voxel_resolution") == nullptr);
    Settings lightInVoxels = settings;
    lightInVoxels.method = Method::vct;  // reads no LRSM
    CHECK(adviceOn(adviseSettings(scene, analysisOf(scene, lightInVoxels), lightInVoxels, 48, 27), "rsm_resolution") == nullptr);

    settings.rsm.resolution = 128;
    settings.voxel.resolution = 256;
    advice = adviseSettings(scene, analysisOf(scene, settings), settings, 48, 27);
    REQUIRE(adviceOn(advice, "voxel_resolution"));
    CHECK(adviceOn(advice, "voxel_resolution")->to == "64");  // ratio 3.97, 1.98
    REQUIRE(adviceOn(advice, "start_voxels"));
    CHECK(adviceOn(advice, "start_voxels")->to == "2");
    const Settings applied = applyAdvice(settings, advice);
    CHECK(applied.voxel.resolution == 64);
    CHECK(applied.cones.march.startVoxels == 2.0f);
    CHECK(adviceOn(adviseSettings(scene, analysisOf(scene, applied), applied, 48, 27), "voxel_resolution") == nullptr);  // taken once, it is not given again
}

TEST_CASE("a light that lights nothing keeps no layer, changes no bit, and gives no advice", "[sweep][advice]")
{
    Scene scene = floorScene();
    const Settings settings = adviceSettings();
    const Frame before = adviceFrame(scene, settings);
    Light away = spotLight(Vec3(0, 1, 0), Vec3(0, 2, 0), Vec3(1.0f), 0.3f, 0.4f);
    scene.lights.push_back(away);
    const SceneAnalysis found = analysisOf(scene, settings);
    CHECK(found.lights[1].litTexels == 0);
    CHECK(found.lights[1].layers == 0);
    CHECK(adviceFrame(scene, settings).combined.texels == before.combined.texels);
    scene.lights.clear();
    CHECK(adviseSettings(scene, analysisOf(scene, settings), settings, 48, 27).empty());
}

TEST_CASE("what is left out changes no bit: random small scenes, forced and not", "[sweep][advice][requirements]")
{
    std::mt19937 random(71);
    const auto uniform = [&](float low, float high) { return low + (high - low) * float(random() >> 8) * 0x1p-24f; };
    const auto point = [&](float reach) {
        const float x = uniform(-reach, reach), y = uniform(0.1f, reach), z = uniform(-reach, reach);
        return Vec3(x, y, z);
    };
    for (int trial = 0; trial < 12; ++trial) {
        Scene scene = floorScene();
        const int boxes = 1 + int(random() % 3u);
        for (int i = 0; i < boxes; ++i) {
            const Vec3 at = point(0.8f);
            addBox(scene.meshes[0], at - Vec3(0.1f), at + Vec3(uniform(0.05f, 0.4f)));
        }
        if (random() % 2u) scene.materials[0].roughness = uniform(0.1f, 0.9f);
        updateBounds(scene);
        const int lights = int(random() % 4u);
        scene.lights.clear();
        for (int i = 0; i < lights; ++i) {
            const Vec3 at = point(1.5f), target = point(0.7f);
            if (random() % 2u)
                scene.lights.push_back(spotLight(at, target + Vec3(0.01f), Vec3(uniform(0.0f, 2.0f)), 0.1f, uniform(0.15f, 1.2f)));
            else
                scene.lights.push_back(directionalLight(target - at + Vec3(0.01f), Vec3(1.0f)));
            if (random() % 3u == 0) scene.lights.back().intensity = Vec3(0.0f);  // lights nothing
        }
        Settings lean = adviceSettings();
        lean.cones.march.estimator = trial % 2 ? Estimator::paper : Estimator::slab;
        Settings full = lean;
        full.force.everything = true;
        full.layers.dropEmpty = false;
        const Frame a = adviceFrame(scene, lean), b = adviceFrame(scene, full);
        CAPTURE(trial, lights);
        CHECK(a.combined.texels == b.combined.texels);
        CHECK(a.irradiance.texels == b.irradiance.texels);
        CHECK(a.opacity.texels == b.opacity.texels);
    }
}
