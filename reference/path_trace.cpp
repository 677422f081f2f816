#include "reference/path_trace.h"

#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "reference/pixel_sampler.h"

#include <mutex>

namespace lrsm {
namespace {

constexpr std::size_t kPixelsAtATime = 256;

using Clock = std::chrono::steady_clock;

Segment segmentOf(const SampleRange& range, std::uint32_t number, int blockBits)
{
    const std::uint64_t block = (range.begin >> blockBits) + number, start = block << blockBits, size = std::uint64_t(1) << blockBits;
    return {block, std::uint32_t(std::max(range.begin, start) - start), std::uint32_t(std::min(range.end - start, size))};
}
std::uint32_t segmentCount(const SampleRange& range, int blockBits)
{
    if (range.size() == 0) return 0;
    return std::uint32_t(((range.end - 1) >> blockBits) - (range.begin >> blockBits) + 1);
}

bool anySpecular(const Scene& scene)
{
    return std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) { return hasSpecularPart(m); });
}

std::array<std::uint32_t, 2> keyOf(std::uint64_t seed)
{
    return {std::uint32_t(seed), std::uint32_t(seed >> 32)};
}

}  // namespace

void validate(const ReferenceSettings& s)
{
    const auto require = [](bool ok, const std::string& what) {
        if (!ok) throw InputError("reference settings", what);
    };
    require(s.width >= 1 && s.height >= 1 && s.width <= 65536 && s.height <= 65536,
            "size = " + std::to_string(s.width) + "x" + std::to_string(s.height) + " must be in 1..65536 each way");
    require(s.blockBits >= 0 && s.blockBits <= 12, "block bits = " + std::to_string(s.blockBits) + " must be in 0..12");
    require(s.specularApertureDegrees >= 0.0f && s.specularApertureDegrees <= 170.0f,
            "specular_aperture_degrees = " + std::to_string(s.specularApertureDegrees) + " must be in [0, 170]");
}

double sampleUnit(const Scene& scene)
{
    const Vec3 extent = extentOf(scene).empty() ? Vec3(1.0f) : extentOf(scene).extent();
    const double size2 = std::max(double(glm::dot(extent, extent)), 1e-30);
    double largest = 0.0;
    for (const Light& light : scene.lights) {
        const double intensity = std::max({light.intensity.x, light.intensity.y, light.intensity.z});
        largest = std::max(largest, light.type == LightType::directional ? intensity : intensity / size2);
    }
    return largest > 0.0 ? std::ldexp(1.0, std::ilogb(largest)) : 1.0;
}

PathTracer::PathTracer(const Scene& scene, const Camera& camera, const ReferenceSettings& settings)
    : scene_(scene),
      settings_((validate(settings), settings)),
      embree_(scene),
      lights_(scene.lights.begin(), scene.lights.end()),
      specular_(anySpecular(scene)),
      unit_(sampleUnit(scene))
{
    shootPrimary(camera);
    guide_.tiles = {settings_.width, settings_.height};
    if (settings_.fromLights) guide_ = learnLightGuide(embree_, lights_, primary_, settings_.transport);
}

int PathTracer::channels() const
{
    return !specular_ ? kDiffuseChannels : settings_.specularApertureDegrees > 0.0f ? kConeChannels : kLobeChannels;
}

