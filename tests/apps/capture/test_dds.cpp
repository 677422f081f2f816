#include "apps/capture/dds.h"
#include "core/base/errors.h"

#include "catch.h"
#include "python.h"
#include "scratch.h"

#include <cmath>
#include <cstring>
#include <sstream>

using namespace lrsm;

namespace {

/// Filled so that each byte of a texture differs from its neighbours'.
DdsTexture filled(DdsTexture texture)
{
    texture.texels.resize(texture.byteSize());
    for (std::size_t i = 0; i < texture.texels.size(); ++i) texture.texels[i] = static_cast<std::byte>(i * 13 + i / 251);
    return texture;
}

std::vector<std::byte> counted(std::size_t n)
{
    std::vector<std::byte> bytes(n);
    for (std::size_t i = 0; i < n; ++i) bytes[i] = static_cast<std::byte>(i + 1);
    return bytes;
}

void setWord(std::vector<std::byte>& file, std::size_t word, std::uint32_t value)
{
    std::memcpy(file.data() + 4 * word, &value, 4);
}

std::string messageOfDds(const std::vector<std::byte>& file)
{
    try {
        decodeDds(file, "a.dds");
    } catch (const InputError& error) {
        return error.what();
    }
    return "read";
}

/// An independent reader, written from Microsoft's description alone: prints what the header says, and the last byte of each level of each layer.
constexpr const char* kReader = R"(
import struct, sys
data = open(sys.argv[1], 'rb').read()
magic, size, flags, height, width, pitch, depth, mips = struct.unpack_from('<4s7I', data)
pf_size, pf_flags, four_cc = struct.unpack_from('<2I4s', data, 4 + 72)
caps, caps2 = struct.unpack_from('<2I', data, 4 + 104)
dxgi, dimension, misc, array, misc2 = struct.unpack_from('<5I', data, 4 + 124)
assert (magic, size, pf_size, pf_flags, four_cc) == (b'DDS ', 124, 32, 4, b'DX10')
assert flags & 0x21007 == 0x21007 and caps & 0x1000 and misc == 0 and misc2 == 0
volume = dimension == 4
assert volume == bool(flags & 0x800000) == bool(caps2 & 0x200000)
assert bool(caps & 0x400000) == (mips > 1)
texel = {2: 16, 10: 8, 11: 8, 28: 4, 41: 4, 42: 4, 54: 2, 56: 2, 61: 1}[dxgi]
assert pitch == width * texel
at, ends = 148, []
for layer in range(array):
    for mip in range(mips):
        w, h, d = (max(1, n >> mip) for n in (width, height, depth if volume else 1))
        at += w * h * d * texel
        ends.append(data[at - 1])
assert at == len(data), (at, len(data))
print(dxgi, width, height, depth, mips, array, *ends)
)";

}  // namespace

TEST_CASE("dds: arrays, mips and volumes read back as written, and as an independent reader sees them", "[capture][dds]")
{
    const auto shape = GENERATE(values<DdsTexture>({
        {DxgiFormat::R8_UNORM, 8, 8, 8, 4, 1, true, {}},
        {DxgiFormat::R8G8B8A8_UNORM, 4, 4, 4, 3, 1, true, {}},
        {DxgiFormat::R16G16B16A16_FLOAT, 16, 16, 1, 5, 3, false, {}},
        {DxgiFormat::R16G16B16A16_UNORM, 16, 16, 1, 5, 4, false, {}},
        {DxgiFormat::R32_FLOAT, 13, 7, 1, 1, 1, false, {}},
        {DxgiFormat::R32G32B32A32_FLOAT, 5, 3, 1, 3, 2, false, {}},
    }));
    const DdsTexture texture = filled(shape);
    const std::vector<std::byte> file = encodeDds(texture);
    const DdsTexture back = decodeDds(file, "test");
    CHECK(back.texels == texture.texels);
    CHECK((back.format == texture.format && back.width == texture.width && back.height == texture.height && back.depth == texture.depth));
    CHECK((back.mips == texture.mips && back.layers == texture.layers && back.volume == texture.volume));

    LRSM_NEED_PYTHON(python, "struct");
    ScratchFolder scratch;
    scratch.write("a.dds", {reinterpret_cast<const char*>(file.data()), file.size()});
    scratch.write("read.py", kReader);
    std::ostringstream expected;
    expected << static_cast<std::uint32_t>(texture.format) << " " << texture.width << " " << texture.height << " " << (texture.volume ? texture.depth : 0)
             << " " << texture.mips << " " << texture.layers;
    for (std::uint32_t layer = 0; layer < texture.layers; ++layer)
        for (std::uint32_t mip = 0; mip < texture.mips; ++mip) expected << " " << std::to_integer<int>(texture.level(layer, mip).back());
    const CommandOutcome outcome = runCommand(python + " " + scratch.path("read.py") + " " + scratch.path("a.dds"));
    CHECK(outcome.text == expected.str() + "\n");
}

