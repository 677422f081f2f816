#include "apps/capture/dds.h"

#include "core/base/errors.h"
#include "core/base/file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstring>

namespace lrsm {

static_assert(std::endian::native == std::endian::little, "texels are written as they lie in memory");

namespace {

struct FormatRow {
    DxgiFormat format;
    std::string_view name;
    std::size_t bytes;
    int channels;
};
constexpr std::array<FormatRow, 9> kFormats = {{{DxgiFormat::R32G32B32A32_FLOAT, "R32G32B32A32_FLOAT", 16, 4},
                                                {DxgiFormat::R16G16B16A16_FLOAT, "R16G16B16A16_FLOAT", 8, 4},
                                                {DxgiFormat::R16G16B16A16_UNORM, "R16G16B16A16_UNORM", 8, 4},
                                                {DxgiFormat::R8G8B8A8_UNORM, "R8G8B8A8_UNORM", 4, 4},
                                                {DxgiFormat::R32_FLOAT, "R32_FLOAT", 4, 1},
                                                {DxgiFormat::R32_UINT, "R32_UINT", 4, 1},
                                                {DxgiFormat::R16_FLOAT, "R16_FLOAT", 2, 1},
                                                {DxgiFormat::R16_UNORM, "R16_UNORM", 2, 1},
                                                {DxgiFormat::R8_UNORM, "R8_UNORM", 1, 1}}};

const FormatRow& rowOf(DxgiFormat format)
{
    return *std::find_if(kFormats.begin(), kFormats.end(), [&](const FormatRow& row) { return row.format == format; });
}

// The file: the magic, DDS_HEADER and DDS_HEADER_DXT10, all 32-bit words. Indices into them:
constexpr std::size_t kWords = 37;  // 1 + 31 + 5
static_assert(kWords * sizeof(std::uint32_t) == kDdsHeaderBytes);
constexpr std::size_t kLegacyHeaderBytes = 128;  // without DDS_HEADER_DXT10
enum Word : std::size_t {
    magic = 0,
    size = 1,
    flags = 2,
    height = 3,
    width = 4,
    pitch = 5,
    depth = 6,
    mipCount = 7,
    pixelFormatSize = 19,
    pixelFormatFlags = 20,
    fourCC = 21,
    bitCount = 22,
    masks = 23,  // red, green, blue, alpha
    caps = 27,
    caps2 = 28,
    dxgiFormat = 32,
    resourceDimension = 33,
    miscFlags = 34,
    arraySize = 35,
};
constexpr std::uint32_t kDdsMagic = 0x20534444, kHeaderSize = 124, kPixelFormatSize = 32, kFourCC = 0x4, kDx10 = 0x30315844;
constexpr std::uint32_t kFlags = 0x1 | 0x2 | 0x4 | 0x8 | 0x1000 | 0x20000;  // caps, height, width, pitch, pixel format, mip count
constexpr std::uint32_t kFlagDepth = 0x800000;
constexpr std::uint32_t kCapsTexture = 0x1000, kCapsComplex = 0x8, kCapsMipmap = 0x400000, kCaps2Volume = 0x200000;
constexpr std::uint32_t kCaps2Cube = 0x200, kCaps2Faces = 0xfc00, kMiscCube = 0x4;
constexpr std::uint32_t kDimension2D = 3, kDimension3D = 4;
constexpr std::uint32_t kLargestEdge = 16384, kMostLayers = 2048;

std::uint32_t largestMipCount(const DdsTexture& t)
{
    return static_cast<std::uint32_t>(std::bit_width(std::max({t.width, t.height, t.depth})));
}

bool within(std::uint32_t value, std::uint32_t most)
{
    return value >= 1 && value <= most;
}

}  // namespace

std::string_view nameOf(DxgiFormat format)
{
    return rowOf(format).name;
}

DxgiFormat dxgiFormatByName(std::string_view name, const std::string& place)
{
    for (const FormatRow& row : kFormats)
        if (row.name == name) return row.format;
    throw InputError(place, "\"" + std::string(name) + "\" is no texture format of captures");
}

std::size_t bytesPerTexel(DxgiFormat format)
{
    return rowOf(format).bytes;
}

int channelsOf(DxgiFormat format)
{
    return rowOf(format).channels;
}

std::size_t DdsTexture::levelBytes(std::uint32_t mip) const
{
    const auto extent = [mip](std::uint32_t n) { return std::size_t(std::max(1u, n >> mip)); };
    return extent(width) * extent(height) * extent(depth) * texelBytes();
}

std::size_t DdsTexture::layerBytes() const
{
    std::size_t bytes = 0;
    for (std::uint32_t mip = 0; mip < mips; ++mip) bytes += levelBytes(mip);
    return bytes;
}

std::span<std::byte> DdsTexture::level(std::uint32_t layer, std::uint32_t mip)
{
    std::size_t offset = layer * layerBytes();
    for (std::uint32_t l = 0; l < mip; ++l) offset += levelBytes(l);
    return std::span(texels).subspan(offset, levelBytes(mip));
}

std::span<const std::byte> DdsTexture::level(std::uint32_t layer, std::uint32_t mip) const
{
    return const_cast<DdsTexture&>(*this).level(layer, mip);
}

std::vector<std::byte> encodeDds(const DdsTexture& t)
{
    assert(t.texels.size() == t.byteSize() && !(t.volume && t.layers != 1));
    std::array<std::uint32_t, kWords> words{};
    words[magic] = kDdsMagic;
    words[size] = kHeaderSize;
    words[flags] = kFlags | (t.volume ? kFlagDepth : 0);
    words[height] = t.height;
    words[width] = t.width;
    words[pitch] = static_cast<std::uint32_t>(t.width * bytesPerTexel(t.format));
    words[depth] = t.volume ? t.depth : 0;
    words[mipCount] = t.mips;
    words[pixelFormatSize] = kPixelFormatSize;
    words[pixelFormatFlags] = kFourCC;
    words[fourCC] = kDx10;
    words[caps] = kCapsTexture | (t.mips > 1 || t.layers > 1 || t.volume ? kCapsComplex : 0) | (t.mips > 1 ? kCapsMipmap : 0);
    words[caps2] = t.volume ? kCaps2Volume : 0;
    words[dxgiFormat] = static_cast<std::uint32_t>(t.format);
    words[resourceDimension] = t.volume ? kDimension3D : kDimension2D;
    words[arraySize] = t.layers;

    std::vector<std::byte> file(sizeof words + t.texels.size());
    std::memcpy(file.data(), words.data(), sizeof words);
    if (!t.texels.empty()) std::memcpy(file.data() + sizeof words, t.texels.data(), t.texels.size());
    return file;
}

DdsTexture decodeDds(std::span<const std::byte> file, const std::string& place)
{
    const auto fail = [&](const std::string& why) -> InputError { return {place, why}; };
    std::array<std::uint32_t, kWords> words{};
    std::copy_n(file.begin(), std::min(file.size(), sizeof words), std::as_writable_bytes(std::span(words)).begin());
    if (words[magic] != kDdsMagic) throw fail("is no DDS file");
    if (words[size] != kHeaderSize || words[pixelFormatSize] != kPixelFormatSize) throw fail("is no readable DDS: its header has a wrong size");
    const bool dx10 = (words[pixelFormatFlags] & kFourCC) && words[fourCC] == kDx10;
    const std::size_t headerBytes = dx10 ? kDdsHeaderBytes : kLegacyHeaderBytes;
    if (file.size() < headerBytes) throw fail("is no readable DDS: it ends within its header");

    DdsTexture t;
    if (dx10) {
        t.layout = layoutOfDxgi(words[dxgiFormat], place);
        t.format = static_cast<DxgiFormat>(words[dxgiFormat]);
        if (words[resourceDimension] != kDimension2D && words[resourceDimension] != kDimension3D) throw fail("is neither a 2D texture nor a volume");
        t.volume = words[resourceDimension] == kDimension3D;
        t.layers = words[arraySize];
        if (words[miscFlags] & kMiscCube && t.layers <= kMostLayers) t.layers *= 6;
    } else {
        t.layout = layoutOfLegacy(
            {words[pixelFormatFlags], words[fourCC], words[bitCount], {words[masks], words[masks + 1], words[masks + 2], words[masks + 3]}}, place);
        t.volume = (words[caps2] & kCaps2Volume) != 0;
        t.layers = words[caps2] & kCaps2Cube ? static_cast<std::uint32_t>(std::popcount(words[caps2] & kCaps2Faces)) : 1;
    }
    t.width = words[width];
    t.height = words[height];
    t.depth = t.volume ? words[depth] : 1;
    t.mips = std::max(1u, words[mipCount]);
    if (!within(t.width, kLargestEdge) || !within(t.height, kLargestEdge) || !within(t.depth, kLargestEdge))
        throw fail("has an edge outside 1 .. " + std::to_string(kLargestEdge));
    if (!within(t.layers, t.volume ? 1 : kMostLayers)) throw fail("has " + std::to_string(t.layers) + " layers");
    if (t.mips > largestMipCount(t)) throw fail("has " + std::to_string(t.mips) + " mips, more than its size allows");
    if (file.size() - headerBytes != t.byteSize())
        throw fail("holds " + std::to_string(file.size() - headerBytes) + " bytes of texels where its header needs " + std::to_string(t.byteSize()) + " (" +
                   t.layout.name + ")");
    t.texels.assign(file.begin() + static_cast<std::ptrdiff_t>(headerBytes), file.end());
    return t;
}

DdsTexture readDds(const std::string& path)
{
    const std::vector<unsigned char> file = readFile(path);
    return decodeDds(std::as_bytes(std::span(file)), path);
}

}  // namespace lrsm
