#include "core/scene/mip_chain.h"

#include "core/base/rng.h"
#include "core/scene/brdf.h"
#include "core/scene/shapes.h"
#include "core/scene/texture_sampling.h"

#include "catch.h"

#include <cmath>

using namespace lrsm;

namespace {

Image<Rgba8> noise(int width, int height)
{
    Image<Rgba8> image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto words = philox({std::uint32_t(x), std::uint32_t(y), 0, 0}, {3, 4});
            image.at(x, y) = {std::uint8_t(words[0]), std::uint8_t(words[1]), std::uint8_t(words[2]), std::uint8_t(words[3])};
        }
    return image;
}

double srgbToLinear(std::uint8_t code)
{
    static const std::vector<double> table = [] {
        std::vector<double> values;
        for (int i = 0; i < 256; ++i) values.push_back(i / 255.0 <= 0.04045 ? i / 255.0 / 12.92 : std::pow((i / 255.0 + 0.055) / 1.055, 2.4));
        return values;
    }();
    return table[code];
}
double linearToSrgb(double linear)
{
    return 255.0 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055);
}

/// A floor from the eye's feet to the horizon, one texture repeat a metre.
Scene texturedFloor(const Image<Rgba8>& image, float repeats)
{
    Scene scene;
    Mesh mesh;
    addQuad(mesh, {-50, 0, 50}, {50, 0, 50}, {50, 0, -50}, {-50, 0, -50});
    mesh.uv0 = {{0, repeats}, {repeats, repeats}, {repeats, 0}, {0, 0}};
    scene.meshes.push_back(mesh);
    scene.materials.push_back(diffuseMaterial("floor", Vec3(1)));
    scene.materials[0].baseColorTexture.texture = 0;
    const auto texture = std::make_shared<Texture>();
    texture->image = image;
    scene.textures.push_back(texture);
    updateBounds(scene);
    buildMipChains({texture}, scene.materials);
    return scene;
}

}  // namespace

TEST_CASE("mip chains: each texel is the mean of the area it covers, colours in linear light, any size", "[textures]")
{
    const int width = GENERATE(8, 7, 1, 12), height = GENERATE(8, 5, 3);
    const Image<Rgba8> base = noise(width, height);
    for (const TexelMeaning meaning : {TexelMeaning::color, TexelMeaning::data}) {
        const Image<Rgba8> next = halveTexture(base, meaning);
        REQUIRE((next.width == std::max(1, width / 2) && next.height == std::max(1, height / 2)));
        for (int y = 0; y < next.height; ++y)
            for (int x = 0; x < next.width; ++x) {
                // By many points in the texel's own area.
                constexpr int kPoints = 210;  // a multiple of every edge, so that none lies on a border
                double red = 0.0, alpha = 0.0;
                for (int j = 0; j < kPoints; ++j)
                    for (int i = 0; i < kPoints; ++i) {
                        const Rgba8 t = base.at(int((x + (i + 0.5) / kPoints) / next.width * width), int((y + (j + 0.5) / kPoints) / next.height * height));
                        red += meaning == TexelMeaning::color ? srgbToLinear(t.r) : t.r;
                        alpha += t.a;
                    }
                red /= kPoints * kPoints;
                CHECK(double(next.at(x, y).r) == Approx(meaning == TexelMeaning::color ? linearToSrgb(red) : red).margin(1.0));
                CHECK(double(next.at(x, y).a) == Approx(alpha / (kPoints * kPoints)).margin(1.0));
            }
    }
}

TEST_CASE("mip chains: down to one texel, for the uses that there are, and a constant stays", "[textures]")
{
    Scene scene = texturedFloor(Image<Rgba8>(20, 6, {200, 17, 90, 128}), 1);
    const Texture& texture = *scene.textures[0];
    REQUIRE(texture.colorMips.size() == 4);  // 10x3, 5x1, 2x1, 1x1
    CHECK((texture.colorMips[3].width == 1 && texture.colorMips[3].height == 1));
    CHECK(texture.dataMips.empty());
    for (const Image<Rgba8>& level : texture.colorMips)
        for (const Rgba8& texel : level.texels) CHECK(texel == Rgba8{200, 17, 90, 128});
}

