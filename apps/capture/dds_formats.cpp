#include "apps/capture/dds_formats.h"

#include "core/base/elementary.h"
#include "core/base/errors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace lrsm {

namespace {

using Code = TexelCode;

struct ReadFormat {
    std::uint32_t number;
    std::string_view name;
    TexelCode code;
    Dtype dtype;
    std::size_t bytes;
    int channels;
    std::array<std::uint64_t, 4> masks = {};
};

constexpr std::array<std::uint64_t, 4> kBgra8 = {0xff0000, 0xff00, 0xff, 0xff000000}, kBgrx8 = {0xff0000, 0xff00, 0xff},
                                       kRgb10A2 = {0x3ff, 0xffc00, 0x3ff00000, 0xc0000000};

constexpr ReadFormat kRead[] = {
    {1, "R32G32B32A32_TYPELESS", Code::typeless, Dtype::u4, 16, 4},
    {2, "R32G32B32A32_FLOAT", Code::number, Dtype::f4, 16, 4},
    {3, "R32G32B32A32_UINT", Code::number, Dtype::u4, 16, 4},
    {4, "R32G32B32A32_SINT", Code::number, Dtype::i4, 16, 4},
    {5, "R32G32B32_TYPELESS", Code::typeless, Dtype::u4, 12, 3},
    {6, "R32G32B32_FLOAT", Code::number, Dtype::f4, 12, 3},
    {7, "R32G32B32_UINT", Code::number, Dtype::u4, 12, 3},
    {8, "R32G32B32_SINT", Code::number, Dtype::i4, 12, 3},
    {9, "R16G16B16A16_TYPELESS", Code::typeless, Dtype::u2, 8, 4},
    {10, "R16G16B16A16_FLOAT", Code::number, Dtype::f2, 8, 4},
    {11, "R16G16B16A16_UNORM", Code::unorm, Dtype::u2, 8, 4},
    {12, "R16G16B16A16_UINT", Code::number, Dtype::u2, 8, 4},
    {13, "R16G16B16A16_SNORM", Code::snorm, Dtype::i2, 8, 4},
    {14, "R16G16B16A16_SINT", Code::number, Dtype::i2, 8, 4},
    {15, "R32G32_TYPELESS", Code::typeless, Dtype::u4, 8, 2},
    {16, "R32G32_FLOAT", Code::number, Dtype::f4, 8, 2},
    {17, "R32G32_UINT", Code::number, Dtype::u4, 8, 2},
    {18, "R32G32_SINT", Code::number, Dtype::i4, 8, 2},
    {19, "R32G8X24_TYPELESS", Code::leadingFloat, Dtype::f4, 8, 1},
    {20, "D32_FLOAT_S8X24_UINT", Code::leadingFloat, Dtype::f4, 8, 1},
    {21, "R32_FLOAT_X8X24_TYPELESS", Code::leadingFloat, Dtype::f4, 8, 1},
    {23, "R10G10B10A2_TYPELESS", Code::packedUnorm, Dtype::u4, 4, 4, kRgb10A2},
    {24, "R10G10B10A2_UNORM", Code::packedUnorm, Dtype::u4, 4, 4, kRgb10A2},
    {25, "R10G10B10A2_UINT", Code::packedUint, Dtype::u4, 4, 4, kRgb10A2},
    {26, "R11G11B10_FLOAT", Code::float11, Dtype::u4, 4, 3},
    {27, "R8G8B8A8_TYPELESS", Code::typeless, Dtype::u1, 4, 4},
    {28, "R8G8B8A8_UNORM", Code::unorm, Dtype::u1, 4, 4},
    {29, "R8G8B8A8_UNORM_SRGB", Code::unormSrgb, Dtype::u1, 4, 4},
    {30, "R8G8B8A8_UINT", Code::number, Dtype::u1, 4, 4},
    {31, "R8G8B8A8_SNORM", Code::snorm, Dtype::i1, 4, 4},
    {32, "R8G8B8A8_SINT", Code::number, Dtype::i1, 4, 4},
    {33, "R16G16_TYPELESS", Code::typeless, Dtype::u2, 4, 2},
    {34, "R16G16_FLOAT", Code::number, Dtype::f2, 4, 2},
    {35, "R16G16_UNORM", Code::unorm, Dtype::u2, 4, 2},
    {36, "R16G16_UINT", Code::number, Dtype::u2, 4, 2},
    {37, "R16G16_SNORM", Code::snorm, Dtype::i2, 4, 2},
    {38, "R16G16_SINT", Code::number, Dtype::i2, 4, 2},
    {39, "R32_TYPELESS", Code::typeless, Dtype::u4, 4, 1},
    {40, "D32_FLOAT", Code::number, Dtype::f4, 4, 1},
    {41, "R32_FLOAT", Code::number, Dtype::f4, 4, 1},
    {42, "R32_UINT", Code::number, Dtype::u4, 4, 1},
    {43, "R32_SINT", Code::number, Dtype::i4, 4, 1},
    {44, "R24G8_TYPELESS", Code::packedUnorm, Dtype::u4, 4, 1, {0xffffff}},
    {45, "D24_UNORM_S8_UINT", Code::packedUnorm, Dtype::u4, 4, 1, {0xffffff}},
    {46, "R24_UNORM_X8_TYPELESS", Code::packedUnorm, Dtype::u4, 4, 1, {0xffffff}},
    {48, "R8G8_TYPELESS", Code::typeless, Dtype::u1, 2, 2},
    {49, "R8G8_UNORM", Code::unorm, Dtype::u1, 2, 2},
    {50, "R8G8_UINT", Code::number, Dtype::u1, 2, 2},
    {51, "R8G8_SNORM", Code::snorm, Dtype::i1, 2, 2},
    {52, "R8G8_SINT", Code::number, Dtype::i1, 2, 2},
    {53, "R16_TYPELESS", Code::typeless, Dtype::u2, 2, 1},
    {54, "R16_FLOAT", Code::number, Dtype::f2, 2, 1},
    {55, "D16_UNORM", Code::unorm, Dtype::u2, 2, 1},
    {56, "R16_UNORM", Code::unorm, Dtype::u2, 2, 1},
    {57, "R16_UINT", Code::number, Dtype::u2, 2, 1},
    {58, "R16_SNORM", Code::snorm, Dtype::i2, 2, 1},
    {59, "R16_SINT", Code::number, Dtype::i2, 2, 1},
    {60, "R8_TYPELESS", Code::typeless, Dtype::u1, 1, 1},
    {61, "R8_UNORM", Code::unorm, Dtype::u1, 1, 1},
    {62, "R8_UINT", Code::number, Dtype::u1, 1, 1},
    {63, "R8_SNORM", Code::snorm, Dtype::i1, 1, 1},
    {64, "R8_SINT", Code::number, Dtype::i1, 1, 1},
    {65, "A8_UNORM", Code::unorm, Dtype::u1, 1, 1},
    {67, "R9G9B9E5_SHAREDEXP", Code::sharedExponent, Dtype::u4, 4, 3},
    {85, "B5G6R5_UNORM", Code::packedUnorm, Dtype::u2, 2, 3, {0xf800, 0x7e0, 0x1f}},
    {86, "B5G5R5A1_UNORM", Code::packedUnorm, Dtype::u2, 2, 4, {0x7c00, 0x3e0, 0x1f, 0x8000}},
    {87, "B8G8R8A8_UNORM", Code::packedUnorm, Dtype::u4, 4, 4, kBgra8},
    {88, "B8G8R8X8_UNORM", Code::packedUnorm, Dtype::u4, 4, 3, kBgrx8},
    {90, "B8G8R8A8_TYPELESS", Code::packedUnorm, Dtype::u4, 4, 4, kBgra8},
    {91, "B8G8R8A8_UNORM_SRGB", Code::packedUnormSrgb, Dtype::u4, 4, 4, kBgra8},
    {92, "B8G8R8X8_TYPELESS", Code::packedUnorm, Dtype::u4, 4, 3, kBgrx8},
    {93, "B8G8R8X8_UNORM_SRGB", Code::packedUnormSrgb, Dtype::u4, 4, 3, kBgrx8},
    {115, "B4G4R4A4_UNORM", Code::packedUnorm, Dtype::u2, 2, 4, {0xf00, 0xf0, 0xf, 0xf000}},
};

struct NamedFormat {
    std::uint32_t number;
    std::string_view name;
};
constexpr NamedFormat kNotRead[] = {{22, "X32_TYPELESS_G8X24_UINT"},
                                    {47, "X24_TYPELESS_G8_UINT"},
                                    {66, "R1_UNORM"},
                                    {68, "R8G8_B8G8_UNORM"},
                                    {69, "G8R8_G8B8_UNORM"},
                                    {70, "BC1_TYPELESS"},
                                    {71, "BC1_UNORM"},
                                    {72, "BC1_UNORM_SRGB"},
                                    {73, "BC2_TYPELESS"},
                                    {74, "BC2_UNORM"},
                                    {75, "BC2_UNORM_SRGB"},
                                    {76, "BC3_TYPELESS"},
                                    {77, "BC3_UNORM"},
                                    {78, "BC3_UNORM_SRGB"},
                                    {79, "BC4_TYPELESS"},
                                    {80, "BC4_UNORM"},
                                    {81, "BC4_SNORM"},
                                    {82, "BC5_TYPELESS"},
                                    {83, "BC5_UNORM"},
                                    {84, "BC5_SNORM"},
                                    {89, "R10G10B10_XR_BIAS_A2_UNORM"},
                                    {94, "BC6H_TYPELESS"},
                                    {95, "BC6H_UF16"},
                                    {96, "BC6H_SF16"},
                                    {97, "BC7_TYPELESS"},
                                    {98, "BC7_UNORM"},
                                    {99, "BC7_UNORM_SRGB"},
                                    {100, "AYUV"},
                                    {101, "Y410"},
                                    {102, "Y416"},
                                    {103, "NV12"},
                                    {104, "P010"},
                                    {105, "P016"},
                                    {106, "420_OPAQUE"},
                                    {107, "YUY2"},
                                    {108, "Y210"},
                                    {109, "Y216"},
                                    {110, "NV11"},
                                    {111, "AI44"},
                                    {112, "IA44"},
                                    {113, "P8"},
                                    {114, "A8P8"}};

/// Codes that D3D9 wrote in the place of four letters (D3DFORMAT), and the DXGI format of each.
struct LegacyCode {
    std::uint32_t fourCC, format;
};
constexpr LegacyCode kLegacyCodes[] = {{36, 11}, {110, 13}, {111, 54}, {112, 34}, {113, 10}, {114, 41}, {115, 16}, {116, 2}};

struct LegacyName {
    std::string_view letters, meaning;
};
constexpr LegacyName kLegacyNames[] = {{"DXT1", "BC1_UNORM"}, {"DXT2", "BC2_UNORM"},       {"DXT3", "BC2_UNORM"},      {"DXT4", "BC3_UNORM"},
                                       {"DXT5", "BC3_UNORM"}, {"ATI1", "BC4_UNORM"},       {"BC4U", "BC4_UNORM"},      {"BC4S", "BC4_SNORM"},
                                       {"ATI2", "BC5_UNORM"}, {"BC5U", "BC5_UNORM"},       {"BC5S", "BC5_SNORM"},      {"UYVY", "video"},
                                       {"YUY2", "video"},     {"RGBG", "R8G8_B8G8_UNORM"}, {"GRGB", "G8R8_G8B8_UNORM"}};

namespace LegacyFlag {
enum : std::uint32_t { alphaPixels = 0x1, alphaOnly = 0x2, hasFourCC = 0x4, rgbMasks = 0x40, luminance = 0x20000 };
}  // namespace LegacyFlag

[[noreturn]] void refuseFormat(const std::string& place, std::string name)
{
    if (name.starts_with("BC")) name += ", which is compressed in blocks: its values are no longer those of the pass";
    throw InputError(place,
                     "is in " + name +
                         "; what is read is R8, R16, R32 with 1 to 4 channels (FLOAT, UNORM, SNORM, UINT, SINT, TYPELESS), R8G8B8A8_UNORM_SRGB, D16, D24, "
                         "D32, R10G10B10A2, R11G11B10_FLOAT, R9G9B9E5, B5G6R5, B5G5R5A1, B4G4R4A4, B8G8R8A8, B8G8R8X8, and D3D9 headers with masks: save "
                         "one of these");
}

double linearFromSrgb(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : power((encoded + 0.055) / 1.055, 2.4);
}

/// Exponent of 5 bits, bias 15, no sign: the low bits are the mantissa.
double smallFloat(std::uint64_t bits, int mantissaBits)
{
    const std::uint64_t exponent = bits >> mantissaBits;
    const double mantissa = std::ldexp(static_cast<double>(bits & ((std::uint64_t(1) << mantissaBits) - 1)), -mantissaBits);
    if (exponent == 31) return mantissa == 0.0 ? HUGE_VAL : std::nan("");
    return exponent == 0 ? std::ldexp(mantissa, -14) : std::ldexp(1.0 + mantissa, static_cast<int>(exponent) - 15);
}

/// A channel of a texel that is one word.
double channelOfWord(const TexelLayout& layout, std::uint64_t word, std::size_t channel)
{
    if (layout.code == Code::float11) return channel < 2 ? smallFloat(word >> (11 * channel) & 0x7ff, 6) : smallFloat(word >> 22, 5);
    if (layout.code == Code::sharedExponent) return std::ldexp(static_cast<double>(word >> (9 * channel) & 0x1ff), static_cast<int>(word >> 27) - 15 - 9);
    const std::uint64_t mask = layout.masks[channel];
    const auto code = static_cast<double>((word & mask) >> std::countr_zero(mask));
    if (layout.code == Code::packedUint) return code;
    const double value = code / static_cast<double>(mask >> std::countr_zero(mask));
    return layout.code == Code::packedUnormSrgb && channel < 3 ? linearFromSrgb(value) : value;
}

}  // namespace

