#include "core/base/formats.h"
#include "core/imageio/image_io.h"

#include "core/base/errors.h"
#include "core/base/output_folder.h"

#include "catch.h"

#include <unistd.h>
#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>

using namespace lrsm;

namespace {

std::string scratch(const std::string& name)
{
    return (std::filesystem::temp_directory_path() / ("lrsm_image_" + std::to_string(::getpid()) + "_" + name)).string();
}

LayeredImage someImage()
{
    Image<Vec3> combined(5, 3), irradiance(5, 3);
    Image<float> depth(5, 3);
    for (std::size_t i = 0; i < combined.texels.size(); ++i) {
        const float x = static_cast<float>(i);
        combined.texels[i] = Vec3(x, 0.1f * x, -x);
        irradiance.texels[i] = Vec3(1e-30f * x, 1e30f * x, 1.0f / (x + 3.0f));
        depth.texels[i] = std::sqrt(x);
    }
    depth.texels[1] = std::numeric_limits<float>::infinity();
    irradiance.texels[2].y = std::nanf("");
    LayeredImage image;
    addLayer(image, "", combined);
    addLayer(image, "indirect.diffuse", combined);
    addLayer(image, "irradiance", irradiance);
    addLayer(image, "depth", depth, "Z");
    image.metadata.emplace_back("lrsm:settings", R"({"cone_count":6})");
    return image;
}

}  // namespace

TEST_CASE("a tonemapped picture has the codes of srgb8FromLinear", "[imageio]")
{
    // A prime stride through the floats up to 1.
    std::vector<float> values;
    for (std::uint32_t bits = 0; bits <= std::bit_cast<std::uint32_t>(1.0f); bits += 20011) values.push_back(std::bit_cast<float>(bits));
    Image<Vec3> picture(static_cast<int>(values.size()), 1);
    for (std::size_t i = 0; i < values.size(); ++i) picture.texels[i] = Vec3(values[i], 1.0f, -1.0f);
    const Image<Rgb8> codes = tonemap(picture, 0.0f);
    for (std::size_t i = 0; i < values.size(); ++i) REQUIRE(codes.texels[i] == Rgb8{srgb8FromLinear(values[i]), 255, 0});
}

TEST_CASE("EXR: layers, channel names, metadata and every bit come back", "[imageio]")
{
    const LayeredImage image = someImage();
    const std::string path = scratch("round.exr");
    writeFileWhole(path, encodeExr(image));
    const LayeredImage back = readImage(path);
    std::filesystem::remove(path);

    CHECK(back.width == 5);
    CHECK(back.height == 3);
    REQUIRE(back.layers.size() == image.layers.size());
    for (const ImageLayer& layer : image.layers) {
        CAPTURE(layer.name);
        const ImageLayer* found = back.find(layer.name);
        REQUIRE(found);
        CHECK(found->channelNames == layer.channelNames);
        REQUIRE(found->values.size() == layer.values.size());
        for (std::size_t i = 0; i < layer.values.size(); ++i)
            REQUIRE(std::bit_cast<std::uint32_t>(found->values[i]) == std::bit_cast<std::uint32_t>(layer.values[i]));
    }
    REQUIRE(back.metadata.size() == 1);
    CHECK(back.metadata == image.metadata);
    CHECK(rgbLayer(back, "", "t").at(4, 2) == Vec3(14.0f, 0.1f * 14.0f, -14.0f));
    CHECK(scalarLayer(back, "depth", "t").at(4, 0) == 2.0f);
}

TEST_CASE("EXR: the same picture gives the same bytes, a second later too", "[imageio]")
{
    const auto first = encodeExr(someImage());
    ::usleep(1100000);
    const bool same = encodeExr(someImage()) == first;
    CHECK(same);
}

