#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "reference/directions.h"
#include "reference/integrator.h"
#include "reference/light_guide.h"
#include "reference/path_trace.h"
#include "reference/purposes.h"

#include <algorithm>

namespace lrsm {

namespace {

constexpr int kLargestSide = 32, kLeastSide = 4, kMostTexels = 4096;
constexpr int kPixelsAcross = 4;               // of a tile, each way
constexpr int kRayBits = 6, kMostRayBits = 8;  // log2 of the rays of a pixel
constexpr std::size_t kTilesForFewRays = 64;   // a small picture has more rays a pixel, so that the pilot still sees the scene
constexpr double kEvenSpread = 0.05;           // of the variance over the squared mean
constexpr int kPoolBits = 10;
constexpr std::uint32_t kMeanLight = 16, kMostLight = 1024;  // that a cosine ray counts, as bright as the mean and at the most
constexpr float kUniformShare = 0.1f;                        // of `base`: rays that the pilot has not found, it may have missed
constexpr std::array<std::uint32_t, 2> kPilotKey = {0x70696c6fu, 0x74000000u};

/// A point of a light that the pilot has looked at.
struct Finding {
    LightPoint point;
    float brightness = 0.0f;              ///< that a cosine ray has brought from it
    std::uint32_t light = 0;              ///< the same in whole numbers
    bool tried = false, reached = false;  ///< one of a pool, and it was seen
};

/// What the pilot has found from one tile.
struct Findings {
    std::vector<Finding> seen, further;
    double rays = 0.0, brightness = 0.0, squares = 0.0;  ///< of what the eye's surfaces see: rays, sum and sum of squares of what they bring

    /// One more ray, which has found what `seen` holds from `first` on.
    void countRay(std::size_t first)
    {
        double sum = 0.0;
        for (std::size_t i = first; i < seen.size(); ++i) sum += double(seen[i].brightness);
        ++rays;
        brightness += sum;
        squares += sum * sum;
    }
    /// All rays find the same light: there is nothing to win for technique b.
    bool even() const { return squares * rays <= (1.0 + kEvenSpread) * brightness * brightness && brightness > 0.0; }
};

/// Runs through the tiles in parallel; each writes what is its own.
class Pilot {
  public:
    Pilot(const EmbreeScene& embree, std::span<const LightSampler> lights, const PrimaryHits& primary, Transport transport, LightGuide& guide)
        : embree_(embree), lights_(lights), primary_(primary), transport_(transport), guide_(guide), rayBits_(kRayBits)
    {
        for (std::size_t tiles = guide.tiles.count(); rayBits_ < kMostRayBits && (tiles << (rayBits_ - kRayBits)) < kTilesForFewRays;) ++rayBits_;
    }

    std::vector<Findings> castRays() const
    {
        return overTiles([&](std::size_t tile, Tracer& tracer, Findings& found) {
            visitPixels(tile, [&](std::uint32_t pixel, const Surface& surface) {
                const SobolBlock directions = points(pixel, Purpose::pilotDirection, rayBits_), onwards = points(pixel, Purpose::pilotFurther, rayBits_);
                for (std::uint32_t i = 0; i < (1u << rayBits_); ++i) {
                    const std::size_t before = found.seen.size();
                    const std::optional<Surface> struck = castRay(tracer, surface, directions.point(i), found.seen);
                    found.countRay(before);
                    if (struck && transport_ == Transport::full) castRay(tracer, *struck, onwards.point(i), found.further);
                }
            });
        });
    }

    std::vector<Findings> drawPools() const
    {
        return overTiles([&](std::size_t tile, Tracer& tracer, Findings& found) {
            const TileGuide guide = guide_.guideFor(tile);
            const LightPool pool =
                drawPool(tracer, guide_.maps, guide, points(std::uint32_t(tile), Purpose::pilotPoints, kPoolBits), 0, 1u << kPoolBits, transport_);
            PoolWeights weights;
            visitPixels(tile, [&](std::uint32_t pixel, const Surface& surface) {
                const LightReceiver receiver = receiverAt(tracer, surface);
                weights.weighDiffuse(pool, receiver, 1.0f);
                if (!weights.any()) return;
                const SobolBlock choices = points(pixel, Purpose::pilotChoice, rayBits_);
                for (std::uint32_t i = 0; i < (1u << rayBits_); ++i) {
                    const std::size_t chosen = weights.choose(choices.first(i)).index;
                    const Vec3 direction = glm::normalize(pool.position(chosen) - receiver.origin);
                    const bool reached = radianceFrom(tracer, pool, chosen, receiver, direction) != Vec3(0.0f);
                    const std::optional<LightCoordinates> at = guide_.maps[pool.points[chosen].light].coordinates(pool.position(chosen));
                    // Drawn in proportion to what they bring: all that are reached bring the same.
                    if (at) found.seen.push_back({{pool.points[chosen].light, at->at}, 0.0f, reached ? kMeanLight : 0, true, reached});
                }
            });
        });
    }

