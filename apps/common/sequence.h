#pragma once

#include "apps/common/common_options.h"
#include "apps/common/messages.h"
#include "core/base/output_folder.h"
#include "core/scene/load_scene.h"

#include <atomic>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

/// Many moments of one scene, a folder each: `--frames A:B --fps F -o DIR` makes DIR/0000/..., and DIR/sequence.json lists them.
///
/// Frame i is the picture at time i / F and hangs on nothing else: whichever frames are made beside it, before it or elsewhere, it has the same bits. A frame's
/// folder appears when it is complete, with kFrameFile in it, which says what it was made from; frames already there of the same input and settings are kept,
/// so that an interrupted run goes on, and parts made on several machines are put together by copying their folders into one.
namespace lrsm {

inline constexpr const char* kSequenceFile = "sequence.json";
inline constexpr const char* kFrameFile = "moment.json";

struct SequenceArguments {
    std::string frames;
    double fps = 24.0;
    std::string bounds = "frame", reuse = "on";
    bool noPreview = false;
};
void addSequenceOptions(CLI::App& parser, SequenceArguments& arguments);

/// Frames begin .. end - 1.
struct FrameRange {
    int begin = 0, end = 0;
    double fps = 24.0;
    bool unionBounds = false;  ///< all frames share Scene::bounds and Scene::reach: those of all moments from 0 s to the end of motion
    bool reuse = true;         ///< a frame takes from the one before what stands; the bits are the same
    bool preview = true;       ///< a film of the pictures, when all are there
    float time(int frame) const { return float(double(frame) / fps); }  ///< seconds, as --time takes them
};
/// Of --frames and --fps; nothing: a still picture. Throws InputError.
std::optional<FrameRange> chosenFrames(const SequenceArguments& arguments);
/// "0007", and wider from 10000 on.
std::string frameName(int frame);

/// What is to be made: one frame.
struct SequenceFrame {
    int index = 0;
    float time = 0.0f;
    const Scene& scene;
    const Camera& camera;
    std::string sceneHash;
    const std::atomic<bool>& stop;  ///< Ctrl-C: what takes long may end early
};

struct SequenceJob {
    FrameRange range;
    std::string folder;
    nlohmann::ordered_json common;  ///< what all frames share and their files hang on: command, size, settings
    std::string mainFile;           ///< the file whose SHA-256 is the frame's, image.exr
    bool quiet = false, json = false;
    /// Writes the frame's files, kFrameFile apart, and does not commit. False when it was interrupted: what it keeps for next time is then its own affair.
    std::function<bool(const SequenceFrame&, OutputFolder&)> make;
    OutputFolder::Earlier earlier = {};  ///< of a frame's folder that is written anew
};

/// Makes the frames that are not there yet, in order, and sequence.json. All views are checked before the first frame. Returns the exit code: kInterruptedCode
/// after Ctrl-C, when the frame at hand is done.
int runSequence(const SequenceJob& job, const CommonOptions& options);

}  // namespace lrsm
