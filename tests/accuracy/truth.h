#pragma once

#include "apps/sweep/measure.h"
#include "conetrace/render.h"

#include <string>
#include <vector>

/// What the path tracer says of a scene, layer by layer, as it is stored beside the test; and how far a frame is from it.
namespace lrsm::accuracy {

/// The layers that are held, and where a frame has them.
struct Layer {
    const char* name;  ///< as in image.exr
    Image<Vec3> Frame::*picture;
};
inline constexpr Layer kLayers[] = {
    {"irradiance", &Frame::irradiance}, {"indirect.specular", &Frame::indirectSpecular}, {"direct", &Frame::direct}, {"combined", &Frame::combined}};

struct StoredTruth {
    int width = 0, height = 0;
    std::string sceneSha256;            ///< of the scene that was traced
    std::vector<Truth> layers;          ///< one a layer of kLayers; its picture stands in `irradiance`, whatever the layer
    std::vector<TruthFigures> figures;  ///< likewise
};
/// InputError naming the file where it is missing or has not all that is needed.
StoredTruth readTruth(const std::string& path);

/// From image.exr of `lrsm reference` to a stored truth: the layers above and their variances, rounded so that they compress.
void storeTruth(const std::string& imagePath, const std::string& truthPath);

/// One error a layer of kLayers.
std::vector<PictureError> errorsOf(const StoredTruth& truth, const Frame& frame);

}  // namespace lrsm::accuracy