  private:
    static SobolBlock points(std::uint32_t index, Purpose purpose, int bits) { return {philox({index, 0, 0, std::uint32_t(purpose)}, kPilotKey), bits}; }

    template <class Body>
    std::vector<Findings> overTiles(const Body& body) const
    {
        std::vector<Findings> findings(guide_.tiles.count());
        parallelFor(findings.size(), 1, [&](std::size_t tile, std::size_t) {
            Tracer tracer(embree_, lights_);
            body(tile, tracer, findings[tile]);
        });
        return findings;
    }

    /// The covered pixels of a sparse grid.
    template <class Visit>
    void visitPixels(std::size_t tile, const Visit& visit) const
    {
        const Tile t = guide_.tiles[tile];
        const auto across = [](int begin, int end, int i) { return begin + (2 * i + 1) * (end - begin) / (2 * std::min(kPixelsAcross, end - begin)); };
        for (int j = 0; j < std::min(kPixelsAcross, t.y1 - t.y0); ++j)
            for (int i = 0; i < std::min(kPixelsAcross, t.x1 - t.x0); ++i) {
                const std::size_t pixel = primary_.covered.index(across(t.x0, t.x1, i), across(t.y0, t.y1, j));
                if (primary_.covered.texels[pixel]) visit(std::uint32_t(pixel), primary_.surface.texels[pixel]);
            }
    }

    /// One cosine ray; where it meets light is added to `lit`, what it strikes is returned.
    std::optional<Surface> castRay(Tracer& tracer, const Surface& from, UnitPoint xi, std::vector<Finding>& lit) const
    {
        const Vec3 direction = cosineDirection(from.normal, xi);
        if (!(glm::dot(from.geometricNormal, direction) > 0.0f)) return std::nullopt;
        const Ray ray = rayFrom(tracer, from, direction, RayKind::bounce);
        const std::optional<RayHit> hit = tracer.closestHit(ray);
        if (!hit || !reflects(tracer.scene(), *hit)) return std::nullopt;
        visitLights(tracer, ray, *hit, [&](std::size_t k, const Surface& surface, const LightSample& sample) {
            // A glossy point counts as if it shone alike to all sides: to whom it does is not a matter of where it is.
            Surface even = surface;
            if (transport_ == Transport::full) even.albedo += surface.specularColor;
            const Vec3 radiance = diffuseRadiance(even, sample);
            const std::optional<LightCoordinates> at = guide_.maps[k].coordinates(surface.position);
            if (at && radiance != Vec3(0.0f)) lit.push_back({{std::uint32_t(k), at->at}, radiance.x + radiance.y + radiance.z});
        });
        if (transport_ == Transport::single) return std::nullopt;
        return evaluateSurface(tracer.scene(), hit->surface, -direction);
    }

