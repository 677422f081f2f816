#include "apps/validate/split.h"

#include "conetrace/frame/cones.h"
#include "conetrace/frame/irradiance_filter.h"
#include "conetrace/lrsm/gather.h"
#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "core/bvh/embree_scene.h"
#include "reference/integrator.h"
#include "voxel/voxel_ray.h"

namespace lrsm {
namespace {

constexpr float kVoxelDiagonal = 1.7320508f;

struct GatherDirection {
    Vec3 local{0.0f};     ///< tangent frame
    float weight = 0.0f;  ///< all weights sum to 1
};

std::vector<GatherDirection> gatherDirections(int strata)
{
    ConeSettings dense;
    dense.march.estimator = Estimator::slab;
    dense.set.rotation = Rotation::strata;
    dense.set.count = strata;
    const ConeSet set = makeConeSet(dense);

    std::vector<GatherDirection> directions;
    for (int rotation = 0; rotation < kRotations; ++rotation)
        for (const ConeRing& ring : set.rings)
            for (const Vec3& local : set.rotation(rotation).subspan(std::size_t(ring.first), std::size_t(ring.count)))
                directions.push_back({local, ring.weight / kRotations});
    return directions;
}

/// Everything that a ray reads.
struct SplitWorld {
    const OpacityPyramid& opacity;
    const EmbreeScene& embree;
    const ConeSettings& cones;
    Visibility visibility;
    std::vector<LightSampler> lights;
    std::vector<GatherDirection> directions;
};

struct PixelLight {
    Vec3 irradiance{0.0f};
    float opacity = 0.0f;
};

struct Arriving {
    Vec3 radiance{0.0f};
    bool hit = false;
};

Vec3 exactRadiance(Tracer& tracer, const Ray& ray, bool& hit)
{
    PathRandom unused({}, {});  // a single bounce draws nothing
    return incomingRadiance(tracer, {ray}, {}, Transport::single, unused, hit);
}

/// The radiance of the first surface along an exact ray.
Arriving alongExactRay(Tracer& tracer, const Surface& surface, const Vec3& direction)
{
    Arriving arriving;
    arriving.radiance = exactRadiance(tracer, rayFrom(tracer, surface, direction, RayKind::bounce), arriving.hit);
    return arriving;
}

/// The exact radiance of what lies in, or next to, the first occupied voxels along the ray.
Arriving alongVoxelRay(const SplitWorld& world, Tracer& tracer, const Surface& surface, const Vec3& direction)
{
    const VoxelGrid& grid = world.opacity.base.grid;
    const Vec3 n = glm::abs(surface.geometricNormal);
    const float offset = world.cones.march.normalOffsetVoxels * (n.x + n.y + n.z) * grid.voxelSize;
    const Vec3 origin = surface.position + surface.geometricNormal * offset;
    const std::optional<VoxelRun> run = firstOccupied(world.opacity, grid.voxelsFromWorld(origin), direction, world.cones.march.startVoxels);
    if (!run) return {};

    const float tNear = std::max(0.0f, run->enter - kVoxelDiagonal) * grid.voxelSize, tFar = (run->leave + kVoxelDiagonal) * grid.voxelSize;
    bool surfaceInReach = false;
    return {exactRadiance(tracer, {origin, direction, tNear, tFar, RayKind::bounce}, surfaceInReach), true};
}

PixelLight gatherPixel(const SplitWorld& world, Tracer& tracer, const Surface& surface)
{
    const Mat3 basis = basisFromNormal(surface.normal);
    PixelLight sum;
    for (const GatherDirection& sample : world.directions) {
        const Vec3 direction = basis * sample.local;
        Arriving arriving{Vec3(0.0f), true};  // below the horizon: the surface itself is in the way
        if (glm::dot(surface.geometricNormal, direction) > 0.0f)
            arriving = world.visibility == Visibility::rays ? alongExactRay(tracer, surface, direction) : alongVoxelRay(world, tracer, surface, direction);
        sum.irradiance += (kPi * sample.weight) * arriving.radiance;
        sum.opacity += arriving.hit ? sample.weight : 0.0f;
    }
    return sum;
}

Gathered gatherRays(const GBuffer& gbuffer, const SplitWorld& world)
{
    Gathered gathered;
    gathered.irradiance = Image<Vec3>(gbuffer.width, gbuffer.height);
    gathered.opacity = Image<float>(gbuffer.width, gbuffer.height);
    parallelFor(std::size_t(gbuffer.height), 1, [&](std::size_t begin, std::size_t end) {
        Tracer tracer(world.embree, world.lights);
        for (std::size_t pixel = begin * std::size_t(gbuffer.width); pixel < end * std::size_t(gbuffer.width); ++pixel) {
            if (!gbuffer.covered(pixel)) continue;
            Surface surface;
            surface.position = gbuffer.position.texels[pixel];
            surface.geometricNormal = gbuffer.geometricNormal.texels[pixel];
            surface.normal = gbuffer.normal.texels[pixel];
            const PixelLight light = gatherPixel(world, tracer, surface);
            gathered.irradiance.texels[pixel] = light.irradiance;
            gathered.opacity.texels[pixel] = light.opacity;
        }
    });
    return gathered;
}

Gathered gatherByRays(const GatherInput& input, Visibility visibility, int strata, PassLog& log)
{
    const ConeSettings& cones = input.settings.cones;
    const std::vector<Lrsm> lrsms = buildLrsms(input.rsms, input.settings.layers, log);
    Gathered byCones = log.run("cones", kPicturePass, [&] { return traceCones(input.gbuffer, input.camera, input.opacity, lrsms, input.needs, cones); });
    Gathered byRays = log.run("rays", kPicturePass, [&] {
        const EmbreeScene embree(input.scene);
        SplitWorld world{
            .opacity = input.opacity, .embree = embree, .cones = cones, .visibility = visibility, .lights = {}, .directions = gatherDirections(strata)};
        for (const Light& light : input.scene.lights) world.lights.emplace_back(light);
        return gatherRays(input.gbuffer, world);
    });
    byRays.specular = std::move(byCones.specular);
    if (cones.set.filter && !byCones.lobeWeight.empty())
        byRays.specular =
            log.run("specular filter", kPicturePass, [&] { return filterSpecular(byRays.specular, byCones.lobeWeight, input.gbuffer, input.gbuffer.height); });
    return byRays;
}

}  // namespace

GatherMethod exactRadianceMethod(Visibility visibility, int strata)
{
    if (visibility == Visibility::cones) throw InputError("--radiance exact", "cones hit no one surface; take visibility=rays or voxel-rays");
    return {.reads = {.bits = true, .mips = true},
            .gather = [visibility, strata](const GatherInput& input, PassLog& log) { return gatherByRays(input, visibility, strata, log); },
            .explain = {},
            .predict = {}};
}

}  // namespace lrsm
