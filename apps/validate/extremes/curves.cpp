#include "apps/validate/extremes/synthetic_map.h"
#include "apps/validate/extremes/worlds.h"
#include "core/report/table.h"
#include "core/scene/shapes.h"
#include "voxel/voxelize.h"

#include <cmath>

// Where accuracy degrades: error against how extreme the input is.
namespace lrsm::extremes {
namespace {

constexpr double kLeastShown = 1e-12;

std::vector<double> powers(double base, double from, double to)
{
    std::vector<double> x;
    for (double e = from; e <= to + 1e-9; e += 1.0) x.push_back(std::pow(base, e));
    return x;
}

double roomAgainst(Mode mode, const World& world)
{
    const Settings settings = smallSettings(mode);
    return relativeDifference(renderWorld(world, settings).irradiance, renderWorld(room(), settings).irradiance);
}

/// Fraction of pixels that show the farther of two walls, 1 % apart, the far one submitted last.
double depthFighting(double ratio)
{
    World world;
    Scene& scene = world.scene;
    scene.materials = {diffuseMaterial("near", Vec3(0.5f)), diffuseMaterial("far", Vec3(0.5f))};
    scene.meshes.resize(2);
    scene.meshes[1].material = 1;
    const auto wall = [&](Mesh& mesh, float z) { addQuad(mesh, Vec3(-20, -20, z), Vec3(20, -20, z), Vec3(20, 20, z), Vec3(-20, 20, z)); };
    wall(scene.meshes[1], -10.1f);
    wall(scene.meshes[0], -10.0f);
    std::swap(scene.meshes[0], scene.meshes[1]);  // the far wall first: ties go to it
    updateBounds(scene);
    world.camera = lookAt(Vec3(0.0f), Vec3(0.02f, 0.03f, -1.0f), Vec3(0, 1, 0), 1.0f);
    world.camera.nearPlane = float(10.0 / ratio);
    const GBuffer picture = renderGBuffer(scene, world.camera, {}, {64, 48});
    std::size_t wrong = 0;
    for (const std::uint32_t id : picture.objectId.texels) wrong += id == 1;
    return static_cast<double>(wrong) / static_cast<double>(picture.objectId.texels.size());
}

/// One texel in `count` is lit: what the chain's top sends against radiance / count.
double thinCoverage(Mode mode, double count)
{
    const int n = static_cast<int>(std::sqrt(count) + 0.5);
    const FilteredTexel top = topOfLoneTexel(mode, n);
    return std::max(std::abs(double(top.radiance.x) * count - 1.0), std::abs(double(top.depthAlpha) * count - 1.0));
}

double radianceLost(Mode mode, double radiance)
{
    return std::abs(radianceError(mode, radiance));
}

/// A floor lit by a sun at this elevation sends light to a wall: irradiance over <n.l>, against the sun overhead.
double grazingIrradiance(Mode mode, double nDotL)
{
    const auto irradiance = [&](double cosine) {
        World world = litWall(1.0f, 10.0f, 20.0f);
        Mesh& wall = world.scene.meshes[0];
        addQuad(wall, Vec3(-1, 1, 0), Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(-1, 1, 1));  // a shelf that the sun from +z and the side meets edge-on or from below
        const double across = std::sqrt(1.0 - cosine * cosine);
        world.scene.lights[0] = directionalLight(Vec3(float(across), 0.0f, float(-cosine)), Vec3(10.0f));
        world.camera = lookAt(Vec3(0, -1, 2.5f), Vec3(0, 1, 0.5f), Vec3(0, 0, 1), 0.4f);
        updateBounds(world.scene);
        const Frame frame = renderWorld(world, smallSettings(mode));
        return meanOf(frame.irradiance, frame.gbuffer);
    };
    return std::abs(irradiance(nDotL) / nDotL / irradiance(1.0) - 1.0);
}

/// A metal mirror that sees nothing but an evenly lit wall: the specular cone's radiance against the wall's, for a fixed aperture in degrees.
double specularOfWall(Mode mode, double degrees)
{
    World world = furnaceSphere(0.5f, 1.0f);
    Material& material = world.scene.materials[0];
    material.roughness = 0.5f;
    Settings settings = smallSettings(mode);
    settings.voxel.resolution = 64;
    settings.cones.specular.aperture = SpecularAperture::fixed;
    settings.cones.specular.apertureDegrees = float(degrees);
    const World& sphere = world;
    const Requirements needs;
    const OpacityPyramid opacity = buildPyramid(voxelize(sphere.scene, settings.voxel), settings.voxel);
    std::vector<Lrsm> lrsms;
    for (const Light& light : sphere.scene.lights) lrsms.push_back(buildLrsm(renderRsm(sphere.scene, light, needs, settings.rsm), settings.layers));
    const GBuffer gbuffer = renderGBuffer(sphere.scene, sphere.camera, needs, {16, 12});
    const Gathered gathered = traceCones(gbuffer, sphere.camera, opacity, lrsms, needs, settings.cones);
    return std::abs(meanOf(gathered.specular, gbuffer) / (0.5 / 3.14159265358979) - 1.0);
}

double furnaceError(Mode mode, double resolution)
{
    Settings settings = smallSettings(mode);
    settings.voxel.resolution = static_cast<int>(resolution);
    const Frame frame = renderWorld(furnaceSphere(0.5f, 1.0f), settings, 8, 6);
    return std::abs(meanOf(frame.irradiance, frame.gbuffer) / 0.5 - 1.0);
}

}  // namespace

ExtremeCurve drawCurve(const CurvePlan& plan)
{
    ExtremeCurve curve;
    curve.name = plan.name;
    curve.xLabel = plan.xLabel;
    curve.yLabel = plan.yLabel;
    curve.bound = plan.bound;
    curve.degradesDownwards = plan.degradesDownwards;
    curve.degradesFrom = plan.degradesDownwards ? 0.0 : std::numeric_limits<double>::infinity();
    double worst = 0.0;
    for (const Mode mode : plan.modes) {
        ChartSeries series{.label = nameOf(mode), .x = plan.x};
        for (const double x : plan.x) {
            const double y = plan.y(mode, x);
            series.y.push_back(std::isfinite(y) ? std::max(y, kLeastShown) : y);
            if (y <= plan.bound) {
                worst = std::max(worst, y);
                continue;
            }
            curve.degradesFrom = plan.degradesDownwards ? std::max(curve.degradesFrom, x) : std::min(curve.degradesFrom, x);
        }
        curve.series.push_back(std::move(series));
    }
    const bool nowhere = plan.degradesDownwards ? curve.degradesFrom == 0.0 : std::isinf(curve.degradesFrom);
    curve.sentence =
        plan.subject + (nowhere ? " stays within " + shortNumber(plan.bound) + " over the whole range, " + shortNumber(plan.x.front()) + " to " +
                                      shortNumber(plan.x.back()) + "."
                                : " degrades from " + plan.xLabel + " = " + shortNumber(curve.degradesFrom) + (plan.degradesDownwards ? " downwards" : " on") +
                                      " (error above " + shortNumber(plan.bound) + "; before that at most " + shortNumber(worst) + ").");
    return curve;
}

std::vector<CurvePlan> curvePlans()
{
    const std::vector<Mode> storage(std::begin(kStorageModes), std::end(kStorageModes)), one = {Mode::gpuD3d}, any = {Mode::any};
    const std::vector<double> cosines = {1e-5, 1e-4, 1e-3, 1e-2, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0};
    const std::vector<double> degrees = {1e-3, 1e-2, 0.1, 1, 2, 5, 10, 20, 40, 60, 90, 120, 150, 170};
    const auto moved = [](Mode mode, double x) { return roomAgainst(mode, movedRoom(glm::dvec3(x, -0.7 * x, 0.4 * x))); };
    const auto scaled = [](Mode mode, double x) { return roomAgainst(mode, scaledRoom(x)); };
    const auto fighting = [](Mode, double x) { return depthFighting(x); };
    return {{"offset", "distance from the origin (m)", "difference of irradiance / mean", powers(10.0, 0, 7), storage, moved, 0.05, false,
             "Irradiance in a room of 2 m moved from the origin"},
            {"scale", "scale of the scene", "difference of irradiance / mean", powers(10.0, -11, 14), storage, scaled, 0.01, false,
             "Irradiance in a room of 2 m scaled"},
            {"depth ratio", "distance / near plane", "fraction of pixels that show the farther wall", powers(10.0, 1, 6), any, fighting, 0.0, false,
             "The order of two walls 1 % apart in depth"},
            {"radiance, upwards", "radiance (W/(m^2 sr))", "relative error", powers(10.0, -4, 8), storage, radianceLost, 2e-3, false,
             "Radiance stored and sampled"},
            {"radiance, downwards", "radiance (W/(m^2 sr))", "relative error", powers(10.0, -8, 4), storage, radianceLost, 2e-3, true,
             "Radiance stored and sampled"},
            {"<n.l>", "<n.l>", "error of irradiance / <n.l>", cosines, storage, grazingIrradiance, 0.10, true, "Light from a wall lit at a grazing angle"},
            {"aperture", "full aperture (degrees)", "relative error of the cone's radiance", degrees, one, specularOfWall, 0.10, false,
             "A specular cone in a furnace"},
            {"voxel resolution", "voxels along an edge", "relative error of irradiance", powers(2.0, 0, 7), storage, furnaceError, 0.10, true,
             "Irradiance of a furnace"},
            {"coverage", "texels for one that is lit", "relative error of alpha or A R", powers(4.0, 1, 10), storage, thinCoverage, 0.05, false,
             "What a lone lit texel leaves at the chain's top"}};
}

}  // namespace lrsm::extremes
