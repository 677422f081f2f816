#include "conetrace/frame/gbuffer.h"

#include "core/base/parallel.h"
#include "core/scene/shapes.h"
#include "tests/conetrace/ray_oracle.h"

#include "catch.h"

#include <set>

using namespace lrsm;

namespace {

const Requirements kEverything;

Scene testScene()
{
    Scene scene;
    scene.materials.push_back(diffuseMaterial("single", Vec3(0.8f, 0.5f, 0.25f)));
    scene.materials.push_back(diffuseMaterial("double", Vec3(0.2f, 0.4f, 0.6f), true));
    const auto add = [&](Mesh mesh, int material) {
        mesh.material = material;
        scene.meshes.push_back(std::move(mesh));
    };
    Mesh room, ball, box, sheet;
    addBox(room, Vec3(-4, 0, -4), Vec3(4, 5, 4), true);
    addSphere(ball, Vec3(1.2f, 1.1f, -0.5f), 0.9f, 3);
    addBox(box, Vec3(-2, 0, -1), Vec3(-0.7f, 1.7f, 0.4f));
    addQuad(sheet, {-1, 2, -2}, {2, 2.5f, -2}, {2, 4, -3}, {-1, 4.2f, -3});
    add(room, 0);
    add(ball, 1);
    add(box, 0);
    add(sheet, 1);
    updateBounds(scene);
    return scene;
}

std::vector<Camera> testCameras()
{
    Camera inside = lookAt({2.5f, 2, 3}, {-0.5f, 1.2f, -1}, {0, 1, 0}, 1.0f);
    Camera tilted = lookAt({-3, 4.5f, 2}, {1, 0.3f, -0.4f}, glm::normalize(Vec3(0.4f, 1, 0.2f)), 1.9f);
    Camera flat = inside;
    flat.perspective = false;
    flat.verticalExtent = 3.5f;
    Camera cut = inside;
    cut.nearPlane = 3.7f;  // cuts the ball and the box open
    return {inside, tilted, flat, cut};
}

}  // namespace

TEST_CASE("G-buffer: each pixel holds what its ray hits first", "[conetrace][gbuffer]")
{
    const Scene scene = testScene();
    const int width = 161, height = 90;
    for (std::size_t c = 0; c < testCameras().size(); ++c) {
        const Camera camera = testCameras()[c];
        const GBuffer gbuffer = renderGBuffer(scene, camera, kEverything, {width, height});
        int direct = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const std::size_t i = gbuffer.objectId.index(x, y);
                CAPTURE(c, x, y, gbuffer.position.texels[i].x, gbuffer.position.texels[i].y, gbuffer.position.texels[i].z);
                // Snapping moves edges by at most 1/362 pixel: at silhouettes any of the neighbouring rays may be right.
                bool matched = false;
                for (int k = 0; k < 9 && !matched; ++k) {
                    const float dx = 0.004f * float(k % 3 - (k % 3 == 2 ? 3 : 0)), dy = 0.004f * float(k / 3 - (k / 3 == 2 ? 3 : 0));
                    const oracle::RayHit hit = oracle::closestHit(scene, pixelRay(camera, width, height, float(x) + 0.5f + dx, float(y) + 0.5f + dy));
                    if (hit.mesh < 0) {
                        matched = !gbuffer.covered(i);
                        direct += matched && k == 0;
                        continue;
                    }
                    // The position lies on the hit triangle's plane, a hundredth of a pixel around the ray.
                    const double pixel = (camera.perspective ? 2 * std::tan(0.5 * camera.verticalFov) * hit.t : double(camera.verticalExtent)) / height;
                    const glm::dvec3 error = glm::dvec3(gbuffer.position.texels[i]) - hit.position;
                    matched = int(gbuffer.objectId.texels[i]) == hit.mesh + 1 && std::abs(glm::dot(error, hit.normal)) < 1e-5 &&
                              glm::length(error) < 0.012 * pixel / std::max(0.02, std::abs(hit.cosine)) + 1e-5 &&
                              glm::length(glm::dvec3(gbuffer.geometricNormal.texels[i]) - hit.normal) < 1e-5;
                    direct += matched && k == 0;
                }
                REQUIRE(matched);
            }
        CHECK(direct > 0.98 * width * height);
    }
}

