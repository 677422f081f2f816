#include "apps/sweep/measure.h"

#include "core/base/errors.h"
#include "core/base/hash.h"
#include "core/imageio/display.h"
#include "core/scene/builtin_scenes.h"
#include "core/scene/scene_hash.h"
#include "core/settings/settings_table.h"
#include "reference/flip.h"
#include "reference/ztest.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kKeyDigits = 16;
constexpr std::uint64_t kPathTracerSeed = 1;  // the truth's is 0
constexpr int kMaxBlockBits = 12;
constexpr int kCalibrationWidth = 96, kCalibrationHeight = 54;

std::string shortHash(const std::string& text)
{
    return Sha256().add(text).hex().substr(0, kKeyDigits);
}

double median(std::vector<double> values)
{
    return summarize(std::move(values)).median;
}

/// What each repeat of a frame took, pass by pass; the lights' passes are summed.
class PassTimes {
  public:
    void add(const std::vector<PassReport>& passes)
    {
        double wall = 0.0, cpu = 0.0;
        ++repeats_;
        for (const PassReport& pass : passes) {
            wall += pass.milliseconds;
            cpu += pass.cpuMilliseconds;
            timesOf(pass).back() += pass.milliseconds;
        }
        wall_.push_back(wall);
        cpu_.push_back(cpu);
    }

    void summarizeInto(Measurement& row) const
    {
        row.frame = summarize(wall_);
        row.frameCpu = median(cpu_);
        for (const auto& [pass, times] : passes_) row.passes.push_back({pass.family, pass.perPixel, summarize(times)});
    }

  private:
    std::vector<double>& timesOf(const PassReport& pass)
    {
        const std::string family = passFamily(pass.name);
        auto found = std::find_if(passes_.begin(), passes_.end(), [&](const auto& entry) { return entry.first.family == family; });
        if (found == passes_.end()) found = passes_.insert(passes_.end(), {{family, pass.traits.perPixel, {}}, {}});
        found->second.resize(repeats_, 0.0);
        return found->second;
    }

    std::size_t repeats_ = 0;
    std::vector<double> wall_, cpu_;
    std::vector<std::pair<PassTime, std::vector<double>>> passes_;
};

/// Bytes of what stays until the frame is done, and what all passes counted.
void addReports(Measurement& row, const std::vector<PassReport>& passes)
{
    for (const PassReport& pass : passes) {
        if (pass.traits.resident) {
            row.bytes += pass.bytes;
            row.gpuBytes += pass.gpuBytes;
        }
        for (const Counter& counter : pass.counters) addTo(row.counters, counter);
    }
}

Measurement rowOf(const SceneCase& sceneCase)
{
    Measurement row;
    row.scene = sceneCase.name;
    row.caseKey = caseKeyOf(sceneCase);
    row.width = sceneCase.width;
    row.height = sceneCase.height;
    row.truthSamples = sceneCase.truth.samples;
    return row;
}

void setCost(Measurement& row, const std::vector<double>& calibrations)
{
    row.calibrationCpu = median(calibrations);
    row.cost = row.calibrationCpu > 0.0 ? row.frameCpu / row.calibrationCpu : 0.0;
}

}  // namespace

Truth truthOf(const ReferenceFrame& frame, const PixelMask& covered, const std::string& sha256, const std::string& place)
{
    if (frame.irradianceVariance.empty()) throw InputError(place, "two blocks of samples are needed to tell the truth's own noise; raise --spp");
    return {frame.irradiance, frame.irradianceVariance, covered, frame.samples, sha256};
}

std::string caseKeyOf(const SceneCase& sceneCase)
{
    const Camera& eye = sceneCase.camera;
    std::vector<float> numbers;
    for (const Vec3& v : {eye.position, eye.forward, eye.up}) numbers.insert(numbers.end(), {v.x, v.y, v.z});
    numbers.insert(numbers.end(), {eye.perspective ? eye.verticalFov : eye.verticalExtent, eye.nearPlane});
    Sha256 hash;
    hash.add(sceneCase.sceneSha256.empty() ? hashScene(sceneCase.scene) : sceneCase.sceneSha256).add(numbers);
    hash.add(std::string(eye.perspective ? " perspective " : " orthographic ") + std::to_string(sceneCase.width) + "x" + std::to_string(sceneCase.height) +
             " ");
    return hash.add(sceneCase.truth.sha256).hex().substr(0, kKeyDigits);
}

