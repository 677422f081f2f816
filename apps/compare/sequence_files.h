#pragma once

#include "core/imageio/image_io.h"
#include "reference/sequence_metrics.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

/// Sequences on disk: DIR/0000/image.exr, ... as `render --frames` writes them, or another engine.
namespace lrsm {

struct SequenceFiles {
    std::string folder;
    std::map<int, std::string> pictures;  ///< image.exr of each frame
    std::map<int, double> times;          ///< seconds, where moment.json tells them
};
/// Throws InputError where the folder is none or has no frame.
SequenceFiles readSequence(const std::string& folder);

/// The frames that both have, consecutive, three at least, of equal times. Throws InputError otherwise.
std::vector<int> commonFrames(const SequenceFiles& test, const SequenceFiles& reference);

/// Both pictures of one frame.
struct FramePair {
    std::string testPath, referencePath;
    LayeredImage test, reference;
};
FramePair readFrame(const SequenceFiles& test, const SequenceFiles& reference, int frame);

/// The camera that a picture's metadata tell, in the file's world; nothing where they do not.
std::optional<Camera> cameraOf(const LayeredImage& image);

/// What the meter needs of one layer. Pixels count where the eye sees a surface in either picture, as far as they tell, and both are finite. Where camera,
/// position and depth are all told, pixels can follow.
MomentPair momentOf(const FramePair& pair, const std::string& layer, bool allPixels);
/// Pixels of a layer that are not finite in either picture.
std::uint64_t notFinite(const FramePair& pair, const std::string& layer);

}  // namespace lrsm
