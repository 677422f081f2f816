#include "apps/validate/ladder/ladder.h"

#include "apps/validate/ladder/cone_opacity.h"
#include "apps/validate/ladder/ladder_statistics.h"
#include "apps/validate/ladder/light_footprint.h"
#include "apps/validate/ladder/segment_emission.h"
#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "voxel/voxelize.h"

#include <cmath>

namespace lrsm {
namespace {

using glm::dvec3;

/// One light at every stage of its way from texels to stored layers.
struct LadderLight {
    Rsm rsm;  ///< float32
    LayerModel model;
    Lrsm wide;  ///< float32
};

/// Appends what the frame has to `stored`.
LadderLight makeLight(const Scene& scene, const Light& light, const Requirements& needs, const Settings& settings, std::vector<Lrsm>& stored)
{
    RsmSettings wideRsm = settings.rsm;
    wideRsm.storage = Storage::float32;
    LayerSettings wideLayers = settings.layers;
    wideLayers.storage = Storage::float32;
    Rsm rsm = renderRsm(scene, light, needs, wideRsm);
    LayerModel model(rsm, settings.layers);
    Lrsm wide = buildLrsm(rsm, wideLayers);
    stored.push_back(buildLrsm(settings.rsm.storage == Storage::gpu ? renderRsm(scene, light, needs, settings.rsm) : rsm, settings.layers));
    return {std::move(rsm), std::move(model), std::move(wide)};
}

double meanOf(const dvec3& rgb)
{
    return (rgb.x + rgb.y + rgb.z) / 3.0;
}

/// The frame that is sampled, and what judges it.
class LadderWorld {
  public:
    LadderWorld(const Scene& scene, const Camera& camera, const Requirements& needs, const Settings& settings, const LadderOptions& options)
        : settings_(settings),
          options_(options),
          side_(std::max(2, static_cast<int>(std::ceil(std::sqrt(double(options.raysPerSample)))))),
          opacity_(buildPyramid(voxelize(scene, settings.voxel), settings.voxel)),
          embree_(scene),
          gbuffer_(renderGBuffer(scene, camera, needs, {options.width, options.height})),
          plan_(planGather(settings.cones, needs, settings.voxel.resolution)),
          phi_(settings.cones.gather.gaussian, settings.cones.gather.gaussianTableSize)
    {
        for (const Light& light : scene.lights) {
            samplers_.emplace_back(light);
            lights_.push_back(makeLight(scene, light, needs, settings, stored_));
        }
        for (const LadderLight& light : lights_) rsms_.push_back(&light.rsm);
    }

    SampledFrame draw(const Camera& camera) const
    {
        return sampleGather(gbuffer_, camera, world(), plan_, static_cast<std::size_t>(std::max(options_.samples, 0)), options_.seed);
    }

    LadderSample climb(const RecordedSample& recorded, Tracer& tracer) const
    {
        LadderSample sample = describe(recorded);
        const SampleKey key{static_cast<std::uint32_t>(gbuffer_.position.index(recorded.x, recorded.y)),
                            static_cast<std::uint32_t>(recorded.cone) * 0x20000u + static_cast<std::uint32_t>(recorded.step), options_.seed};
        climbRadiance(recorded, tracer, key, sample);
        const ConeOpacity opacity = coneOpacity(world(), embree_, recorded, side_, key);
        sample.opacity[int(VisibilityRung::rays)] = opacity.rays;
        sample.opacity[int(VisibilityRung::voxelRays)] = opacity.voxelRays;
        sample.opacity[int(VisibilityRung::boxMips)] = opacity.boxMips;
        sample.opacity[int(VisibilityRung::cone)] = opacity.cone;
        if (settings_.cones.march.estimator == Estimator::slab) {
            const SegmentEmission emission = segmentEmission(world(), rsms_, tracer, recorded, side_, key);
            sample.emission[int(EmissionRung::beam)] = emission.rays;
            sample.emission[int(EmissionRung::texels)] = emission.texels;
            sample.emission[int(EmissionRung::segment)] = emission.segment;
        }
        return sample;
    }

    Tracer tracer() const { return {embree_, samplers_}; }

  private:
    ConeWorld world() const { return {opacity_, stored_, settings_.cones, phi_}; }

    LadderSample describe(const RecordedSample& recorded) const
    {
        LadderSample sample;
        sample.x = recorded.x;
        sample.y = recorded.y;
        sample.cone = recorded.cone;
        sample.step = recorded.step;
        sample.centre = recorded.sphere.centre;
        sample.toReceiver = recorded.sphere.toReceiver;
        sample.radius = recorded.sphere.radius;
        sample.distance = recorded.steps[recorded.step].middle * opacity_.base.grid.voxelSize;
        sample.voxelLevel = double(recorded.steps[recorded.step].level);
        sample.weight = double(recorded.coneWeight) * (recorded.before - recorded.after);
        sample.emissionWeight = double(recorded.coneWeight) * recorded.before;
        return sample;
    }

