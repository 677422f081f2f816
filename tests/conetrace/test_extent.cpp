#include "conetrace/frame/gbuffer.h"
#include "conetrace/render.h"
#include "core/scene/builtin_scenes.h"
#include "core/scene/exposure.h"
#include "core/scene/reach.h"
#include "core/scene/shapes.h"

#include "catch.h"

using namespace lrsm;

namespace {

Settings extentSettings()
{
    Settings settings;
    settings.voxel.resolution = 64;
    settings.rsm.resolution = 128;
    return settings;
}

Frame renderExtent(const Scene& scene, const Settings& settings = extentSettings())
{
    return renderFrame(scene, scene.cameras.at(0), settings, {.width = 48, .height = 36, .watch = {}, .method = {}});
}

/// Measured as loading does.
Scene measured(Scene scene)
{
    updateBounds(scene);
    scene.reach = measureReach(scene, scene.cameras.at(0));
    return scene;
}

Mesh& addMesh(Scene& scene)
{
    scene.materials.push_back(diffuseMaterial("added", Vec3(0.5f), true));
    scene.meshes.emplace_back().material = int(scene.materials.size()) - 1;
    return scene.meshes.back();
}

bool sameBits(const Image<Vec3>& a, const Image<Vec3>& b)
{
    return a.texels == b.texels;
}

double total(const Image<Vec3>& image)
{
    double sum = 0.0;
    for (const Vec3& v : image.texels) sum += double(v.x) + double(v.y) + double(v.z);
    return sum;
}

}  // namespace

TEST_CASE("extent: a stray quad 20 km away costs no bit of the picture", "[conetrace][extent]")
{
    const std::string name = GENERATE("cornell-glossy", "atrium");
    const auto builtin = makeBuiltinScene(name);
    INFO(name);
    const Vec3 at = GENERATE(Vec3(20000, 3, 5), Vec3(-4000, 20000, -9000), Vec3(0, -20000, 30));
    Scene with = *builtin;
    addQuad(addMesh(with), at, at + Vec3(1, 0, 0), at + Vec3(1, 1, 0), at + Vec3(0, 1, 0));
    const Frame plain = renderExtent(measured(*builtin)), stray = renderExtent(measured(with));
    CHECK(total(plain.irradiance) > 0.0);
    REQUIRE(plain.passes.size() == stray.passes.size());
    for (std::size_t i = 0; i < plain.passes.size(); ++i) {
        INFO(plain.passes[i].name);
        CHECK(plain.passes[i].sha256 == stray.passes[i].sha256);
    }
}

TEST_CASE("extent: the settings fit grid and maps to the whole scene instead", "[conetrace][extent]")
{
    Scene scene = *makeBuiltinScene("cornell-box");
    scene.lights[0].intensity *= 10.0f;  // ordinary over the part and over the whole: pre-exposure does not differ
    const Vec3 at(20, 0, 0);
    addQuad(addMesh(scene), at, at + Vec3(1, 0, 0), at + Vec3(1, 1, 0), at + Vec3(0, 1, 0));
    Scene whole = measured(scene), part = whole;
    whole.reach = whole.bounds;
    Settings settings = extentSettings();
    settings.voxel.extent = settings.rsm.extent = Extent::scene;
    const Frame forced = renderExtent(part, settings), expected = renderExtent(whole);
    CHECK(sameBits(forced.combined, expected.combined));
    CHECK_FALSE(sameBits(renderExtent(part).combined, expected.combined));
}

TEST_CASE("extent: a sun's casters outside the reach still throw their shadow", "[conetrace][extent]")
{
    // A floor with a crate; a plate high above, off to the sun's side, shadows all of it.
    Scene scene;
    addQuad(addMesh(scene), Vec3(-2, 0, 2), Vec3(2, 0, 2), Vec3(2, 0, -2), Vec3(-2, 0, -2));
    addBox(addMesh(scene), Vec3(-0.5f, 0, -0.5f), Vec3(0.5f, 1, 0.5f));
    scene.lights.push_back(directionalLight(Vec3(-1, -2, 0), Vec3(10.0f)));
    scene.cameras.push_back(lookAt(Vec3(0, 2, 4), Vec3(0, 0, 0), Vec3(0, 1, 0), 0.8f));
    Scene covered = scene;
    addQuad(addMesh(covered), Vec3(140, 300, 20), Vec3(160, 300, 20), Vec3(160, 300, -20), Vec3(140, 300, -20));
    addQuad(addMesh(covered), Vec3(3000, 0, 0), Vec3(3001, 0, 0), Vec3(3001, 1, 0), Vec3(3000, 1, 0));
    covered = measured(covered);
    CHECK(covered.reach == measured(scene).bounds);
    CHECK(total(renderExtent(measured(scene)).direct) > 0.0);
    CHECK(total(renderExtent(covered).direct) == 0.0);
}

TEST_CASE("extent: surfaces beyond the reach are lit, not shadowed by the map's end", "[conetrace][extent]")
{
    // A wall far behind the crate, seen by the camera, in the spot's cone.
    Scene scene;
    addQuad(addMesh(scene), Vec3(-1, 0, 1), Vec3(1, 0, 1), Vec3(1, 0, -1), Vec3(-1, 0, -1));
    scene.lights.push_back(spotLight(Vec3(0, 1, 1), Vec3(0, 0, -1), Vec3(1e6f), 0.9f, 1.0f));
    scene.cameras.push_back(lookAt(Vec3(0, 1, 2), Vec3(0, 0.2f, -1), Vec3(0, 1, 0), 0.9f));
    addQuad(addMesh(scene), Vec3(-300, -300, -400), Vec3(300, -300, -400), Vec3(300, 300, -400), Vec3(-300, 300, -400));
    scene = measured(scene);
    scene.reach = Aabb{Vec3(-1, 0, -1), Vec3(1, 1, 1)};
    const Frame frame = renderExtent(scene);
    std::size_t far = 0, lit = 0;
    for (std::size_t i = 0; i < frame.direct.texels.size(); ++i) {
        if (frame.gbuffer.position.texels[i].z > -399.0f) continue;
        ++far;
        lit += frame.direct.texels[i] != Vec3(0.0f) ? 1 : 0;
    }
    CHECK(far > 100);
    CHECK(lit > far / 4);
}

