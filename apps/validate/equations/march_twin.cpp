#include "apps/validate/equations/march_twin.h"

#include "apps/validate/equations/oracle.h"

namespace lrsm::twin {
namespace {

double phi(double x)
{
    return static_cast<double>(oracle::phi(static_cast<long double>(x)));
}

/// Where a ray leaves the grid's cube.
double exitOf(const ConeRay& ray, int resolution)
{
    double exit = 1e30;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = double(ray.direction[axis]), o = double(ray.originVoxels[axis]);
        if (d > 0.0) exit = std::min(exit, (resolution - o) / d);
        if (d < 0.0) exit = std::min(exit, o / -d);
    }
    return std::max(exit, 0.0);
}

double densityOf(const ConeWorld& world, const DVec3& sample, const DVec3& direction)
{
    if (world.opacity.axes == OpacityAxes::isotropic) return sample.x;
    return std::abs(direction.x) * sample.x + std::abs(direction.y) * sample.y + std::abs(direction.z) * sample.z;
}

struct Segment {
    double begin, end, middle;
    double width;      ///< of its taps, voxels
    double footprint;  ///< in the light's map, voxels
};

/// Coverage by axis along the cone: density of each stretch between two edges.
struct Stretch {
    double begin, end;
    DVec3 density;
};

/// F at distance t: nothing before the first stretch, constant behind the last.
DVec3 opticalDepth(const std::vector<Stretch>& stretches, double t)
{
    DVec3 depth(0.0);
    for (const Stretch& s : stretches) depth += s.density * std::min(std::max(t - s.begin, 0.0), s.end - s.begin);
    return depth;
}
double total(const DVec3& v)
{
    return v.x + v.y + v.z;
}

/// What stands in front of a surface crossed at t: docs/pipeline.md, "in front of the emitter".
double inFront(const ConeWorld& world, const std::vector<Stretch>& stretches, const Segment& s, const DVec3& direction, const DVec3& normal, double crossing)
{
    const LrsmGatherSettings& gather = world.settings.gather;
    const double cosine = -glm::dot(normal, direction);
    const double delay = (double(gather.emitterDelayTaps) * s.width + double(gather.emitterDelayVoxels)) / std::max(cosine, double(gather.emitterSlantCap));
    const DVec3 now = opticalDepth(stretches, crossing - 1.5 * s.width), before = opticalDepth(stretches, crossing - delay);
    const double rim = 1.0 / std::min(s.width, 8.0), way = 1.0 / std::max(cosine, 0.05);
    const bool isotropic = world.opacity.axes == OpacityAxes::isotropic;
    double front = 0.0, crossed = 0.0;
    for (int axis = 0; axis < 3; ++axis) crossed += (std::abs(normal[axis]) + rim) * way;
    for (int axis = 0; axis < (isotropic ? 1 : 3); ++axis) {
        const double own = isotropic ? crossed : std::abs(direction[axis]) * (std::abs(normal[axis]) + rim) * way;
        front += now[axis] - std::min(std::max(0.0, now[axis] - before[axis]), own);
    }
    return front;
}

/// What one light's layers emit within a segment.
DVec3 emission(const ConeWorld& world, const Lrsm& lrsm, const ConeRay& ray, const DVec3& pWorld, const Segment& s, const std::vector<Stretch>& stretches,
               double& toJump)
{
    const ConeSettings& settings = world.settings;
    const double voxel = double(world.opacity.base.grid.voxelSize), tap = s.footprint * voxel, step = (s.end - s.begin) * voxel;
    const Projected p = project(lrsm.projection, pWorld);
    if (!p.valid) return DVec3(0.0);
    const double range = double(lrsm.projection.depthFar) - double(lrsm.projection.depthNear), reach = (0.5 * step + 1.5 * tap) / range;
    DVec3 toLight = -DVec3(lrsm.projection.forward);
    if (lrsm.projection.type != LightType::directional) toLight = glm::normalize(DVec3(lrsm.projection.position) - pWorld);
    const double lod = level(tap, p.texelSize, double(settings.gather.rsmLevelBias), double(settings.gather.rsmMinLevel));

    DVec3 sum(0.0);
    for (int layer = 0; layer < lrsm.layers(); ++layer) {
        const LayerRange& bounds = lrsm.ranges[std::size_t(layer)];
        const double gap = std::min(p.depth + reach - double(bounds.depthMin), double(bounds.depthMax) - (p.depth - reach));
        toJump = std::min(toJump, std::abs(gap));
        if (gap < 0.0) continue;
        const Filtered t = sample(lrsm, layer, p.u, p.v, lod);
        if (!(t.depthAlpha > 0.0 && t.normalAlpha > 0.0)) continue;
        const DVec3 n = t.normal / t.normalAlpha;
        const double facing = -glm::dot(n, DVec3(ray.direction));
        toJump = std::min(toJump, std::abs(facing));
        if (!(facing > 0.0)) continue;
        const double rate = facing / std::max(glm::dot(n, toLight), 0.001);

        const double mean = t.depth / t.depthAlpha, variance = std::max(0.0, t.depthSquared / t.depthAlpha - mean * mean);
        const double width = (double(bounds.depthMax) - double(bounds.depthMin)) * range;
        const double sigma = std::sqrt(variance * width * width + tap * tap / 4.0);
        const double ahead = p.depth * range - (double(bounds.depthMin) * range + mean * width), half = 0.5 * rate * step;
        const double w = phi((ahead + half) / sigma) - phi((ahead - half) / sigma);

        const double crossing = std::min(std::max(s.middle - ahead / (rate * voxel), s.begin - s.width), s.end + s.width);
        const double front = inFront(world, stretches, s, DVec3(ray.direction), n / glm::length(n), crossing);
        sum += transmittance(front, settings) * w * t.radiance;
    }
    return sum;
}

}  // namespace