    void climbRadiance(const RecordedSample& recorded, Tracer& tracer, const SampleKey& key, LadderSample& sample) const
    {
        const ConeSample& sphere = recorded.sphere;
        const auto rung = [&sample](RadianceRung r) -> double& { return sample.radiance[int(r)]; };
        const SurfaceIntegral truth = integrateSurface(tracer, sphere, side_, key);
        sample.hasSurface = truth.coverage > 0.0;
        sample.noise = truth.noise;
        rung(RadianceRung::eq2) = meanOf(dvec3(truth.radiance));

        const CoveredSphere covered{dvec3(sphere.centre), double(sphere.radius), dvec3(sphere.toReceiver)};
        const TermSettings terms = TermSettings::of(settings_.cones);
        ConeSettings exactFractions = settings_.cones;
        exactFractions.march.filterFraction = FilterFraction::exact;
        double brightest = -1.0;
        Vec3 shipped(0.0f);
        for (std::size_t i = 0; i < lights_.size(); ++i) {
            const LadderLight& light = lights_[i];
            const Lrsm& stored = stored_[i];
            const FootprintRadiance footprint = footprintRadiance(light.rsm, light.model, terms, covered, &embree_);
            rung(RadianceRung::eq3) += meanOf(footprint.eq3);
            rung(RadianceRung::eq5) += meanOf(footprint.eq5);
            rung(RadianceRung::eq12) += meanOf(footprint.eq12);
            rung(RadianceRung::eq14) += meanOf(footprint.eq14);
            rung(RadianceRung::eq15) += meanOf(footprint.eq15);
            const twin::Projected projected = twin::project(stored.projection, dvec3(sphere.centre));
            rung(RadianceRung::mips) += meanOf(twin::algorithm1(light.wide, projected, sphere, exactFractions, 0.0).radiance);
            rung(RadianceRung::table1) += meanOf(twin::algorithm1(stored, projected, sphere, exactFractions).radiance);
            shipped += sampleLrsm(stored, sphere, settings_.cones, phi_);
            if (const double brightness = meanOf(footprint.eq3); brightness > brightest) {
                brightest = brightness;
                sample.slope = footprint.slope;
                sample.layers = footprint.layers;
                sample.lightCosine = double(glm::dot(directionToLight(light.rsm.projection, sphere.centre), sphere.toReceiver));
                const LightSpacePoint at = projectToLight(light.rsm.projection, sphere.centre);
                sample.level = at.valid ? std::log2(double(sphere.radius) / double(at.texelSize)) + double(settings_.cones.gather.rsmLevelBias) : 0.0;
            }
        }
        rung(RadianceRung::algorithm1) = meanOf(dvec3(shipped));
    }