TEST_CASE("dds: malformed files give one line that begins with the place", "[capture][dds]")
{
    const std::vector<std::byte> good = encodeDds(filled({DxgiFormat::R16G16B16A16_FLOAT, 8, 8, 1, 4, 2, false, {}}));
    REQUIRE(messageOfDds(good) == "read");
    struct Case {
        std::size_t word;
        std::uint32_t value;
        std::string why;
    };
    const auto c = GENERATE(values<Case>({
        {0, 0, "no DDS file"},
        {1, 100, "wrong size"},
        {21, 0x31545844, "BC1_UNORM (\"DXT1\"), which is compressed"},
        {21, 0x32595559, "video"},  // YUY2
        {21, 200, "D3D9 format 200"},
        {32, 71, "BC1_UNORM, which is compressed"},
        {32, 98, "BC7_UNORM, which is compressed"},
        {32, 95, "BC6H_UF16"},
        {32, 103, "NV12"},
        {32, 999, "DXGI format 999"},
        {33, 2, "neither a 2D texture"},
        {4, 0, "edge outside"},
        {3, 1u << 31, "edge outside"},
        {7, 5, "5 mips"},
        {7, 3, "bytes of texels"},
        {35, 0, "0 layers"},
        {35, 3, "bytes of texels"},
        {4, 16, "bytes of texels"},
    }));
    std::vector<std::byte> file = good;
    setWord(file, c.word, c.value);
    const std::string message = messageOfDds(file);
    CAPTURE(c.word, message);
    CHECK(message.starts_with("a.dds: "));
    CHECK(message.find(c.why) != std::string::npos);

    for (const std::size_t size : {std::size_t(0), std::size_t(3), std::size_t(100), std::size_t(147), good.size() - 1}) {
        CAPTURE(size);
        CHECK(messageOfDds({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)}) != "read");
    }
}

namespace {

/// One row of texels of 32-bit words behind a DX10 header.
std::vector<std::byte> ofDxgi(std::uint32_t format, std::uint32_t width, const std::vector<std::byte>& texels)
{
    std::vector<std::byte> file = encodeDds(filled({DxgiFormat::R8_UNORM, width, 1, 1, 1, 1, false, {}}));
    setWord(file, 32, format);
    file.resize(kDdsHeaderBytes);
    file.insert(file.end(), texels.begin(), texels.end());
    return file;
}

std::vector<std::byte> wordsOf(const std::vector<std::uint32_t>& words)
{
    std::vector<std::byte> bytes(words.size() * 4);
    std::memcpy(bytes.data(), words.data(), bytes.size());
    return bytes;
}

std::vector<double> valuesOf(const std::vector<std::byte>& file)
{
    const DdsTexture texture = decodeDds(file, "test");
    return decodedTexels(texture.layout, texture.texels);
}

/// D3D9's header: pixel format flags, fourCC, bits, masks.
std::vector<std::byte> ofLegacy(const std::vector<std::uint32_t>& pixelFormat, std::uint32_t width, const std::vector<std::byte>& texels)
{
    std::vector<std::byte> file = encodeDds(filled({DxgiFormat::R8_UNORM, width, 1, 1, 1, 1, false, {}}));
    for (std::size_t i = 0; i < pixelFormat.size(); ++i) setWord(file, 20 + i, pixelFormat[i]);
    file.resize(128);
    file.insert(file.end(), texels.begin(), texels.end());
    return file;
}

}  // namespace

