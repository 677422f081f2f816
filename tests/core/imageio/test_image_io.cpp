#include "core/base/formats.h"
#include "core/imageio/image_io.h"

#include "core/base/errors.h"
#include "core/base/output_folder.h"

#include "catch.h"
#include "scratch.h"

#include <OpenImageIO/imageio.h>
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

namespace {

struct PartToWrite {
    OIIO::ImageSpec spec;
    std::vector<float> pixels;
};

OIIO::ImageSpec specOf(int width, int height, std::vector<std::string> channels, const std::string& name = "")
{
    OIIO::ImageSpec spec(width, height, int(channels.size()), OIIO::TypeFloat);
    spec.channelnames = std::move(channels);
    if (!name.empty()) spec.attribute("oiio:subimagename", name);
    return spec;
}

void writeParts(const std::string& path, const std::vector<PartToWrite>& parts)
{
    const auto output = OIIO::ImageOutput::create(path);
    std::vector<OIIO::ImageSpec> specs;
    for (const PartToWrite& part : parts) specs.push_back(part.spec);
    REQUIRE(output->open(path, int(specs.size()), specs.data()));
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (i > 0) REQUIRE(output->open(path, specs[i], OIIO::ImageOutput::AppendSubimage));
        REQUIRE(output->write_image(OIIO::TypeFloat, parts[i].pixels.data()));
    }
    REQUIRE(output->close());
}

}  // namespace

TEST_CASE("image io: every part of an EXR, layers by channel or by part", "[imageio]")
{
    ScratchFolder scratch;
    writeParts(scratch.path("a.exr"), {{specOf(2, 1, {"R", "G", "B"}, "beauty"), {1, 2, 3, 4, 5, 6}},
                                       {specOf(2, 1, {"gbuffer.normal.R", "gbuffer.normal.G", "gbuffer.normal.B"}, "second"), {7, 8, 9, 10, 11, 12}},
                                       {specOf(2, 1, {"Z"}, "gbuffer.depth"), {13, 14}}});
    const LayeredImage image = readImage(scratch.path("a.exr"));
    REQUIRE(image.layers.size() == 3);
    CHECK(image.notes.empty());
    CHECK(image.find("")->values == std::vector<float>{1, 2, 3, 4, 5, 6});
    CHECK(image.find("beauty") == image.find(""));
    CHECK(image.find("gbuffer.normal")->values == std::vector<float>{7, 8, 9, 10, 11, 12});
    CHECK(image.find("gbuffer.depth")->values == std::vector<float>{13, 14});
}

TEST_CASE("image io: integer channels of an EXR keep every bit, beside floats too", "[imageio]")
{
    ScratchFolder scratch;
    OIIO::ImageSpec spec = specOf(2, 1, {"Z", "id"});
    spec.channelformats = {OIIO::TypeFloat, OIIO::TypeUInt32};
    const struct {
        float depth = 0.0f;
        std::uint32_t id = 0;
    } pixels[] = {{0.5f, 4294967295u}, {2.0f, 16777217u}};
    const auto output = OIIO::ImageOutput::create(scratch.path("a.exr"));
    REQUIRE(output->open(scratch.path("a.exr"), spec));
    REQUIRE(output->write_image(OIIO::TypeUnknown, pixels));
    REQUIRE(output->close());
    const LayeredImage image = readImage(scratch.path("a.exr"));
    REQUIRE(image.layers.size() == 1);
    REQUIRE(image.layers[0].integers.size() == 1);
    const auto& whole = image.layers[0].integers[0];
    CHECK(image.layers[0].channelNames[whole.channel] == "id");
    CHECK(whole.values == std::vector<std::uint32_t>{4294967295u, 16777217u});
    CHECK(image.layers[0].values[1 - whole.channel] == 0.5f);
}

TEST_CASE("image io: the display window is the picture: overscan is cropped, what is missing is black, both are said", "[imageio]")
{
    ScratchFolder scratch;
    // Data 3x2 at (-1, 1) in a display of 4x2 at (0, 0): of its columns two are seen, of its rows the first alone, as the picture's last.
    OIIO::ImageSpec spec = specOf(3, 2, {"Y"});
    spec.x = -1, spec.y = 1;
    spec.full_x = spec.full_y = 0, spec.full_width = 4, spec.full_height = 2;
    writeParts(scratch.path("a.exr"), {{spec, {1, 2, 3, 4, 5, 6}}});
    const LayeredImage image = readImage(scratch.path("a.exr"));
    CHECK((image.width == 4 && image.height == 2));
    CHECK(image.layers[0].values == std::vector<float>{0, 0, 0, 0, 2, 3, 0, 0});
    REQUIRE(image.notes.size() == 1);
    CHECK(image.notes[0] == "its data window is 3x2 at (-1, 1), its display window 4x2 at (0, 0): what lies outside is cropped, what is missing is black");
}

TEST_CASE("image io: colours of a PNG with alpha are those stored, as sRGB or as numbers", "[imageio]")
{
    ScratchFolder scratch;
    OIIO::ImageSpec spec(1, 1, 4, OIIO::TypeUInt8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    const std::uint8_t pixel[] = {255, 51, 188, 0};
    const auto output = OIIO::ImageOutput::create(scratch.path("a.png"));
    REQUIRE(output->open(scratch.path("a.png"), spec));
    REQUIRE(output->write_image(OIIO::TypeUInt8, pixel));
    REQUIRE(output->close());
    CHECK(readImage(scratch.path("a.png"), Transfer::linear).layers[0].values == std::vector<float>{1.0f, 0.2f, 188.0f / 255.0f, 0.0f});
    CHECK(readImage(scratch.path("a.png")).layers[0].values[2] == Approx(0.502886458f).epsilon(1e-5));
}