    const Settings& settings_;
    const LadderOptions& options_;
    int side_;
    OpacityPyramid opacity_;
    EmbreeScene embree_;
    GBuffer gbuffer_;
    GatherPlan plan_;
    NormalCdf phi_;
    std::vector<LightSampler> samplers_;
    std::vector<LadderLight> lights_;
    std::vector<Lrsm> stored_;
    std::vector<const Rsm*> rsms_;  ///< of lights_
};

std::vector<std::string> notesOn(const Settings& settings)
{
    const ConeSettings& cones = settings.cones;
    std::vector<std::string> notes;
    if (cones.march.estimator == Estimator::slab)
        notes.push_back(
            "estimator=slab gathers a segment's emission, not a sphere's L: the first ladder evaluates Algorithm 1 at the spheres of the steps where "
            "slab looks light up, weighed by the opacity that the step adds; the third is what the segments emit");
    if (cones.gather.backface != Backface::cosine) notes.push_back("N of Eq. 8 is taken as `backface` says from rung Eq. 5-8 on, not as the printed cosine");
    if (cones.gather.layerSelection == LayerSelection::touched)
        notes.push_back("layer_selection=touched: rung Eq. 15 adds every layer that the sphere touches, without decay");
    if (cones.gather.vRadiusScale != 1.0f) notes.push_back("v_radius_scale widens the window of Eq. 12 from rung Eq. 10-12 on");
    if (cones.gather.rsmLevelBias != 0.0f || cones.gather.rsmMinLevel != 0.0f) notes.push_back("rsm_level_bias and rsm_min_level enter at rung mips");
    return notes;
}

void describeAll(LadderScene& scene, bool slab, int worstPerRung)
{
    std::vector<std::size_t> all, withSurface;
    double light = 0.0, fromNothing = 0.0, noise = 0.0;
    for (std::size_t i = 0; i < scene.samples.size(); ++i) {
        const LadderSample& sample = scene.samples[i];
        const double gathered = sample.weight * sample.radiance[kRadianceRungs - 1];
        all.push_back(i);
        light += gathered;
        if (!sample.hasSurface) {
            fromNothing += gathered;
            continue;
        }
        withSurface.push_back(i);
        noise += sample.noise * sample.noise;
    }
    scene.withoutSurface = all.size() - withSurface.size();
    scene.lightFromNothing = light > 0.0 ? fromNothing / light : 0.0;
    scene.noise = withSurface.empty() ? 0.0 : std::sqrt(noise / double(withSurface.size()));
    scene.radiance = describeLadder(radianceView(), scene.samples, withSurface, worstPerRung);
    scene.visibility = describeLadder(visibilityView(), scene.samples, all, worstPerRung);
    scene.verdict = scene.scene + ": " + scene.radiance.verdict + " " + scene.visibility.verdict;
    if (!slab) return;
    scene.emission = describeLadder(emissionView(), scene.samples, all, worstPerRung);
    scene.verdict += " " + scene.emission.verdict;
}

}  // namespace

std::vector<RungInfo> radianceRungs()
{
    return {{"Eq. 2", "the surface integral itself: parallel rays along v_c, first hit inside the sphere, shadow rays to the lights"},
            {"Eq. 3, 4", "the RSM's texels in place of the surface: unlit parts are guessed to face the light"},
            {"Eq. 5-8", "product of three means, V by counting texels inside the sphere"},
            {"Eq. 10-12", "V by a Gaussian of the texels' mean and variance of depth"},
            {"Eq. 13, 14", "the same in each layer, all layers added"},
            {"Eq. 15", "only the layers that are selected, with their overlap and decay"},
            {"mips", "the footprint by pre-filtered mip chain and trilinear lookup, in float32"},
            {"Table 1", "RSM and LRSM in their storage: half and UNORM16, with the variance's floor"},
            {"Algorithm 1", "as shipped: its Gaussian, sampler fractions and float32 arithmetic"}};
}

std::vector<RungInfo> visibilityRungs()
{
    return {{"rays", "a bundle of rays through the triangles fills the cone's solid angle"},
            {"voxel rays", "the same rays through the bits of level 0, from the march's start on"},
            {"box mips", "the cone's steps, opacity from exact boxes as wide as the tap, in double"},
            {"cone", "as shipped: quadrilinear lookups in the stored mip chain"}};
}

std::vector<RungInfo> emissionRungs()
{
    return {{"beam", "rays through the cone's width: the radiance of the first surface within the segment"},
            {"beam texels", "the RSM's texels inside the same cylinder, by their area, none hidden by another"},
            {"segment", "as shipped: w A R from the pre-filtered layers, a tap wide"}};
}

const std::vector<double>& ladderProbabilities()
{
    static const std::vector<double> probabilities = {0.0, 0.01, 0.05, 0.1, 0.25, 0.5, 0.75, 0.9, 0.95, 0.99, 1.0};
    return probabilities;
}

LadderScene climbLadder(const Scene& scene, const Camera& camera, const Requirements& needs, const Settings& settings, const LadderOptions& options)
{
    if (scene.lights.empty()) throw InputError(scene.name, "has no light, so no cone sample has a radiance; add one, in the file or by a view file");
    if (options.samples < 1) throw InputError("ladder", "the number of samples must be at least 1");
    const auto tell = [&](const char* stage, double fraction) {
        if (options.progress) options.progress(stage, fraction);
    };

    tell("frame", 0.0);
    const LadderWorld world(scene, camera, needs, settings, options);
    tell("samples", 0.2);
    const SampledFrame drawn = world.draw(camera);
    if (drawn.samples.empty()) throw InputError(scene.name, "the frame looks up no light: nothing is in view, or no cone meets a voxel; try another camera");

    LadderScene result;
    result.scene = scene.name;
    result.width = options.width;
    result.height = options.height;
    result.lookups = drawn.lookups;
    result.notes = notesOn(settings);
    result.samples.resize(drawn.samples.size());
    constexpr std::size_t kBlock = 128;
    for (std::size_t first = 0; first < drawn.samples.size(); first += kBlock) {
        tell("rungs", 0.3 + 0.7 * double(first) / double(drawn.samples.size()));
        parallelFor(std::min(kBlock, drawn.samples.size() - first), 4, [&](std::size_t begin, std::size_t end) {
            Tracer tracer = world.tracer();
            for (std::size_t i = first + begin; i < first + end; ++i) result.samples[i] = world.climb(drawn.samples[i], tracer);
        });
    }
    describeAll(result, settings.cones.march.estimator == Estimator::slab, options.worstPerRung);
    tell("rungs", 1.0);
    return result;
}

}  // namespace lrsm