DVec3 OpacityField::operator()(const DVec3& p, double level) const
{
    const double waves = 0.6 + 0.4 * std::sin(0.31 * p.x + 0.17 * p.y - 0.23 * p.z);
    return amplitude * (waves * (1.0 + 0.2 * level));
}

double stepOpacity(double density, double stepLength, const ConeSettings& settings)
{
    const double a = std::min(std::max(density, 0.0), 1.0);
    if (settings.march.opacity == OpacityModel::none) return a;
    return 1.0 - std::pow(1.0 - a, double(settings.march.densityK) * stepLength);
}

double transmittance(double depth, const ConeSettings& settings)
{
    if (settings.march.transmittance == TransmittanceModel::linear) return std::max(0.0, 1.0 - depth);
    return std::exp(-double(settings.march.densityK) * depth);
}

March marchPaper(const ConeWorld& world, const OpacityField& field, const ConeRay& ray, const MarchSchedule& schedule)
{
    const ConeSettings& settings = world.settings;
    const double voxel = double(world.opacity.base.grid.voxelSize), exit = exitOf(ray, world.opacity.base.grid.resolution);
    March result;
    FrontToBack sum;
    for (const MarchStep& step : schedule.steps) {
        const double t = double(step.middle), diameter = double(step.diameter);
        result.toJump = std::min(result.toJump, std::abs(t - diameter - exit));
        if (t - diameter > exit) break;
        const DVec3 offset = DVec3(ray.direction) * t + DVec3(ray.receiverNormal) * (double(settings.march.push) * 0.5 * diameter);
        const DVec3 sampled = field(DVec3(ray.originVoxels) + offset, double(step.level));
        const double alpha = stepOpacity(densityOf(world, sampled, DVec3(ray.direction)), double(step.end) - double(step.begin), settings);
        const DVec3 pWorld = DVec3(ray.originWorld) + offset * voxel;
        const DVec3 back = DVec3(ray.originWorld) - pWorld, toReceiver = settings.march.push == 0.0f ? -DVec3(ray.direction) : glm::normalize(back);
        DVec3 outgoing(0.0);
        for (const Lrsm& lrsm : world.lrsms) {
            const Outgoing out = algorithm1(lrsm, project(lrsm.projection, pWorld), {Vec3(pWorld), float(0.5 * diameter * voxel), Vec3(toReceiver)}, settings);
            result.toJump = std::min(result.toJump, out.toJump);
            outgoing += out.radiance;
        }
        sum.add(alpha, outgoing);
        result.toJump = std::min(result.toJump, std::abs(sum.clear - double(settings.march.transmittanceCutoff)));
        if (sum.clear < double(settings.march.transmittanceCutoff)) break;
    }
    result.radiance = sum.radiance;
    result.opacity = 1.0 - sum.clear;
    return result;
}

March marchSlab(const ConeWorld& world, const OpacityField& field, const ConeRay& ray, const MarchSchedule& schedule)
{
    const ConeSettings& settings = world.settings;
    const double voxel = double(world.opacity.base.grid.voxelSize), exit = exitOf(ray, world.opacity.base.grid.resolution);
    March result;
    std::vector<Stretch> stretches;
    for (const MarchStep& step : schedule.steps) {
        const double begin = double(step.begin), end = double(step.end), diameter = double(step.diameter);
        const Segment s{.begin = begin, .end = end, .middle = 0.5 * (begin + end), .width = double(step.tapWidth), .footprint = std::max(0.5, 0.13 * diameter)};
        result.toJump = std::min(result.toJump, std::abs(s.begin - 1.5 * s.width - exit));
        if (s.begin - 1.5 * s.width > exit) break;

        for (int k = 0; k < step.taps; ++k) {
            const double from = begin + (end - begin) * k / step.taps, to = begin + (end - begin) * (k + 1) / step.taps;
            DVec3 density(0.0);
            if (step.begin > 0.0f || settings.march.startVoxels == 0.0f) {  // the first segment lies in the receiver's own voxels
                density = field(DVec3(ray.originVoxels) + DVec3(ray.direction) * (0.5 * (from + to)), double(step.level));
                density = world.opacity.axes == OpacityAxes::isotropic ? DVec3(density.x, 0.0, 0.0) : glm::abs(DVec3(ray.direction)) * density;
            }
            stretches.push_back({from, to, density});
        }
        const DVec3 pWorld = DVec3(ray.originWorld) + DVec3(ray.direction) * (s.middle * voxel);
        for (const Lrsm& lrsm : world.lrsms) result.radiance += emission(world, lrsm, ray, pWorld, s, stretches, result.toJump);

        const double left = transmittance(total(opticalDepth(stretches, double(step.settled))), settings);
        result.toJump = std::min(result.toJump, std::abs(left - double(settings.march.transmittanceCutoff)));
        if (left < double(settings.march.transmittanceCutoff)) break;
    }
    result.opacity = 1.0 - transmittance(total(opticalDepth(stretches, 1e30)), settings);
    return result;
}

}  // namespace lrsm::twin
