#include "reference/path_trace.h"

#include "core/base/elementary.h"
#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "reference/directions.h"
#include "reference/integrator.h"
#include "reference/sample_layout.h"

#include <mutex>

namespace lrsm {
namespace {

constexpr std::size_t kChunkPixels = 256;

/// What the counter of a random draw is for: keeps the streams of one pixel apart.
enum Purpose : std::uint32_t { kDiffuseDirection = 0, kLobeDirection = 1, kConeDirection = 2, kDiffusePath = 16, kLobePath = 17, kConePath = 18 };

using Clock = std::chrono::steady_clock;
using Sample = std::array<float, kConeChannels>;

/// Everything that the samples of one pixel in one block share.
struct PixelBlock {
    std::uint32_t pixel;
    std::uint64_t block;
    int blockBits;
    std::array<std::uint32_t, 2> key;

    SobolBlock points(Purpose purpose) const { return {philox({pixel, std::uint32_t(block), std::uint32_t(block >> 32), purpose}, key), blockBits}; }
    PathRandom path(Purpose purpose, std::uint32_t index) const
    {
        // The low 24 bits of the last word count the path's vertices.
        return {{pixel, std::uint32_t(block << blockBits) | index, std::uint32_t(block >> (32 - blockBits)), std::uint32_t(purpose) << 24}, key};
    }
};

/// Radiance from one direction off the primary surface, 0 below its geometric horizon: the surface itself is in the way there.
Vec3 gather(Tracer& tracer, const Surface& surface, const Vec3& direction, Transport transport, PathRandom random, bool& hit)
{
    hit = true;
    if (!(glm::dot(surface.geometricNormal, direction) > 0.0f)) return Vec3(0.0f);
    return incomingRadiance(tracer, rayFrom(tracer, surface, direction, RayKind::bounce), transport, random, hit);
}

void store(Sample& sample, int channel, const Vec3& value)
{
    for (int c = 0; c < 3; ++c) sample[std::size_t(channel + c)] = value[c];
}

class PixelSampler {
  public:
    PixelSampler(const PixelBlock& block, const ReferenceSettings& settings, const Surface& surface, const Vec3& toEye, int channels)
        : block_(block),
          transport_(settings.transport),
          surface_(surface),
          toEye_(toEye),
          channels_(channels),
          diffuse_(block.points(kDiffuseDirection)),
          lobe_(block.points(kLobeDirection)),
          cone_(block.points(kConeDirection)),
          cosHalf_(float(sinCos(0.5 * double(settings.specularApertureDegrees) * 3.14159265358979323846 / 180.0).cos))
    {
    }

    Sample draw(Tracer& tracer, std::uint32_t index) const
    {
        Sample sample{};
        bool hit = false;
        const Vec3 direction = cosineDirection(surface_.normal, diffuse_.point(index));
        store(sample, kIrradiance, kPi * gather(tracer, surface_, direction, transport_, block_.path(kDiffusePath, index), hit));
        sample[kOpacity] = hit ? 1.0f : 0.0f;
        if (channels_ > kDiffuseChannels && surface_.specularColor != Vec3(0.0f)) drawSpecular(tracer, index, sample);
        return sample;
    }

  private:
    void drawSpecular(Tracer& tracer, std::uint32_t index, Sample& sample) const
    {
        bool hit = false;
        const Vec3 direction = lobeDirection(surface_, toEye_, lobe_.point(index));
        const Vec3 reflected = evaluateSpecular(surface_, direction, toEye_);
        if (reflected != Vec3(0.0f))
            store(sample, kLobe,
                  reflected / lobeDensity(surface_, toEye_, direction) * gather(tracer, surface_, direction, transport_, block_.path(kLobePath, index), hit));
        if (channels_ < kConeChannels) return;
        const Vec3 inCone = coneDirection(mirrored(toEye_, surface_.normal), cosHalf_, cone_.point(index));
        store(sample, kCone, gather(tracer, surface_, inCone, transport_, block_.path(kConePath, index), hit));
    }

