// What D3D guarantees of a sampler.
#include "core/scene/texture_sampling.h"

#include "catch.h"

#include <random>

using namespace lrsm;

namespace {

/// Grey values in a row or a block; alpha is 255 minus grey.
Texture texture(int width, int height, const std::vector<int>& grey, Wrap wrap = Wrap::repeat, bool nearest = false)
{
    Texture t;
    t.image = Image<Rgba8>(width, height);
    for (std::size_t i = 0; i < grey.size(); ++i) {
        const auto v = std::uint8_t(grey[i]);
        t.image.texels[i] = {v, v, v, std::uint8_t(255 - v)};
    }
    t.wrapS = t.wrapT = wrap;
    t.nearest = nearest;
    return t;
}

float greyAt(const Texture& t, float u, float v = 0.5f)
{
    return 255.0f * sampleTexture(t, {u, v}).r;
}

double srgbDecoded(double c)
{
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

}  // namespace

TEST_CASE("a texel's centre gives the texel, exactly", "[scene][texture]")
{
    std::mt19937 random(1);
    std::vector<int> grey(64);
    for (int& g : grey) g = int(random() % 256);
    for (const bool nearest : {false, true}) {
        const Texture t = texture(16, 4, grey, Wrap::repeat, nearest);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 16; ++x) {
                const auto g = float(grey[std::size_t(16 * y + x)]);
                CHECK(sampleTexture(t, {(float(x) + 0.5f) / 16, (float(y) + 0.5f) / 4}) == Vec4(g / 255, g / 255, g / 255, (255 - g) / 255));
            }
    }
}

TEST_CASE("row 0 is at the top: v grows downwards", "[scene][texture]")
{
    const Texture t = texture(1, 2, {10, 200});
    CHECK(greyAt(t, 0.5f, 0.25f) == Approx(10));
    CHECK(greyAt(t, 0.5f, 0.75f) == Approx(200));
}

TEST_CASE("a constant stays that constant, and no lookup leaves the texels' range", "[scene][texture]")
{
    std::mt19937 random(2);
    std::uniform_real_distribution<float> any(-3, 3);
    const Texture constant = texture(3, 5, std::vector<int>(15, 137));
    const Texture mixed = texture(5, 3, {3, 250, 17, 99, 42, 3, 3, 250, 250, 8, 77, 31, 250, 3, 120});
    const float lowLinear = sampleTextureSrgb(texture(1, 1, {3}), {0, 0}).r, highLinear = sampleTextureSrgb(texture(1, 1, {250}), {0, 0}).r;
    for (int i = 0; i < 20000; ++i) {
        const Vec2 uv(any(random), any(random));
        REQUIRE(sampleTexture(constant, uv).g == 137.0f / 255.0f);
        REQUIRE(sampleTextureSrgb(constant, uv) == sampleTextureSrgb(constant, {0.5f, 0.5f}));
        const float g = sampleTexture(mixed, uv).g, linear = sampleTextureSrgb(mixed, uv).g;
        REQUIRE(g >= 3.0f / 255.0f);
        REQUIRE(g <= 250.0f / 255.0f);
        REQUIRE(linear >= lowLinear);
        REQUIRE(linear <= highLinear);
    }
}

TEST_CASE("between two centres the lookup is linear and monotone", "[scene][texture]")
{
    const Texture t = texture(2, 1, {20, 220}, Wrap::clampToEdge);
    float last = -1;
    for (int i = 0; i <= 1000; ++i) {
        const float u = float(i) / 1000;
        const float g = greyAt(t, u);
        CHECK(g >= last);
        CHECK(g == Approx(std::clamp(20 + 200 * (2 * u - 0.5f), 20.0f, 220.0f)).margin(1e-3));
        last = g;
    }
}

