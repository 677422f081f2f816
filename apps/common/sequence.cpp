#include "apps/common/sequence.h"

#include "apps/common/describe.h"
#include "apps/common/interrupts.h"
#include "apps/common/preview.h"
#include "apps/common/progress.h"
#include "core/base/errors.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/json_reader.h"
#include "core/report/table.h"
#include "core/scene/scene_hash.h"

#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>

namespace lrsm {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kMostFrames = 1000000;

std::string hashOfFile(const fs::path& path)
{
    return Sha256().add(readFile(path.string())).hex();
}

struct Boxes {
    Aabb bounds, reach;
};

/// Of all moments, not of the range at hand alone: so that any split of it gives the same.
Boxes boxesOfAll(const SceneSource& source, const CommonOptions& options, const FrameRange& range, KeptPoses* kept)
{
    const double last = std::ceil(endOfMotion(source) * range.fps);
    if (last > kMostFrames) throw InputError("--sequence-bounds union", "the view moves for more than " + std::to_string(kMostFrames) + " frames");
    Progress progress(options.quiet);
    Boxes all;
    for (int i = 0; i <= int(last); ++i) {
        progress.show("bounds of all moments", double(i) / (last + 1.0));
        const Scene scene = poseChosenScene(source, options, range.time(i), kept);
        all.bounds.include(scene.bounds);
        all.reach.include(extentOf(scene));
    }
    return all;
}

/// What all frames share, and the scene that they are of: as it is at 0 s, and the view's text.
Json commonOf(const SequenceJob& job, const SceneSource& source, const CommonOptions& options)
{
    Json common = {{"program", "lrsm"}, {"version", LRSM_VERSION}, {"fps", job.range.fps}, {"sequence_bounds", job.range.unionBounds ? "union" : "frame"}};
    common.update(job.common);
    const Scene first = poseChosenScene(source, options, 0.0f);
    common["scene"] = {{"name", first.name}, {"sha256_at_0", hashScene(first)}};
    if (source.view) common["scene"]["view_sha256"] = Sha256().add(source.view->text).hex();
    return common;
}

/// A frame's kFrameFile, its main file's hash still missing.
Json entryOf(const SequenceFrame& frame, const std::string& sequence)
{
    const std::string camera = cameraJson(frame.camera, Angle::radians, frame.scene.origin).dump(-1, ' ', false, Json::error_handler_t::replace);
    return {
        {"frame", frame.index}, {"time", frame.time}, {"sequence", sequence}, {"scene_sha256", frame.sceneHash}, {"camera_sha256", Sha256().add(camera).hex()}};
}

/// The entry of a complete frame; empty where there is none.
Json readEntry(const fs::path& folder, const std::string& mainFile)
{
    std::error_code ignored;
    const fs::path file = folder / kFrameFile;
    if (!fs::exists(file, ignored) || !fs::exists(folder / mainFile, ignored)) return Json::object();
    try {
        Json entry = parseJson(readFile(file.string()), file.string());
        return entry.is_object() ? entry : Json::object();
    } catch (const InputError&) {
        return Json::object();
    }
}

bool holds(const Json& json, const std::string& key, const Json& value)
{
    return json.contains(key) && json[key] == value;
}

/// Is it there, made from the same, and as it was written?
bool isKept(const Json& found, const Json& wanted, const fs::path& folder, const std::string& mainFile)
{
    for (const auto& [key, value] : wanted.items())
        if (!holds(found, key, value)) return false;
    return holds(found, "sha256", hashOfFile(folder / mainFile));
}

/// What a kill while the frame was written has left.
void removePartials(const fs::path& folder)
{
    std::error_code ignored;
    const std::string prefix = "." + folder.filename().string() + "-partial-";
    for (const fs::directory_entry& entry : fs::directory_iterator(folder.parent_path(), ignored))
        if (entry.path().filename().string().starts_with(prefix)) fs::remove_all(entry.path(), ignored);
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
        if (entry.path().filename().string().starts_with(".lrsm-partial-")) fs::remove_all(entry.path(), ignored);
}

/// All frames of this sequence that the folder holds, whoever made them.
Json sequenceJson(const Json& common, const SequenceJob& job, const std::string& sequence)
{
    std::map<int, Json> frames;
    for (const fs::directory_entry& folder : fs::directory_iterator(job.folder)) {
        const Json entry = readEntry(folder.path(), job.mainFile);
        if (holds(entry, "sequence", sequence) && entry.contains("frame") && entry["frame"].is_number_integer() &&
            folder.path().filename() == frameName(entry["frame"].get<int>()))
            frames[entry["frame"].get<int>()] = entry;
    }
    Json json = common;
    json["sequence"] = sequence;
    json["main_file"] = job.mainFile;
    json["frames"] = Json::array();
    for (auto& [index, entry] : frames) {
        entry.erase("sequence");
        entry["folder"] = frameName(index);
        json["frames"].push_back(std::move(entry));
    }
    return json;
}

void writeText(const fs::path& path, const std::string& text)
{
    writeFileWhole(path.string(), std::as_bytes(std::span(text.data(), text.size())));
}

/// Makes one frame that is not there; false when it was interrupted.
bool makeFrame(const SequenceJob& job, const SequenceFrame& frame, Json entry, const fs::path& path)
{
    removePartials(path);
    OutputFolder folder(path.string());
    if (!job.make(frame, folder)) return false;
    entry["sha256"] = hashOfFile(folder.staged(job.mainFile));
    folder.write(kFrameFile, jsonText(entry));
    // Files that replace others do it one by one, this one last: until then the frame is none.
    std::error_code ignored;
    fs::remove(path / kFrameFile, ignored);
    folder.commit(job.earlier);
    return true;
}

struct Tally {
    int made = 0, kept = 0, replaced = 0;
    bool interrupted = false;
};

Tally makeAll(const SequenceJob& job, const CommonOptions& options, const SceneSource& source, KeptPoses* kept, const std::optional<Boxes>& boxes,
              const std::string& sequence)
{
    const CatchInterrupts catching;
    Tally tally;
    for (int i = job.range.begin; i < job.range.end && !tally.interrupted; ++i) {
        Scene scene = poseChosenScene(source, options, job.range.time(i), kept);
        if (boxes) scene.bounds = boxes->bounds, scene.reach = boxes->reach;
        const SequenceFrame frame{.index = i,
                                  .time = job.range.time(i),
                                  .scene = scene,
                                  .camera = chosenCamera(scene, options),
                                  .sceneHash = hashScene(scene),
                                  .stop = catching.asked()};
        const fs::path path = fs::path(job.folder) / frameName(i);
        const Json entry = entryOf(frame, sequence), found = readEntry(path, job.mainFile);
        if (isKept(found, entry, path, job.mainFile)) {
            ++tally.kept;
            continue;
        }
        tally.replaced += found.empty() ? 0 : 1;
        const auto start = std::chrono::steady_clock::now();
        if (!makeFrame(job, frame, entry, path)) {
            tally.interrupted = true;
            break;
        }
        ++tally.made;
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        if (!job.quiet && !job.json)
            std::cout << "  " << frameName(i) << "  at " << shortNumber(double(frame.time)) << " s, took " << shortNumber(seconds.count()) << " s" << std::endl;
        tally.interrupted = catching.asked() && i + 1 < job.range.end;
    }
    return tally;
}

/// A film of the frames, where they have pictures; how to make one, where no encoder is found.
void showFilm(const SequenceJob& job)
{
    std::error_code ignored;
    if (!fs::exists(fs::path(job.folder) / frameName(job.range.begin) / "image.png", ignored)) return;
    const PreviewRange range{job.range.begin, job.range.end, job.range.fps};
    const std::string film = makePreview(job.folder, range);
    if (job.quiet || job.json) return;
    std::cout << (film.empty() ? "to look at it: " + previewHint(job.folder, range) : "to look at it: " + job.folder + "/" + film)
              << "; one exposure for all: --exposure STOPS\n";
}

}  // namespace

