#include "core/imageio/image_io.h"

#include "core/base/elementary.h"
#include "core/base/errors.h"
#include "core/base/formats.h"
#include "core/base/text.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <filesystem>

namespace lrsm {

namespace {

/// Otherwise OpenEXR starts as many threads as there are processors, whatever --threads and the system say.
void useCallersThread()
{
    OIIO::attribute("exr_threads", -1);
}

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

/// The library multiplies by 1 / (2^n - 1): the quotient, correctly rounded.
void restoreCodes(ImageLayer& layer, OIIO::TypeDesc format)
{
    const float most = format.size() == 1 ? 255.0f : 65535.0f;
    for (float& value : layer.values) value = std::floor(value * most + 0.5f) / most;
}

/// A part's channels, interleaved, over the picture's rectangle.
struct PartPixels {
    std::vector<float> floats;
    std::vector<std::pair<std::size_t, std::vector<std::uint32_t>>> integers;  ///< by channel
};

/// Data in their own window to the display window's rectangle, which begins at (full_x, full_y).
template <class T>
std::vector<T> placed(const std::vector<T>& data, const OIIO::ImageSpec& spec, std::size_t channels)
{
    if (spec.x == spec.full_x && spec.y == spec.full_y && spec.width == spec.full_width && spec.height == spec.full_height) return data;
    std::vector<T> picture(std::size_t(spec.full_width) * std::size_t(spec.full_height) * channels);
    const std::int64_t left = std::int64_t(spec.x) - spec.full_x, top = std::int64_t(spec.y) - spec.full_y;
    const std::int64_t x0 = std::max<std::int64_t>(left, 0), x1 = std::min<std::int64_t>(left + spec.width, spec.full_width);
    for (std::int64_t y = std::max<std::int64_t>(top, 0); y < std::min<std::int64_t>(top + spec.height, spec.full_height) && x0 < x1; ++y)
        std::copy_n(data.begin() + ((y - top) * spec.width + x0 - left) * std::int64_t(channels), (x1 - x0) * std::int64_t(channels),
                    picture.begin() + (y * spec.full_width + x0) * std::int64_t(channels));
    return picture;
}

std::string windowText(int x, int y, int width, int height)
{
    return std::to_string(width) + "x" + std::to_string(height) + " at (" + std::to_string(x) + ", " + std::to_string(y) + ")";
}

void noteWindows(const OIIO::ImageSpec& spec, std::vector<std::string>& notes)
{
    const bool over = spec.x < spec.full_x || spec.y < spec.full_y || spec.x + spec.width > spec.full_x + spec.full_width ||
                      spec.y + spec.height > spec.full_y + spec.full_height;
    const bool under = spec.x > spec.full_x || spec.y > spec.full_y || spec.x + spec.width < spec.full_x + spec.full_width ||
                       spec.y + spec.height < spec.full_y + spec.full_height;
    if (!over && !under) return;
    const std::string note = "its data window is " + windowText(spec.x, spec.y, spec.width, spec.height) + ", its display window " +
                             windowText(spec.full_x, spec.full_y, spec.full_width, spec.full_height) + ": " + (over ? "what lies outside is cropped" : "") +
                             (over && under ? ", " : "") + (under ? "what is missing is black" : "");
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
}

OIIO::TypeDesc formatOf(const OIIO::ImageSpec& spec, std::size_t channel)
{
    return spec.channelformats.empty() ? spec.format : spec.channelformats[channel];
}

void checkSize(std::int64_t width, std::int64_t height, const std::string& path)
{
    if (width > kMaxPixels || width * height > kMaxPixels) throw InputError(path, "is larger than 2^28 pixels");
}

PartPixels readPart(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, int part, const std::string& path)
{
    const auto read = [&](int first, int end, OIIO::TypeDesc type, void* pixels) {
        if (!input.read_image(part, 0, first, end, type, pixels)) throw InputError(path, "cannot be read: " + oneLine(input.geterror()));
    };
    const std::size_t count = std::size_t(spec.width) * std::size_t(spec.height), channels = std::size_t(spec.nchannels);
    PartPixels pixels;
    pixels.floats.resize(count * channels);
    read(0, spec.nchannels, OIIO::TypeFloat, pixels.floats.data());
    if (std::string_view(input.format_name()) != "openexr") return pixels;
    for (std::size_t c = 0; c < channels; ++c) {
        if (formatOf(spec, c) != OIIO::TypeUInt32) continue;
        // The library scales integers to 0 .. 1 when asked for floats; in an EXR they are what they say.
        std::vector<std::uint32_t> whole(count);
        read(int(c), int(c) + 1, OIIO::TypeUInt32, whole.data());
        for (std::size_t i = 0; i < count; ++i) pixels.floats[i * channels + c] = static_cast<float>(whole[i]);
        pixels.integers.emplace_back(c, placed(whole, spec, 1));
    }
    pixels.floats = placed(pixels.floats, spec, channels);
    return pixels;
}

void addLayers(LayeredImage& image, const OIIO::ImageSpec& spec, const PartPixels& pixels, const std::string& part, bool first)
{
    struct Sources {
        std::size_t layer;
        std::vector<std::size_t> channels;
    };
    std::vector<Sources> sources;
    for (std::size_t c = 0; c < spec.channelnames.size(); ++c) {
        auto [ofChannel, channel] = splitChannel(spec.channelnames[c]);
        std::string layerName = std::move(ofChannel);  // clang++ lets no lambda see a binding
        if (layerName.empty() && !first) layerName = part;
        auto known = std::find_if(sources.begin(), sources.end(), [&](const Sources& s) { return image.layers[s.layer].name == layerName; });
        if (known == sources.end()) {
            ImageLayer layer;
            layer.name = layerName;
            layer.part = part;
            image.layers.push_back(std::move(layer));
            known = sources.insert(sources.end(), {image.layers.size() - 1, {}});
        }
        image.layers[known->layer].channelNames.push_back(channel);
        known->channels.push_back(c);
    }
    const std::size_t all = spec.channelnames.size(), count = pixels.floats.size() / all;
    for (const Sources& from : sources) {
        ImageLayer& layer = image.layers[from.layer];
        layer.values.reserve(count * from.channels.size());
        for (std::size_t i = 0; i < count; ++i)
            for (const std::size_t c : from.channels) layer.values.push_back(pixels.floats[i * all + c]);
        for (std::size_t place = 0; place < from.channels.size(); ++place)
            for (const auto& [channel, values] : pixels.integers)
                if (channel == from.channels[place]) layer.integers.push_back({place, values});
    }
}

}  // namespace

const ImageLayer* LayeredImage::find(const std::string& name) const
{
    for (const ImageLayer& layer : layers)
        if (layer.name == name) return &layer;
    for (const ImageLayer& layer : layers)
        if (layer.name.empty() && !name.empty() && layer.part == name) return &layer;
    return nullptr;
}

void addLayer(LayeredImage& image, const std::string& name, const Image<Vec3>& picture)
{
    takeSize(image, picture.width, picture.height);
    ImageLayer layer{name, {"R", "G", "B"}, {}, {}, {}};
    layer.values.reserve(picture.texels.size() * 3);
    for (const Vec3& color : picture.texels) layer.values.insert(layer.values.end(), {color.x, color.y, color.z});
    image.layers.push_back(std::move(layer));
}

void addLayer(LayeredImage& image, const std::string& name, const Image<float>& picture, const std::string& channel)
{
    takeSize(image, picture.width, picture.height);
    image.layers.push_back({name, {channel}, picture.texels, {}, {}});
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
    useCallersThread();
    OIIO::ImageSpec spec(image.width, image.height, 0, OIIO::TypeFloat);
    spec.channelnames.clear();
    for (const ImageLayer& layer : image.layers)
        for (const std::string& channel : layer.channelNames) spec.channelnames.push_back(layer.name.empty() ? channel : layer.name + "." + channel);
    spec.nchannels = static_cast<int>(spec.channelnames.size());
    // 29 float channels of 1280x720: a third of the time of zip, for 1.4 times the bytes.
    spec.attribute("compression", "rle");
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

LayeredImage readImage(const std::string& path, Transfer transfer)
{
    std::error_code ignored;
    if (path.empty()) throw InputError("picture", "the path is empty");
    if (std::filesystem::is_directory(path, ignored)) throw InputError(path, "is a folder, not a picture");
    if (!std::filesystem::exists(path, ignored)) throw InputError(path, "there is no such file");

    useCallersThread();
    OIIO::ImageSpec wishes;
    wishes.attribute("oiio:UnassociatedAlpha", 1);  // otherwise the library multiplies a PNG's colours by its alpha
    const auto input = OIIO::ImageInput::open(path, &wishes);
    if (!input) throw InputError(path, "is not a picture that can be read: " + oneLine(OIIO::geterror()));
    const bool exr = std::string_view(input->format_name()) == "openexr";
    LayeredImage image;
    for (int part = 0; part == 0 || (exr && input->seek_subimage(part, 0)); ++part) {
        OIIO::ImageSpec spec = input->spec(part);
        const std::string name = spec.get_string_attribute("oiio:subimagename");
        if (spec.deep) {
            image.notes.push_back("part " + (name.empty() ? std::to_string(part) : "\"" + name + "\"") + " is deep and is passed over");
            continue;
        }
        if (spec.nchannels <= 0 || spec.depth > 1 || spec.width <= 0 || spec.height <= 0) throw InputError(path, "is not a flat picture");
        if (!exr || spec.full_width <= 0 || spec.full_height <= 0) {
            spec.full_x = spec.x, spec.full_y = spec.y;
            spec.full_width = spec.width, spec.full_height = spec.height;
        }
        checkSize(spec.width, spec.height, path);
        checkSize(spec.full_width, spec.full_height, path);
        const bool first = image.layers.empty();
        if (first) {
            image.width = spec.full_width;
            image.height = spec.full_height;
        } else if (image.width != spec.full_width || image.height != spec.full_height) {
            image.notes.push_back("part " + (name.empty() ? std::to_string(part) : "\"" + name + "\"") + " is of another size and is passed over");
            continue;
        }
        noteWindows(spec, image.notes);
        addLayers(image, spec, readPart(*input, spec, part, path), name, first);
        if (!exr && !spec.format.is_floating_point())
            for (ImageLayer& layer : image.layers) transfer == Transfer::srgb ? decodeSrgb(layer) : restoreCodes(layer, spec.format);
        if (!first) continue;
        for (const OIIO::ParamValue& attribute : spec.extra_attribs)
            if (attribute.name().string().starts_with("lrsm:") && attribute.type() == OIIO::TypeString)
                image.metadata.emplace_back(attribute.name().string(), attribute.get_string());
    }
    if (image.layers.empty()) throw InputError(path, "is a deep picture, which is not supported");
    return image;
}

}  // namespace lrsm
