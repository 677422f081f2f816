#include "apps/validate/ladder/segment_emission.h"

namespace lrsm {

SegmentEmission segmentEmission(const ConeWorld& world, std::span<const Rsm* const> rsms, Tracer& tracer, const RecordedSample& sample, int side,
                                const SampleKey& key)
{
    const MarchStep& step = sample.steps[sample.step];
    const float voxelSize = world.opacity.base.grid.voxelSize;
    SegmentEmission emission;
    const Beam beam{sample.ray.originWorld + sample.ray.direction * (step.begin * voxelSize), sample.ray.direction, 0.5f * step.diameter * voxelSize,
                    (step.end - step.begin) * voxelSize};
    const Vec3 met = integrateBeam(tracer, beam, side, key);
    emission.rays = double(met.x + met.y + met.z) / 3.0;

    const CoveredBeam covered{glm::dvec3(beam.begin) + 0.5 * double(beam.length) * glm::dvec3(beam.direction), glm::dvec3(beam.direction), double(beam.radius),
                              double(beam.length)};
    for (const Rsm* rsm : rsms) {
        const glm::dvec3 rgb = beamEmission(*rsm, covered);
        emission.texels += (rgb.x + rgb.y + rgb.z) / 3.0;
    }

    // The march's own function, nothing in front of the segment.
    MarchSchedule schedule{.tanHalf = sample.tanHalf, .steps = {step}, .edges = {step.begin, step.end}};
    schedule.steps[0].firstTap = 0;
    schedule.steps[0].taps = 1;
    const MarchScratch clear{{Vec3(0.0f), Vec3(0.0f)}};
    ConeCounts counts;
    NoRecorder recorder;
    Vec3 shipped(0.0f);
    for (int light = 0; light < static_cast<int>(world.lrsms.size()); ++light)
        shipped += slabEmission(world, light, sample.ray, sample.sphere.centre, schedule, 0, {.width = step.tapWidth}, clear, counts, recorder);
    emission.segment = double(shipped.x + shipped.y + shipped.z) / 3.0;
    return emission;
}

}  // namespace lrsm