void PathTracer::shootPrimary(const Camera& camera)
{
    const int width = settings_.width, height = settings_.height;
    primary_ = {{width, height}, {width, height}, {width, height}, {width, height}, {width, height}};
    const PixelSpacing spacing = pixelSpacing(camera, height);
    std::mutex countsMutex;
    parallelFor(primary_.covered.texels.size(), kPixelsAtATime, [&](std::size_t begin, std::size_t end) {
        Tracer tracer(embree_, lights_);
        for (std::size_t i = begin; i < end; ++i) {
            const auto x = float(i % std::size_t(width)), y = float(i / std::size_t(width));
            const CameraRay eye = pixelRay(camera, width, height, x + 0.5f, y + 0.5f);
            const std::optional<RayHit> hit = tracer.closestHit({eye.origin, eye.direction, eye.tNear, kInfinity, RayKind::eye});
            if (!hit) continue;
            primary_.covered.texels[i] = 1;
            primary_.toEye.texels[i] = -eye.direction;
            const PixelSpacing here = spacingAt(spacing, camera, eye.origin + eye.direction * hit->t);
            primary_.surface.texels[i] = evaluateSurface(scene_, hit->surface, -eye.direction, &here);
            primary_.depth.texels[i] = glm::dot(primary_.surface.texels[i].position - camera.position, camera.forward);
            primary_.direct.texels[i] = directLight(tracer, primary_.surface.texels[i], -eye.direction);
        }
        const std::lock_guard lock(countsMutex);  // integers: any order gives the same sum
        primaryRays_.eye += tracer.counts.eye;
        primaryRays_.light += tracer.counts.light;
    });
}

ReferenceState PathTracer::start(SampleRange range) const
{
    if (range.begin > range.end) throw InputError("samples", "the range ends before it begins");
    ReferenceState state;
    state.target = range;
    const std::size_t pixels = primary_.covered.texels.size();
    state.sums = makeSums(pixels, channels(), settings_.blockBits);
    state.tileBlocks.assign(guide_.tiles.count(), 0);
    const std::uint32_t segments = segmentCount(range, settings_.blockBits);
    for (std::uint32_t number = 0; number < segments; ++number) {
        const Segment segment = segmentOf(range, number, settings_.blockBits);
        const std::uint32_t samples = segment.last - segment.first;
        if (samples == state.sums.blockSize())
            ++state.sums.completeBlocks;
        else
            state.sums.partial.push_back({segment.block, samples, std::vector<Int128>(state.sums.sums.size(), 0)});
    }
    return state;
}

void PathTracer::extend(ReferenceState& state, SampleRange range) const
{
    ReferenceState next = start(range);
    next.base = std::move(state.sums);
    next.rays = state.rays;
    next.faults = state.faults;
    next.seconds = state.seconds;
    state = std::move(next);
}

SampleFaults PathTracer::addTile(Tracer& tracer, SampleSums& sums, PartialBlock* cut, std::size_t tile, const Segment& segment) const
{
    const int channelCount = channels();
    SampleFaults faults;
    std::array<std::array<Int128, kConeChannels>, kTilePixels> tileSums{};
    TileSampler sampler(*this, tile, {segment.block, settings_.blockBits, keyOf(settings_.seed)});
    sampler.drawSamples(tracer, segment.first, segment.last, [&](std::size_t, std::size_t number, const Sample& sample) {
        for (int c = 0; c < channelCount; ++c) {
            const double value = double(sample[std::size_t(c)]) / (c == kOpacity ? 1.0 : unit_);
            tileSums[number][std::size_t(c)] += toFixed(value, faults);
        }
    });
    forEachPixel(guide_.tiles, tile, [&](std::size_t pixel, std::size_t number) {
        for (int c = 0; c < channelCount; ++c) {
            const std::size_t at = pixel * std::size_t(channelCount) + std::size_t(c);
            const Int128 sum = tileSums[number][std::size_t(c)];
            if (cut)
                cut->sums[at] += sum;
            else {
                sums.sums[at] += sum;
                sums.squares[at] += squareOfBlockMean(sum, settings_.blockBits);
            }
        }
    });
    return faults;
}