    PixelBlock block_;
    Transport transport_;
    const Surface& surface_;
    Vec3 toEye_;
    int channels_;
    SobolBlock diffuse_, lobe_, cone_;
    float cosHalf_;
};

/// The part of block `block` that lies in the range.
struct Segment {
    std::uint64_t block;
    std::uint32_t first, last;
};
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

std::size_t chunkCount(std::size_t pixels)
{
    return (pixels + kChunkPixels - 1) / kChunkPixels;
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
    const Vec3 extent = scene.bounds.empty() ? Vec3(1.0f) : scene.bounds.extent();
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
    parallelFor(primary_.covered.texels.size(), kChunkPixels, [&](std::size_t begin, std::size_t end) {
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
    state.chunkBlocks.assign(chunkCount(pixels), 0);
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
    next.invalidSamples = state.invalidSamples;
    next.seconds = state.seconds;
    state = std::move(next);
}

bool PathTracer::advance(ReferenceState& state, Clock::time_point deadline, const std::atomic<bool>* stop) const
{
    const Clock::time_point begun = Clock::now();
    const std::uint32_t segments = segmentCount(state.target, settings_.blockBits);
    const int channelCount = channels();
    const auto halted = [&] { return (stop && stop->load(std::memory_order_relaxed)) || Clock::now() >= deadline; };
    std::mutex reportMutex;

    // All pixels see one block before any sees the next, so that an interrupted picture is evenly converged.
    const std::uint32_t least = state.chunkBlocks.empty() ? segments : *std::min_element(state.chunkBlocks.begin(), state.chunkBlocks.end());
    for (std::uint32_t number = least; number < segments && !halted(); ++number) {
        const Segment segment = segmentOf(state.target, number, settings_.blockBits);
        const bool whole = segment.last - segment.first == state.sums.blockSize();
        PartialBlock* cut = nullptr;
        for (PartialBlock& partial : state.sums.partial)
            if (!whole && partial.block == segment.block) cut = &partial;

        parallelFor(state.chunkBlocks.size(), 1, [&](std::size_t chunk, std::size_t) {
            if (state.chunkBlocks[chunk] != number || halted()) return;
            Tracer tracer(embree_, lights_);
            std::uint64_t invalid = 0;
            const std::size_t end = std::min((chunk + 1) * kChunkPixels, primary_.covered.texels.size());
            for (std::size_t i = chunk * kChunkPixels; i < end; ++i) {
                if (!primary_.covered.texels[i]) continue;
                const PixelBlock block{std::uint32_t(i), segment.block, settings_.blockBits, keyOf(settings_.seed)};
                const PixelSampler sampler(block, settings_, primary_.surface.texels[i], primary_.toEye.texels[i], channelCount);
                std::array<Int128, kConeChannels> sum{};
                for (std::uint32_t index = segment.first; index < segment.last; ++index) {
                    const Sample sample = sampler.draw(tracer, index);
                    for (int c = 0; c < channelCount; ++c) {
                        const double value = double(sample[std::size_t(c)]) / (c == kOpacity ? 1.0 : unit_);
                        if (std::isfinite(value))
                            sum[std::size_t(c)] += toFixed(value);
                        else
                            ++invalid;
                    }
                }
                for (int c = 0; c < channelCount; ++c) {
                    const std::size_t at = i * std::size_t(channelCount) + std::size_t(c);
                    if (whole) {
                        state.sums.sums[at] += sum[std::size_t(c)];
                        state.sums.squares[at] += squareOfBlockMean(sum[std::size_t(c)], settings_.blockBits);
                    } else {
                        cut->sums[at] += sum[std::size_t(c)];
                    }
                }
            }
            state.chunkBlocks[chunk] = number + 1;
            const std::lock_guard lock(reportMutex);
            state.rays.bounce += tracer.counts.bounce;
            state.rays.light += tracer.counts.light;
            state.invalidSamples += invalid;
        });
    }
    state.seconds += std::chrono::duration<double>(Clock::now() - begun).count();
    const bool done = std::all_of(state.chunkBlocks.begin(), state.chunkBlocks.end(), [&](std::uint32_t blocks) { return blocks == segments; });
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
    if (segments == 0 || state.chunkBlocks.empty()) return 1.0;
    std::uint64_t done = 0;
    for (const std::uint32_t blocks : state.chunkBlocks) done += blocks;
    return double(done) / (double(segments) * double(state.chunkBlocks.size()));
}

BareLoop PathTracer::timeBareLoop(std::size_t stride) const
{
    const std::size_t pixels = primary_.covered.texels.size();
    std::vector<std::vector<RecordedRay>> chunks((chunkCount(pixels) + stride - 1) / stride);
    parallelFor(chunks.size(), 1, [&](std::size_t number, std::size_t) {
        Tracer tracer(embree_, lights_, &chunks[number]);
        const std::size_t first = number * stride * kChunkPixels;
        for (std::size_t i = first; i < std::min(first + kChunkPixels, pixels); ++i) {
            if (!primary_.covered.texels[i]) continue;
            const PixelSampler sampler({std::uint32_t(i), 0, settings_.blockBits, keyOf(settings_.seed)}, settings_, primary_.surface.texels[i],
                                       primary_.toEye.texels[i], channels());
            for (std::uint32_t index = 0; index < (1u << settings_.blockBits); ++index) sampler.draw(tracer, index);
        }
    });

    BareLoop result;
    for (const auto& rays : chunks) result.rays += rays.size();
    std::atomic<std::uint64_t> hits = 0;  // uses the answers, so that no query is dropped
    const Clock::time_point begun = Clock::now();
    parallelFor(chunks.size(), 1, [&](std::size_t number, std::size_t) {
        std::uint64_t here = 0;
        for (const RecordedRay& recorded : chunks[number])
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
