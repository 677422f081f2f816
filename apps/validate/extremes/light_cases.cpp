#include "apps/validate/extremes/worlds.h"
#include "core/report/table.h"
#include "core/scene/light.h"
#include "core/scene/shapes.h"

#include <cmath>

// Lights and cameras where they should not be, and of every shape.
namespace lrsm::extremes {
namespace {

template <class Change>
Case finite(const std::string& name, const std::string& what, Change change)
{
    return {name, what, "every pass finite", [change](Mode mode, Probe& probe) {
                World world = room(true);
                change(world);
                probe.frame(renderWorld(world, smallSettings(mode)));
                probe.frame(renderWorld(world, smallLiteral(mode)));
            }};
}

template <class Change>
Case refused(const std::string& name, const std::string& what, Change change)
{
    return refusal(name, what, [change](Mode mode, Probe& probe) {
        World world = room();
        change(world);
        probe.frame(renderWorld(world, smallSettings(mode)));
    });
}

/// Nothing of the scene is lit: no direct light, no indirect light.
template <class Change>
Case dark(const std::string& name, const std::string& what, Change change)
{
    return {name, what, "every picture exactly 0", [change](Mode mode, Probe& probe) {
                World world = room(true);
                change(world);
                const Frame frame = renderWorld(world, smallSettings(mode));
                probe.frame(frame);
                probe.require(allZero(frame.direct) && allZero(frame.irradiance) && allZero(frame.combined), "there is light");
            }};
}

Light& light(World& world)
{
    return world.scene.lights[0];
}

/// The wall's middle sends rho I / (pi d^2).
void onAxis(Mode mode, Probe& probe, float distance, float inner, float outer)
{
    const Frame frame = renderWorld(litWall(distance, inner, outer), smallSettings(mode), 3, 3);
    probe.frame(frame);
    const double expected = 0.5 / 3.14159265358979 / double(distance) / double(distance);
    probe.bound("direct light of the middle pixel over rho I / (pi d^2), - 1", double(frame.direct.at(1, 1).x) / expected - 1.0, 1e-4);
}

void coincident(Mode mode, Probe& probe, int count)
{
    World world = room();
    const Frame one = renderWorld(world, smallSettings(mode));
    world.scene.lights.resize(std::size_t(count), world.scene.lights[0]);
    const Frame many = renderWorld(world, smallSettings(mode));
    probe.frame(many);
    probe.bound("irradiance over the number of lights, against one", relativeDifference(many.irradiance, one.irradiance, 1.0 / count), 2e-5);
    probe.bound("direct light over the number of lights, against one", relativeDifference(many.direct, one.direct, 1.0 / count), 2e-5);
}

/// A closed, double-sided block around the light: the room gets no direct light.
void insideGeometry(Mode mode, Probe& probe)
{
    World world = room();
    world.scene.materials[1].doubleSided = true;
    light(world).position = Vec3(-0.4f, -0.6f, -0.2f);
    const Frame frame = renderWorld(world, smallSettings(mode));
    probe.frame(frame);
    double outside = 0.0;
    for (std::size_t i = 0; i < frame.direct.texels.size(); ++i)
        if (frame.gbuffer.objectId.texels[i] == 1) outside = std::max(outside, double(frame.direct.texels[i].x));
    probe.bound("direct light on the walls outside", outside, 0.0);
}

/// A floor under a sun at this elevation: radiance of each texel is rho E <n.l> / pi.
void grazing(Mode mode, Probe& probe, double nDotL)
{
    World world = litWall(1.0f, 10.0f, 20.0f);
    const double across = std::sqrt(1.0 - nDotL * nDotL);
    world.scene.lights[0] = directionalLight(Vec3(float(across), 0.0f, float(-nDotL)), Vec3(10.0f));
    const Settings settings = smallSettings(mode);
    const Rsm rsm = renderRsm(world.scene, world.scene.lights[0], {}, settings.rsm);
    probe.output("rsm", rsm);
    probe.output("lrsm", buildLrsm(rsm, settings.layers));
    probe.frame(renderWorld(world, settings));
    double worst = 0.0;
    for (const RsmTexel& texel : rsm.texels.texels)
        if (texel.coverage > 0.0f) worst = std::max(worst, std::abs(double(texel.radiance.x) - 0.5 * 10.0 * nDotL / 3.14159265358979));
    probe.bound("radiance less rho E <n.l> / pi", worst, 1e-3 * nDotL + 1e-6);
}

}  // namespace

Group lightCases()
{
    Group group{"lights", {}};
    auto& cases = group.cases;
    const std::string middle = "the middle pixel's direct light is rho I / (pi d^2) within 1e-4";
    for (const float outer : {0.5f, 1.0f, 30.0f, 85.0f, 89.0f}) {
        cases.push_back({"a spot of " + numberText(6, 2.0 * double(outer)) + " degrees", "a spot of this full angle on a wall 1 m away, smooth to its edge",
                         middle, [outer](Mode mode, Probe& probe) { onAxis(mode, probe, 1.0f, 0.5f * outer, outer); }});
    }
    for (const float distance : {1e-6f, 1e-3f, 1e3f, 1e6f, 1e12f}) {
        cases.push_back({"a spot " + numberText(6, double(distance)) + " m off", "a wall of 2 m under a spot of 60 degrees at this distance", middle,
                         [distance](Mode mode, Probe& probe) { onAxis(mode, probe, distance, 20.0f, 30.0f); }});
    }
    cases.push_back(
        {"inner and outer angle equal", "a spot with a sharp edge", middle, [](Mode mode, Probe& probe) { onAxis(mode, probe, 1.0f, 30.0f, 30.0f); }});
    cases.push_back({"two coincident lights", "the room's light twice", "twice the light of one", [](Mode mode, Probe& probe) { coincident(mode, probe, 2); }});
    cases.push_back({"a thousand lights", "the room's light 1000 times, RSMs of 4^2", "a thousand times the light of one", [](Mode mode, Probe& probe) {
                         World world = room();
                         Settings settings = smallSettings(mode);
                         settings.rsm.resolution = 4;
                         const Frame one = renderWorld(world, settings, 8, 6);
                         world.scene.lights.resize(1000, world.scene.lights[0]);
                         const Frame many = renderWorld(world, settings, 8, 6);
                         probe.frame(many);
                         probe.bound("irradiance over 1000, against one", relativeDifference(many.irradiance, one.irradiance, 1e-3), 1e-4);
                     }});
    cases.push_back({"inside geometry", "a spot inside a closed, double-sided block", "no direct light outside the block; every pass finite", insideGeometry});
    for (const double nDotL : {1e-1, 1e-3, 1e-5, 1e-7, 0.0}) {
        cases.push_back({"grazing, <n.l> = " + numberText(6, nDotL), "a wall under a sun that all but misses it: 1/<n.l> of Eq. 4 runs off",
                         "RSM radiance is rho E <n.l> / pi; every pass finite", [nDotL](Mode mode, Probe& probe) { grazing(mode, probe, nDotL); }});
    }
    cases.push_back(dark("facing away", "a spot outside the room that looks the other way",
                         [](World& w) { light(w) = spotLight(Vec3(0, 5, 0), Vec3(0, 9, 0), Vec3(4.0f), 0.3f, 0.5f); }));
    cases.push_back(dark("intensity 0", "a light of no intensity", [](World& w) { light(w).intensity = Vec3(0.0f); }));
    cases.push_back(dark("no light", "a scene without lights", [](World& w) { w.scene.lights.clear(); }));
    cases.push_back(dark("range of 1e-12 m", "all geometry lies beyond the light's range", [](World& w) { light(w).range = 1e-12f; }));
    cases.push_back(dark("all geometry behind the light", "a spot in the floor's plane that looks down",
                         [](World& w) { light(w) = spotLight(Vec3(0, -1.001f, 0), Vec3(0, -5, 0), Vec3(4.0f), 0.3f, 0.5f); }));
    cases.push_back(finite("on a surface", "a spot in the floor, looking up",
                           [](World& w) { light(w) = spotLight(Vec3(0.3f, -1, 0.2f), Vec3(0.3f, 1, 0.2f), Vec3(4.0f), 0.3f, 0.8f); }));
    cases.push_back(
        finite("on a vertex", "a spot in the room's corner", [](World& w) { light(w) = spotLight(Vec3(-1.0f), Vec3(1.0f), Vec3(4.0f), 0.3f, 0.8f); }));
    cases.push_back(finite("a hair above the floor", "a spot 1e-7 m from the surface it lights",
                           [](World& w) { light(w) = spotLight(Vec3(0.3f, -1.0f + 1.2e-7f, 0.2f), Vec3(0.3f, -2, 0.2f), Vec3(4.0f), 0.3f, 0.8f); }));
    cases.push_back(finite("at the eye", "light and camera at one point", [](World& w) { light(w).position = w.camera.position; }));
    cases.push_back(finite("at the point seen", "a light exactly where the middle pixel's surface is", [](World& w) {
        light(w) = spotLight(Vec3(0.0f, -1.0f, 0.0f), Vec3(0, 1, 0), Vec3(1e12f, 0, 1), 0.3f, 0.8f);
        w.camera = lookAt(Vec3(0, 0.5f, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), 1.0f);
    }));
    cases.push_back(
        finite("point light at the centre", "six cube faces", [](World& w) { w.scene.lights = splitPointLight(Vec3(0.0f), Vec3(4.0f), kInfinity, "point"); }));
    cases.push_back(finite("point light in a corner", "six cube faces, three of which see nothing",
                           [](World& w) { w.scene.lights = splitPointLight(Vec3(1.0f), Vec3(4.0f), kInfinity, "point"); }));
    cases.push_back(
        finite("sun along an axis", "a directional light exactly along -y", [](World& w) { light(w) = directionalLight(Vec3(0, -1, 0), Vec3(10.0f)); }));
    cases.push_back(finite("sun off an axis by 1e-7", "a directional light all but along -y on a flat scene", [](World& w) {
        light(w) = directionalLight(Vec3(1e-7f, -1, 1e-8f), Vec3(10.0f));
        for (Mesh& m : w.scene.meshes)
            for (Vec3& p : m.positions) p.y = 0.1f;
        updateBounds(w.scene);
    }));
    cases.push_back(finite("intensity 1e30", "a spot of 1e30 W/sr: irradiance is capped at 1e20 W/m^2", [](World& w) { light(w).intensity = Vec3(1e30f); }));
    cases.push_back(finite("intensity 3e38", "a spot of the largest float", [](World& w) { light(w).intensity = Vec3(3.4e38f, 0, 1e-45f); }));
    cases.push_back(
        finite("sun of 3e38", "a directional light of the largest float", [](World& w) { light(w) = directionalLight(Vec3(0.2f, -1, 0.1f), Vec3(3.4e38f)); }));
    cases.push_back(finite("range of 1e30 m", "a range far beyond the scene", [](World& w) { light(w).range = 1e30f; }));
    cases.push_back(finite("up nearly along the axis", "a light frame made from an axis close to y",
                           [](World& w) { light(w) = spotLight(Vec3(0, 0.9f, 0), Vec3(1e-6f, -1, 0), Vec3(4.0f), 0.3f, 0.8f); }));
    for (const float value : {-1.0f, kNan, kInfinity})
        cases.push_back(refused("intensity " + std::to_string(value), "of one channel", [value](World& w) { light(w).intensity.y = value; }));
    cases.push_back(
        refused("inner angle beyond outer", "inner 0.6, outer 0.5 rad", [](World& w) { light(w).innerConeAngle = 0.6f, light(w).outerConeAngle = 0.5f; }));
    for (const float degrees : {89.6f, 90.0f, 91.0f, 180.0f, 0.0f, -5.0f})
        cases.push_back(refused("outer angle of " + std::to_string(int(degrees * 10.0f)) + " tenths of a degree", "from the axis",
                                [degrees](World& w) { light(w).innerConeAngle = 0.0f, light(w).outerConeAngle = degrees * kDegree; }));
    cases.push_back(refused("target at the light", "a spot whose target is its position",
                            [](World& w) { light(w) = spotLight(Vec3(0.5f), Vec3(0.5f), Vec3(1.0f), 0.3f, 0.5f); }));
    cases.push_back(refused("direction 0", "a sun that goes nowhere", [](World& w) { light(w) = directionalLight(Vec3(0.0f), Vec3(1.0f)); }));
    cases.push_back(refused("position NaN", "one coordinate", [](World& w) { light(w).position.x = kNan; }));
    cases.push_back(refused("range 0", "no range", [](World& w) { light(w).range = 0.0f; }));
    cases.push_back(refused("range NaN", "no number", [](World& w) { light(w).range = kNan; }));
    return group;
}

Group cameraCases()
{
    const Vec3 up(0, 1, 0);
    Group group{"camera", {}};
    auto& cases = group.cases;
    cases.push_back(finite("inside a wall", "the eye in the block", [=](World& w) { w.camera = lookAt(Vec3(-0.4f, -0.6f, -0.2f), Vec3(1, 0, 0), up, 1.0f); }));
    cases.push_back(
        finite("in a wall's plane", "the eye exactly in the floor", [=](World& w) { w.camera = lookAt(Vec3(0, -1, 0.9f), Vec3(0, -1, -1), up, 1.0f); }));
    cases.push_back(finite("on a vertex", "the eye in the room's corner", [=](World& w) { w.camera = lookAt(Vec3(-1.0f), Vec3(1.0f), up, 1.0f); }));
    cases.push_back(finite("field of view 0.1 degrees", "", [=](World& w) { w.camera.verticalFov = 0.1f * kDegree; }));
    cases.push_back(finite("field of view 179 degrees", "", [=](World& w) { w.camera.verticalFov = 179.0f * kDegree; }));
    cases.push_back(finite("orthographic", "2 m high", [=](World& w) { w.camera.perspective = false, w.camera.verticalExtent = 2.0f; }));
    cases.push_back(finite("orthographic, 1e-10 m high", "", [=](World& w) { w.camera.perspective = false, w.camera.verticalExtent = 1e-10f; }));
    cases.push_back(finite("orthographic, 1e14 m high", "", [=](World& w) { w.camera.perspective = false, w.camera.verticalExtent = 1e14f; }));
    cases.push_back(finite("near plane 1e-6 m", "near to far 1 : 2e6", [=](World& w) { w.camera.nearPlane = 1e-6f; }));
    cases.push_back(finite("near plane behind everything", "1e6 m", [=](World& w) { w.camera.nearPlane = 1e6f; }));
    cases.push_back(dark("all geometry behind the camera", "the eye looks away", [=](World& w) { w.camera = lookAt(Vec3(0, 0, 5), Vec3(0, 0, 9), up, 1.0f); }));
    cases.push_back(finite("1e9 m away", "the scene is far less than a pixel", [=](World& w) {
        w.camera = lookAt(Vec3(0, 0, 1e9f), Vec3(0.0f), up, 0.7f);
        w.camera.nearPlane = 1e3f;
    }));
    const auto pictures = [](const std::string& name, int width, int height) {
        return Case{name, "the room in a picture of this size", "every pass finite",
                    [=](Mode mode, Probe& probe) { probe.frame(renderWorld(room(true), smallSettings(mode), width, height)); }};
    };
    cases.push_back(pictures("picture of 1x1", 1, 1));
    cases.push_back(pictures("picture of 1x300", 1, 300));
    cases.push_back(pictures("picture of 300x1", 300, 1));
    cases.push_back(pictures("picture of 17x13", 17, 13));
    const auto noPicture = [](const std::string& name, const std::string& what, int width, int height) {
        return refusal(name, what, [=](Mode mode, Probe& probe) { probe.frame(renderWorld(room(), smallSettings(mode), width, height)); });
    };
    cases.push_back(noPicture("picture of 0x0", "no pixel", 0, 0));
    cases.push_back(noPicture("picture of -1x5", "a negative side", -1, 5));
    cases.push_back(noPicture("picture of 20000x1", "more than 16384", 20000, 1));
    for (const float fov : {0.0f, 180.0f, -10.0f, 400.0f, kNan})
        cases.push_back(refused("field of view " + std::to_string(fov), "degrees", [=](World& w) { w.camera.verticalFov = fov * kDegree; }));
    cases.push_back(refused("eye at the target", "no direction", [=](World& w) { w.camera = lookAt(Vec3(0.5f), Vec3(0.5f), up, 1.0f); }));
    cases.push_back(refused("up along the view", "no right", [=](World& w) { w.camera = lookAt(Vec3(0.0f), Vec3(0, 1, 0), up, 1.0f); }));
    cases.push_back(refused("up 0", "no up", [=](World& w) { w.camera = lookAt(Vec3(0.0f), Vec3(1, 0, 0), Vec3(0.0f), 1.0f); }));
    cases.push_back(refused("eye NaN", "one coordinate", [=](World& w) { w.camera.position.y = kNan; }));
    cases.push_back(refused("near plane 0", "a perspective without near plane", [=](World& w) { w.camera.nearPlane = 0.0f; }));
    cases.push_back(refused("near plane 1e-30 m", "near to far beyond 1 : 1e7", [=](World& w) { w.camera.nearPlane = 1e-30f; }));
    cases.push_back(refused("orthographic of no height", "0 m", [=](World& w) { w.camera.perspective = false, w.camera.verticalExtent = 0.0f; }));
    return group;
}

}  // namespace lrsm::extremes
