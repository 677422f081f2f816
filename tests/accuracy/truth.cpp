#include "tests/accuracy/truth.h"

#include "core/base/errors.h"
#include "core/base/output_folder.h"
#include "core/imageio/image_io.h"

#include <cmath>

namespace lrsm::accuracy {
namespace {

constexpr char kVariance[] = ".variance", kSceneKey[] = "lrsm:scene_sha256";
// Far below the noise of any mean; and a variance is itself only known to some percent.
constexpr int kMeanBits = 11, kVarianceBits = 4;

/// To `bits` significant bits, so that the file's ZIP has whole bytes of zeros.
Image<Vec3> rounded(Image<Vec3> picture, int bits)
{
    for (Vec3& texel : picture.texels)
        for (int c = 0; c < 3; ++c) {
            int exponent = 0;
            const float mantissa = std::frexp(texel[c], &exponent);
            texel[c] = std::ldexp(std::nearbyint(std::ldexp(mantissa, bits)), exponent - bits);
        }
    return picture;
}

bool hasNoise(const std::string& layer)
{
    return layer != "direct";  // one ray a pixel and one a light, in the frame as in the truth
}

std::string metadataOf(const LayeredImage& image, const std::string& key, const std::string& path)
{
    for (const auto& [name, value] : image.metadata)
        if (name == key) return value;
    throw InputError(path, "does not say its " + key);
}

}  // namespace

StoredTruth readTruth(const std::string& path)
{
    const LayeredImage image = readImage(path);
    StoredTruth truth{image.width, image.height, metadataOf(image, kSceneKey, path), {}, {}};
    const Image<float> seen = scalarLayer(image, "covered", path);
    PixelMask covered(image.width, image.height);
    for (std::size_t i = 0; i < covered.texels.size(); ++i) covered.texels[i] = seen.texels[i] != 0.0f;

    for (const Layer& layer : kLayers) {
        const std::string name = layer.name;
        const Image<Vec3> variance = hasNoise(name) ? rgbLayer(image, name + kVariance, path) : Image<Vec3>(image.width, image.height, Vec3(0.0f));
        truth.layers.push_back({rgbLayer(image, name, path), variance, covered, 0, {}});
        truth.figures.push_back(figuresOf(truth.layers.back()));
    }
    return truth;
}

void storeTruth(const std::string& imagePath, const std::string& truthPath)
{
    const LayeredImage image = readImage(imagePath);
    LayeredImage stored;
    stored.metadata = image.metadata;
    for (const Layer& layer : kLayers) {
        const std::string name = layer.name;
        addLayer(stored, name, rounded(rgbLayer(image, name, imagePath), kMeanBits));
        if (hasNoise(name)) addLayer(stored, name + kVariance, rounded(rgbLayer(image, name + kVariance, imagePath), kVarianceBits));
    }
    Image<float> covered = scalarLayer(image, "depth", imagePath);
    for (float& depth : covered.texels) depth = depth != 0.0f;
    addLayer(stored, "covered", covered);
    writeFileWhole(truthPath, encodeExr(stored));
}

std::vector<PictureError> errorsOf(const StoredTruth& truth, const Frame& frame)
{
    std::vector<PictureError> errors;
    for (std::size_t i = 0; i < truth.layers.size(); ++i) errors.push_back(errorOf(truth.layers[i], truth.figures[i], frame.*kLayers[i].picture));
    return errors;
}

}  // namespace lrsm::accuracy