TEST_CASE("wrap modes: what lies beyond the edge", "[scene][texture]")
{
    const std::vector<int> row = {0, 80, 160, 240};
    const Texture repeat = texture(4, 1, row, Wrap::repeat), clamp = texture(4, 1, row, Wrap::clampToEdge), mirror = texture(4, 1, row, Wrap::mirroredRepeat);
    CHECK(greyAt(repeat, 0.0f) == Approx(120));  // halfway between the first texel and the last
    CHECK(greyAt(clamp, 0.0f) == Approx(0).margin(1e-5));
    CHECK(greyAt(mirror, 0.0f) == Approx(0).margin(1e-5));
    CHECK(greyAt(repeat, 1.0f) == Approx(120));
    CHECK(greyAt(clamp, 1.0f) == Approx(240));
    CHECK(greyAt(mirror, 1.0f) == Approx(240));
    for (const float u : {0.03f, 0.2f, 0.5f, 0.71f, 0.99f}) {
        CAPTURE(u);
        for (const float period : {-4.0f, -1.0f, 1.0f, 2.0f, 7.0f}) CHECK(greyAt(repeat, u + period) == Approx(greyAt(repeat, u)).margin(2e-3));
        for (const float period : {-4.0f, -2.0f, 2.0f, 6.0f}) CHECK(greyAt(mirror, u + period) == Approx(greyAt(mirror, u)).margin(2e-3));
        CHECK(greyAt(mirror, -u) == Approx(greyAt(mirror, u)).margin(1e-3));
        CHECK(greyAt(mirror, 2 - u) == Approx(greyAt(mirror, u)).margin(1e-3));
        CHECK(greyAt(clamp, -u) == Approx(0).margin(1e-5));
        CHECK(greyAt(clamp, 1 + u) == Approx(240));
    }
    // Each axis has its own mode.
    Texture mixed = texture(2, 2, {0, 100, 200, 250}, Wrap::clampToEdge, true);
    mixed.wrapT = Wrap::repeat;
    CHECK(greyAt(mixed, 1.3f, 1.3f) == Approx(100));
}

TEST_CASE("nearest takes the texel whose square holds the point", "[scene][texture]")
{
    const Texture t = texture(4, 1, {0, 80, 160, 240}, Wrap::repeat, true);
    for (int i = 0; i < 4; ++i) {
        CHECK(greyAt(t, (float(i) + 0.01f) / 4) == Approx(80 * i).margin(1e-4));
        CHECK(greyAt(t, (float(i) + 0.99f) / 4) == Approx(80 * i).margin(1e-4));
    }
    CHECK(greyAt(t, -1e-12f) == Approx(0).margin(1e-4));  // rounds to 1, wraps to 0
}

TEST_CASE("no uv is too large, not even infinity or NaN", "[scene][texture]")
{
    for (const Wrap wrap : {Wrap::repeat, Wrap::clampToEdge, Wrap::mirroredRepeat})
        for (const bool nearest : {false, true}) {
            const Texture t = texture(4, 4, std::vector<int>(16, 50), wrap, nearest);
            for (const float u : {1e10f, -1e10f, 3e38f, -3e38f, kInfinity, -kInfinity, std::nanf(""), 1e-45f, -1e-45f})
                CHECK(sampleTexture(t, {u, -u}).r == 50.0f / 255.0f);
        }
    CHECK(sampleTexture(Texture{}, {0.5f, 0.5f}) == Vec4(1));
}

TEST_CASE("alpha alone is the alpha of the whole lookup", "[scene][texture]")
{
    std::mt19937 random(2);
    std::vector<int> grey(64);
    for (int& g : grey) g = int(random() % 256);
    for (const Wrap wrap : {Wrap::repeat, Wrap::clampToEdge, Wrap::mirroredRepeat})
        for (const bool nearest : {false, true}) {
            const Texture t = texture(16, 4, grey, wrap, nearest);
            for (int i = 0; i < 200; ++i) {
                const Vec2 uv(float(random() % 4000) / 1000.0f - 2.0f, float(random() % 4000) / 1000.0f - 2.0f);
                CHECK(sampleTextureAlpha(t, uv) == sampleTexture(t, uv).a);
                CHECK(sampleTextureAlpha(t, uv) == sampleTextureSrgb(t, uv).a);
            }
        }
    CHECK(sampleTextureAlpha(Texture{}, {0.5f, 0.5f}) == 1.0f);
}

TEST_CASE("sRGB is decoded before filtering, alpha not at all", "[scene][texture]")
{
    for (int v = 0; v < 256; ++v) {
        const Vec4 c = sampleTextureSrgb(texture(1, 1, {v}), {0.3f, 0.7f});
        CHECK(double(c.r) == Approx(srgbDecoded(v / 255.0)).epsilon(1e-6).margin(1e-9));
        CHECK(c.a == float(255 - v) / 255.0f);
    }
    const Vec4 middle = sampleTextureSrgb(texture(2, 1, {0, 255}, Wrap::clampToEdge), {0.5f, 0.5f});
    CHECK(middle.r == 0.5f);  // not the decoded mean of the stored values, 0.214
}