TEST_CASE("dds: packed formats give the values of the Functional Specification", "[capture][dds]")
{
    // R11G11B10: 1 is exponent 15, mantissa 0; 65024 and 64512 the largest; 2^-20 and 2^-19 the smallest denormals; exponent 31 is infinity.
    CHECK(valuesOf(ofDxgi(26, 4, wordsOf({15u << 6 | 15u << 17 | 15u << 27, 0x7bfu | 0x7bfu << 11 | 0x3dfu << 22, 1u | 1u << 11 | 1u << 22, 0x7c0u}))) ==
          std::vector<double>{1, 1, 1, 65024, 65024, 64512, 0x1p-20, 0x1p-20, 0x1p-19, HUGE_VAL, 0, 0});
    // R9G9B9E5: 2^(e - 24) a step.
    CHECK(valuesOf(ofDxgi(67, 1, wordsOf({256u | 511u << 9 | 1u << 18 | 16u << 27}))) == std::vector<double>{1, 511.0 / 256, 1.0 / 256});
    CHECK(valuesOf(ofDxgi(24, 1, wordsOf({1023u | 511u << 10 | 0u << 20 | 2u << 30}))) == std::vector<double>{1, 511.0 / 1023, 0, 2.0 / 3});
    CHECK(valuesOf(ofDxgi(25, 1, wordsOf({1023u | 511u << 10 | 0u << 20 | 2u << 30}))) == std::vector<double>{1023, 511, 0, 2});
    CHECK(valuesOf(ofDxgi(45, 2, wordsOf({0xabffffff, 0x7f000000}))) == std::vector<double>{1, 0});
    CHECK(valuesOf(ofDxgi(20, 1, wordsOf({0x3fc00000, 0x77}))) == std::vector<double>{1.5});
    CHECK(valuesOf(ofDxgi(87, 1, wordsOf({0x80ff3300}))) == std::vector<double>{1, 0.2, 0, 128.0 / 255});
    CHECK(valuesOf(ofDxgi(88, 1, wordsOf({0x80ff3300}))) == std::vector<double>{1, 0.2, 0});
    CHECK(valuesOf(ofDxgi(85, 2, wordsOf({0xf81f07e0}))) == std::vector<double>{0, 1, 0, 1, 0, 1});
    // SNORM: the lowest code is -1, too.
    CHECK(valuesOf(ofDxgi(31, 1, wordsOf({0x8081007f}))) == std::vector<double>{1, 0, -1, -1});
    CHECK(valuesOf(ofDxgi(37, 1, wordsOf({0x80017fff}))) == std::vector<double>{1, -1});
    const std::vector<double> srgb = valuesOf(ofDxgi(29, 1, wordsOf({0x80bc0000})));
    CHECK(srgb[2] == Approx(0.502886458).epsilon(1e-6));
    CHECK(srgb[3] == 128.0 / 255);  // alpha is linear
}

TEST_CASE("dds: headers of D3D9: numbers in the place of letters, masks, cubes", "[capture][dds]")
{
    struct Code {
        std::uint32_t fourCC;
        std::string name;
        std::size_t bytes;
    };
    for (const Code& code :
         {Code{36, "R16G16B16A16_UNORM", 8}, Code{110, "R16G16B16A16_SNORM", 8}, Code{111, "R16_FLOAT", 2}, Code{112, "R16G16_FLOAT", 4},
          Code{113, "R16G16B16A16_FLOAT", 8}, Code{114, "R32_FLOAT", 4}, Code{115, "R32G32_FLOAT", 8}, Code{116, "R32G32B32A32_FLOAT", 16}}) {
        const DdsTexture texture = decodeDds(ofLegacy({4, code.fourCC, 0}, 3, counted(3 * code.bytes)), "test");
        CHECK(texture.layout.name == code.name);
        CHECK(texture.texels == counted(3 * code.bytes));
    }
    CHECK(valuesOf(ofLegacy({0x41, 0, 32, 0xff0000, 0xff00, 0xff, 0xff000000}, 1, wordsOf({0x80ff3300}))) == std::vector<double>{1, 0.2, 0, 128.0 / 255});
    CHECK(valuesOf(ofLegacy({0x40, 0, 24, 0xff0000, 0xff00, 0xff, 0}, 1, {std::byte{0}, std::byte{51}, std::byte{255}})) == std::vector<double>{1, 0.2, 0});
    CHECK(valuesOf(ofLegacy({0x20000, 0, 16, 0xffff, 0, 0, 0}, 2, wordsOf({0xffff0000}))) == std::vector<double>{0, 1});
    CHECK(valuesOf(ofLegacy({0x2, 0, 8, 0, 0, 0, 0xff}, 1, {std::byte{51}})) == std::vector<double>{0.2});
    std::vector<std::byte> cube = ofLegacy({4, 114, 0}, 2, counted(6 * 16));
    setWord(cube, 3, 2);
    setWord(cube, 28, 0x200 | 0xfc00);
    CHECK(decodeDds(cube, "test").layers == 6);
    CHECK(messageOfDds(ofLegacy({0x40, 0, 32, 0xff00ff, 0, 0, 0}, 1, wordsOf({0}))).find("no runs of bits") != std::string::npos);
    CHECK(messageOfDds(ofLegacy({0, 0, 0}, 1, wordsOf({0}))).find("D3D9 format of 0 bits") != std::string::npos);
}