bool PathTracer::advance(ReferenceState& state, Clock::time_point deadline, const std::atomic<bool>* stop) const
{
    const Clock::time_point begun = Clock::now();
    const std::uint32_t segments = segmentCount(state.target, settings_.blockBits);
    const auto halted = [&] { return (stop && stop->load(std::memory_order_relaxed)) || Clock::now() >= deadline; };
    std::mutex reportMutex;

    // All pixels see one block before any sees the next, so that an interrupted picture is evenly converged.
    const std::uint32_t least = state.tileBlocks.empty() ? segments : *std::min_element(state.tileBlocks.begin(), state.tileBlocks.end());
    for (std::uint32_t number = least; number < segments && !halted(); ++number) {
        const Segment segment = segmentOf(state.target, number, settings_.blockBits);
        const bool whole = segment.last - segment.first == state.sums.blockSize();
        PartialBlock* cut = nullptr;
        for (PartialBlock& partial : state.sums.partial)
            if (!whole && partial.block == segment.block) cut = &partial;

        parallelFor(state.tileBlocks.size(), 1, [&](std::size_t tile, std::size_t) {
            if (state.tileBlocks[tile] != number || halted()) return;
            Tracer tracer(embree_, lights_);
            const SampleFaults faults = addTile(tracer, state.sums, cut, tile, segment);
            state.tileBlocks[tile] = number + 1;
            const std::lock_guard lock(reportMutex);
            state.rays += tracer.counts;
            state.faults += faults;
        });
    }
    state.seconds += std::chrono::duration<double>(Clock::now() - begun).count();
    const bool done = std::all_of(state.tileBlocks.begin(), state.tileBlocks.end(), [&](std::uint32_t blocks) { return blocks == segments; });
    if (done && !state.finished() && state.target.size() > 0) {
        state.sums.ranges = {state.target};
        if (!state.base.ranges.empty()) mergeSums(state.sums, state.base, "samples");
        state.base = {};
    }
    return done;
}

double PathTracer::progress(const ReferenceState& state)
{
    const std::uint32_t segments = segmentCount(state.target, state.sums.blockBits);
    if (segments == 0 || state.tileBlocks.empty()) return 1.0;
    std::uint64_t done = 0;
    for (const std::uint32_t blocks : state.tileBlocks) done += blocks;
    return double(done) / (double(segments) * double(state.tileBlocks.size()));
}

BareLoop PathTracer::timeBareLoop(std::size_t stride) const
{
    std::vector<std::vector<RecordedRay>> tiles((guide_.tiles.count() + stride - 1) / stride);
    parallelFor(tiles.size(), 1, [&](std::size_t number, std::size_t) {
        Tracer tracer(embree_, lights_, &tiles[number]);
        TileSampler sampler(*this, number * stride, {0, settings_.blockBits, keyOf(settings_.seed)});
        sampler.drawSamples(tracer, 0, 1u << settings_.blockBits, [](std::size_t, std::size_t, const Sample&) {});
    });

    BareLoop result;
    for (const auto& rays : tiles) result.rays += rays.size();
    std::atomic<std::uint64_t> hits = 0;  // uses the answers, so that no query is dropped
    const Clock::time_point begun = Clock::now();
    parallelFor(tiles.size(), 1, [&](std::size_t number, std::size_t) {
        std::uint64_t here = 0;
        for (const RecordedRay& recorded : tiles[number])
            here += recorded.shadow ? embree_.occluded(recorded.ray) : embree_.closestHit(recorded.ray).has_value();
        hits += here;
    });
    result.seconds = std::chrono::duration<double>(Clock::now() - begun).count();
    return result;
}

ReferenceFrame PathTracer::resolve(const SampleSums& sums) const
{
    Image<Vec3> albedo(settings_.width, settings_.height);
    for (std::size_t i = 0; i < albedo.texels.size(); ++i) albedo.texels[i] = primary_.surface.texels[i].albedo;
    return resolveFrame(sums, unit_, primary_.direct, albedo);
}

ReferenceFrame renderReference(const Scene& scene, const Camera& camera, const ReferenceSettings& settings, std::uint64_t samples)
{
    const PathTracer tracer(scene, camera, settings);
    ReferenceState state = tracer.start({0, samples});
    tracer.advance(state, Clock::time_point::max());
    return tracer.resolve(state.sums);
}

}  // namespace lrsm
