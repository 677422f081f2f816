#include "core/scene/brdf.h"
#include "core/scene/requirements.h"
#include "core/scene/shapes.h"

#include "catch.h"

#include <random>

using namespace lrsm;

namespace {

/// A triangle (0,0,0), (2,0,0), (0,1,0) facing +z, with one white material.
Scene triangle()
{
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].metallic = 0.0f;
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}};
    mesh.normals.assign(3, Vec3(0, 0, 1));
    mesh.uv0 = {{0, 1}, {1, 1}, {0, 0}};  // upright: u to the right, v downwards
    mesh.triangles = {{0, 1, 2}};
    scene.meshes = {mesh};
    return scene;
}

int addTexel(Scene& scene, Rgba8 texel)
{
    Texture t;
    t.image = Image<Rgba8>(1, 1, texel);
    scene.textures.push_back(std::make_shared<Texture>(t));
    return int(scene.textures.size()) - 1;
}

Surface glossy(float roughness, Vec3 f0)
{
    Surface s;
    s.normal = s.geometricNormal = Vec3(0, 0, 1);
    s.roughness = roughness;
    s.specularColor = f0;
    return s;
}

Vec3 direction(double cosTheta, double phi)
{
    const double s = std::sqrt(std::max(0.0, 1 - cosTheta * cosTheta));
    return {float(s * std::cos(phi)), float(s * std::sin(phi)), float(cosTheta)};
}

const SurfaceHit kMiddle{0, 0, 0.25f, 0.5f};
const Vec3 kFront(0.3f, 0.2f, 5.0f), kBack(0.3f, 0.2f, -5.0f);

}  // namespace

TEST_CASE("a hit interpolates position, normal, uv and colour by its barycentrics", "[scene][brdf]")
{
    Scene scene = triangle();
    scene.meshes[0].colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 0}};
    scene.meshes[0].normals = {{0, 0, 1}, {0, 0, 1}, glm::normalize(Vec3(1, 0, 1))};
    scene.materials[0].baseColor = {0.5f, 1, 1, 1};
    const Surface s = evaluateSurface(scene, kMiddle, kFront);
    CHECK(s.position == Vec3(0.5f, 0.5f, 0));
    CHECK(glm::distance(s.normal, glm::normalize(0.5f * Vec3(0, 0, 1) + 0.5f * glm::normalize(Vec3(1, 0, 1)))) < 1e-6f);
    CHECK(s.geometricNormal == Vec3(0, 0, 1));
    CHECK(s.albedo == Vec3(0.125f, 0.25f, 0.5f));
    scene.materials[0].alphaMask = true;
    scene.materials[0].alphaCutoff = 0.5f;
    CHECK(passesAlphaTest(scene, kMiddle));  // alpha exactly at the cutoff stays
    CHECK_FALSE(passesAlphaTest(scene, {0, 0, 0.25f, 0.51f}));
    scene.materials[0].alphaMask = false;
    CHECK(passesAlphaTest(scene, {0, 0, 0.0f, 1.0f}));
}

TEST_CASE("a double-sided surface turns both normals to the viewer, a single-sided one keeps them", "[scene][brdf]")
{
    Scene scene = triangle();
    for (const bool doubleSided : {false, true}) {
        scene.materials[0].doubleSided = doubleSided;
        CHECK(evaluateSurface(scene, kMiddle, kFront).normal == Vec3(0, 0, 1));
        const Surface behind = evaluateSurface(scene, kMiddle, kBack);
        CHECK(behind.normal == Vec3(0, 0, doubleSided ? -1 : 1));
        CHECK(behind.geometricNormal == Vec3(0, 0, doubleSided ? -1 : 1));
    }
    scene.meshes[0].normals.assign(3, Vec3(0, 0, -1));  // vertex normals against the winding
    CHECK(evaluateSurface(scene, kMiddle, kFront).normal == Vec3(0, 0, 1));
    CHECK(evaluateSurface(scene, kMiddle, kBack).normal == Vec3(0, 0, -1));
}

