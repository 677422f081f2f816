#include "lrsm/light_projection.h"

#include "core/base/math.h"

#include "catch.h"

#include <random>

using namespace lrsm;

namespace {

using Random = std::mt19937_64;

float between(Random& random, float low, float high)
{
    return low + (high - low) * float(random() >> 40) * 0x1p-24f;
}
Vec3 pointIn(Random& random, const Aabb& box)
{
    return {between(random, box.min.x, box.max.x), between(random, box.min.y, box.max.y), between(random, box.min.z, box.max.z)};
}
Vec3 direction(Random& random)
{
    for (;;) {
        const Vec3 v(between(random, -1, 1), between(random, -1, 1), between(random, -1, 1));
        const float length = glm::length(v);
        if (length > 0.1f && length < 1.0f) return v / length;
    }
}
Light randomLight(Random& random, LightType type, const Aabb& around)
{
    Light light;
    light.type = type;
    light.position = pointIn(random, around);
    light.direction = direction(random);
    light.up = basisFromNormal(light.direction)[0];
    light.outerConeAngle = between(random, 0.1f, 1.4f);
    return light;
}
const Aabb kBounds{Vec3(-3, 0, -2), Vec3(5, 4, 7)};
const Aabb kAround{Vec3(-15), Vec3(15)};

}  // namespace

TEST_CASE("light projection: the clip matrix sees the same (u, v), and depth grows with distance along the axis", "[lrsm][projection]")
{
    Random random(2);
    const LightType type = GENERATE(LightType::directional, LightType::spot, LightType::cubeFace);
    for (int i = 0; i < 2000; ++i) {
        const LightProjection q = fitLightProjection(randomLight(random, type, kAround), kBounds, 512);
        const Mat4 clip = clipFromWorld(q);
        const Vec3 p = pointIn(random, kBounds);
        const LightSpacePoint s = projectToLight(q, p);
        REQUIRE((!s.valid || (s.depth >= -1e-5f && s.depth <= 1.0f + 1e-5f)));
        if (!s.valid || std::abs(s.u - 0.5f) > 0.5f || std::abs(s.v - 0.5f) > 0.5f) continue;
        const Vec4 c = clip * Vec4(p, 1);
        const float axial = glm::dot(p - q.position, q.forward);
        const float slack = type == LightType::directional ? 1.0f : std::max(1.0f, 5.0f / (axial * q.halfWidth));
        CAPTURE(i, axial, c.w, c.z / c.w);
        REQUIRE(c.x / c.w == Approx(2 * s.u - 1).margin(2e-6f * slack));
        REQUIRE(c.y / c.w == Approx(1 - 2 * s.v).margin(2e-6f * slack));
        if (type != LightType::directional && axial < 2e-4f * q.depthFar) continue;
        REQUIRE(c.z >= 0.0f);
        REQUIRE(c.z <= c.w * 1.00001f);
        const Vec4 farther = clip * Vec4(p + q.forward, 1);
        REQUIRE(farther.z / farther.w > c.z / c.w);
    }
}

TEST_CASE("light projection: counter-clockwise seen from the light is counter-clockwise in clip space", "[lrsm][projection]")
{
    Random random(3);
    const LightType type = GENERATE(LightType::directional, LightType::spot, LightType::cubeFace);
    for (int i = 0; i < 200; ++i) {
        const LightProjection q = fitLightProjection(randomLight(random, type, kAround), kBounds, 64);
        CHECK(glm::length(glm::cross(q.right, q.up) + q.forward) < 1e-5f);
        const Vec3 centre = q.position + q.forward * 3.0f;
        Vec2 ndc[3];
        for (int k = 0; k < 3; ++k) {
            const Vec3 corner = centre + (k == 1 ? q.right : k == 2 ? q.up : Vec3(0.0f)) * 0.1f;  // a, a + right, a + up
            const Vec4 c = clipFromWorld(q) * Vec4(corner, 1);
            ndc[k] = Vec2(c) / c.w;
        }
        const Vec2 a = ndc[1] - ndc[0], b = ndc[2] - ndc[0];
        REQUIRE(a.x * b.y - a.y * b.x > 0.0f);
    }
}

TEST_CASE("light projection: a directional map holds all bounds and is snapped to whole texels", "[lrsm][projection]")
{
    Random random(4);
    for (int i = 0; i < 500; ++i) {
        const Vec3 a = pointIn(random, kAround), b = pointIn(random, kAround);
        const Aabb bounds{glm::min(a, b), glm::max(a, b)};
        const LightProjection q = fitLightProjection(randomLight(random, LightType::directional, kAround), bounds, 128);
        for (unsigned k = 0; k < 8; ++k) {
            const Vec3 corner(k & 1 ? bounds.max.x : bounds.min.x, k & 2 ? bounds.max.y : bounds.min.y, k & 4 ? bounds.max.z : bounds.min.z);
            const LightSpacePoint s = projectToLight(q, corner);
            CAPTURE(i, k, s.u, s.v, s.depth);
            REQUIRE((s.u > -1e-5f && s.u < 1 + 1e-5f && s.v > -1e-5f && s.v < 1 + 1e-5f && s.depth > -1e-5f && s.depth < 1 + 1e-5f));
        }
        const float texel = 2 * q.halfWidth / 128;
        for (const Vec3& axis : {q.right, q.up}) {
            const double steps = double(glm::dot(q.position, axis)) / texel;
            REQUIRE(std::abs(steps - std::round(steps)) < 1e-2);
        }
    }
}