TEST_CASE("texture level: D3D's, by the longer movement in texels", "[textures]")
{
    const Image<Rgba8> base(64, 32);
    const auto level = [&](const Vec2& right, const Vec2& down) { return textureLevel(base, {Vec2(0), right, down}, 7); };
    CHECK(level({0, 0}, {0, 0}) == 0.0f);
    CHECK(level({1.0f / 64, 0}, {0, 1.0f / 32}) == 0.0f);  // a texel a pixel
    CHECK(level({4.0f / 64, 0}, {0, 1.0f / 32}) == Approx(2.0f));
    CHECK(level({0, 3.0f / 32}, {0, 0}) == Approx(std::log2(3.0)));
    CHECK(level({3.0f / 64, 4.0f / 32}, {0, 0}) == Approx(std::log2(5.0)));
    CHECK(level({100, 0}, {0, 0}) == 6.0f);
    CHECK(level({kInfinity, 0}, {0, 0}) == 0.0f);
    CHECK(level({std::nanf(""), 0}, {0, 0}) == 0.0f);
}

TEST_CASE("trilinear lookup: between levels, and the base level's own bits where a texture is magnified", "[textures]")
{
    Scene scene = texturedFloor(noise(16, 16), 1);
    const Texture& texture = *scene.textures[0];
    const Vec2 uv(0.3f, 0.71f);
    const auto at = [&](float texels) { return sampleTextureSrgb(texture, {uv, Vec2(texels / 16, 0), Vec2(0)}); };
    CHECK(at(0.5f) == sampleTextureSrgb(texture, uv));
    Texture level1 = texture, level2 = texture;
    level1.image = texture.colorMips[0];
    level2.image = texture.colorMips[1];
    CHECK(at(2.0f) == sampleTextureSrgb(level1, uv));
    const Vec4 middle = at(2.0f * std::sqrt(2.0f)), expected = 0.5f * (sampleTextureSrgb(level1, uv) + sampleTextureSrgb(level2, uv));
    for (int c = 0; c < 4; ++c) CHECK(middle[c] == Approx(expected[c]).margin(1e-5));
    // The whole texture in a pixel: its mean.
    double mean = 0.0;
    for (const Rgba8& t : texture.image.texels) mean += srgbToLinear(t.g) / 256;
    CHECK(double(at(64).g) == Approx(mean).margin(0.01));
}

TEST_CASE("derivatives: those of the neighbouring pixels' rays on the plane", "[textures]")
{
    const Scene scene = texturedFloor(noise(64, 64), 100);
    const int width = 64, height = 48;
    for (const bool perspective : {true, false}) {
        Camera camera = lookAt({0.3f, 2, 8}, {0, 0.5f, -1}, {0.1f, 1, 0}, 0.9f);
        camera.perspective = perspective;
        camera.verticalExtent = 9.0f;
        const PixelSpacing unit = pixelSpacing(camera, height);
        const auto onFloor = [&](float x, float y) {
            const CameraRay ray = pixelRay(camera, width, height, x, y);
            return glm::dvec3(ray.origin) - glm::dvec3(ray.direction) * (double(ray.origin.y) / double(ray.direction.y));
        };
        int tested = 0;
        for (const int y : {30, 38, 46})
            for (const int x : {3, 31, 60}) {
                const glm::dvec3 p = onFloor(float(x), float(y));
                const double h = 1.0 / 16;
                const glm::dvec3 right = (onFloor(float(x + h), float(y)) - onFloor(float(x - h), float(y))) / (2 * h);
                const glm::dvec3 down = (onFloor(float(x), float(y + h)) - onFloor(float(x), float(y - h))) / (2 * h);
                // One repeat a metre: uv moves as the point does. The level is that of 64 texels a metre.
                const double texels = 64 * std::max(glm::length(right), glm::length(down));
                const PixelSpacing here = spacingAt(unit, camera, Vec3(p));
                const Vec3 toEye = camera.perspective ? camera.position - Vec3(p) : -camera.forward;
                // b1, b2 of triangle (0, 1, 2) of the square, extended.
                const double b12 = (p.x + 50) / 100, b2 = (50 - p.z) / 100;
                const SurfaceHit hit{0, 0, float(b12 - b2), float(b2)};
                const Vec3 filtered = evaluateSurface(scene, hit, toEye, &here).albedo;
                const auto at = [&](double level) {
                    return Vec3(sampleTextureSrgb(*scene.textures[0],
                                                  {Vec2(float(p.x + 50), float(100 - (50 - p.z))), Vec2(float(std::exp2(level) / 64), 0), Vec2(0)}));
                };
                const Vec3 expected = at(std::log2(texels));
                CAPTURE(perspective, x, y, texels);
                CHECK(glm::distance(filtered, expected) < 0.02f);
                tested += texels > 1.5;
            }
        CHECK(tested > 5);
    }
}