std::string rowKeyOf(const std::string& caseKey, const Settings& settings)
{
    return shortHash(caseKey + " " LRSM_VERSION " " + settingsToJson(settings).dump());
}

std::string rowKeyOf(const std::string& caseKey, std::uint64_t pathTracerSamples)
{
    return shortHash(caseKey + " " LRSM_VERSION " path tracer " + std::to_string(pathTracerSamples));
}

TruthFigures figuresOf(const Truth& truth)
{
    return {zTest(truth.irradiance, truth.irradiance, truth.variance, truth.covered).noise, automaticExposure(truth.irradiance)};
}

PictureError errorOf(const Truth& truth, const TruthFigures& figures, const Image<Vec3>& irradiance)
{
    const Metrics m = measure(truth.irradiance, irradiance, truth.covered);
    const Image<float> visible = flip(exposed(truth.irradiance, figures.exposureStops), exposed(irradiance, figures.exposureStops));
    return {m.energyRatio, m.rmse, m.mae, poolFlip(visible).mean, figures.noise};
}

Calibration::Calibration() : scene_(makeBuiltinScene("cornell-box").value())
{
    run();
    run();
}

Settings Calibration::settings()
{
    Settings s;
    s.method = Method::lrsm;
    s.surface = {.textureFilter = TextureFilter::trilinear};
    s.voxel = {.resolution = 128, .mode = Voxelization::thin, .mipFilter = MipFilter::mean, .axes = OpacityAxes::directional, .storage = Storage::gpu};
    s.rsm = {.resolution = 256, .storage = Storage::gpu, .halfRounding = HalfRounding::d3d};
    s.layers = {.depthLayers = 2,
                .normalLayers = 2,
                .overlap = 0.0f,
                .fitRanges = true,
                .outermostDecay = false,
                .dropEmpty = true,
                .storage = Storage::gpu,
                .halfRounding = HalfRounding::d3d};
    s.direct = {.shadows = Shadows::hard, .shadowResolution = 1, .depthBiasTexels = 0.75f, .pcfWidthTexels = 2.0f, .shadowConeApertureDegrees = 2.0f};
    s.cones.set = {.count = 6, .apertureScale = 0.5f, .rotation = Rotation::strata, .filter = true, .filterPasses = 0, .setsPerPixel = 1};
    s.cones.march = {.estimator = Estimator::slab,
                     .step = 0.5f,
                     .startVoxels = 3.0f,
                     .normalOffsetVoxels = 1.0f,
                     .minDiameterVoxels = 1.0f,
                     .push = 0.0f,
                     .transmittanceCutoff = 0.01f,
                     .maxSteps = 1024,
                     .opacity = OpacityModel::density,
                     .densityK = 2.0f,
                     .transmittance = TransmittanceModel::linear,
                     .voxelLevelBias = -2.0f,
                     .filterFraction = FilterFraction::exact};
    s.cones.gather = {.emitterDelayTaps = 2.0f,
                      .emitterDelayVoxels = 0.75f,
                      .emitterSlantCap = 0.5f,
                      .layerSelection = LayerSelection::touched,
                      .backface = Backface::step,
                      .vRadiusScale = 1.0f,
                      .rsmLevelBias = 0.0f,
                      .rsmMinLevel = 0.0f,
                      .gaussian = GaussianMethod::polynomial,
                      .gaussianTableSize = 1024};
    s.cones.specular = {.direction = SpecularDirection::mirror, .aperture = SpecularAperture::roughness, .apertureDegrees = 10.0f};
    s.force = {.everything = false};
    return s;
}

Calibration::Times Calibration::run() const
{
    RenderOptions options;
    options.width = kCalibrationWidth;
    options.height = kCalibrationHeight;
    options.watch.hashPasses = false;
    const Frame frame = renderFrame(scene_, scene_.cameras.at(0), settings(), options);
    Times times;
    for (const PassReport& pass : frame.passes) {
        times.cpu += pass.cpuMilliseconds;
        times.wall += pass.milliseconds;
    }
    return times;
}