TEST_CASE("light projection: rsm_snap=sphere keeps a sun's texels one size from all directions, and holds all bounds", "[lrsm][projection]")
{
    Random random(9);
    const Aabb bounds{Vec3(-3, 0, -2), Vec3(4, 5, 2.5f)};
    const float size = fitLightProjection(randomLight(random, LightType::directional, kAround), bounds, bounds, 128, RsmSnap::sphere).halfWidth;
    float narrowest = kInfinity, widest = 0.0f;
    for (int i = 0; i < 200; ++i) {
        const Light light = randomLight(random, LightType::directional, kAround);
        const LightProjection q = fitLightProjection(light, bounds, bounds, 128, RsmSnap::sphere);
        REQUIRE(q.halfWidth == size);
        for (unsigned k = 0; k < 8; ++k) {
            const LightSpacePoint s = projectToLight(q, bounds.corner(k));
            REQUIRE((s.u > -1e-5f && s.u < 1 + 1e-5f && s.v > -1e-5f && s.v < 1 + 1e-5f));
        }
        // A little more room changes nothing; the close fit follows it, and the direction.
        const Aabb grown{bounds.min, bounds.max + Vec3(0.01f)};
        REQUIRE(fitLightProjection(light, grown, grown, 128, RsmSnap::sphere).halfWidth == size);
        const float close = fitLightProjection(light, bounds, bounds, 128, RsmSnap::none).halfWidth;
        REQUIRE(close < fitLightProjection(light, bounds, bounds, 128, RsmSnap::texel).halfWidth);
        narrowest = std::min(narrowest, close), widest = std::max(widest, close);
    }
    CHECK(widest > 1.1f * narrowest);
    CHECK(widest < size);
}

TEST_CASE("light projection: a cube face's texels subtend 4 pi / 6, and texelSize is their edge", "[lrsm][projection]")
{
    Light light;
    light.type = LightType::cubeFace;
    light.position = Vec3(1, 2, 3);
    light.direction = Vec3(0, -1, 0);
    light.up = Vec3(0, 0, 1);
    const int n = 256;
    const LightProjection q = fitLightProjection(light, kBounds, n);
    double solidAngle = 0;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            // The point under the texel's centre, two metres along the axis.
            const float u = (float(x) + 0.5f) / n, v = (float(y) + 0.5f) / n;
            const Vec3 p = q.position + 2.0f * (q.forward + q.right * (2 * u - 1) + q.up * (1 - 2 * v));
            const LightSpacePoint s = projectToLight(q, p);
            REQUIRE(s.u == Approx(u).margin(1e-6));
            const double r = glm::length(p - q.position);
            solidAngle += double(s.texelSize) * s.texelSize * (2.0 / r) / (r * r);
        }
    CHECK(solidAngle == Approx(4 * 3.14159265358979 / 6).epsilon(1e-5));
}

TEST_CASE("light projection: lights inside, outside and facing away, and scenes without extent, keep finite ranges", "[lrsm][projection]")
{
    Random random(5);
    const Aabb point{Vec3(2, 2, 2), Vec3(2, 2, 2)}, plane{Vec3(-1, 0, -1), Vec3(1, 0, 1)}, empty;
    for (const Aabb& bounds : {kBounds, point, plane, empty})
        for (const LightType type : {LightType::directional, LightType::spot, LightType::cubeFace})
            for (int i = 0; i < 100; ++i) {
                Light light = randomLight(random, type, kAround);
                if (i == 0) light.position = Vec3(2, 2, 2);
                if (i == 1) light.direction = Vec3(0, -1, 0), light.up = Vec3(1, 0, 0);
                if (i == 2) light.position = Vec3(0, 1e6f, 0);
                const LightProjection q = fitLightProjection(light, bounds, 64);
                CAPTURE(int(type), i, q.depthNear, q.depthFar, q.halfWidth);
                REQUIRE(q.depthRange() > 0.0f);
                REQUIRE((std::isfinite(q.depthFar) && q.halfWidth > 0.0f && std::isfinite(q.halfWidth) && isFinite(q.position)));
                const Mat4 clip = clipFromWorld(q);
                for (int k = 0; k < 4; ++k)
                    for (int j = 0; j < 4; ++j) REQUIRE(std::isfinite(clip[k][j]));
            }
}

TEST_CASE("light projection: behind a spot light nothing is valid, the direction to the light is the light's own", "[lrsm][projection]")
{
    Light light;
    light.type = LightType::spot;
    light.position = Vec3(0, 3, 0);
    light.direction = Vec3(0, -1, 0);
    light.up = Vec3(1, 0, 0);
    const LightProjection q = fitLightProjection(light, kBounds, 64);
    CHECK_FALSE(projectToLight(q, Vec3(0, 3.5f, 0)).valid);
    CHECK_FALSE(projectToLight(q, Vec3(0, 3, 0)).valid);
    CHECK(projectToLight(q, Vec3(0, 2.9f, 0)).valid);
    CHECK(directionToLight(q, Vec3(0, 1, 0)) == Vec3(0, 1, 0));
    CHECK(directionToLight(q, Vec3(0, 3, 0)) == Vec3(0, 1, 0));
}

TEST_CASE("light projection: what is projected is found again", "[lrsm][projection]")
{
    Random random(9);
    const LightType type = GENERATE(LightType::directional, LightType::spot, LightType::cubeFace);
    float largest = 0.0f;
    for (int i = 0; i < 2000; ++i) {
        const LightProjection q = fitLightProjection(randomLight(random, type, kAround), kBounds, 512);
        const Vec3 p = pointIn(random, kBounds);
        const LightSpacePoint s = projectToLight(q, p);
        if (!s.valid || std::abs(s.u - 0.5f) > 0.5f || std::abs(s.v - 0.5f) > 0.5f) continue;
        largest = std::max(largest, glm::length(unprojectFromLight(q, s.u, s.v, s.depth) - p));
    }
    CAPTURE(largest);
    CHECK(largest < kUnprojectionMaxError);
}
