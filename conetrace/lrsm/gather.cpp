#include "conetrace/lrsm/gather.h"

#include "conetrace/frame/tiles.h"
#include "conetrace/lrsm/explain.h"
#include "conetrace/lrsm/gather_pixel.h"
#include "conetrace/lrsm/gather_rays.h"
#include "conetrace/lrsm/march_slab_batch.h"
#include "conetrace/lrsm/memory.h"
#include "voxel/sample_opacity.h"

#include <algorithm>
#include <deque>
#include <memory>
#include <utility>

namespace lrsm {
namespace {

/// Of the march itself it is told nothing.
struct ResultRecorder : NoRecorder, ConeKeeper {};

/// What the tiles fill in.
struct GatherOutput {
    Gathered& gathered;
    ConeRecord* record;  ///< may be null
    ConeCounts& counts;
};

/// The pixels of one tile by Algorithm 1, one after the other.
template <class SamplerOf>
void gatherTile(const GBuffer& gbuffer, const Camera& camera, const std::vector<ConeWorld>& worlds, const SamplerOf& samplerOf, const GatherPlan& plan,
                int tileX, int tileY, const GatherOutput& to, ConeCounts& counts)
{
    Gathered& out = to.gathered;
    MarchScratch scratch;
    forPixels(gbuffer.width, gbuffer.height, tileX, tileY, [&](int x, int y) {
        const std::size_t pixel = out.irradiance.index(x, y);
        if (!gbuffer.covered(pixel)) return;
        const ConeWorld& world = worlds[std::size_t(cascadeOfPixel(gbuffer, worlds[0].opacity, worlds[0].settings, x, y))];
        const auto& sampler = samplerOf(world);
        const Receiver receiver = receiverAt(gbuffer, world.opacity.base.grid, world.settings, x, y);
        ResultRecorder recorder{{}, diffuseKeeper(to.record, pixel)};
        const PixelGather diffuse = gatherDiffuse<Estimator::paper>(world, sampler, plan, receiver, scratch, counts, recorder);
        out.irradiance.texels[pixel] = diffuse.irradiance;
        out.opacity.texels[pixel] = diffuse.opacity;
        if (out.specular.empty() || gbuffer.specularColor.texels[pixel] == Vec3(0.0f)) return;
        const Vec3 toEye = glm::normalize(directionToEye(camera, receiver.position));
        const float roughness = gbuffer.roughness.texels[pixel];
        const LobeDirection lobe = plan.lobes.direction(receiver.normal, toEye, roughness, receiver.rotation);
        recorder = {{}, specularKeeper(to.record, pixel)};
        out.specular.texels[pixel] = gatherSpecular<Estimator::paper>(world, sampler, plan, receiver, lobe.direction, roughness, scratch, counts, recorder);
        if (!out.lobeWeight.empty()) out.lobeWeight.texels[pixel] = lobe.weight;
    });
}

/// `paper`, Algorithm 1 as printed: one cone at a time.
void gatherPaper(const GBuffer& gbuffer, const Camera& camera, const ConeWorld& world, const GatherPlan& plan, const GatherOutput& out)
{
    const std::vector<ConeWorld> worlds = cascadeWorlds(world);
    const FilterFraction fraction = world.settings.march.filterFraction;
    const auto gatherWith = [&](const auto& samplerOf) {
        out.counts += forTiles<ConeCounts>(gbuffer.width, gbuffer.height, [&] {
            return [&](int tileX, int tileY, ConeCounts& counts) { gatherTile(gbuffer, camera, worlds, samplerOf, plan, tileX, tileY, out, counts); };
        });
    };
    if (worlds.size() > 1)
        gatherWith([&](const ConeWorld& own) { return GenericSampler{own.opacity, fraction}; });
    else
        withOpacitySampler(world.opacity, fraction, [&](const auto& sampler) { gatherWith([&](const ConeWorld&) -> const auto& { return sampler; }); });
}

/// The pixels of one tile whose cones count in one cascade, as a batch of cones: all of them for one cone of the set, then for the next.
class TileBatch {
  public:
    TileBatch(const GBuffer& gbuffer, const std::deque<BatchWorld>& worlds, std::size_t cascade, const GatherPlan& plan, MarchBatch march)
        : gbuffer_(gbuffer),
          finest_(worlds[0].cones.opacity),
          cascade_(worlds.size() > 1 ? int(cascade) : kOnly),
          world_(worlds[cascade]),
          plan_(plan),
          march_(march)
    {
    }