TEST_CASE("pre-exposure: light scaled by a power of two scales the picture bit for bit", "[conetrace][exposure]")
{
    // But for what is subnormal in half, in steps of 2^-24, where the brightest is 2^-6 or more.
    Scene scene = *makeBuiltinScene("cornell-glossy");
    const Frame plain = renderExtent(scene);
    for (const int power : {-100, -40, -24, -9, 12, 30, 60}) {
        Scene scaled = scene;
        for (Light& light : scaled.lights) light.intensity *= std::ldexp(1.0f, power);
        CHECK(preExposureOf(scaled) != 1.0f);
        const Frame frame = renderExtent(scaled);
        float largest = 0.0f, worst = 0.0f;
        for (std::size_t i = 0; i < plain.combined.texels.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const float back = std::ldexp(frame.combined.texels[i][c], -power);
                worst = std::max(worst, std::abs(back - plain.combined.texels[i][c]));
                largest = std::max(largest, plain.combined.texels[i][c]);
            }
        INFO("2^" << power << ": " << worst / largest);
        CHECK(worst <= 0x1p-18f * largest);
    }
}

TEST_CASE("pre-exposure: 1e-7 to 1e9 cd show the same picture in the GPU's formats", "[conetrace][exposure]")
{
    Scene scene = *makeBuiltinScene("cornell-box");
    const Frame plain = renderExtent(scene);
    for (int decade = -7; decade <= 9; decade += 2) {
        Scene scaled = scene;
        const double factor = std::pow(10.0, decade);
        for (Light& light : scaled.lights) light.intensity *= float(factor);
        const Frame frame = renderExtent(scaled);
        CHECK(total(frame.irradiance) / factor == Approx(total(plain.irradiance)).epsilon(1e-3));
        CHECK(total(frame.combined) / factor == Approx(total(plain.combined)).epsilon(1e-3));
        CHECK(counterSum(frame.passes, "half_saturations") == counterSum(plain.passes, "half_saturations"));
    }
}

TEST_CASE("voxels: triangles of zero area stop no cone", "[conetrace][voxel]")
{
    Scene scene = *makeBuiltinScene("two-rooms"), stitched = scene;
    Mesh& mesh = stitched.meshes[0];
    // As strips are joined: a corner of one quad, a corner of another, twice; and three corners on a line.
    const std::uint32_t a = 0, b = 17;
    mesh.triangles.push_back({a, a, b});
    mesh.triangles.push_back({a, b, b});
    const auto first = std::uint32_t(mesh.positions.size());
    for (const float t : {0.1f, 0.3f, 0.7f}) {
        mesh.positions.push_back(glm::mix(mesh.positions[a], mesh.positions[b], t));
        mesh.normals.push_back(Vec3(0, 1, 0));
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    CHECK(sameBits(renderExtent(scene).irradiance, renderExtent(stitched).irradiance));
}

TEST_CASE("voxels: what is drawn nowhere stops no cone", "[conetrace][voxel]")
{
    Scene scene = *makeBuiltinScene("cornell-box"), veiled = scene;
    Mesh& veil = addMesh(veiled);
    addQuad(veil, Vec3(0, 0.2f, 0), Vec3(0.5f, 0.2f, 0), Vec3(0.5f, 0.2f, 0.5f), Vec3(0, 0.2f, 0.5f));
    Material& material = veiled.materials.back();
    material.alphaMask = true;
    material.baseColor.w = 0.4f;
    CHECK(sameBits(renderExtent(scene).combined, renderExtent(veiled).combined));
    material.baseColor.w = 0.6f;
    CHECK_FALSE(sameBits(renderExtent(scene).combined, renderExtent(veiled).combined));
}

TEST_CASE("extent: a plane of 10 km a centimetre below a floor is not drawn through it", "[conetrace][extent][raster]")
{
    Scene scene;
    addQuad(addMesh(scene), Vec3(-2, 0, 2), Vec3(2, 0, 2), Vec3(2, 0, -2), Vec3(-2, 0, -2));
    const float half = GENERATE(50.0f, 500.0f, 5000.0f, 20000.0f);
    addQuad(addMesh(scene), Vec3(-half, -0.01f, half), Vec3(half, -0.01f, half), Vec3(half, -0.01f, -half), Vec3(-half, -0.01f, -half));
    updateBounds(scene);
    const Camera camera = lookAt(Vec3(0.6f, 1.4f, 4.2f), Vec3(0.6f, 0.9f, -2.0f), Vec3(0, 1, 0), 0.8f);
    const GBuffer gbuffer = renderGBuffer(scene, camera, {}, {96, 54});
    std::size_t floor = 0;
    for (int y = 0; y < 54; ++y)
        for (int x = 0; x < 96; ++x) {
            const CameraRay ray = pixelRay(camera, 96, 54, float(x) + 0.5f, float(y) + 0.5f);
            if (!(ray.direction.y < 0.0f)) continue;
            const Vec3 met = ray.origin - ray.direction * (ray.origin.y / ray.direction.y);
            if (std::abs(met.x) > 1.9f || std::abs(met.z) > 1.9f) continue;
            ++floor;
            CHECK(gbuffer.position.at(x, y).y == 0.0f);
        }
    CHECK(floor > 300);
}
