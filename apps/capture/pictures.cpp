#include "apps/capture/pictures.h"

#include "core/base/output_folder.h"
#include "core/imageio/display.h"
#include "core/imageio/image_io.h"

#include <algorithm>

namespace lrsm {

namespace {

constexpr int kThumbnailWidth = 256, kColumns = 4, kGap = 8;
constexpr const char *kFrameExr = "frame.exr", *kSheetFile = "contact-sheet.png";
constexpr Rgb8 kBackground{48, 48, 48};

bool isPicture(const Buffer& b)
{
    return b.axes.size() >= 2 && b.axes[0] == "row" && b.axes[1] == "column" && b.dtype != Dtype::u4 && b.pass != "tables";
}

int channels(const Buffer& b)
{
    return b.components.empty() ? 1 : static_cast<int>(b.components.size());
}

/// "Y", or the components' names as viewers know them.
std::vector<std::string> channelNames(const Buffer& b)
{
    if (b.components.empty()) return {"Y"};
    static const std::vector<std::string> rgba = {"R", "G", "B", "A"};
    return {rgba.begin(), rgba.begin() + channels(b)};
}

ImageLayer layerOf(const Buffer& b)
{
    ImageLayer layer{b.name, channelNames(b), {}, {}, {}};
    layer.values.resize(valueCount(b));
    for (std::size_t i = 0; i < layer.values.size(); ++i) layer.values[i] = static_cast<float>(decodedValue(b, i));
    return layer;
}

void writeExr(OutputFolder& folder, const Capture& capture, const std::string& file, const std::string& prefix, bool withPrefix)
{
    LayeredImage image;
    for (const Buffer& b : capture.buffers) {
        if (!isPicture(b) || b.name.starts_with(prefix) != withPrefix || b.name.starts_with("rsm") != withPrefix) continue;
        image.height = static_cast<int>(b.shape[0]);
        image.width = static_cast<int>(b.shape[1]);
        image.layers.push_back(layerOf(b));
    }
    if (image.layers.empty()) return;
    image.metadata = {
        {"lrsm:version", capture.version}, {"lrsm:command", "capture"}, {"lrsm:scene", capture.sceneName}, {"lrsm:scene_sha256", capture.sceneHash}};
    folder.write(file, encodeExr(image));
}

/// Every buffer with rows and columns, its first layer where it has several; base levels alone.
std::vector<Buffer const*> sheetBuffers(const Capture& capture)
{
    std::vector<Buffer const*> all;
    for (const Buffer& b : capture.buffers) {
        const bool layered = b.axes.size() == 4 && b.axes[1] == "row",
                   base = !b.name.ends_with(".alpha") && (b.name.find(".mip") == std::string::npos || b.name.ends_with(".mip0"));
        if (!b.bytes.empty() && b.pass != "tables" && (isPicture(b) || (layered && base))) all.push_back(&b);
    }
    return all;
}

/// The thumbnail's pixels are the nearest ones; layers of an array stand in the same cell, the first alone.
template <class T, class Read>
Image<T> shrunk(int width, int height, int smallWidth, int smallHeight, const Read& read)
{
    Image<T> small(smallWidth, smallHeight);
    for (int y = 0; y < smallHeight; ++y)
        for (int x = 0; x < smallWidth; ++x) small.at(x, y) = read((2 * x + 1) * width / (2 * smallWidth), (2 * y + 1) * height / (2 * smallHeight));
    return small;
}

Image<Rgb8> thumbnail(const Buffer& b, float stops)
{
    const std::size_t rowAxis = b.axes[0] == "row" ? 0 : 1;
    const int height = static_cast<int>(b.shape[rowAxis]), width = static_cast<int>(b.shape[rowAxis + 1]), count = channels(b);
    const int smallWidth = kThumbnailWidth, smallHeight = std::max(1, kThumbnailWidth * height / width);
    const auto value = [&](int x, int y, int c) {
        return static_cast<float>(
            decodedValue(b, (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) * static_cast<std::size_t>(count) +
                                static_cast<std::size_t>(c)));
    };
    if (count < 3) {
        const Image<float> values = shrunk<float>(width, height, smallWidth, smallHeight, [&](int x, int y) { return value(x, y, 0); });
        const float most = values.texels.empty() ? 1.0f : *std::max_element(values.texels.begin(), values.texels.end());
        return falseColor(values, 0.0f, most);
    }
    const Image<Vec3> values =
        shrunk<Vec3>(width, height, smallWidth, smallHeight, [&](int x, int y) { return Vec3(value(x, y, 0), value(x, y, 1), value(x, y, 2)); });
    if (b.name.find("normal") != std::string::npos) return normalColor(values);
    const bool light = !b.unit.empty() && b.unit != "m";
    return tonemap(values, light ? (b.pass.starts_with("rsm") || b.pass.starts_with("lrsm") ? automaticExposure(values) : stops) : 0.0f);
}

void writeSheet(OutputFolder& folder, const Capture& capture)
{
    const std::vector<Buffer const*> buffers = sheetBuffers(capture);
    if (buffers.empty()) return;
    const Buffer* combined = capture.find("composite.combined");
    float stops = 0.0f;
    if (combined) {
        Image<Vec3> picture(capture.width, capture.height);
        std::copy_n(combined->as<Vec3>().begin(), picture.texels.size(), picture.texels.begin());
        stops = automaticExposure(picture);
    }
    std::vector<Image<Rgb8>> thumbnails;
    for (const Buffer* b : buffers) thumbnails.push_back(thumbnail(*b, stops));

    // Row by row, each as high as its highest.
    const std::size_t columns = kColumns;
    std::vector<int> tops = {kGap};
    for (std::size_t first = 0; first < thumbnails.size(); first += columns) {
        int height = 0;
        for (std::size_t i = first; i < std::min(first + columns, thumbnails.size()); ++i) height = std::max(height, thumbnails[i].height);
        tops.push_back(tops.back() + height + kGap);
    }
    Image<Rgb8> sheet(kColumns * (kThumbnailWidth + kGap) + kGap, tops.back(), kBackground);
    for (std::size_t i = 0; i < thumbnails.size(); ++i) {
        const int left = kGap + static_cast<int>(i % columns) * (kThumbnailWidth + kGap), top = tops[i / columns];
        for (int y = 0; y < thumbnails[i].height; ++y)
            for (int x = 0; x < thumbnails[i].width; ++x) sheet.at(left + x, top + y) = thumbnails[i].at(x, y);
    }
    folder.write(kSheetFile, encodePng(sheet));
}

}  // namespace

std::vector<std::string> pictureFiles(const std::vector<std::string>& files)
{
    std::vector<std::string> pictures = {kFrameExr, kSheetFile};
    for (const std::string& file : files) {
        const std::string exr = file.substr(0, file.find('.')) + ".exr";
        if (file.starts_with("rsm") && pictures.back() != exr) pictures.push_back(exr);
    }
    return pictures;
}

void writePictures(OutputFolder& folder, const Capture& capture)
{
    writeExr(folder, capture, kFrameExr, "rsm", false);
    for (std::size_t i = 0; i < capture.lights.size(); ++i) {
        const std::string name = "rsm" + std::to_string(i);
        writeExr(folder, capture, name + ".exr", name + ".", true);
    }
    writeSheet(folder, capture);
}

}  // namespace lrsm
