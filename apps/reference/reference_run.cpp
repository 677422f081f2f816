#include "apps/reference/reference_run.h"

#include "apps/common/describe.h"
#include "apps/reference/reference_files.h"
#include "reference/ztest.h"

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kMostSamples = std::uint64_t(1) << 32;
constexpr std::uint64_t kFirstBlocks = 8;  // before their spread says how large the noise is
constexpr double kGoalMargin = 1.01;       // rather reach the target than come again

const char* modelName(Transport transport)
{
    return transport == Transport::full ? "full" : "single";
}

std::uint64_t samplesOf(const ReferenceState& state)
{
    const double begun = state.finished() ? 0.0 : PathTracer::progress(state) * double(state.target.size());
    return (state.finished() ? state.sums : state.base).sampleCount() + std::uint64_t(begun);
}

/// Renders the samples of one state, writing checkpoints; false when interrupted.
class Runner {
  public:
    Runner(const PathTracer& tracer, const TraceOptions& options, Checkpoint& checkpoint)
        : tracer_(tracer), options_(options), checkpoint_(checkpoint), saved_(Clock::now())
    {
    }

    /// `goal`: the samples that there will be in the end.
    bool finish(ReferenceState& state, std::uint64_t goal)
    {
        goal_ = double(goal);
        while (!tracer_.advance(state, Clock::now() + std::chrono::milliseconds(200), options_.stop)) {
            show(state);
            const bool stopped = options_.stop && *options_.stop,
                       due = std::chrono::duration<double>(Clock::now() - saved_).count() >= options_.checkpointSeconds;
            if ((due || stopped) && !options_.folder.empty()) save(state);
            if (stopped) return false;
        }
        return true;
    }

  private:
    void save(const ReferenceState& state)
    {
        checkpoint_.state = state;
        std::filesystem::create_directories(options_.folder);
        writeFileWhole((std::filesystem::path(options_.folder) / kSamplesFile).string(), encodeCheckpoint(checkpoint_));
        saved_ = Clock::now();
    }

    void show(const ReferenceState& state)
    {
        if (!options_.show) return;
        const double done = double(samplesOf(state)) / goal_;
        if (firstShown_ < 0.0) {
            firstShown_ = done;
            begun_ = Clock::now();
        }
        const double elapsed = std::chrono::duration<double>(Clock::now() - begun_).count(), gained = done - firstShown_;
        const double left = gained > 0.0 ? elapsed * std::max(0.0, 1.0 - done) / gained : 0.0;
        char text[64];
        std::snprintf(text, sizeof text, "tracing, %d:%02d left", int(left) / 60, int(left) % 60);
        options_.show(text, std::min(done, 1.0));
    }

    const PathTracer& tracer_;
    const TraceOptions& options_;
    Checkpoint& checkpoint_;
    Clock::time_point saved_, begun_;
    double firstShown_ = -1.0, goal_ = 1.0;
};

Json speedJson(const RayCounts& rays, double seconds)
{
    return {{"eye", rays.eye},       {"bounce", rays.bounce}, {"light", rays.light},
            {"total", rays.total()}, {"seconds", seconds},    {"million_per_second", seconds > 0.0 ? double(rays.total()) / seconds * 1e-6 : 0.0}};
}

}  // namespace

Identity identifyReference(const PathTracer& tracer, const Camera& camera, const std::string& sceneHash)
{
    const ReferenceSettings& settings = tracer.settings();
    Json eye = cameraJson(camera);
    eye.erase("name");
    return {{"version", LRSM_VERSION},
            {"scene_sha256", sceneHash},
            {"camera", eye.dump()},
            {"size", std::to_string(settings.width) + "x" + std::to_string(settings.height)},
            {"model", modelName(settings.transport)},
            {"seed", std::to_string(settings.seed)},
            {"block", std::to_string(1 << settings.blockBits)},
            {"specular_aperture_degrees", Json(settings.specularApertureDegrees).dump()},
            {"light_guide_sha256", tracer.guide().sha256}};
}

bool traceRange(const PathTracer& tracer, ReferenceState& state, const SampleRange& range, Checkpoint& checkpoint, const TraceOptions& options)
{
    Runner runner(tracer, options, checkpoint);
    if (!state.finished() && !runner.finish(state, range.size())) return false;
    if (state.sums.ranges.back().end >= range.end) return true;
    tracer.extend(state, {state.sums.ranges.back().end, range.end});
    return runner.finish(state, range.size());
}

double noiseOf(const PathTracer& tracer, const SampleSums& sums)
{
    const ReferenceFrame frame = tracer.resolve(sums);
    if (frame.irradianceVariance.empty()) return kInfinity;
    const double noise = zTest(frame.irradiance, frame.irradiance, frame.irradianceVariance, tracer.primary().covered).noise;
    return std::isfinite(noise) ? noise : 0.0;  // a black picture has none
}

bool traceToNoise(const PathTracer& tracer, ReferenceState& state, double target, Checkpoint& checkpoint, const TraceOptions& options)
{
    const std::uint64_t block = std::uint64_t(1) << tracer.settings().blockBits;
    Runner runner(tracer, options, checkpoint);
    if (!state.finished() && !runner.finish(state, samplesOf(state) + state.target.size())) return false;
    for (;;) {
        const std::uint64_t done = state.sums.ranges.back().end;
        if (done >= kMostSamples) return true;
        std::uint64_t goal = kFirstBlocks * block;
        if (done >= goal) {
            const double noise = noiseOf(tracer, state.sums);
            if (noise <= target) return true;
            goal = std::uint64_t(std::min(double(done) * (noise / target) * (noise / target) * kGoalMargin, double(kMostSamples)));
        }
        // To twice as many at the most: the noise is better known then.
        const std::uint64_t end = std::min({std::max(goal, done + 1), std::max(2 * done, kFirstBlocks * block), kMostSamples});
        tracer.extend(state, {done, (end + block - 1) / block * block});
        if (!runner.finish(state, std::max(goal, end))) return false;
    }
}

Json referenceSettingsJson(const ReferenceSettings& settings)
{
    return {{"model", modelName(settings.transport)},
            {"seed", settings.seed},
            {"block", 1 << settings.blockBits},
            {"from_lights", settings.fromLights},
            {"specular_aperture_degrees", settings.specularApertureDegrees}};
}

Json referenceJson(const Scene& scene, const std::string& sceneHash, const Camera& camera, const PathTracer& tracer, const ReferenceState& state)
{
    const ReferenceSettings& settings = tracer.settings();
    Json json = {{"program", "lrsm"}, {"version", LRSM_VERSION}, {"command", "reference"}, {"size", {settings.width, settings.height}}};
    json["samples"] = state.sums.sampleCount();
    json["sample_ranges"] = describeRanges(state.sums.ranges);
    json["settings"] = referenceSettingsJson(settings);
    json["scene"] = sceneJson(scene, sceneHash);
    json["camera"] = cameraJson(camera);
    json["primary_rays"] = {{"eye", tracer.primaryRays().eye}, {"light", tracer.primaryRays().light}};
    json["rays"] = speedJson(state.rays, state.seconds);
    json["not_finite_samples"] = state.faults.notFinite;
    json["clamped_samples"] = state.faults.clamped;
    return json;
}

}  // namespace lrsm
