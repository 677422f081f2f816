#pragma once

#include "core/base/image.h"
#include "core/base/math.h"
#include "core/imageio/display.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

/// EXR and PNG: written by OpenEXR and libpng, read by OpenImageIO (picture_file.h). Encoding gives bytes in memory, the same for the same input: no date, no
/// host, no library version. Write them through OutputFolder.
namespace lrsm {

/// Channels that belong together: "irradiance" with R, G, B; "depth" with Z. Values interleaved, row 0 at the top.
struct ImageLayer {
    std::string name;                       ///< "" is what viewers show by default
    std::vector<std::string> channelNames;  ///< without the layer's name
    std::vector<float> values;              ///< width * height * channelNames.size()
    struct Integers {
        std::size_t channel = 0;
        std::vector<std::uint32_t> values;  ///< width * height
    };
    std::vector<Integers> integers = {};  ///< channels that an EXR stores as whole numbers, exactly; `values` has them rounded to float
    std::string part = {};                ///< of a multi-part EXR
};

struct LayeredImage {
    int width = 0, height = 0;
    std::vector<ImageLayer> layers;
    std::vector<std::pair<std::string, std::string>> metadata;  ///< EXR only; keys in lower case begin with "lrsm:"
    std::vector<std::string> notes = {};                        ///< what reading it changed or left out, a sentence each, without the file's name

    /// By the layer's name, else by its part's where the layer has none. nullptr when there is none.
    const ImageLayer* find(const std::string& name) const;
};

/// Adds name.R, name.G, name.B; the picture must be as large as `image` (an image without layers takes its size).
void addLayer(LayeredImage& image, const std::string& name, const Image<Vec3>& picture);
/// Adds one channel, by default name.Y.
void addLayer(LayeredImage& image, const std::string& name, const Image<float>& picture, const std::string& channel = "Y");

/// A layer's R, G and B; a layer of one channel is spread to all three. InputError begins with `place` when the layer is not there.
Image<Vec3> rgbLayer(const LayeredImage& image, const std::string& name, const std::string& place);
/// A layer's first channel.
Image<float> scalarLayer(const LayeredImage& image, const std::string& name, const std::string& place);

/// float32, RLE. Reads back to the same bits (NaN payloads included).
std::vector<std::byte> encodeExr(const LayeredImage& image);
/// 8-bit RGB PNG, values as they are (already sRGB encoded), compressed fast.
std::vector<std::byte> encodePng(const Image<Rgb8>& picture);

/// What integer pictures (PNG) hold.
enum class Transfer {
    srgb,    ///< sRGB codes: decoded to linear
    linear,  ///< numbers: code / (2^n - 1), as UNORM textures
};

/// EXR or PNG and whatever else OpenImageIO reads. Of an EXR: every flat part, layers by channel name, else by part; the display window: what lies
/// outside is cropped, what is missing is 0. Colours as they are stored, whatever alpha says. `transfer` is of integer pictures; floats are taken as
/// they are. InputError when it cannot be opened, is not a picture, or is larger than 2^28 pixels.
LayeredImage readImage(const std::string& path, Transfer transfer = Transfer::srgb);

}  // namespace lrsm