void addSequenceOptions(CLI::App& parser, SequenceArguments& arguments)
{
    CLI::Option* frames = parser.add_option(
        "--frames", arguments.frames, "A:B: frames A .. B-1, each in a folder of its own, DIR/0000 ..., and DIR/sequence.json; what is there already is kept");
    parser
        .add_option("--sequence-bounds", arguments.bounds,
                    "what voxel grid and light maps are fitted to: each frame, or the union of all moments of the view at these fps, so that they stand still")
        ->needs(frames)
        ->check(CLI::IsMember({"frame", "union"}))
        ->capture_default_str();
    parser
        .add_option("--sequence-reuse", arguments.reuse,
                    "on: a frame takes from the one before what stands still, voxels, light maps, meshes; off: makes all of it anew. The bits are the same")
        ->needs(frames)
        ->check(CLI::IsMember({"on", "off"}))
        ->capture_default_str();
    parser
        .add_flag("--no-preview", arguments.noPreview, "no DIR/preview.mp4 or .webp, which ffmpeg or img2webp else makes of the pictures where it is installed")
        ->needs(frames);
    parser.add_option("--fps", arguments.fps, "frames a second: frame i is at i / fps seconds")->needs(frames)->capture_default_str();
    frames->excludes("--time");
}

std::optional<FrameRange> chosenFrames(const SequenceArguments& arguments)
{
    if (arguments.frames.empty()) return {};
    FrameRange range{.begin = 0,
                     .end = 0,
                     .fps = arguments.fps,
                     .unionBounds = arguments.bounds == "union",
                     .reuse = arguments.reuse == "on",
                     .preview = !arguments.noPreview};
    const char *begin = arguments.frames.data(), *end = begin + arguments.frames.size();
    const auto first = std::from_chars(begin, end, range.begin);
    const bool colon = first.ec == std::errc() && first.ptr != end && *first.ptr == ':';
    const auto second = colon ? std::from_chars(first.ptr + 1, end, range.end) : first;
    if (!colon || second.ec != std::errc() || second.ptr != end || range.begin < 0 || range.begin >= range.end || range.end > kMostFrames)
        throw InputError("--frames " + arguments.frames, "must be A:B with 0 <= A < B <= " + std::to_string(kMostFrames) + ": frames A, A + 1, ... B - 1");
    if (!(range.fps >= 1e-3 && range.fps <= 1e6)) throw InputError("--fps", "must be in [0.001, 1000000] frames a second");
    return range;
}

