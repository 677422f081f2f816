#include "apps/validate/ladder/cone_opacity.h"

#include "voxel/voxel_ray.h"

#include <cmath>

namespace lrsm {
namespace {

/// The level whose texels a box is added up from: fine ones where that is the same mean, the chain's own where its filter is another.
int texelLevel(const OpacityPyramid& pyramid, double level)
{
    const int whole = std::min(static_cast<int>(level), pyramid.levels() - 1);
    if (pyramid.mipFilter != MipFilter::mean) return whole;
    if (pyramid.axes == OpacityAxes::isotropic) return std::max(0, whole - 2);
    return whole <= 3 ? whole : std::max(3, whole - 2);  // columns are counted in blocks of up to 8^3
}

struct AxisSpan {
    int begin = 0, end = 0;
    double low = 0.0, high = 0.0;
    double weight(int i) const { return std::max(0.0, std::min(high, i + 1.0) - std::max(low, double(i))) / (high - low); }
};

/// Eq. 1's transmittance behind a recorded step, its opacities from boxes.
double boxTransmittance(const ConeWorld& world, const RecordedSample& sample)
{
    const ConeSettings& settings = world.settings;
    const bool slab = settings.march.estimator == Estimator::slab;
    double transmittance = 1.0, depth = 0.0;
    for (int i = 0; i <= sample.step; ++i) {
        const MarchStep& step = sample.steps[i];
        const double length = double(step.end) - double(step.begin);
        const float push = slab ? 0.0f : settings.march.push * 0.5f * step.diameter;
        const Vec3 offset = sample.ray.direction * step.middle + sample.ray.receiverNormal * push;
        if (slab && !step.readVoxels) continue;
        double density = boxDensity(world.opacity, sample.ray.originVoxels + offset, double(step.level), sample.ray.direction);
        if (slab) {
            depth += density * length;
            continue;
        }
        const double a = std::min(density, 1.0);
        transmittance *= settings.march.opacity == OpacityModel::none ? 1.0 - a : std::pow(1.0 - a, double(settings.march.densityK) * length);
    }
    if (!slab) return transmittance;
    return settings.march.transmittance == TransmittanceModel::linear ? std::max(0.0, 1.0 - depth) : std::exp(-double(settings.march.densityK) * depth);
}

}  // namespace

double boxDensity(const OpacityPyramid& pyramid, const Vec3& pVoxels, double level, const Vec3& direction)
{
    const int lod = texelLevel(pyramid, level), last = pyramid.resolutionAt(lod) - 1;
    const double edge = std::exp2(level), texel = std::exp2(double(lod));
    AxisSpan span[3];
    for (int axis = 0; axis < 3; ++axis) {
        span[axis].low = (double(pVoxels[axis]) - 0.5 * edge) / texel;
        span[axis].high = (double(pVoxels[axis]) + 0.5 * edge) / texel;
        span[axis].begin = static_cast<int>(std::clamp(std::floor(span[axis].low), 0.0, last + 1.0));
        span[axis].end = static_cast<int>(std::clamp(std::ceil(span[axis].high), 0.0, last + 1.0));
    }
    const int channels = lod == 0 ? 1 : pyramid.channels();
    double sum[3] = {};
    for (int z = span[2].begin; z < span[2].end; ++z)
        for (int y = span[1].begin; y < span[1].end; ++y) {
            const double row = span[2].weight(z) * span[1].weight(y);
            for (int x = span[0].begin; x < span[0].end; ++x)
                for (int c = 0; c < channels; ++c) sum[c] += row * span[0].weight(x) * double(pyramid.value(lod, c, x, y, z));
        }
    if (channels == 1) sum[1] = sum[2] = sum[0];
    if (pyramid.axes == OpacityAxes::isotropic) return sum[0];
    return double(densityScale(pyramid, lod)) *
           (std::abs(double(direction.x)) * sum[0] + std::abs(double(direction.y)) * sum[1] + std::abs(double(direction.z)) * sum[2]);
}

ConeOpacity coneOpacity(const ConeWorld& world, const EmbreeScene& embree, const RecordedSample& sample, int side, const SampleKey& key)
{
    const float voxelSize = world.opacity.base.grid.voxelSize, start = world.settings.march.startVoxels;
    const float reach = sample.steps[sample.step].end;
    int blocked = 0, blockedVoxels = 0;
    const std::vector<Vec3> bundle = coneBundle(sample.ray.direction, sample.tanHalf, side, key);
    for (const Vec3& direction : bundle) {
        blocked += embree.occluded({sample.ray.originWorld, direction, 0.0f, reach * voxelSize, RayKind::bounce}) ? 1 : 0;
        const auto run = firstOccupied(world.opacity, sample.ray.originVoxels, direction, start);
        blockedVoxels += run && run->enter < reach ? 1 : 0;
    }
    const auto count = double(bundle.size());
    return {blocked / count, blockedVoxels / count, 1.0 - boxTransmittance(world, sample), 1.0 - sample.after};
}

}  // namespace lrsm
