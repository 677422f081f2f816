#include "core/imageio/image_io.h"

#include "core/base/elementary.h"
#include "core/base/errors.h"
#include "core/base/formats.h"
#include "core/base/text.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <algorithm>
#include <cassert>
#include <filesystem>

namespace lrsm {

namespace {

constexpr std::int64_t kMaxPixels = std::int64_t(1) << 28;

/// OpenImageIO's messages may hold several lines; ours are one.
std::string oneLine(std::string text)
{
    while (!text.empty() && text.back() == '\n') text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.empty() ? "unknown reason" : text;
}

std::vector<std::byte> encode(const std::string& format, const OIIO::ImageSpec& spec, OIIO::TypeDesc type, const void* pixels)
{
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const auto output = OIIO::ImageOutput::create("memory." + format);
    if (!output) throw MachineError("writing " + format, oneLine(OIIO::geterror()));
    output->set_ioproxy(&memory);
    if (!output->open("memory." + format, spec) || !output->write_image(type, pixels) || !output->close())
        throw MachineError("writing " + format, oneLine(output->geterror()));
    const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
    return {first, first + bytes.size()};
}

void takeSize(LayeredImage& image, int width, int height)
{
    if (image.layers.empty()) image.width = width, image.height = height;
    assert(image.width == width && image.height == height);
}

const ImageLayer& need(const LayeredImage& image, const std::string& name, const std::string& place)
{
    if (const ImageLayer* layer = image.find(name)) return *layer;
    const auto nameOf = [](const ImageLayer& layer) { return layer.name.empty() ? "(unnamed)" : layer.name; };
    throw InputError(place, "has no layer \"" + name + "\"; it has " + joined(image.layers, nameOf));
}

/// "indirect.diffuse.R" belongs to the layer "indirect.diffuse".
std::pair<std::string, std::string> splitChannel(const std::string& name)
{
    const std::size_t dot = name.rfind('.');
    return dot == std::string::npos ? std::pair(std::string(), name) : std::pair(name.substr(0, dot), name.substr(dot + 1));
}

float linearFromSrgb(float encoded)
{
    if (encoded <= 0.04045f) return encoded / 12.92f;
    return static_cast<float>(power((double(encoded) + 0.055) / 1.055, 2.4));
}

/// Integer files hold sRGB codes; alpha is linear, and float files already are.
void decodeSrgb(ImageLayer& layer)
{
    const std::size_t channels = layer.channelNames.size();
    for (std::size_t i = 0; i < layer.values.size(); ++i)
        if (layer.channelNames[i % channels] != "A") layer.values[i] = linearFromSrgb(layer.values[i]);
}

LayeredImage splitIntoLayers(const OIIO::ImageSpec& spec, const std::vector<float>& pixels)
{
    LayeredImage image;
    image.width = spec.width;
    image.height = spec.height;
    std::vector<std::vector<std::size_t>> sources;  // of each layer: its channels in the file
    for (std::size_t c = 0; c < spec.channelnames.size(); ++c) {
        const auto names = splitChannel(spec.channelnames[c]);
        auto layer = std::find_if(image.layers.begin(), image.layers.end(), [&](const ImageLayer& l) { return l.name == names.first; });
        if (layer == image.layers.end()) {
            image.layers.push_back({names.first, {}, {}});
            sources.emplace_back();
            layer = image.layers.end() - 1;
        }
        layer->channelNames.push_back(names.second);
        sources[static_cast<std::size_t>(layer - image.layers.begin())].push_back(c);
    }
    const std::size_t all = spec.channelnames.size(), count = pixels.size() / all;
    for (std::size_t l = 0; l < image.layers.size(); ++l) {
        image.layers[l].values.reserve(count * sources[l].size());
        for (std::size_t i = 0; i < count; ++i)
            for (const std::size_t c : sources[l]) image.layers[l].values.push_back(pixels[i * all + c]);
    }
    return image;
}

}  // namespace

const ImageLayer* LayeredImage::find(const std::string& name) const
{
    for (const ImageLayer& layer : layers)
        if (layer.name == name) return &layer;
    return nullptr;
}

void addLayer(LayeredImage& image, const std::string& name, const Image<Vec3>& picture)
{
    takeSize(image, picture.width, picture.height);
    ImageLayer layer{name, {"R", "G", "B"}, {}};
    layer.values.reserve(picture.texels.size() * 3);
    for (const Vec3& color : picture.texels) layer.values.insert(layer.values.end(), {color.x, color.y, color.z});
    image.layers.push_back(std::move(layer));
}

void addLayer(LayeredImage& image, const std::string& name, const Image<float>& picture, const std::string& channel)
{
    takeSize(image, picture.width, picture.height);
    image.layers.push_back({name, {channel}, picture.texels});
}

Image<Vec3> rgbLayer(const LayeredImage& image, const std::string& name, const std::string& place)
{
    const ImageLayer& layer = need(image, name, place);
    const std::size_t channels = layer.channelNames.size();
    std::size_t source[3] = {0, 0, 0};  // one channel (or two) is grey
    if (channels >= 3)
        for (std::size_t c = 0; c < 3; ++c) {
            const auto found = std::find(layer.channelNames.begin(), layer.channelNames.end(), std::string(1, "RGB"[c]));
            source[c] = found == layer.channelNames.end() ? c : static_cast<std::size_t>(found - layer.channelNames.begin());
        }
    Image<Vec3> picture(image.width, image.height);
    for (std::size_t i = 0; i < picture.texels.size(); ++i) {
        const float* values = layer.values.data() + i * channels;
        picture.texels[i] = Vec3(values[source[0]], values[source[1]], values[source[2]]);
    }
    return picture;
}

Image<float> scalarLayer(const LayeredImage& image, const std::string& name, const std::string& place)
{
    const ImageLayer& layer = need(image, name, place);
    Image<float> picture(image.width, image.height);
    for (std::size_t i = 0; i < picture.texels.size(); ++i) picture.texels[i] = layer.values[i * layer.channelNames.size()];
    return picture;
}

std::vector<std::byte> encodeExr(const LayeredImage& image)
{
    OIIO::ImageSpec spec(image.width, image.height, 0, OIIO::TypeFloat);
    spec.channelnames.clear();
    for (const ImageLayer& layer : image.layers)
        for (const std::string& channel : layer.channelNames) spec.channelnames.push_back(layer.name.empty() ? channel : layer.name + "." + channel);
    spec.nchannels = static_cast<int>(spec.channelnames.size());
    spec.attribute("compression", "zip");
    spec.attribute("DateTime", "1970:01:01 00:00:00");  // otherwise the library writes the time of day
    for (const auto& [key, value] : image.metadata) spec.attribute(key, value);

    std::vector<float> pixels(std::size_t(image.width) * std::size_t(image.height) * std::size_t(spec.nchannels));
    std::size_t firstChannel = 0;
    for (const ImageLayer& layer : image.layers) {
        const std::size_t channels = layer.channelNames.size();
        for (std::size_t i = 0; i < layer.values.size(); ++i)
            pixels[(i / channels) * std::size_t(spec.nchannels) + firstChannel + i % channels] = layer.values[i];
        firstChannel += channels;
    }
    return encode("exr", spec, OIIO::TypeFloat, pixels.data());
}

std::vector<std::byte> encodePng(const Image<Rgb8>& picture)
{
    static_assert(sizeof(Rgb8) == 3);
    OIIO::ImageSpec spec(picture.width, picture.height, 3, OIIO::TypeUInt8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    return encode("png", spec, OIIO::TypeUInt8, picture.texels.data());
}

LayeredImage readImage(const std::string& path)
{
    std::error_code ignored;
    if (path.empty()) throw InputError("picture", "the path is empty");
    if (std::filesystem::is_directory(path, ignored)) throw InputError(path, "is a folder, not a picture");
    if (!std::filesystem::exists(path, ignored)) throw InputError(path, "there is no such file");

    const auto input = OIIO::ImageInput::open(path);
    if (!input) throw InputError(path, "is not a picture that can be read: " + oneLine(OIIO::geterror()));
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || spec.depth > 1) throw InputError(path, "is not a flat picture");
    if (std::int64_t(spec.width) * spec.height > kMaxPixels) throw InputError(path, "is larger than 2^28 pixels");
    if (spec.deep) throw InputError(path, "is a deep picture, which is not supported");

    std::vector<float> pixels(std::size_t(spec.width) * std::size_t(spec.height) * std::size_t(spec.nchannels));
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, pixels.data())) throw InputError(path, "cannot be read: " + oneLine(input->geterror()));

    LayeredImage image = splitIntoLayers(spec, pixels);
    if (!spec.format.is_floating_point())
        for (ImageLayer& layer : image.layers) decodeSrgb(layer);
    for (const OIIO::ParamValue& attribute : spec.extra_attribs)
        if (attribute.name().string().starts_with("lrsm:") && attribute.type() == OIIO::TypeString)
            image.metadata.emplace_back(attribute.name().string(), attribute.get_string());
    return image;
}

}  // namespace lrsm
