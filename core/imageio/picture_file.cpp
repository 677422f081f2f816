#include "core/imageio/picture_file.h"

#include "core/base/errors.h"

#include <OpenImageIO/imageio.h>
#include <algorithm>
#include <string_view>

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

/// "indirect.diffuse.R" belongs to the layer "indirect.diffuse".
std::pair<std::string, std::string> splitChannel(const std::string& name)
{
    const std::size_t dot = name.rfind('.');
    return dot == std::string::npos ? std::pair(std::string(), name) : std::pair(name.substr(0, dot), name.substr(dot + 1));
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

extern "C" void lrsmReadPictureFile(const std::string& path, PictureFile& file)
{
    useCallersThread();
    OIIO::ImageSpec wishes;
    wishes.attribute("oiio:UnassociatedAlpha", 1);  // otherwise the library multiplies a PNG's colours by its alpha
    const auto input = OIIO::ImageInput::open(path, &wishes);
    if (!input) throw InputError(path, "is not a picture that can be read: " + oneLine(OIIO::geterror()));
    const bool exr = std::string_view(input->format_name()) == "openexr";
    LayeredImage& image = file.image;
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
        if (!exr && !spec.format.is_floating_point()) file.largestCode = spec.format.size() == 1 ? 255.0f : 65535.0f;
        if (!first) continue;
        for (const OIIO::ParamValue& attribute : spec.extra_attribs)
            if (attribute.name().string().starts_with("lrsm:") && attribute.type() == OIIO::TypeString)
                image.metadata.emplace_back(attribute.name().string(), attribute.get_string());
    }
    if (image.layers.empty()) throw InputError(path, "is a deep picture, which is not supported");
}

}  // namespace lrsm
