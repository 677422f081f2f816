#pragma once

#include "conetrace/frame/cone.h"
#include "conetrace/frame/cone_batch.h"
#include "conetrace/frame/cone_record.h"
#include "conetrace/frame/gather.h"
#include "conetrace/frame/gather_plan.h"
#include "conetrace/frame/pixel_cones.h"
#include "conetrace/frame/receiver.h"
#include "conetrace/frame/tiles.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

/// Final gathering by batches, whatever the kernel that marches them.
namespace lrsm {

/// What is gathered for whom, and where it goes.
struct TileGather {
    const GBuffer& gbuffer;
    const Camera& camera;
    const VoxelGrid& grid;
    const ConeSettings& settings;
    const GatherPlan& plan;
    Gathered& out;
    ConeRecord* record;  ///< may be null
};

/// The pixels of one tile as a batch of cones: all of them for one cone of the set, then for the next.
template <class Mine, class March>
class TileBatch {
  public:
    /// mine(x, y): is the pixel one of the batch's? march(schedule, cones, result, counts) is in the scene's units.
    TileBatch(const TileGather& gather, const Mine& mine, March march) : of_(gather), mine_(mine), march_(std::move(march)) {}

    void gather(int tileX, int tileY, ConeCounts& counts)
    {
        place(tileX, tileY);
        if (pixels_.empty()) return;
        gatherDiffuse(counts);
        if (!of_.out.specular.empty()) gatherSpecular(counts);
    }

  private:
    void place(int tileX, int tileY)
    {
        pixels_.clear();
        receivers_.clear();
        forPixels(of_.gbuffer.width, of_.gbuffer.height, tileX, tileY, [&](int x, int y) {
            const std::size_t pixel = of_.gbuffer.position.index(x, y);
            if (!of_.gbuffer.covered(pixel) || !mine_(x, y)) return;
            pixels_.push_back(pixel);
            receivers_.push_back(receiverAt(of_.gbuffer, of_.grid, of_.settings, x, y));
        });
    }

    void setOrigin(int cone, const Receiver& receiver) { cones_->setOrigin(cone, receiver.originVoxels, receiver.originWorld, receiver.geometricNormal); }

    void gatherDiffuse(ConeCounts& counts)
    {
        const int count = static_cast<int>(pixels_.size()), sets = of_.settings.set.setsPerPixel;
        const ConeSet& set = of_.plan.cones;
        std::vector<Mat3> bases;
        for (int k = 0; k < count; ++k) {
            bases.push_back(basisFromNormal(receivers_[std::size_t(k)].normal));
            setOrigin(k, receivers_[std::size_t(k)]);
        }
        cones_->count = count;
        std::vector<PixelGather> sums(pixels_.size());
        int cone = 0;
        for (int s = 0; s < sets; ++s)
            for (std::size_t r = 0; r < set.rings.size(); ++r) {
                const ConeRing& ring = set.rings[r];
                for (int c = ring.first; c < ring.first + ring.count; ++c, ++cone) {
                    for (int k = 0; k < count; ++k) {
                        const int rotation = (receivers_[std::size_t(k)].rotation + s * kRotations / sets) % kRotations;
                        cones_->setDirection(k, bases[std::size_t(k)] * set.rotation(rotation)[std::size_t(c)]);
                    }
                    march_(of_.plan.ringSchedules[r], *cones_, *result_, counts);
                    for (int k = 0; k < count; ++k) {
                        const Vec3 radiance = radianceOf(k);
                        PixelGather& sum = sums[std::size_t(k)];
                        sum.irradiance += ring.weight * radiance;
                        sum.opacity += ring.weight * result_->opacity[k];
                        if (of_.record)
                            of_.record->diffuse[std::size_t(cone) * of_.gbuffer.position.texels.size() + pixels_[std::size_t(k)]] =
                                Vec4(radiance, result_->opacity[k]);
                    }
                }
            }
        const float perSet = 1.0f / static_cast<float>(sets);
        for (std::size_t k = 0; k < pixels_.size(); ++k) {
            of_.out.irradiance.texels[pixels_[k]] = sums[k].irradiance * (kPi * perSet);
            of_.out.opacity.texels[pixels_[k]] = sums[k].opacity * perSet;
        }
    }

    /// A batch for each class of roughness in the tile: specular cones of one class take the same steps.
    void gatherSpecular(ConeCounts& counts)
    {
        std::vector<std::pair<const MarchSchedule*, std::size_t>> waiting;  // schedule, index into pixels_
        std::vector<Vec3> directions(pixels_.size());
        for (std::size_t k = 0; k < pixels_.size(); ++k) {
            if (of_.gbuffer.specularColor.texels[pixels_[k]] == Vec3(0.0f)) continue;
            const Receiver& receiver = receivers_[k];
            const Vec3 toEye = glm::normalize(directionToEye(of_.camera, receiver.position));
            const float roughness = of_.gbuffer.roughness.texels[pixels_[k]];
            const LobeDirection lobe = of_.plan.lobes.direction(receiver.normal, toEye, roughness, receiver.rotation);
            directions[k] = lobe.direction;
            if (!of_.out.lobeWeight.empty()) of_.out.lobeWeight.texels[pixels_[k]] = lobe.weight;
            if (!(glm::dot(lobe.direction, receiver.geometricNormal) > 0.0f)) continue;
            waiting.emplace_back(&of_.plan.specularSchedule(roughness), k);
        }
        std::sort(waiting.begin(), waiting.end());
        for (std::size_t begin = 0, end = 0; begin < waiting.size(); begin = end) {
            for (end = begin; end < waiting.size() && waiting[end].first == waiting[begin].first; ++end) {
                const std::size_t k = waiting[end].second;
                const int cone = static_cast<int>(end - begin);
                setOrigin(cone, receivers_[k]);
                cones_->setDirection(cone, directions[k]);
            }
            cones_->count = static_cast<int>(end - begin);
            march_(*waiting[begin].first, *cones_, *result_, counts);
            for (std::size_t i = begin; i < end; ++i) {
                const int cone = static_cast<int>(i - begin);
                const std::size_t pixel = pixels_[waiting[i].second];
                of_.out.specular.texels[pixel] = radianceOf(cone);
                if (of_.record) of_.record->specular.texels[pixel] = Vec4(radianceOf(cone), result_->opacity[cone]);
            }
        }
    }

    Vec3 radianceOf(int cone) const { return {result_->radiance[cone][0], result_->radiance[cone][1], result_->radiance[cone][2]}; }

    const TileGather& of_;
    const Mine& mine_;
    March march_;
    std::vector<std::size_t> pixels_;  ///< covered ones of the tile; any order will do, a stage packs away what it rules out
    std::vector<Receiver> receivers_;
    std::unique_ptr<ConeBatch> cones_ = std::make_unique_for_overwrite<ConeBatch>();
    std::unique_ptr<ConeBatchResult> result_ = std::make_unique_for_overwrite<ConeBatchResult>();
};

/// Final gathering of the covered pixels that are `mine`, parallel over tiles; the same bits for any number of threads. startTask() returns what marches a
/// task's batches.
template <class Mine, class StartTask>
ConeCounts gatherTiles(const TileGather& gather, const Mine& mine, const StartTask& startTask)
{
    return forTiles<ConeCounts>(gather.gbuffer.width, gather.gbuffer.height, [&] {
        return [batch = TileBatch(gather, mine, startTask())](int tileX, int tileY, ConeCounts& counts) mutable { batch.gather(tileX, tileY, counts); };
    });
}

}  // namespace lrsm
