#include "core/imageio/image_io.h"

#include "core/base/elementary.h"
#include "core/base/errors.h"
#include "core/base/formats.h"
#include "core/base/text.h"
#include "core/imageio/picture_file.h"

#include <dlfcn.h>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <filesystem>

namespace lrsm {

namespace {

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
void restoreCodes(ImageLayer& layer, float largestCode)
{
    for (float& value : layer.values) value = std::floor(value * largestCode + 0.5f) / largestCode;
}

/// OpenImageIO, loaded now. It stands where the program's RUNPATH says (CMakeLists.txt).
decltype(&lrsmReadPictureFile) loadReader(const std::string& path)
{
    void* const library = ::dlopen("lrsm_picture_file.so", RTLD_NOW | RTLD_LOCAL);
    void* const reader = library ? ::dlsym(library, "lrsmReadPictureFile") : nullptr;
    if (!reader) throw MachineError(path, "cannot be read without the library that reads pictures: " + std::string(::dlerror()));
    return reinterpret_cast<decltype(&lrsmReadPictureFile)>(reader);
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
    static_assert(sizeof(Vec3) == 3 * sizeof(float));
    if (!picture.texels.empty()) layer.values.assign(&picture.texels[0].x, &picture.texels[0].x + 3 * picture.texels.size());
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

LayeredImage readImage(const std::string& path, Transfer transfer)
{
    std::error_code ignored;
    if (path.empty()) throw InputError("picture", "the path is empty");
    if (std::filesystem::is_directory(path, ignored)) throw InputError(path, "is a folder, not a picture");
    if (!std::filesystem::exists(path, ignored)) throw InputError(path, "there is no such file");

    PictureFile file;
    loadReader(path)(path, file);
    if (file.largestCode > 0.0f)
        for (ImageLayer& layer : file.image.layers) transfer == Transfer::srgb ? decodeSrgb(layer) : restoreCodes(layer, file.largestCode);
    return std::move(file.image);
}

}  // namespace lrsm