std::string frameName(int frame)
{
    std::string digits = std::to_string(frame);
    return std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits;
}

int runSequence(const SequenceJob& job, const CommonOptions& options)
{
    {
        const OutputFolder writable(job.folder);
    }  // fails now rather than after the first frame
    const SceneSource source = openChosenScene(options);
    for (int i = job.range.begin; i < job.range.end; ++i) checkMoment(source, job.range.time(i));
    Json common = commonOf(job, source, options);
    KeptPoses poses;
    KeptPoses* const kept = job.range.reuse ? &poses : nullptr;
    const std::optional<Boxes> boxes = job.range.unionBounds ? std::optional(boxesOfAll(source, options, job.range, kept)) : std::nullopt;
    if (boxes) common["bounds"] = boxJson(boxes->bounds), common["reach"] = boxJson(boxes->reach);
    const std::string sequence = Sha256().add(common.dump(-1, ' ', false, Json::error_handler_t::replace)).hex();

    const Tally tally = makeAll(job, options, source, kept, boxes, sequence);
    if (fs::is_directory(job.folder)) {
        const Json json = sequenceJson(common, job, sequence);
        writeText(fs::path(job.folder) / kSequenceFile, jsonText(json));
        if (job.json) std::cout << jsonText(json);
    }
    if (tally.replaced > 0) say({"frames of other input or settings, or damaged, that were replaced: " + std::to_string(tally.replaced)});
    if (tally.interrupted) {
        std::cerr << "lrsm: interrupted; frames that are done are in " << job.folder << " (the same command continues)" << std::endl;
        return kInterruptedCode;
    }
    if (!job.quiet && !job.json) std::cout << job.folder << ": " << tally.made << " frames made, " << tally.kept << " kept, " << kSequenceFile << "\n";
    if (job.range.preview) showFilm(job);
    return 0;
}

}  // namespace lrsm