    void gather(const Camera& camera, int tileX, int tileY, const GatherOutput& to, ConeCounts& counts)
    {
        place(tileX, tileY);
        if (pixels_.empty()) return;
        gatherDiffuse(to, counts);
        if (!to.gathered.specular.empty()) gatherSpecular(camera, to, counts);
    }

  private:
    void place(int tileX, int tileY)
    {
        pixels_.clear();
        receivers_.clear();
        forPixels(gbuffer_.width, gbuffer_.height, tileX, tileY, [&](int x, int y) {
            const std::size_t pixel = gbuffer_.position.index(x, y);
            if (!gbuffer_.covered(pixel)) return;
            if (cascade_ != kOnly && cascadeOfPixel(gbuffer_, finest_, world_.cones.settings, x, y) != cascade_) return;
            pixels_.push_back(pixel);
            receivers_.push_back(receiverAt(gbuffer_, world_.cones.opacity.base.grid, world_.cones.settings, x, y));
        });
    }

    void gatherDiffuse(const GatherOutput& to, ConeCounts& counts)
    {
        const int count = static_cast<int>(pixels_.size()), sets = world_.cones.settings.set.setsPerPixel;
        std::vector<Mat3> bases;
        for (int k = 0; k < count; ++k) {
            const Receiver& receiver = receivers_[std::size_t(k)];
            bases.push_back(basisFromNormal(receiver.normal));
            cones_->setOrigin(k, receiver.originVoxels, receiver.originWorld);
        }
        cones_->count = count;
        std::vector<PixelGather> sums(pixels_.size());
        int cone = 0;
        for (int s = 0; s < sets; ++s)
            for (std::size_t r = 0; r < plan_.cones.rings.size(); ++r) {
                const ConeRing& ring = plan_.cones.rings[r];
                for (int c = ring.first; c < ring.first + ring.count; ++c, ++cone) {
                    for (int k = 0; k < count; ++k) {
                        const int rotation = (receivers_[std::size_t(k)].rotation + s * kRotations / sets) % kRotations;
                        cones_->setDirection(k, bases[std::size_t(k)] * plan_.cones.rotation(rotation)[std::size_t(c)]);
                    }
                    march_(world_, plan_.ringSchedules[r], *cones_, *scratch_, *result_, counts);
                    for (int k = 0; k < count; ++k) {
                        const Vec3 radiance = radianceOf(k);
                        PixelGather& sum = sums[std::size_t(k)];
                        sum.irradiance += ring.weight * radiance;
                        sum.opacity += ring.weight * result_->opacity[k];
                        if (to.record)
                            to.record->diffuse[std::size_t(cone) * gbuffer_.position.texels.size() + pixels_[std::size_t(k)]] =
                                Vec4(radiance, result_->opacity[k]);
                    }
                }
            }
        const float perSet = 1.0f / static_cast<float>(sets);
        for (std::size_t k = 0; k < pixels_.size(); ++k) {
            to.gathered.irradiance.texels[pixels_[k]] = sums[k].irradiance * (kPi * perSet);
            to.gathered.opacity.texels[pixels_[k]] = sums[k].opacity * perSet;
        }
    }