TexelLayout layoutOfDxgi(std::uint32_t format, const std::string& place)
{
    for (const ReadFormat& row : kRead)
        if (row.number == format) return {std::string(row.name), row.code, row.dtype, row.bytes, row.channels, row.masks};
    for (const NamedFormat& named : kNotRead)
        if (named.number == format) refuseFormat(place, std::string(named.name));
    refuseFormat(place, "DXGI format " + std::to_string(format));
}

TexelLayout layoutOfLegacy(const LegacyPixelFormat& format, const std::string& place)
{
    if (format.flags & LegacyFlag::hasFourCC) {
        for (const LegacyCode& known : kLegacyCodes)
            if (known.fourCC == format.fourCC) return layoutOfDxgi(known.format, place);
        std::string letters(4, ' ');
        std::memcpy(letters.data(), &format.fourCC, 4);
        for (const LegacyName& known : kLegacyNames)
            if (known.letters == letters) refuseFormat(place, std::string(known.meaning) + " (\"" + letters + "\")");
        const bool readable = std::all_of(letters.begin(), letters.end(), [](char c) { return c > ' ' && c < 127; });
        refuseFormat(place, "D3D9 format " + (readable ? "\"" + letters + "\"" : std::to_string(format.fourCC)));
    }
    TexelLayout layout;
    layout.code = Code::packedUnorm;
    layout.bytes = format.bits / 8;
    layout.channels = 0;
    const std::size_t colors = format.flags & LegacyFlag::rgbMasks ? 3 : format.flags & LegacyFlag::luminance ? 1 : 0;
    std::string text = std::to_string(format.bits) + "-bit masks";
    for (std::size_t c = 0; c < 4; ++c) {
        const bool used = c < colors || (c == 3 && format.flags & (LegacyFlag::alphaPixels | LegacyFlag::alphaOnly));
        // A file of red alone leaves green and blue empty.
        if (!used || format.masks[c] == 0) continue;
        const std::uint32_t run = format.masks[c] >> std::countr_zero(format.masks[c]);
        if ((run & (run + 1)) != 0 || (format.bits < 32 && format.masks[c] >> format.bits != 0))
            refuseFormat(place, "a format whose masks are no runs of bits");
        layout.masks[static_cast<std::size_t>(layout.channels++)] = format.masks[c];
    }
    if (layout.channels == 0 || format.bits % 8 != 0 || format.bits < 8 || format.bits > 32)
        refuseFormat(place, "a D3D9 format of " + std::to_string(format.bits) + " bits with flags " + std::to_string(format.flags));
    layout.name = text;
    return layout;
}

