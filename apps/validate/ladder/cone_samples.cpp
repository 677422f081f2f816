#include "apps/validate/ladder/cone_samples.h"

#include "core/base/parallel.h"
#include "core/base/rng.h"
#include "voxel/sample_opacity.h"

#include <algorithm>

namespace lrsm {
namespace {

constexpr std::size_t kPixelsPerChunk = 1024;

bool earlier(const RecordedSample& a, const RecordedSample& b)
{
    return std::tie(a.y, a.x, a.cone, a.step) < std::tie(b.y, b.x, b.cone, b.step);
}

/// Ties of keys have odds of 2^-64 a pair; they are broken all the same.
bool smallerKey(const RecordedSample& a, const RecordedSample& b)
{
    return a.key != b.key ? a.key < b.key : earlier(a, b);
}

/// Listens to the march and keeps the lookups with the smallest keys.
class SampleRecorder {
  public:
    static constexpr bool active = true;

    SampleRecorder(std::size_t count, std::uint64_t seed, bool slab) : count_(count), seed_(seed), slab_(slab) {}

    void pixel(int x, int y, std::uint32_t index)
    {
        current_.x = x;
        current_.y = y;
        pixel_ = index;
        current_.cone = -1;
        current_.specular = false;
    }
    void specular() { current_.specular = true; }
    void cone(const ConeRay& ray, float weight, float tanHalf)
    {
        ++current_.cone;
        current_.step = -1;
        current_.ray = ray;
        current_.coneWeight = weight;
        current_.tanHalf = tanHalf;
        current_.after = 1.0;
    }
    void step(const StepRecord& record)
    {
        ++current_.step;
        current_.steps = record.step - current_.step;
        // The paper's march tells the transmittance in front of a step, slab's the one behind it.
        current_.before = slab_ ? current_.after : double(record.transmittance);
        current_.after = slab_ ? double(record.transmittance) : double(record.transmittance) * (1.0 - double(record.alpha));
    }
    void lookup(const ConeSample& sphere)
    {
        ++lookups;
        current_.key = lookupKey(pixel_, current_.cone, current_.step, seed_);
        current_.sphere = sphere;
        if (kept.size() == count_) {
            if (count_ == 0 || !smallerKey(current_, kept.front())) return;
            std::pop_heap(kept.begin(), kept.end(), smallerKey);
            kept.pop_back();
        }
        kept.push_back(current_);
        std::push_heap(kept.begin(), kept.end(), smallerKey);
    }
    void result(const ConeResult&) {}

    std::vector<RecordedSample> kept;  ///< heap, largest key first
    std::uint64_t lookups = 0;

  private:
    std::size_t count_;
    std::uint64_t seed_;
    bool slab_;
    std::uint32_t pixel_ = 0;
    RecordedSample current_;
};

template <Estimator estimator>
void recordPixel(const GBuffer& gbuffer, const Camera& camera, const ConeWorld& world, const GatherPlan& plan, int x, int y, MarchScratch& scratch,
                 SampleRecorder& recorder)
{
    const std::size_t index = gbuffer.position.index(x, y);
    if (!gbuffer.covered(index)) return;
    const GenericSampler sampler{world.opacity, world.settings.march.filterFraction};
    const Receiver receiver = receiverAt(gbuffer, world.opacity.base.grid, world.settings, x, y);
    ConeCounts counts;
    recorder.pixel(x, y, static_cast<std::uint32_t>(index));
    gatherDiffuse<estimator>(world, sampler, plan, receiver, scratch, counts, recorder);
    if (plan.specularSchedules.empty() || gbuffer.specularColor.texels[index] == Vec3(0.0f)) return;
    recorder.specular();
    const Vec3 toEye = glm::normalize(directionToEye(camera, receiver.position));
    const float roughness = gbuffer.roughness.texels[index];
    const LobeDirection lobe = plan.lobes.direction(receiver.normal, toEye, roughness, receiver.rotation);
    gatherSpecular<estimator>(world, sampler, plan, receiver, lobe.direction, roughness, scratch, counts, recorder);
}

}  // namespace

std::uint64_t lookupKey(std::uint32_t pixel, int cone, int step, std::uint64_t seed)
{
    const Philox4 words = philox({pixel, static_cast<std::uint32_t>(cone), static_cast<std::uint32_t>(step), 0x1add3u},
                                 {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
    return (std::uint64_t(words[0]) << 32) | words[1];
}

SampledFrame sampleGather(const GBuffer& gbuffer, const Camera& camera, const ConeWorld& world, const GatherPlan& plan, std::size_t count, std::uint64_t seed)
{
    const bool slab = world.settings.march.estimator == Estimator::slab;
    const std::size_t pixels = gbuffer.position.texels.size();
    std::vector<SampleRecorder> chunks((pixels + kPixelsPerChunk - 1) / kPixelsPerChunk, SampleRecorder(count, seed, slab));
    parallelFor(pixels, kPixelsPerChunk, [&](std::size_t begin, std::size_t end) {
        MarchScratch scratch;
        SampleRecorder& recorder = chunks[begin / kPixelsPerChunk];
        for (std::size_t i = begin; i < end; ++i) {
            const int x = static_cast<int>(i % std::size_t(gbuffer.width)), y = static_cast<int>(i / std::size_t(gbuffer.width));
            if (slab)
                recordPixel<Estimator::slab>(gbuffer, camera, world, plan, x, y, scratch, recorder);
            else
                recordPixel<Estimator::paper>(gbuffer, camera, world, plan, x, y, scratch, recorder);
        }
    });

    SampledFrame frame;
    for (const SampleRecorder& chunk : chunks) {
        frame.lookups += chunk.lookups;
        frame.samples.insert(frame.samples.end(), chunk.kept.begin(), chunk.kept.end());
    }
    std::sort(frame.samples.begin(), frame.samples.end(), smallerKey);
    frame.samples.resize(std::min(frame.samples.size(), count));
    std::sort(frame.samples.begin(), frame.samples.end(), earlier);
    return frame;
}

}  // namespace lrsm
