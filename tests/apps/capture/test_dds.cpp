#include "apps/capture/dds.h"
#include "core/base/errors.h"

#include "catch.h"
#include "python.h"
#include "scratch.h"

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
        {21, 0x31545844, "no DX10 header"},  // DXT1
        {32, 71, "DXGI format 71"},          // BC1
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
