#include "core/base/errors.h"
#include "core/scene/brdf.h"
#include "core/scene/builtin_scenes.h"
#include "core/scene/check_scene.h"
#include "core/scene/light.h"
#include "core/scene/shapes.h"

#include "catch.h"

#include <cmath>

using namespace lrsm;

namespace {

const float kNan = std::nanf("");

/// The refusal's line; "" if there is none.
template <class Check>
std::string refusal(const Check& check)
{
    try {
        check();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("checks: the built-in scenes pass", "[scene][check]")
{
    for (const BuiltinSceneInfo& info : builtinScenes()) {
        const Scene scene = *makeBuiltinScene(info.name);
        CHECK(refusal([&] { checkScene(scene); }) == "");
        for (const Camera& camera : scene.cameras) CHECK(refusal([&] { checkCamera(camera); }) == "");
    }
}

TEST_CASE("checks: a light without direction, with a senseless intensity, range or cone is refused by name", "[scene][check]")
{
    const Light good = spotLight(Vec3(0, 2, 0), Vec3(0.0f), Vec3(1.0f), 0.2f, 0.5f);
    REQUIRE(refusal([&] { checkLight(good); }) == "");
    const auto with = [&](auto change) {
        Light light = good;
        change(light);
        return refusal([&] { checkLight(light); });
    };
    CHECK(contains(with([](Light& l) { l.intensity.y = kNan; }), "light \"spot\": intensity"));
    CHECK(contains(with([](Light& l) { l.intensity.x = -1.0f; }), "intensity"));
    CHECK(contains(with([](Light& l) { l.intensity.x = kInfinity; }), "intensity"));
    CHECK(contains(with([](Light& l) { l.direction = Vec3(0.0f); }), "direction"));
    CHECK(contains(with([](Light& l) { l.up = l.direction; }), "up"));
    CHECK(contains(with([](Light& l) { l.position.z = kInfinity; }), "position"));
    CHECK(contains(with([](Light& l) { l.range = 0.0f; }), "range"));
    CHECK(contains(with([](Light& l) { l.range = kNan; }), "range"));
    CHECK(contains(with([](Light& l) { l.innerConeAngle = 0.6f; }), "inner cone angle"));
    CHECK(contains(with([](Light& l) { l.outerConeAngle = 1.5708f; }), "outer cone angle"));
    CHECK(with([](Light& l) { l.innerConeAngle = l.outerConeAngle; }) == "");
}

TEST_CASE("checks: a camera without field of view, near plane or direction is refused", "[scene][check]")
{
    const Camera good = lookAt(Vec3(0, 0, 1), Vec3(0.0f), Vec3(0, 1, 0), 0.7f);
    REQUIRE(refusal([&] { checkCamera(good); }) == "");
    const auto with = [&](auto change) {
        Camera camera = good;
        change(camera);
        return refusal([&] { checkCamera(camera); });
    };
    for (const float fov : {0.0f, 3.14159265f, -1.0f, kNan}) CHECK(contains(with([&](Camera& c) { c.verticalFov = fov; }), "field of view"));
    for (const float near : {0.0f, -1.0f, kNan, kInfinity}) CHECK(contains(with([&](Camera& c) { c.nearPlane = near; }), "near plane"));
    CHECK(contains(with([](Camera& c) { c = lookAt(Vec3(1.0f), Vec3(1.0f), Vec3(0, 1, 0), 0.7f); }), "direction"));
    CHECK(contains(with([](Camera& c) { c = lookAt(Vec3(0.0f), Vec3(0, 1, 0), Vec3(0, 1, 0), 0.7f); }), "up"));
    CHECK(contains(with([](Camera& c) { c.perspective = false, c.verticalExtent = 0.0f; }), "vertical extent"));
}

TEST_CASE("checks: bounds beyond 1e15 m or below 1e-12 m, bad materials and broken streams are refused", "[scene][check]")
{
    CHECK(refusal([] { checkBounds({}); }) == "");
    CHECK(refusal([] { checkBounds({Vec3(2.0f), Vec3(2.0f)}); }) == "");
    CHECK(contains(refusal([] { checkBounds({Vec3(0.0f), Vec3(1e30f)}); }), "1e15"));
    CHECK(contains(refusal([] { checkBounds({Vec3(0.0f), Vec3(kInfinity)}); }), "finite"));
    CHECK(contains(refusal([] { checkBounds({Vec3(0.0f), Vec3(1e-40f)}); }), "longest side"));

    Scene scene = *makeBuiltinScene("cornell-box");
    scene.materials[0].roughness = kNan;
    CHECK(contains(refusal([&] { checkMaterials(scene); }), "roughness"));
    scene = *makeBuiltinScene("cornell-box");
    scene.meshes[0].triangles[0][1] = 4000;
    CHECK(contains(refusal([&] { checkScene(scene); }), "uses vertex 4000"));
    scene = *makeBuiltinScene("cornell-box");
    scene.meshes[0].normals.pop_back();
    CHECK(contains(refusal([&] { checkScene(scene); }), "differ in length"));
}

TEST_CASE("a light at the very point it lights is bright, not infinite, its black channel stays black", "[scene][light]")
{
    for (const float distance : {1e-10f, 1e-20f, 1e-30f, 1e-42f}) {
        const Light light = spotLight(Vec3(0.0f), Vec3(0, 0, -1), Vec3(1e12f, 0.0f, 1.0f), 0.2f, 0.5f);
        const LightSample sample = sampleLight(light, Vec3(0, 0, -distance));
        CAPTURE(distance);
        CHECK(isFinite(sample.irradiance));
        CHECK(sample.irradiance.x <= kMaxIrradiance);
        CHECK(sample.irradiance.y == 0.0f);
    }
    CHECK(sampleLight(directionalLight(Vec3(0, -1, 0), Vec3(1e30f)), Vec3(0.0f)).irradiance == Vec3(kMaxIrradiance));
}

TEST_CASE("a vertex colour that is NaN is black, grazing light and eye give a finite highlight", "[scene][brdf]")
{
    Scene scene = *makeBuiltinScene("cornell-box");
    scene.meshes[0].colors.assign(scene.meshes[0].positions.size(), Vec4(kNan, 0.5f, 1.0f, 1.0f));
    const Surface surface = evaluateSurface(scene, {0, 0, 0.3f, 0.3f}, Vec3(0, 1, 0));
    CHECK(surface.albedo.x == 0.0f);
    CHECK(surface.albedo.y > 0.0f);

    Surface mirror;
    mirror.normal = mirror.geometricNormal = Vec3(0, 1, 0);
    mirror.specularColor = Vec3(1.0f);
    mirror.roughness = 0.0f;
    for (const float grazing : {1e-10f, 1e-20f, 1e-30f, 1e-40f}) CHECK(isFinite(evaluateSpecular(mirror, Vec3(1, grazing, 0), Vec3(-1, grazing, 0))));
}
