#include "apps/validate/extremes/worlds.h"

#include "core/scene/light.h"
#include "core/scene/requirements.h"
#include "core/scene/shapes.h"
#include "core/settings/settings_table.h"

#include <cmath>

namespace lrsm::extremes {
namespace {

void apply(Settings& settings, Mode mode)
{
    const Storage storage = mode == Mode::float32 ? Storage::float32 : Storage::gpu;
    settings.voxel.storage = settings.rsm.storage = settings.layers.storage = storage;
    settings.rsm.halfRounding = settings.layers.halfRounding = mode == Mode::gpuNearestEven ? HalfRounding::nearestEven : HalfRounding::d3d;
    settings.voxel.resolution = 32;
    settings.rsm.resolution = 64;
}

/// p -> factor p + offset, each coordinate rounded once.
World transformed(World world, double factor, const glm::dvec3& offset)
{
    const auto place = [&](Vec3& p) { p = Vec3(glm::dvec3(p) * factor + offset); };
    for (Mesh& mesh : world.scene.meshes)
        for (Vec3& p : mesh.positions) place(p);
    for (Light& light : world.scene.lights) {
        place(light.position);
        if (light.type != LightType::directional) light.intensity *= float(factor * factor);
    }
    place(world.camera.position);
    world.camera.nearPlane *= float(factor);
    updateBounds(world.scene);
    return world;
}

}  // namespace

Settings smallSettings(Mode mode)
{
    Settings settings = preset("balanced");
    apply(settings, mode);
    return settings;
}

Settings smallLiteral(Mode mode)
{
    Settings settings = preset("literal");
    apply(settings, mode);
    return settings;
}

World room(bool specular)
{
    World world;
    Scene& scene = world.scene;
    scene.name = "room";
    scene.materials = {diffuseMaterial("walls", Vec3(0.7f, 0.5f, 0.3f)), diffuseMaterial("block", Vec3(0.4f, 0.5f, 0.6f))};
    if (specular) scene.materials[1].roughness = 0.3f;
    scene.meshes.resize(2);
    scene.meshes[0].name = "walls";
    addBox(scene.meshes[0], Vec3(-1.0f), Vec3(1.0f), true);
    scene.meshes[1].name = "block";
    scene.meshes[1].material = 1;
    addBox(scene.meshes[1], Vec3(-0.7f, -1.0f, -0.5f), Vec3(-0.1f, -0.3f, 0.1f));
    scene.lights.push_back(spotLight(Vec3(0.1f, 0.9f, 0.05f), Vec3(0.2f, -1.0f, 0.0f), Vec3(4.0f), 30.0f * kDegree, 45.0f * kDegree));
    world.camera = lookAt(Vec3(0.3f, 0.1f, 0.95f), Vec3(0.0f, -0.2f, -1.0f), Vec3(0.0f, 1.0f, 0.0f), 75.0f * kDegree);
    updateBounds(scene);
    return world;
}

World scaledRoom(double factor)
{
    return transformed(room(), factor, glm::dvec3(0.0));
}

World movedRoom(const glm::dvec3& offset)
{
    return transformed(room(), 1.0, offset);
}

World litWall(float distance, float innerConeDegrees, float outerConeDegrees)
{
    World world;
    world.scene.name = "wall";
    world.scene.materials = {diffuseMaterial("wall", Vec3(0.5f), true)};
    world.scene.meshes.resize(1);
    addQuad(world.scene.meshes[0], Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0));
    world.scene.lights.push_back(spotLight(Vec3(0, 0, distance), Vec3(0.0f), Vec3(1.0f), innerConeDegrees * kDegree, outerConeDegrees * kDegree));
    world.camera = lookAt(Vec3(0, 0, 3), Vec3(0.0f), Vec3(0, 1, 0), 30.0f * kDegree);
    updateBounds(world.scene);
    return world;
}

World furnaceSphere(float albedo, float intensity, int subdivisions)
{
    World world;
    world.scene.name = "furnace";
    world.scene.materials = {diffuseMaterial("sphere", Vec3(albedo))};
    world.scene.meshes.resize(1);
    addSphere(world.scene.meshes[0], Vec3(0.0f), 1.0f, subdivisions, true);
    world.scene.lights = splitPointLight(Vec3(0.0f), Vec3(intensity), kInfinity, "point");
    world.camera = lookAt(Vec3(0.0f), Vec3(0.3f, 0.2f, -1.0f), Vec3(0, 1, 0), 70.0f * kDegree);
    updateBounds(world.scene);
    return world;
}

Frame renderWorld(const World& world, const Settings& settings, int width, int height)
{
    RenderOptions options;
    options.width = width;
    options.height = height;
    return renderFrame(world.scene, world.camera, settings, options);
}

double meanOf(const Image<Vec3>& image, const GBuffer& gbuffer)
{
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < image.texels.size(); ++i) {
        if (!gbuffer.covered(i)) continue;
        const Vec3& v = image.texels[i];
        sum += (double(v.x) + double(v.y) + double(v.z)) / 3.0;
        ++count;
    }
    return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

double relativeDifference(const Image<Vec3>& a, const Image<Vec3>& b, double scaleA)
{
    double squares = 0.0, mean = 0.0;
    for (std::size_t i = 0; i < b.texels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double d = double(a.texels[i][c]) * scaleA - double(b.texels[i][c]);
            squares += d * d;
            mean += double(b.texels[i][c]);
        }
    const double count = 3.0 * static_cast<double>(b.texels.size());
    return mean > 0.0 ? std::sqrt(squares / count) / (mean / count) : std::sqrt(squares / count);
}

bool allZero(const Image<Vec3>& image)
{
    for (const Vec3& v : image.texels)
        if (v != Vec3(0.0f)) return false;
    return true;
}

}  // namespace lrsm::extremes