TEST_CASE("G-buffer: normals are unit and face the eye, depth is the distance along the axis", "[conetrace][gbuffer]")
{
    const Scene scene = testScene();
    for (const Camera& camera : testCameras()) {
        const GBuffer g = renderGBuffer(scene, camera, kEverything, {120, 80});
        for (std::size_t i = 0; i < g.objectId.texels.size(); ++i) {
            if (!g.covered(i)) {
                REQUIRE((g.position.texels[i] == Vec3(0.0f) && g.depthLinear.texels[i] == 0.0f && g.normal.texels[i] == Vec3(0.0f)));
                continue;
            }
            const Vec3 toEye = camera.perspective ? camera.position - g.position.texels[i] : -camera.forward;
            REQUIRE(std::abs(glm::length(g.normal.texels[i]) - 1.0f) < 1e-5f);
            REQUIRE(std::abs(glm::length(g.geometricNormal.texels[i]) - 1.0f) < 1e-5f);
            REQUIRE(glm::dot(g.geometricNormal.texels[i], toEye) > -1e-4f);
            REQUIRE(glm::dot(g.normal.texels[i], toEye) > -1e-4f);
            REQUIRE(g.depthLinear.texels[i] == Approx(glm::dot(g.position.texels[i] - camera.position, camera.forward)));
            REQUIRE(g.depthLinear.texels[i] >= camera.nearPlane * 0.999f);
        }
    }
}

TEST_CASE("G-buffer: pixel centres of camera rays and of the clip matrix are the same points", "[conetrace][gbuffer]")
{
    for (const Camera& camera : testCameras())
        for (int i = 0; i < 50; ++i) {
            const int width = 640, height = 360 + i;
            const float px = float(13 * i) + 0.5f, py = float(7 * i) + 0.5f;
            const CameraRay ray = pixelRay(camera, width, height, px, py);
            const Vec4 c = clipFromWorld(camera, width, height, testScene().bounds) * Vec4(ray.origin + 5.0f * ray.direction, 1);
            CHECK((c.x / c.w + 1) * 0.5f * float(width) == Approx(px).margin(2e-3));
            CHECK((1 - c.y / c.w) * 0.5f * float(height) == Approx(py).margin(2e-3));
        }
}

TEST_CASE("G-buffer: the specular channels are there only when needed, and change nothing else", "[conetrace][gbuffer]")
{
    Requirements need;
    const GBuffer all = renderGBuffer(testScene(), testCameras()[0], need, {64, 36});
    need.specular = false;
    const GBuffer less = renderGBuffer(testScene(), testCameras()[0], need, {64, 36});
    CHECK(bytesOf(all) == GBuffer::predictBytes(64, 36, true));
    CHECK(bytesOf(less) == GBuffer::predictBytes(64, 36, false));
    CHECK(less.specularColor.empty());
    CHECK(less.roughness.empty());
    CHECK(less.position.texels == all.position.texels);
    CHECK(less.albedo.texels == all.albedo.texels);
    CHECK(less.objectId.texels == all.objectId.texels);
}

TEST_CASE("G-buffer: any number of threads gives the same bits, an empty scene gives an empty picture", "[conetrace][gbuffer]")
{
    std::vector<GBuffer> buffers;
    for (const int threads : {1, 2, 8}) {
        const ThreadLimit limit(threads);
        buffers.push_back(renderGBuffer(testScene(), testCameras()[1], kEverything, {200, 150}));
    }
    for (const GBuffer& g : buffers) {
        CHECK(g.position.texels == buffers[0].position.texels);
        CHECK(g.normal.texels == buffers[0].normal.texels);
        CHECK(g.depthLinear.texels == buffers[0].depthLinear.texels);
    }
    const GBuffer none = renderGBuffer(Scene{}, testCameras()[0], kEverything, {8, 8});
    for (std::size_t i = 0; i < 64; ++i) CHECK_FALSE(none.covered(i));
}
