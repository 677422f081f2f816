#include "apps/capture/buffer.h"

#include "core/base/errors.h"
#include "core/base/formats.h"
#include "core/base/text.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdlib>
#include <cstring>

namespace lrsm {

namespace {

constexpr std::array<std::string_view, 3> kEncodings = {"number", "unorm", "bits"};
constexpr std::string_view kMip = ".mip";
constexpr std::array<std::string_view, 4> kToleranceKinds = {"exact", "ulp", "absolute", "relative"};

template <class Enum, std::size_t n>
Enum byName(const std::array<std::string_view, n>& names, std::string_view name, const std::string& place)
{
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<Enum>(found - names.begin());
    throw InputError(place, "\"" + std::string(name) + "\" is none of " + joined(names));
}

/// A buffer's extents as a texture has them.
struct TextureShape {
    std::uint32_t layers = 1, depth = 1, height = 1, width = 1;
    std::size_t channels = 1;      ///< of the buffer
    std::size_t elementBytes = 1;  ///< of one channel in the texture
    std::size_t texels() const { return std::size_t(layers) * depth * height * width; }
};

TextureShape textureShapeOf(const Buffer& buffer)
{
    TextureShape shape;
    std::vector<std::size_t> extents = buffer.shape;
    if (buffer.encoding == Encoding::bits) {
        assert(extents.size() == 3);
        extents[2] = extents[0];  // a cube; the last axis counts bytes
    } else {
        shape.elementBytes = sizeOf(buffer.dtype);
    }
    if (!buffer.components.empty()) {
        shape.channels = extents.back();
        extents.pop_back();
    }
    const auto from = [&](std::size_t fromLast) { return extents.size() > fromLast ? static_cast<std::uint32_t>(extents[extents.size() - 1 - fromLast]) : 1u; };
    shape.width = from(0);
    shape.height = from(1);
    (buffer.dds->volume ? shape.depth : shape.layers) = from(2);
    return shape;
}

/// One level of one layer: the buffer's channels into the texture's, or back.
void copyTexels(const Buffer& buffer, const TextureShape& shape, std::uint32_t layer, std::span<std::byte> level)
{
    const std::size_t count = shape.texels() / shape.layers, toStride = bytesPerTexel(buffer.dds->format), fromStride = shape.channels * shape.elementBytes;
    const std::byte* from = buffer.bytes.data() + layer * count * fromStride;
    for (std::size_t i = 0; i < count; ++i) std::memcpy(level.data() + i * toStride, from + i * fromStride, fromStride);
}

void expandBits(const Buffer& buffer, const TextureShape& shape, std::span<std::byte> level)
{
    const std::size_t rowBytes = buffer.shape[2];
    for (std::size_t row = 0; row < std::size_t(shape.depth) * shape.height; ++row)
        for (std::size_t x = 0; x < shape.width; ++x) {
            const auto byte = static_cast<unsigned>(buffer.bytes[row * rowBytes + x / 8]);
            level[row * shape.width + x] = std::byte((byte >> (x & 7)) & 1u ? 255 : 0);
        }
}

}  // namespace

bool isMip(const std::string& name)
{
    return name.find(kMip) != std::string::npos;
}

int levelOf(const std::string& name)
{
    return isMip(name) ? std::atoi(name.c_str() + name.rfind(kMip) + kMip.size()) : 0;
}

std::string stemOf(const std::string& name)
{
    return name.substr(0, name.rfind(kMip));
}

std::string mipName(const std::string& stem, int level)
{
    return stem + std::string(kMip) + std::to_string(level);
}

std::string_view nameOf(Encoding encoding)
{
    return kEncodings[static_cast<std::size_t>(encoding)];
}

Encoding encodingByName(std::string_view name, const std::string& place)
{
    return byName<Encoding>(kEncodings, name, place);
}

std::string_view nameOf(Tolerance::Kind kind)
{
    return kToleranceKinds[static_cast<std::size_t>(kind)];
}

Tolerance::Kind toleranceKindByName(std::string_view name, const std::string& place)
{
    return byName<Tolerance::Kind>(kToleranceKinds, name, place);
}

std::size_t valueCount(const Buffer& buffer)
{
    return buffer.encoding == Encoding::bits ? buffer.bytes.size() * 8 : buffer.bytes.size() / sizeOf(buffer.dtype);
}

double decodedValue(const Buffer& buffer, std::size_t i)
{
    assert(i < valueCount(buffer));
    if (buffer.encoding == Encoding::bits) return (static_cast<unsigned>(buffer.bytes[i / 8]) >> (i & 7)) & 1u;
    const bool unorm = buffer.encoding == Encoding::unorm;
    switch (buffer.dtype) {
    case Dtype::u1: return double(buffer.as<std::uint8_t>()[i]) / (unorm ? 255.0 : 1.0);
    case Dtype::u2: return double(buffer.as<std::uint16_t>()[i]) / (unorm ? 65535.0 : 1.0);
    case Dtype::u4: return double(buffer.as<std::uint32_t>()[i]);
    case Dtype::u8: return static_cast<double>(buffer.as<std::uint64_t>()[i]);
    case Dtype::i4: return double(buffer.as<std::int32_t>()[i]);
    case Dtype::f2: return double(floatFromHalf(buffer.as<std::uint16_t>()[i]));
    case Dtype::f4: return double(buffer.as<float>()[i]);
    case Dtype::b1: return buffer.bytes[i] == std::byte{0} ? 0.0 : 1.0;
    case Dtype::i1: return double(buffer.as<std::int8_t>()[i]);
    case Dtype::i2: return double(buffer.as<std::int16_t>()[i]);
    case Dtype::i8: return static_cast<double>(buffer.as<std::int64_t>()[i]);
    case Dtype::f8: break;
    }
    return buffer.as<double>()[i];
}

std::vector<NamedTexture> texturesOf(const std::vector<Buffer>& buffers)
{
    std::vector<NamedTexture> textures;
    for (const Buffer& buffer : buffers) {
        if (!buffer.dds) continue;
        const auto known = std::find_if(textures.begin(), textures.end(), [&](const NamedTexture& t) { return t.file == buffer.dds->file; });
        if (known != textures.end()) {
            assert(buffer.dds->mip == known->texture.mips && buffer.dds->format == known->texture.format);
            ++known->texture.mips;
            continue;
        }
        assert(buffer.dds->mip == 0);
        const TextureShape shape = textureShapeOf(buffer);
        textures.push_back({buffer.dds->file, {buffer.dds->format, shape.width, shape.height, shape.depth, 1, shape.layers, buffer.dds->volume, {}}});
    }
    return textures;
}

void fillTexture(NamedTexture& named, const std::vector<Buffer>& buffers)
{
    DdsTexture& texture = named.texture;
    texture.texels.assign(texture.byteSize(), std::byte{0});
    for (const Buffer& buffer : buffers) {
        if (!buffer.dds || buffer.dds->file != named.file) continue;
        const TextureShape shape = textureShapeOf(buffer);
        for (std::uint32_t layer = 0; layer < shape.layers; ++layer) {
            if (buffer.encoding == Encoding::bits)
                expandBits(buffer, shape, texture.level(layer, buffer.dds->mip));
            else
                copyTexels(buffer, shape, layer, texture.level(layer, buffer.dds->mip));
        }
    }
}

}  // namespace lrsm