TEST_CASE("PNG: 8-bit codes come back as linear light, all 256 of them", "[imageio]")
{
    Image<Rgb8> picture(256, 1);
    for (int i = 0; i < 256; ++i) picture.at(i, 0) = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(255 - i), 7};
    const std::string path = scratch("codes.png");
    writeFileWhole(path, encodePng(picture));
    const Image<Vec3> back = rgbLayer(readImage(path), "", "t");
    std::filesystem::remove(path);
    for (int i = 0; i < 256; ++i) {
        const double code = i / 255.0, linear = code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
        REQUIRE(double(back.at(i, 0).x) == Approx(linear).margin(1e-6));
        REQUIRE(back.at(i, 0).x == back.at(255 - i, 0).y);
    }
    CHECK(tonemap(back, 0.0f).texels == picture.texels);
}

TEST_CASE("reading: what is not a picture is an input error that names the file", "[imageio]")
{
    const std::string path = scratch("bad.exr");
    writeFileWhole(path, std::as_bytes(std::span("not a picture", 13)));
    CHECK_THROWS_AS(readImage(path), InputError);
    auto truncated = encodeExr(someImage());
    truncated.resize(truncated.size() / 2);
    writeFileWhole(path, truncated);
    CHECK_THROWS_AS(readImage(path), InputError);
    std::filesystem::remove(path);
    CHECK_THROWS_AS(readImage(path), InputError);
    CHECK_THROWS_AS(readImage("/"), InputError);
    CHECK_THROWS_AS(readImage(""), InputError);
    CHECK_THROWS_AS(rgbLayer(someImage(), "albedo", "x.exr"), InputError);
}

TEST_CASE("display: exposure is in quarter stops, follows the light, and survives black and NaN", "[imageio][display]")
{
    Image<Vec3> picture(10, 10, Vec3(0.2f));
    CHECK(automaticExposure(picture) == 2.0f);  // 0.2 * 2^2 = 0.8
    for (Vec3& c : picture.texels) c *= 1.0f / 64.0f;
    CHECK(automaticExposure(picture) == 8.0f);
    picture.at(0, 0) = Vec3(std::nanf(""));
    picture.at(1, 0) = Vec3(std::numeric_limits<float>::infinity());
    CHECK(automaticExposure(picture) == 8.0f);
    CHECK(automaticExposure(Image<Vec3>(4, 4)) == 0.0f);
    CHECK(tonemap(picture, 8.0f).at(0, 0) == Rgb8{255, 0, 255});
    CHECK(tonemap(picture, 8.0f).at(5, 5) == Rgb8{231, 231, 231});  // sRGB of 0.8
}

TEST_CASE("display: false colours run from end to end, grow in lightness, and clip", "[imageio][display]")
{
    Image<float> values(102, 1);
    for (int i = 0; i < 102; ++i) values.at(i, 0) = static_cast<float>(i - 1) / 99.0f;
    const Image<Rgb8> colors = falseColor(values, 0.0f, 1.0f);
    CHECK(colors.at(0, 0) == colors.at(1, 0));
    CHECK(colors.at(100, 0) == colors.at(101, 0));
    CHECK(colors.at(1, 0) == Rgb8{68, 1, 84});
    CHECK(colors.at(100, 0) == Rgb8{253, 231, 37});
    for (int i = 2; i < 101; ++i) {
        const auto grey = [&](int x) { return 0.2126 * colors.at(x, 0).r + 0.7152 * colors.at(x, 0).g + 0.0722 * colors.at(x, 0).b; };
        REQUIRE(grey(i) >= grey(i - 1) - 0.6);
    }
    CHECK(signedFalseColor(Image<float>(1, 1, 0.0f), 1.0f).at(0, 0) == Rgb8{247, 247, 247});
    CHECK(falseColor(Image<float>(1, 1, std::nanf("")), 0.0f, 1.0f).at(0, 0) == Rgb8{255, 0, 255});
    CHECK(normalColor(Image<Vec3>(1, 1, Vec3(0, 0, 1))).at(0, 0) == Rgb8{128, 128, 255});
}