    /// A batch for each class of roughness in the tile: specular cones of one class take the same steps.
    void gatherSpecular(const Camera& camera, const GatherOutput& to, ConeCounts& counts)
    {
        std::vector<std::pair<const MarchSchedule*, std::size_t>> waiting;  // schedule, index into pixels_
        std::vector<Vec3> directions(pixels_.size());
        for (std::size_t k = 0; k < pixels_.size(); ++k) {
            if (gbuffer_.specularColor.texels[pixels_[k]] == Vec3(0.0f)) continue;
            const Receiver& receiver = receivers_[k];
            const Vec3 toEye = glm::normalize(directionToEye(camera, receiver.position));
            const float roughness = gbuffer_.roughness.texels[pixels_[k]];
            const LobeDirection lobe = plan_.lobes.direction(receiver.normal, toEye, roughness, receiver.rotation);
            directions[k] = lobe.direction;
            if (!to.gathered.lobeWeight.empty()) to.gathered.lobeWeight.texels[pixels_[k]] = lobe.weight;
            if (!(glm::dot(lobe.direction, receiver.geometricNormal) > 0.0f)) continue;
            waiting.emplace_back(&plan_.specularSchedule(roughness), k);
        }
        std::sort(waiting.begin(), waiting.end());
        for (std::size_t begin = 0, end = 0; begin < waiting.size(); begin = end) {
            for (end = begin; end < waiting.size() && waiting[end].first == waiting[begin].first; ++end) {
                const std::size_t k = waiting[end].second;
                const int cone = static_cast<int>(end - begin);
                cones_->setOrigin(cone, receivers_[k].originVoxels, receivers_[k].originWorld);
                cones_->setDirection(cone, directions[k]);
            }
            cones_->count = static_cast<int>(end - begin);
            march_(world_, *waiting[begin].first, *cones_, *scratch_, *result_, counts);
            for (std::size_t i = begin; i < end; ++i) {
                const int cone = static_cast<int>(i - begin);
                const std::size_t pixel = pixels_[waiting[i].second];
                to.gathered.specular.texels[pixel] = radianceOf(cone);
                if (to.record) to.record->specular.texels[pixel] = Vec4(radianceOf(cone), result_->opacity[cone]);
            }
        }
    }

    Vec3 radianceOf(int cone) const
    {
        return unexposed(world_.cones.lrsms) * Vec3(result_->radiance[cone][0], result_->radiance[cone][1], result_->radiance[cone][2]);
    }

    static constexpr int kOnly = -1;

