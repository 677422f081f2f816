#include "apps/sweep/truth.h"

#include "apps/reference/reference_files.h"
#include "apps/reference/reference_run.h"
#include "core/base/errors.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/scene/scene_hash.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace fs = std::filesystem;

namespace {

constexpr int kMostBlockBits = 6;             // 64 paths stratified against each other
constexpr std::uint64_t kBlocksForNoise = 8;  // from fewer the noise floor itself is too uncertain
constexpr std::size_t kNameDigits = 16;

std::string textOf(const Identity& identity)
{
    std::string text;
    for (const auto& [name, value] : identity) text += name + "=" + value + "\n";
    return text;
}

/// Samples of the same picture: how they are stratified, and whether a cone layer is traced beside, changes no mean.
bool samePicture(const Identity& a, const Identity& b)
{
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](const auto& x, const auto& y) {
               return x.first == y.first && (x.second == y.second || x.first == "block" || x.first == "specular_aperture_degrees");
           });
}

bool isEnough(const Checkpoint& found, const Identity& identity, std::uint64_t samples)
{
    const ReferenceState& state = found.state;
    return state.finished() && samePicture(found.identity, identity) && state.sums.completeBlocks >= kBlocksForNoise && state.sums.sampleCount() >= samples;
}

std::optional<Checkpoint> readSamples(const fs::path& folder)
{
    std::error_code ignored;
    const fs::path file = folder / kSamplesFile;
    if (!fs::is_regular_file(file, ignored)) return {};
    return decodeCheckpoint(readFile(file.string()), file.string());
}

/// A finished truth in any folder but `own`; files that are none, or damaged, are somebody else's matter.
std::optional<Checkpoint> searchReferences(const fs::path& references, const fs::path& own, const Identity& identity, std::uint64_t samples)
{
    std::error_code ignored;
    std::vector<fs::path> folders;
    for (fs::directory_iterator at(references, ignored), end; at != end; at.increment(ignored))
        if (at->path() != own && at->is_directory(ignored)) folders.push_back(at->path());
    std::sort(folders.begin(), folders.end());
    for (const fs::path& folder : folders) {
        try {
            std::optional<Checkpoint> found = readSamples(folder);
            if (found && isEnough(*found, identity, samples)) return found;
        } catch (const InputError&) {
        }
    }
    return {};
}

ReferenceSettings truthSettings(const SceneCase& sceneCase, std::uint64_t samples)
{
    ReferenceSettings settings{.width = sceneCase.width, .height = sceneCase.height, .blockBits = 0};
    while (settings.blockBits < kMostBlockBits && (kBlocksForNoise << (settings.blockBits + 1)) <= samples) ++settings.blockBits;
    return settings;
}

Truth toTruth(const SceneCase& sceneCase, const Checkpoint& checkpoint, const PathTracer& tracer)
{
    const std::string sha256 = Sha256().add(textOf(checkpoint.identity) + describeRanges(checkpoint.state.sums.ranges)).hex();
    const SeenLayers seen = seenLayers(tracer.primary());
    return truthOf(resolveFrame(checkpoint.state.sums, checkpoint.unit, seen.direct, seen.albedo), tracer.primary().covered, sha256, sceneCase.name);
}

}  // namespace

std::optional<Truth> findOrMakeTruth(const SceneCase& sceneCase, std::uint64_t samples, const std::string& references, Progress& progress,
                                     const std::atomic<bool>* stop)
{
    if (samples < kBlocksForNoise || samples > std::uint64_t(1) << 32)
        throw InputError("--spp " + std::to_string(samples), "must be " + std::to_string(kBlocksForNoise) + " .. 2^32, for the truth's own noise to be told");
    const std::string sceneHash = sceneCase.sceneSha256.empty() ? hashScene(sceneCase.scene) : sceneCase.sceneSha256;
    const ReferenceSettings settings = truthSettings(sceneCase, samples);
    progress.show(sceneCase.name + ": building the BVH", 0.0);
    const PathTracer tracer(sceneCase.scene, sceneCase.camera, settings);
    Checkpoint checkpoint{identifyReference(tracer, sceneCase.camera, sceneHash), tracer.unit(), {}};

    const fs::path own = references.empty() ? fs::path() : fs::path(references) / Sha256().add(textOf(checkpoint.identity)).hex().substr(0, kNameDigits);
    std::optional<Checkpoint> earlier;
    if (!references.empty()) {
        earlier = readSamples(own);
        if (earlier) requireSameIdentity(checkpoint.identity, "this scene", earlier->identity, (own / kSamplesFile).string());
        if (earlier && isEnough(*earlier, checkpoint.identity, samples)) return toTruth(sceneCase, *earlier, tracer);
        if (const std::optional<Checkpoint> found = searchReferences(references, own, checkpoint.identity, samples)) return toTruth(sceneCase, *found, tracer);
    }

    ReferenceState state = earlier ? std::move(earlier->state) : tracer.start({0, samples});
    const TraceOptions trace{.folder = own.string(),
                             .show = [&](const std::string& text, double fraction) { progress.show("truth of " + sceneCase.name + ": " + text, fraction); },
                             .stop = stop};
    if (!traceRange(tracer, state, {0, samples}, checkpoint, trace)) return {};
    checkpoint.state = std::move(state);
    if (!references.empty()) {
        OutputFolder folder(own.string());
        writeReference(folder, checkpoint, seenLayers(tracer.primary()), referenceJson(sceneCase.scene, sceneHash, sceneCase.camera, tracer, checkpoint.state),
                       {});
        folder.commit();
    }
    return toTruth(sceneCase, checkpoint, tracer);
}

}  // namespace lrsm
