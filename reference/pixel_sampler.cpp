#include "reference/pixel_sampler.h"

#include "core/base/elementary.h"
#include "reference/directions.h"

namespace lrsm {
namespace {

constexpr int kGroupBits = 6;
constexpr int kPointsASampleBits = 5;       // log2 of a pool's points for each sample that a pixel draws from it
constexpr std::size_t kSpecularStride = 4;  // weighing by a lobe costs as much as several by the cosine
constexpr int kDrawBits = 1;                // log2 of the pool's points that a sample looks at
constexpr float kPoolCandidates = 16.0f;    // c of the pools' technique
constexpr int kFurtherPointsBits = 4;       // the same of further vertices' pools
constexpr float kFurtherCandidates = 16.0f;

struct LobeResponse {
    const Surface& surface;
    Vec3 toEye;
    Response operator()(const Vec3& direction) const { return {evaluateSpecular(surface, direction, toEye), lobeDensity(surface, toEye, direction)}; }
};

}  // namespace

TileSampler::TileSampler(const PathTracer& tracer, std::size_t tile, const BlockKey& key)
    : tracer_(tracer),
      settings_(tracer.settings()),
      tile_(tile),
      key_(key),
      channels_(tracer.channels()),
      groupBits_(std::min(key.blockBits, kGroupBits)),
      cosHalf_(float(sinCos(0.5 * double(settings_.specularApertureDegrees) * 3.14159265358979323846 / 180.0).cos))
{
    const PrimaryHits& primary = tracer.primary();
    forEachPixel(tracer.guide().tiles, tile, [&](std::size_t pixel, std::size_t) {
        specular_ |= primary.covered.texels[pixel] && primary.surface.texels[pixel].specularColor != Vec3(0.0f);
    });
    guide_ = tracer.guide().guideFor(tile);
    const auto technique = [&](const LightDensity& density, float candidates) {
        return LightTechnique{tracer.guide().maps, density.empty() ? nullptr : &density, candidates};
    };
    for (Draws* draws : {&diffuse_, &lobe_, &cone_})
        draws->light = {technique(guide_.density, kPoolCandidates), technique(tracer.guide().further.density, kFurtherCandidates), nullptr, &scratch_};
    cone_.light.first = {};  // its rays look where they must
}

GroupPools TileSampler::drawPools(Tracer& tracer, std::uint32_t first) const
{
    GroupPools pools;
    const RayCounts before = tracer.counts;
    const std::uint32_t group = first >> groupBits_;
    const auto draw = [&](const TileGuide& guide, Purpose purpose, int bits) {
        if (guide.density.empty()) return LightPool{};
        const std::uint32_t count = 1u << (groupBits_ + bits);
        return drawPool(tracer, tracer_.guide().maps, guide, key_.points(std::uint32_t(tile_), purpose, bits), group * count, count, settings_.transport);
    };
    pools.diffuse = draw(guide_, Purpose::diffusePoints, kPointsASampleBits);
    pools.furtherDiffuse = draw(tracer_.guide().further, Purpose::furtherDiffusePoints, kFurtherPointsBits);
    // Their own for the lobe, so that the variances of both parts add up.
    if (specular_) pools.lobe = draw(guide_, Purpose::lobePoints, kPointsASampleBits);
    if (specular_) pools.furtherLobe = draw(tracer_.guide().further, Purpose::furtherLobePoints, kFurtherPointsBits);
    layOut(pools.lobe, kSpecularStride);
    for (LightPool* pool : {&pools.furtherDiffuse, &pools.furtherLobe}) layOut(*pool, std::max<std::size_t>(1, pool->size() / kVertexCandidates));
    if (first != group << groupBits_) tracer.counts = before;
    return pools;
}

template <class Direct>
void TileSampler::aim(Draws& draws, Purpose purpose, std::uint32_t begin, std::uint32_t end, const Direct& direct) const
{
    const SobolBlock points = key_.points(pixel_, purpose);
    draws.directions.resize(end - begin);
    for (std::uint32_t i = begin; i < end; ++i) draws.directions[i - begin] = direct(points.point(i));
}

template <class Respond>
void TileSampler::connect(Draws& draws, Purpose purpose, std::uint32_t begin, std::uint32_t end, const Respond& respond) const
{
    draws.connections.clear();
    if (!draws.weights.any()) return;
    const SobolBlock points = key_.points(pixel_, purpose, kDrawBits);
    draws.connections.resize((end - begin) << kDrawBits);
    for (std::uint32_t i = 0; i < draws.connections.size(); ++i) {
        const Choice chosen = draws.weights.choose(points.first((begin << kDrawBits) + i));
        Connection& one = draws.connections[i];
        one.index = chosen.index;
        one.factor = connection(*draws.pool, chosen.index, receiver_, kPoolCandidates, respond, one.direction) * chosen.overDensity;
    }
}

void TileSampler::beginPixel(Tracer& tracer, const GroupPools& pools, std::size_t pixel, std::uint32_t begin, std::uint32_t end)
{
    const PrimaryHits& primary = tracer_.primary();
    pixel_ = std::uint32_t(pixel);
    begin_ = begin;
    surface_ = &primary.surface.texels[pixel];
    toEye_ = primary.toEye.texels[pixel];
    receiver_ = receiverAt(tracer, *surface_);
    aim(diffuse_, Purpose::diffuseDirection, begin, end, [&](UnitPoint xi) { return cosineDirection(surface_->normal, xi); });
    diffuse_.pool = &pools.diffuse;
    diffuse_.light.furtherPool = pools.furtherDiffuse.size() > 0 ? &pools.furtherDiffuse : nullptr;
    diffuse_.weights.weighDiffuse(pools.diffuse, receiver_, kPoolCandidates);
    connect(diffuse_, Purpose::diffusePool, begin, end, CosineResponse{surface_->normal});
    if (channels_ == kDiffuseChannels || surface_->specularColor == Vec3(0.0f)) return;

    aim(lobe_, Purpose::lobeDirection, begin, end, [&](UnitPoint xi) { return lobeDirection(*surface_, toEye_, xi); });
    lobe_.pool = &pools.lobe;
    lobe_.light.furtherPool = cone_.light.furtherPool = pools.furtherLobe.size() > 0 ? &pools.furtherLobe : nullptr;
    const float u = key_.points(pixel_, Purpose::lobeSubset).first(begin >> groupBits_ << groupBits_);
    const auto start = std::size_t(u * float(kSpecularStride));
    const LobeResponse response{*surface_, toEye_};
    lobe_.weights.weigh(pools.lobe, receiver_, kPoolCandidates, response, start);
    connect(lobe_, Purpose::lobePool, begin, end, response);
    if (channels_ < kConeChannels) return;
    const Vec3 mirror = mirrorDirection(surface_->normal, toEye_);
    aim(cone_, Purpose::coneDirection, begin, end, [&](UnitPoint xi) { return coneDirection(mirror, cosHalf_, xi); });
}

Sample TileSampler::sample(Tracer& tracer, std::uint32_t index)
{
    const auto store = [](Sample& sample, int channel, const Vec3& value) {
        for (int c = 0; c < 3; ++c) sample[std::size_t(channel + c)] = value[c];
    };
    Sample sample{};
    bool hit = false;
    const CosineResponse cosine{surface_->normal};
    const Vec3 diffuseDirection = diffuse_.directions[index - begin_];
    store(sample, kIrradiance,
          traced(tracer, diffuseDirection, cosine(diffuseDirection), diffuse_.light, Purpose::diffusePath, index, hit) + connected(tracer, diffuse_, index));
    sample[kOpacity] = hit ? 1.0f : 0.0f;
    if (channels_ == kDiffuseChannels || surface_->specularColor == Vec3(0.0f)) return sample;

    const Vec3 lobeDrawn = lobe_.directions[index - begin_];
    const Response reflected = LobeResponse{*surface_, toEye_}(lobeDrawn);
    Vec3 value = connected(tracer, lobe_, index);
    if (reflected.value != Vec3(0.0f)) value += traced(tracer, lobeDrawn, reflected, lobe_.light, Purpose::lobePath, index, hit);
    store(sample, kLobe, value);
    if (channels_ < kConeChannels) return sample;

    // The mean over the cone: f and p_a are both 1 / its solid angle.
    const float coneDensity = 1.0f / (2.0f * kPi * (1.0f - cosHalf_));
    store(sample, kCone, traced(tracer, cone_.directions[index - begin_], {Vec3(coneDensity), coneDensity}, cone_.light, Purpose::conePath, index, hit));
    return sample;
}

/// Technique a: f / p_a times the radiance along one ray, 0 below the geometric horizon: the surface itself is in the way there.
Vec3 TileSampler::traced(Tracer& tracer, const Vec3& direction, const Response& response, const PathLight& light, Purpose purpose, std::uint32_t index,
                         bool& hit) const
{
    hit = true;
    if (!(glm::dot(surface_->geometricNormal, direction) > 0.0f)) return Vec3(0.0f);
    PathRandom random = key_.path(pixel_, purpose, index);
    const PathStart start{rayFrom(tracer, *surface_, direction, RayKind::bounce), response.density};
    const Vec3 radiance = incomingRadiance(tracer, start, light, settings_.transport, random, hit);
    return response.density > 0.0f ? response.value / response.density * radiance : Vec3(0.0f);
}

/// Technique b: some of the pool's points.
Vec3 TileSampler::connected(Tracer& tracer, const Draws& draws, std::uint32_t index) const
{
    if (draws.connections.empty()) return Vec3(0.0f);
    Vec3 sum(0.0f);
    for (const Connection& one : std::span(draws.connections).subspan((index - begin_) << kDrawBits, 1u << kDrawBits))
        if (one.factor != Vec3(0.0f)) sum += one.factor * radianceFrom(tracer, *draws.pool, one.index, receiver_, one.direction);
    return sum / float(1u << kDrawBits);
}

}  // namespace lrsm