TEST_CASE("a shading normal that faces away is pushed to the tangent plane of the viewer", "[scene][brdf]")
{
    Scene scene = triangle();
    scene.meshes[0].normals.assign(3, glm::normalize(Vec3(1, 0, 0.1f)));
    const Vec3 viewer(-3, 0, 1);  // in front of the triangle, behind the shading normal
    const Surface s = evaluateSurface(scene, kMiddle, viewer);
    CHECK(std::abs(glm::dot(s.normal, glm::normalize(viewer))) < 1e-6f);
    CHECK(glm::length(s.normal) == Approx(1));
    CHECK(glm::dot(s.normal, s.geometricNormal) > 0.0f);
    CHECK(glm::distance(evaluateSurface(scene, kMiddle, {3, 0, 1}).normal, scene.meshes[0].normals[0]) < 1e-6f);
    scene.meshes[0].normals.assign(3, Vec3(0, 0, -1));
    CHECK(evaluateSurface(scene, kMiddle, {0, 0, 1}).normal == Vec3(0, 0, 1));  // straight away: the geometric one
}

TEST_CASE("a tiny or degenerate triangle has finite unit normals", "[scene][brdf]")
{
    Scene scene = triangle();
    for (Vec3& p : scene.meshes[0].positions) p *= 1e-18f;
    CHECK(evaluateSurface(scene, kMiddle, kFront).geometricNormal == Vec3(0, 0, 1));
    scene.meshes[0].positions.assign(3, Vec3(1));
    CHECK(evaluateSurface(scene, kMiddle, kFront).geometricNormal == Vec3(0, 0, 1));
    scene.meshes[0].normals = {{0, 0, 1}, {0, 0, -1}, {0, 0, -1}};
    CHECK(isFinite(evaluateSurface(scene, {0, 0, 0.5f, 0.0f}, kFront).normal));
}

TEST_CASE("normal maps: green is up in the image, from the uv or from the tangents, mirrored or not", "[scene][brdf][normalmap]")
{
    Scene scene = triangle();
    const float tilt = 2.0f * 192.0f / 255.0f - 1.0f;
    scene.materials[0].normalTexture.texture = addTexel(scene, {128, 192, 255, 255});
    const auto normal = [&] { return evaluateSurface(scene, kMiddle, kFront).normal; };
    const Vec3 expected = glm::normalize(Vec3(2.0f * 128.0f / 255.0f - 1.0f, tilt, 1));
    CHECK(glm::distance(normal(), expected) < 1e-6f);

    SECTION("uv mirrored in u: x turns over, up stays up")
    {
        for (Vec2& uv : scene.meshes[0].uv0) uv.x = 1 - uv.x;
        CHECK(glm::distance(normal(), expected * Vec3(-1, 1, 1)) < 1e-6f);
    }
    SECTION("uv turned by a quarter: up is along -dP/dv")
    {
        scene.meshes[0].uv0 = {{0, 0}, {0, 1}, {1, 0}};  // v to the right, u upwards: mirrored
        CHECK(normal().x == Approx(-expected.y));
        CHECK(normal().y == Approx(expected.x));
    }
    SECTION("tangents of the file")
    {
        scene.meshes[0].tangents.assign(3, Vec4(0, 1, 0, 1));  // bitangent = cross(z, y) = -x
        CHECK(normal().x == Approx(-expected.y));
        CHECK(normal().y == Approx(expected.x));
        scene.meshes[0].tangents.assign(3, Vec4(0, 1, 0, -1));
        CHECK(normal().x == Approx(expected.y));
    }
    SECTION("scale")
    {
        scene.materials[0].normalScale = 0.0f;
        CHECK(glm::distance(normal(), Vec3(0, 0, 1)) < 1e-6f);
    }
    SECTION("degenerate uv: no map")
    {
        scene.meshes[0].uv0.assign(3, Vec2(0.5f));
        CHECK(normal() == Vec3(0, 0, 1));
        scene.meshes[0].uv0.clear();
        CHECK(normal() == Vec3(0, 0, 1));
    }
    SECTION("seen from behind, the mapped normal is negated as a whole")
    {
        scene.materials[0].doubleSided = true;
        CHECK(glm::distance(evaluateSurface(scene, kMiddle, kBack).normal, -expected) < 1e-6f);
    }
}

