#pragma once

#include "apps/capture/dds_formats.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Microsoft's texture container with the DX10 header: arrays, mips and volumes in the GPU's own formats, as RenderDoc and the D3D and Vulkan
/// loaders open them. "Programming Guide for DDS", learn.microsoft.com/windows/win32/direct3ddds.
namespace lrsm {

/// What captures are written in. The values are DXGI_FORMAT's.
enum class DxgiFormat : std::uint32_t {
    R32G32B32A32_FLOAT = 2,
    R16G16B16A16_FLOAT = 10,
    R16G16B16A16_UNORM = 11,
    R8G8B8A8_UNORM = 28,
    R32_FLOAT = 41,
    R32_UINT = 42,
    R16_FLOAT = 54,
    R16_UNORM = 56,
    R8_UNORM = 61,
};
std::string_view nameOf(DxgiFormat format);
/// InputError that begins with `place` for any other.
DxgiFormat dxgiFormatByName(std::string_view name, const std::string& place);
std::size_t bytesPerTexel(DxgiFormat format);
int channelsOf(DxgiFormat format);

/// A 2D texture, an array of them, or a volume, with its mips. Level l is max(1, width >> l) wide, and so on. Tightly packed; row 0 first.
struct DdsTexture {
    DxgiFormat format = DxgiFormat::R8_UNORM;
    std::uint32_t width = 1, height = 1;
    std::uint32_t depth = 1;  ///< slices of level 0; a volume has one layer
    std::uint32_t mips = 1;
    std::uint32_t layers = 1;
    bool volume = false;            ///< also when depth is 1
    std::vector<std::byte> texels;  ///< layer by layer, each with all its mips, largest first
    TexelLayout layout = {};        ///< of a texture that was read, in whatever format; no name: `format` says all

    std::size_t texelBytes() const { return layout.name.empty() ? bytesPerTexel(format) : layout.bytes; }
    std::size_t levelBytes(std::uint32_t mip) const;
    std::size_t layerBytes() const;
    std::size_t byteSize() const { return layerBytes() * layers; }
    std::span<std::byte> level(std::uint32_t layer, std::uint32_t mip);
    std::span<const std::byte> level(std::uint32_t layer, std::uint32_t mip) const;
};

inline constexpr std::size_t kDdsHeaderBytes = 148;
/// `texels` must be byteSize() long.
std::vector<std::byte> encodeDds(const DdsTexture& texture);

/// A DX10 header or D3D9's, a format of dds_formats.h, a size that fits the file exactly; the faces of cubes are layers. InputError
/// "PLACE: why; what to do" for anything else.
DdsTexture decodeDds(std::span<const std::byte> file, const std::string& place);
DdsTexture readDds(const std::string& path);

}  // namespace lrsm