    const EmbreeScene& embree_;
    std::span<const LightSampler> lights_;
    const PrimaryHits& primary_;
    Transport transport_;
    const LightGuide& guide_;
    int rayBits_;
};

std::vector<TexelCount> countTexels(const LightGrids& grids, std::span<const Finding> findings)
{
    std::vector<TexelCount> counts(grids.texels());
    for (std::uint32_t texel = 0; texel < counts.size(); ++texel) counts[texel].texel = texel;
    for (const Finding& one : findings) {
        TexelCount& count = counts[grids.texelOf(one.point)];
        count.light += one.light;
        count.tried += one.tried;
        count.reached += one.reached;
    }
    return {counts.begin(), std::remove_if(counts.begin(), counts.end(), [](const TexelCount& count) { return count.light == 0 && count.tried == 0; })};
}

/// Whole numbers in proportion to what each ray has brought, so that sums do not depend on their order.
void countBrightness(std::vector<Findings>& findings, std::vector<Finding> Findings::*member)
{
    double sum = 0.0;
    std::size_t number = 0;
    for (const Findings& tile : findings)
        for (const Finding& one : tile.*member) {
            sum += double(one.brightness);
            ++number;
        }
    const double scale = sum > 0.0 ? kMeanLight * double(number) / sum : 0.0;
    for (Findings& tile : findings)
        for (Finding& one : tile.*member) one.light = std::uint32_t(std::clamp(std::nearbyint(scale * double(one.brightness)), 1.0, double(kMostLight)));
}

/// What all tiles have found, smoothed, and a uniform part; empty where nothing was found.
std::vector<float> baseWeights(const LightGrids& grids, std::span<const Finding> points)
{
    SpreadCounts counts(grids);
    for (const TexelCount& one : countTexels(grids, points)) counts.add(one, 1);
    counts.spread();
    const auto total = double(counts.totalLight());
    if (total == 0.0) return {};
    std::vector<float> weights(grids.texels());
    for (std::size_t i = 0; i < weights.size(); ++i)
        weights[i] = kUniformShare / (grids.perArea(i) * float(grids.lights())) + (1.0f - kUniformShare) * float(double(counts.light[i]) / total);
    return weights;
}

template <class Member>
std::vector<Finding> joined(const std::vector<Findings>& findings, Member member)
{
    std::vector<Finding> all;
    for (const Findings& one : findings) all.insert(all.end(), (one.*member).begin(), (one.*member).end());
    return all;
}

std::vector<LightPoint> pointsOf(const std::vector<Finding>& findings)
{
    std::vector<LightPoint> points;
    for (const Finding& one : findings) points.push_back(one.point);
    return points;
}

void setSeen(LightGuide& guide, const std::vector<Findings>& findings)
{
    guide.seen.resize(findings.size());
    for (std::size_t tile = 0; tile < findings.size(); ++tile) guide.seen[tile] = countTexels(*guide.grids, findings[tile].seen);
    guide.base = baseWeights(*guide.grids, joined(findings, &Findings::seen));
}

std::string hashOf(const LightGuide& guide, const std::vector<TexelCount>& further)
{
    Sha256 hash;
    for (const std::vector<float>& cuts : guide.grids->cuts()) hash.add(cuts);
    hash.add(guide.even);
    for (const std::vector<TexelCount>& tile : guide.seen) hash.add(std::vector<std::uint64_t>{tile.size()}).add(tile);
    return hash.add(further).hex();
}

}  // namespace

LightGuide learnLightGuide(const EmbreeScene& embree, std::span<const LightSampler> lights, const PrimaryHits& primary, Transport transport)
{
    LightGuide guide;
    const Scene& scene = embree.scene();
    for (const Light& light : scene.lights) guide.maps.emplace_back(light, scene.bounds);
    guide.tiles = {primary.covered.width, primary.covered.height};
    if (lights.empty()) return guide;
    const Pilot pilot(embree, lights, primary, transport, guide);

    // Along rays of the surfaces that the eye sees
    std::vector<Findings> byRays = pilot.castRays();
    countBrightness(byRays, &Findings::seen);
    countBrightness(byRays, &Findings::further);
    const std::vector<Finding> seen = joined(byRays, &Findings::seen), further = joined(byRays, &Findings::further);
    const int side = std::clamp(int(std::sqrt(double(kMostTexels) / double(lights.size()))), kLeastSide, kLargestSide);
    guide.grids = std::make_shared<LightGrids>(lights.size(), side, pointsOf(seen));
    setSeen(guide, byRays);
    if (!guide.useful()) guide.base.assign(guide.grids->texels(), 1.0f);

    // From the lights, where those rays have found light
    std::vector<Findings> all = pilot.drawPools();
    for (std::size_t tile = 0; tile < all.size(); ++tile) all[tile].seen.insert(all[tile].seen.end(), byRays[tile].seen.begin(), byRays[tile].seen.end());
    setSeen(guide, all);
    for (const Findings& tile : byRays) guide.even.push_back(tile.even());
    const bool allEven = std::all_of(byRays.begin(), byRays.end(), [](const Findings& tile) { return tile.even() || tile.rays == 0.0; });
    if (std::vector<float> weights = transport == Transport::full && !allEven ? baseWeights(*guide.grids, further) : std::vector<float>(); !weights.empty())
        guide.further.density = LightDensity(guide.grids, std::move(weights));
    guide.sha256 = hashOf(guide, countTexels(*guide.grids, further));
    return guide;
}

}  // namespace lrsm
