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
    double begin, end, middle, width;  ///< width: of the tap, voxels
};

/// F at distance t: linear within a segment, 0 at the apex, constant behind the last.
double opticalDepth(const std::vector<Segment>& segments, const std::vector<double>& atEnd, double t)
{
    double before = 0.0;
    for (std::size_t i = 0; i < atEnd.size(); ++i) {
        if (t <= segments[i].end)
            return t <= segments[i].begin ? before : before + (atEnd[i] - before) * (t - segments[i].begin) / (segments[i].end - segments[i].begin);
        before = atEnd[i];
    }
    return before;
}

/// What one light's layers emit within a segment.
DVec3 emission(const ConeWorld& world, const Lrsm& lrsm, const ConeRay& ray, const DVec3& pWorld, const std::vector<Segment>& segments,
               const std::vector<double>& depths, double& toJump)
{
    const ConeSettings& settings = world.settings;
    const Segment& s = segments[depths.size() - 1];
    const double voxel = double(world.opacity.base.grid.voxelSize), tap = s.width * voxel, step = (s.end - s.begin) * voxel;
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

        const double slant = std::max(facing / glm::length(n), double(settings.gather.emitterSlantCap));
        const double delay = (double(settings.gather.emitterDelayTaps) * s.width + double(settings.gather.emitterDelayVoxels)) / slant;
        sum += transmittance(opticalDepth(segments, depths, s.middle - delay), settings) * w * t.radiance;
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
    double clear = 1.0;
    for (const MarchStep& step : schedule.steps) {
        const double t = double(step.middle), diameter = double(step.diameter);
        result.toJump = std::min(result.toJump, std::abs(t - diameter - exit));
        if (t - diameter > exit) break;
        const DVec3 offset = DVec3(ray.direction) * t + DVec3(ray.receiverNormal) * (double(settings.march.push) * 0.5 * diameter);
        const DVec3 sampled = field(DVec3(ray.originVoxels) + offset, double(step.level));
        const double alpha = stepOpacity(densityOf(world, sampled, DVec3(ray.direction)), double(step.end) - double(step.begin), settings);
        const DVec3 pWorld = DVec3(ray.originWorld) + offset * voxel;
        const DVec3 back = DVec3(ray.originWorld) - pWorld, toReceiver = settings.march.push == 0.0f ? -DVec3(ray.direction) : glm::normalize(back);
        for (const Lrsm& lrsm : world.lrsms) {
            const Outgoing out = algorithm1(lrsm, project(lrsm.projection, pWorld), {Vec3(pWorld), float(0.5 * diameter * voxel), Vec3(toReceiver)}, settings);
            result.toJump = std::min(result.toJump, out.toJump);
            result.radiance += clear * alpha * out.radiance;
        }
        clear *= 1.0 - alpha;
        result.toJump = std::min(result.toJump, std::abs(clear - double(settings.march.transmittanceCutoff)));
        if (clear < double(settings.march.transmittanceCutoff)) break;
    }
    result.opacity = 1.0 - clear;
    return result;
}

March marchSlab(const ConeWorld& world, const OpacityField& field, const ConeRay& ray, const MarchSchedule& schedule)
{
    const ConeSettings& settings = world.settings;
    const double voxel = double(world.opacity.base.grid.voxelSize), exit = exitOf(ray, world.opacity.base.grid.resolution);
    March result;
    std::vector<Segment> segments;
    std::vector<double> depths;
    double depth = 0.0;
    for (const MarchStep& step : schedule.steps) {
        segments.push_back({double(step.begin), double(step.end), 0.5 * (double(step.begin) + double(step.end)), double(step.tapWidth)});
        const Segment& s = segments.back();
        result.toJump = std::min(result.toJump, std::abs(s.begin - 3.0 * s.width - exit));
        if (s.begin - 3.0 * s.width > exit) break;

        const DVec3 offset = DVec3(ray.direction) * s.middle;
        double density = 0.0;
        if (step.begin > 0.0f || settings.march.startVoxels == 0.0f) {  // the first segment lies in the receiver's own voxels
            density = densityOf(world, field(DVec3(ray.originVoxels) + offset, double(step.level)), DVec3(ray.direction));
        }
        depth += density * (s.end - s.begin);
        depths.push_back(depth);
        for (const Lrsm& lrsm : world.lrsms)
            result.radiance += emission(world, lrsm, ray, DVec3(ray.originWorld) + offset * voxel, segments, depths, result.toJump);

        const double left = transmittance(opticalDepth(segments, depths, double(step.settled)), settings);
        result.toJump = std::min(result.toJump, std::abs(left - double(settings.march.transmittanceCutoff)));
        if (left < double(settings.march.transmittanceCutoff)) break;
    }
    result.opacity = 1.0 - transmittance(depth, settings);
    return result;
}

}  // namespace lrsm::twin