std::vector<double> decodedTexels(const TexelLayout& layout, std::span<const std::byte> texels)
{
    const std::size_t count = texels.size() / layout.bytes, channels = static_cast<std::size_t>(layout.channels);
    const std::size_t channelBytes = layout.bytes / channels;
    std::vector<double> values;
    values.reserve(count * channels);
    for (std::size_t i = 0; i < count; ++i) {
        const std::byte* texel = texels.data() + i * layout.bytes;
        std::uint64_t word = 0;
        for (std::size_t b = std::min<std::size_t>(layout.bytes, 8); b-- > 0;) word = word << 8 | std::to_integer<std::uint64_t>(texel[b]);
        for (std::size_t c = 0; c < channels; ++c) {
            if (layout.code == Code::leadingFloat) {
                values.push_back(double(std::bit_cast<float>(static_cast<std::uint32_t>(word))));
            } else if (layout.code == Code::snorm) {
                const double most = channelBytes == 1 ? 127.0 : 32767.0;
                const auto code = channelBytes == 1 ? double(static_cast<std::int8_t>(word >> (8 * c))) : double(static_cast<std::int16_t>(word >> (16 * c)));
                values.push_back(std::max(-1.0, code / most));
            } else if (layout.code == Code::unormSrgb) {
                const double value = double(word >> (8 * c) & 0xff) / 255.0;
                values.push_back(c < 3 ? linearFromSrgb(value) : value);
            } else {
                values.push_back(channelOfWord(layout, word, c));
            }
        }
    }
    return values;
}

}  // namespace lrsm