TEST_CASE("metallic-roughness: albedo and F0 as glTF has them, textures multiply the factors", "[scene][brdf]")
{
    Scene scene = triangle();
    Material& m = scene.materials[0];
    m.baseColor = {0.8f, 0.4f, 0.2f, 1};
    m.metallic = 1.0f;
    m.roughness = 0.5f;
    CHECK(evaluateSurface(scene, kMiddle, kFront).albedo == Vec3(0));
    CHECK(glm::distance(evaluateSurface(scene, kMiddle, kFront).specularColor, Vec3(0.8f, 0.4f, 0.2f)) < 1e-6f);
    m.metallicRoughnessTexture.texture = addTexel(scene, {255, 51, 102, 0});  // green roughness 0.2, blue metallic 0.4
    const Surface s = evaluateSurface(scene, kMiddle, kFront);
    CHECK(s.roughness == Approx(0.1));
    CHECK(s.albedo.r == Approx(0.8 * 0.6));
    CHECK(s.specularColor.b == Approx(0.04 * 0.6 + 0.2 * 0.4));
}

TEST_CASE("a dielectric of roughness 1 has exactly no specular part, and only what is used is required", "[scene][brdf][requirements]")
{
    Scene scene = triangle();
    CHECK_FALSE(hasSpecularPart(scene.materials[0]));
    CHECK(evaluateSurface(scene, kMiddle, kFront).specularColor == Vec3(0));
    CHECK(evaluateSpecular(glossy(1, Vec3(0)), direction(0.1, 0), direction(0.1, 3)) == Vec3(0));

    Requirements need = analyseRequirements(scene, {});
    CHECK_FALSE((need.specular || need.alphaTest || need.normalMaps || need.textures || need.vertexColors));
    CHECK(need.leftOut.size() == 5);
    need = analyseRequirements(scene, {true});
    CHECK((need.specular && need.alphaTest && need.normalMaps && need.textures && need.vertexColors));
    CHECK(need.leftOut.empty());

    Material special;
    special.roughness = 0.9f;
    special.alphaMask = true;
    special.normalTexture.texture = addTexel(scene, {});
    scene.materials.push_back(special);  // worn by nothing
    CHECK_FALSE(analyseRequirements(scene, {}).specular);
    scene.meshes[0].material = 1;
    scene.meshes[0].colors.assign(3, Vec4(1));
    need = analyseRequirements(scene, {});
    CHECK((need.specular && need.alphaTest && need.normalMaps && need.textures && need.vertexColors));
    Material textured = scene.materials[0];
    textured.metallicRoughnessTexture.texture = 0;
    CHECK(hasSpecularPart(textured));
    textured = scene.materials[0];
    textured.metallic = 0.1f;
    CHECK(hasSpecularPart(textured));
}

TEST_CASE("the specular lobe is reciprocal", "[scene][brdf][ggx]")
{
    std::mt19937 random(4);
    std::uniform_real_distribution<> unit(0.02, 1);
    for (int i = 0; i < 2000; ++i) {
        const Surface s = glossy(float(unit(random)), Vec3(0.3f, 0.6f, 1));
        const Vec3 l = direction(unit(random), 6 * unit(random)), v = direction(unit(random), 6 * unit(random));
        const Vec3 a = evaluateSpecular(s, l, v) / l.z, b = evaluateSpecular(s, v, l) / v.z;
        CHECK(a.g == Approx(b.g).epsilon(1e-4));
    }
}