Measured measureSettings(const SceneCase& sceneCase, const TruthFigures& figures, const Settings& settings, const Calibration& calibration,
                         const MeasureOptions& options)
{
    const int repeat = std::max(1, options.repeat);
    RenderOptions renderOptions{
        .width = sceneCase.width, .height = sceneCase.height, .watch = {.hashPasses = false, .progress = {}, .observe = {}}, .method = {}};
    int done = 0;
    if (options.progress) renderOptions.watch.progress = [&](const std::string&, double fraction) { options.progress((done + fraction) / repeat); };

    Measured measured{rowOf(sceneCase), {}};
    Measurement& row = measured.row;
    row.settings = settings;
    PassTimes times;
    std::vector<double> calibrations;
    for (; done < repeat; ++done) {
        calibrations.push_back(calibration.run().cpu);
        Frame frame = renderFrame(sceneCase.scene, sceneCase.camera, settings, renderOptions);
        times.add(frame.passes);
        if (done > 0) continue;  // every frame has the same bits and the same work
        addReports(row, frame.passes);
        measured.irradiance = std::move(frame.irradiance);
    }
    calibrations.push_back(calibration.run().cpu);
    times.summarizeInto(row);
    setCost(row, calibrations);
    row.key = rowKeyOf(row.caseKey, settings);
    row.irradianceSha256 = hashOf(measured.irradiance);
    row.error = errorOf(sceneCase.truth, figures, measured.irradiance);
    return measured;
}

std::vector<Measured> measurePathTracer(const SceneCase& sceneCase, const TruthFigures& figures, std::uint64_t maxSamples, const Calibration& calibration,
                                        const MeasureOptions& options, const std::function<void(const Measured&)>& made)
{
    // One block for all samples: the best stratified picture that this path tracer can give.
    ReferenceSettings settings{.width = sceneCase.width, .height = sceneCase.height, .seed = kPathTracerSeed};
    settings.blockBits = std::min(kMaxBlockBits, static_cast<int>(std::bit_width(std::max<std::uint64_t>(1, maxSamples) - 1)));

    std::vector<double> calibrations{calibration.run().cpu};
    const Clock::time_point begin = Clock::now();
    double cpu = processorMilliseconds();
    const PathTracer tracer(sceneCase.scene, sceneCase.camera, settings);
    double wall = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    cpu = processorMilliseconds() - cpu;

    Measurement row = rowOf(sceneCase);
    row.kind = RowKind::pathTracer;
    std::vector<Measured> all;
    ReferenceState state;
    for (std::uint64_t samples = 1, before = 0; before < maxSamples; before = samples, samples = std::min(2 * samples, maxSamples)) {
        if (before == 0)
            state = tracer.start({0, samples});
        else
            tracer.extend(state, {before, samples});
        const Clock::time_point resumed = Clock::now();
        const double cpuResumed = processorMilliseconds();
        while (!tracer.advance(state, Clock::now() + std::chrono::milliseconds(200), options.stop)) {
            if (options.stop && *options.stop) return all;
            if (options.progress) options.progress((double(before) + PathTracer::progress(state) * double(samples - before)) / double(maxSamples));
        }
        wall += std::chrono::duration<double, std::milli>(Clock::now() - resumed).count();
        cpu += processorMilliseconds() - cpuResumed;
        calibrations.push_back(calibration.run().cpu);

        row.samples = samples;
        row.label = "path tracer " + std::to_string(samples) + " spp";
        row.key = rowKeyOf(row.caseKey, samples);
        row.frame = {wall, wall, 0.0};
        row.frameCpu = cpu;
        setCost(row, calibrations);
        row.rays = tracer.primaryRays().total() + state.rays.total();
        Measured measured{row, tracer.resolve(state.sums).irradiance};
        measured.row.irradianceSha256 = hashOf(measured.irradiance);
        measured.row.error = errorOf(sceneCase.truth, figures, measured.irradiance);
        if (made) made(measured);
        all.push_back(std::move(measured));
    }
    return all;
}

}  // namespace lrsm
