#pragma once

#include "apps/capture/npy.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// What the texels of a DDS mean: the formats that are read, and the names of those that are not.
/// DXGI_FORMAT, "Resource Formats" (learn.microsoft.com/windows/win32/api/dxgiformat), D3D11.3 Functional Specification 3.2 and 19.
namespace lrsm {

/// What a channel's bits stand for.
enum class TexelCode {
    number,       ///< an IEEE float or an integer, by the dtype
    unorm,        ///< bits / (2^n - 1)
    unormSrgb,    ///< the same, and R, G, B are sRGB encoded
    snorm,        ///< max(-1, bits / (2^(n - 1) - 1))
    typeless,     ///< whatever a buffer of the golden is
    packedUnorm,  ///< unorm in the bits of `masks`, of one word
    packedUnormSrgb,
    packedUint,      ///< integers there
    float11,         ///< R11G11B10_FLOAT: unsigned floats with 5 bits of exponent
    sharedExponent,  ///< R9G9B9E5
    leadingFloat,    ///< a float32, then what is passed over: stencil
};

/// How a texel is to be read.
struct TexelLayout {
    std::string name;  ///< as DXGI calls it, or what a header without DXGI format says: "32-bit masks ..."
    TexelCode code = TexelCode::number;
    Dtype dtype = Dtype::u1;  ///< of a channel that is no part of a word
    std::size_t bytes = 1;    ///< of a texel
    int channels = 1;
    std::array<std::uint64_t, 4> masks = {};  ///< packed: of each channel, in the texel read as a little-endian number
};

/// Layout of a DXGI format. InputError "PLACE: is in NAME, which ...; what is read" for block-compressed, video and other formats.
TexelLayout layoutOfDxgi(std::uint32_t format, const std::string& place);

/// DDS_PIXELFORMAT of files without a DX10 header.
struct LegacyPixelFormat {
    std::uint32_t flags = 0, fourCC = 0, bits = 0;
    std::array<std::uint32_t, 4> masks = {};  ///< red, green, blue, alpha
};
TexelLayout layoutOfLegacy(const LegacyPixelFormat& format, const std::string& place);

/// As numbers: value / (2^n - 1) and so on, exactly, in double; channel by channel. For every code but number, unorm and typeless, whose bytes serve.
std::vector<double> decodedTexels(const TexelLayout& layout, std::span<const std::byte> texels);

}  // namespace lrsm