TEST_CASE("white furnace: a lobe of F0 = 1 returns at most what arrives, and nearly all of it where it is smooth", "[scene][brdf][ggx]")
{
    for (const float roughness : {0.15f, 0.3f, 0.6f, 1.0f}) {
        for (const double cosV : {0.1, 0.5, 0.9}) {
            CAPTURE(roughness, cosV);
            // Integral over half vectors, cos(theta_h) warped towards the normal, where the lobe is narrow.
            const Surface s = glossy(roughness, Vec3(1));
            const Vec3 v = direction(cosV, 0);
            const int n = 400, m = 256;
            double sum = 0;
            for (int i = 0; i < n; ++i) {
                const double x = (i + 0.5) / n, theta = x * x * 1.5707963268, dTheta = 2 * x * 1.5707963268 / n;
                for (int k = 0; k < m; ++k) {
                    const Vec3 h = direction(std::cos(theta), (k + 0.5) * 6.283185307 / m);
                    const float vh = glm::dot(v, h);
                    const Vec3 l = 2 * vh * h - v;
                    if (vh <= 0 || l.z <= 0) continue;
                    sum += double(evaluateSpecular(s, l, v).r) * 4 * double(vh) * std::sin(theta) * dTheta * 6.283185307 / m;
                }
            }
            CHECK(sum <= 1.001);
            CHECK(sum >= (roughness < 0.2f ? 0.95 : roughness < 0.7f ? 0.75 : 0.3));  // one bounce between facets only
        }
    }
}

TEST_CASE("the lobe at normal incidence has GGX's closed form, Schlick's rises to 1 at grazing", "[scene][brdf][ggx]")
{
    // l = v = n: D = 1 / (pi alpha^2), G/(4 nl nv) = 1/4, F = F0.
    for (const float roughness : {0.2f, 0.5f, 1.0f}) {
        const double alpha = double(roughness) * double(roughness);
        CHECK(double(evaluateSpecular(glossy(roughness, Vec3(0.5f)), {0, 0, 1}, {0, 0, 1}).r) == Approx(0.5 / (4 * 3.14159265358979 * alpha * alpha)));
    }
    const Vec3 l = direction(0.01, 0), v = direction(0.01, 3.14159265);
    const float low = evaluateSpecular(glossy(0.5f, Vec3(0.04f)), l, v).r, high = evaluateSpecular(glossy(0.5f, Vec3(1)), l, v).r;
    CHECK(low / high == Approx(0.04 + 0.96 * std::pow(0.99, 5)).epsilon(1e-3));
    CHECK(evaluateSpecular(glossy(0.5f, Vec3(1)), {0, 0, -1}, {0, 0, 1}) == Vec3(0));
    CHECK(evaluateSpecular(glossy(0.5f, Vec3(1)), {0, 0, 1}, {1, 0, 0}) == Vec3(0));
    CHECK(isFinite(evaluateSpecular(glossy(0.0f, Vec3(1)), {0, 0, 1}, {0, 0, 1})));
}

TEST_CASE("brdf: a point of a triangle of kilometres lies on its plane", "[scene][extent]")
{
    Scene scene;
    scene.materials = {diffuseMaterial("hill", Vec3(0.5f))};
    Mesh& hill = scene.meshes.emplace_back();
    hill.material = 0;
    hill.positions = {Vec3(-71234.5f, -63211.1f, 50000.7f), Vec3(80123.3f, -55555.5f, 47111.9f), Vec3(1234.5f, 90321.7f, -60123.4f)};
    hill.normals.assign(3, Vec3(0, 1, 0));
    hill.triangles = {{0, 1, 2}};
    scene.bounds = {Vec3(-1e5f), Vec3(1e5f)};
    scene.reach = {Vec3(-5.0f), Vec3(5.0f)};
    const glm::dvec3 p0(hill.positions[0]), e1 = glm::dvec3(hill.positions[1]) - p0, e2 = glm::dvec3(hill.positions[2]) - p0;
    const glm::dvec3 normal = glm::normalize(glm::cross(e1, e2));
    // About where the plane passes nearest to the origin: what stands there is metres large.
    const glm::dvec3 foot = normal * glm::dot(normal, p0) - p0;
    const double area2 = glm::dot(glm::cross(e1, e2), normal);
    for (int i = 0; i < 50; ++i) {
        const float b1 = float(glm::dot(glm::cross(foot, e2), normal) / area2) + 1e-5f * float(i), b2 = float(glm::dot(glm::cross(e1, foot), normal) / area2);
        const Vec3 p = positionOf(scene, {.mesh = 0, .triangle = 0, .b1 = b1, .b2 = b2});
        const Vec3 a = glm::abs(p);
        CHECK(std::abs(glm::dot(glm::dvec3(p) - p0, normal)) < 0x1p-23 * double(std::max({a.x, a.y, a.z})));
    }
}
