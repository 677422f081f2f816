#include "apps/check/given_arrays.h"

#include <algorithm>
#include <cstring>

namespace lrsm {

namespace {

/// What a typeless format is taken for: the golden's own type where the width is the same, else float, but for 8 bits, which have none.
void takeTypeless(const Buffer& golden, GivenArray& given)
{
    const std::size_t bytes = sizeOf(given.dtype);
    if (bytes == sizeOf(golden.dtype) && golden.encoding != Encoding::bits) {
        given.dtype = golden.dtype;
        given.encoding = golden.encoding;
    } else if (bytes == 1) {
        given.encoding = Encoding::unorm;
    } else {
        given.dtype = bytes == 2 ? Dtype::f2 : golden.dtype == Dtype::u4 ? Dtype::u4 : Dtype::f4;
    }
    given.note = std::string("typeless, taken as ") + std::string(nameOf(given.dtype)) + (given.encoding == Encoding::unorm ? " unorm" : "");
}

}  // namespace

GivenArray fromNpy(NpyArray array)
{
    return {.dtype = array.dtype, .encoding = Encoding::number, .encodingKnown = false, .shape = std::move(array.shape), .bytes = std::move(array.bytes)};
}

GivenArray fromTexture(const Buffer& golden, const DdsTexture& texture, std::uint32_t mip)
{
    const auto extent = [&](std::uint32_t n) { return std::size_t(std::max(1u, n >> mip)); };
    const TexelLayout& layout = texture.layout;
    GivenArray given;
    given.dtype = layout.dtype;
    given.encoding = layout.code == TexelCode::unorm ? Encoding::unorm : Encoding::number;
    // Integers are what the golden's integers are: numbers, or codes of UNORM.
    given.encodingKnown = layout.code != TexelCode::number || isFloat(layout.dtype);
    given.shape = {texture.layers, extent(texture.depth), extent(texture.height), extent(texture.width), std::size_t(layout.channels)};
    for (std::uint32_t layer = 0; layer < texture.layers; ++layer) {
        const auto level = texture.level(layer, mip);
        given.bytes.insert(given.bytes.end(), level.begin(), level.end());
    }
    if (layout.code == TexelCode::typeless) takeTypeless(golden, given);
    if (layout.code == TexelCode::number || layout.code == TexelCode::unorm || layout.code == TexelCode::typeless) return given;
    const std::vector<double> values = decodedTexels(layout, given.bytes);
    given.dtype = Dtype::f8;
    given.bytes.resize(values.size() * sizeof(double));
    if (!values.empty()) std::memcpy(given.bytes.data(), values.data(), given.bytes.size());
    given.note = layout.name + " in the file";
    return given;
}

GivenArray fromLayer(const LayeredImage& image, const ImageLayer& layer)
{
    const std::size_t channels = layer.channelNames.size(), pixels = channels ? layer.values.size() / channels : 0;
    GivenArray given;
    given.shape = {std::size_t(image.height), std::size_t(image.width), channels};
    const auto take = [&](Dtype dtype, const void* data, std::size_t bytes) {
        given.dtype = dtype;
        given.bytes.resize(bytes);
        if (bytes) std::memcpy(given.bytes.data(), data, bytes);
    };
    take(Dtype::f4, layer.values.data(), layer.values.size() * sizeof(float));
    if (layer.integers.empty()) return given;
    // Whole numbers as they are; beside floats in doubles, which hold both.
    std::vector<std::uint32_t> whole(layer.values.size());
    std::vector<double> mixed(layer.values.begin(), layer.values.end());
    for (const ImageLayer::Integers& channel : layer.integers)
        for (std::size_t i = 0; i < pixels; ++i) mixed[i * channels + channel.channel] = whole[i * channels + channel.channel] = channel.values[i];
    if (layer.integers.size() == channels)
        take(Dtype::u4, whole.data(), whole.size() * sizeof(std::uint32_t));
    else
        take(Dtype::f8, mixed.data(), mixed.size() * sizeof(double));
    return given;
}

ImageLayer channelOf(const ImageLayer& layer, std::size_t channel)
{
    const std::size_t channels = layer.channelNames.size();
    ImageLayer single;
    single.channelNames = {layer.channelNames[channel]};
    for (std::size_t i = channel; i < layer.values.size(); i += channels) single.values.push_back(layer.values[i]);
    for (const ImageLayer::Integers& integers : layer.integers)
        if (integers.channel == channel) single.integers.push_back({0, integers.values});
    return single;
}

}  // namespace lrsm