    const GBuffer& gbuffer_;
    const OpacityPyramid& finest_;
    const int cascade_;  ///< kOnly: there is one
    const BatchWorld& world_;
    const GatherPlan& plan_;
    const MarchBatch march_;
    std::vector<std::size_t> pixels_;  ///< covered ones of the tile; any order will do, a stage packs away what it rules out
    std::vector<Receiver> receivers_;
    std::unique_ptr<ConeBatch> cones_ = std::make_unique_for_overwrite<ConeBatch>();
    std::unique_ptr<MarchBatchScratch> scratch_ = std::make_unique_for_overwrite<MarchBatchScratch>();
    std::unique_ptr<ConeBatchResult> result_ = std::make_unique_for_overwrite<ConeBatchResult>();
};

/// `slab`: tile by tile at the widest that the machine has.
void gatherSlab(const GBuffer& gbuffer, const Camera& camera, const ConeWorld& world, const GatherPlan& plan, const GatherOutput& out, int lanes)
{
    const std::vector<ConeWorld> cascades = cascadeWorlds(world);
    std::deque<BatchWorld> worlds;  // which do not move
    for (const ConeWorld& own : cascades) {
        if (worlds.empty())
            worlds.emplace_back(own);
        else
            worlds.emplace_back(own, worlds[0].maps);
    }
    const MarchBatch march = marchSlabBatch(lanes);
    for (std::size_t cascade = 0; cascade < worlds.size(); ++cascade)
        out.counts += forTiles<ConeCounts>(gbuffer.width, gbuffer.height, [&] {
            return [&, batch = TileBatch(gbuffer, worlds, cascade, plan, march)](int tileX, int tileY, ConeCounts& counts) mutable {
                batch.gather(camera, tileX, tileY, out, counts);
            };
        });
}

struct KeptLrsms {
    std::vector<Lrsm> lrsms;
    std::vector<MadeFrom> made;
};

std::string passName(std::size_t light)
{
    return "lrsm " + std::to_string(light);
}

}  // namespace

std::vector<Lrsm> buildLrsms(const std::vector<Rsm>& rsms, const LayerSettings& settings, PassLog& log)
{
    std::vector<Lrsm> lrsms;
    for (std::size_t i = 0; i < rsms.size(); ++i) lrsms.push_back(log.run(passName(i), kWorldPass, [&] { return buildLrsm(rsms[i], settings); }));
    return lrsms;
}

const std::vector<Lrsm>& layersOf(const GatherInput& input, PassLog& log, std::vector<Lrsm>& own)
{
    const LayerSettings& settings = input.settings.layers;
    if (!input.kept) return own = buildLrsms(input.rsms, settings, log);
    auto& [lrsms, made] = ownOf<KeptLrsms>(*input.kept);
    lrsms.resize(input.rsms.size());
    made.resize(input.rsms.size());
    for (std::size_t i = 0; i < lrsms.size(); ++i) {
        Lrsm& lrsm = lrsms[i];
        const Rsm& rsm = input.rsms[i];
        const bool kept = keepOrMake(made[i], input.kept->rsmsMade[i].key, log, [&] {
            lrsm = {};
            lrsm = log.run(passName(i), kWorldPass, [&] { return buildLrsm(rsm, settings); });
        });
        if (kept) log.show(passName(i), lrsm);
    }
    return lrsms;
}

Gathered traceCones(const GBuffer& gbuffer, const Camera& camera, const OpacityPyramid& opacity, const std::vector<Lrsm>& lrsms, const Requirements& needs,
                    const ConeSettings& settings, ConeRecord* record, int lanes)
{
    if (record) *record = ConeRecord(gbuffer, needs, settings);
    const GatherPlan plan = planGather(settings, needs, outermostEdge(opacity));
    Gathered out = emptyGathered(gbuffer, needs, plan.lobes.sampling());
    const NormalCdf phi(settings.gather.gaussian, settings.gather.gaussianTableSize);
    const ConeWorld world{.opacity = opacity, .lrsms = lrsms, .settings = settings, .phi = phi};
    ConeCounts counts;
    if (settings.march.estimator == Estimator::slab)
        gatherSlab(gbuffer, camera, world, plan, {out, record, counts}, lanes);
    else
        gatherPaper(gbuffer, camera, world, plan, {out, record, counts});
    out.counters = countersOf(counts);
    return out;
}

Gathered gatherLrsm(const GatherInput& input, PassLog& log)
{
    std::vector<Lrsm> own;
    const std::vector<Lrsm>& lrsms = layersOf(input, log, own);
    const ConeSettings& settings = input.settings.cones;
    ConeRecord kept;
    ConeRecord* const record = log.observed() ? &kept : nullptr;
    Gathered gathered;
    switch (settings.march.visibility) {
    case Visibility::cones:
        gathered = log.run("cones", kPicturePass,
                           [&] { return traceCones(input.gbuffer, input.camera, input.opacity, lrsms, input.needs, settings, record, input.lanes); });
        break;
    case Visibility::rays: {
        const EmbreeScene scene = log.run("bvh", kWorldPass, [&] { return EmbreeScene(input.scene, RayKinds::bounces); });
        gathered = log.run("rays", kPicturePass, [&] { return traceRays(input.gbuffer, input.camera, scene, lrsms, input.needs, settings, record); });
        break;
    }
    case Visibility::voxelRays:
        gathered =
            log.run("rays", kPicturePass, [&] { return traceVoxelRays(input.gbuffer, input.camera, input.opacity, lrsms, input.needs, settings, record); });
        break;
    }
    log.show("cones", kept);
    gathered.filter4x4 = settings.set.filter;
    return gathered;
}

GatherMethod lrsmMethod(Visibility visibility)
{
    GatherMethod method{.reads = {.bits = true, .mips = true}, .gather = gatherLrsm, .explain = explainLrsm, .predict = predictLrsms};
    if (visibility == Visibility::cones) return method;
    method.explain = {};
    if (visibility == Visibility::rays) method.reads = {};
    return method;
}

}  // namespace lrsm
