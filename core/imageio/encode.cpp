#include "core/base/errors.h"
#include "core/imageio/image_io.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <png.h>
#include <algorithm>
#include <cassert>

namespace lrsm {

namespace {

/// OpenEXR's idea of a file: bytes in memory.
class MemoryFile : public Imf::OStream {
  public:
    explicit MemoryFile(std::vector<std::byte>& bytes) : Imf::OStream("memory"), bytes_(bytes) {}
    void write(const char* data, int size) override
    {
        const auto* first = reinterpret_cast<const std::byte*>(data);
        const std::size_t inside = std::min(std::size_t(size), bytes_.size() - position_);
        std::copy_n(first, inside, bytes_.data() + position_);
        bytes_.insert(bytes_.end(), first + inside, first + size);
        position_ += std::size_t(size);
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = position; }

  private:
    std::vector<std::byte>& bytes_;
    std::size_t position_ = 0;
};

}  // namespace

std::vector<std::byte> encodeExr(const LayeredImage& image)
{
    Imf::Header header(image.width, image.height);
    // 29 float channels of 1280x720: a third of the time of zip, for 1.4 times the bytes.
    header.compression() = Imf::RLE_COMPRESSION;
    for (const auto& [key, value] : image.metadata) header.insert(key, Imf::StringAttribute(value));

    Imf::FrameBuffer pixels;
    std::size_t bytesRaw = 0;
    for (const ImageLayer& layer : image.layers) {
        const std::size_t stride = layer.channelNames.size() * sizeof(float);
        assert(layer.values.size() * sizeof(float) == stride * std::size_t(image.width) * std::size_t(image.height));
        for (std::size_t c = 0; c < layer.channelNames.size(); ++c) {
            const std::string name = layer.name.empty() ? layer.channelNames[c] : layer.name + "." + layer.channelNames[c];
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            auto* const first = const_cast<char*>(reinterpret_cast<const char*>(layer.values.data() + c));  // only read, whatever the library's type says
            pixels.insert(name, Imf::Slice(Imf::FLOAT, first, stride, stride * std::size_t(image.width)));
        }
        bytesRaw += layer.values.size() * sizeof(float);
    }

    std::vector<std::byte> bytes;
    bytes.reserve(bytesRaw);  // never grown: what is not written is no memory
    try {
        MemoryFile file(bytes);
        constexpr int kCallersThread = 0;
        Imf::OutputFile output(file, header, kCallersThread);
        output.setFrameBuffer(pixels);
        output.writePixels(image.height);
    } catch (const Iex::BaseExc& error) {
        throw MachineError("writing EXR", error.what());
    }
    return bytes;
}

std::vector<std::byte> encodePng(const Image<Rgb8>& picture)
{
    static_assert(sizeof(Rgb8) == 3);
    png_image header = {};
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(picture.width);
    header.height = static_cast<png_uint_32>(picture.height);
    header.format = PNG_FORMAT_RGB;      // 8 bits: sRGB codes
    header.flags = PNG_IMAGE_FLAG_FAST;  // a quarter of the time for 1.3 times the bytes
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
    std::vector<std::byte> bytes(size);
    if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, picture.texels.data(), 0, nullptr)) throw MachineError("writing PNG", header.message);
    bytes.resize(size);
    return bytes;
}

}  // namespace lrsm
