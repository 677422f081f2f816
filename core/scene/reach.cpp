#include "core/scene/reach.h"

#include "core/base/elementary.h"
#include "core/scene/coarse_view.h"
#include "core/scene/cut_polygon.h"
#include "core/scene/invisible.h"
#include "core/scene/light.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lrsm {
namespace {

/// Vertices count within so many reaches: the far ends of what is seen.
constexpr double kVertexReaches = 2.0;
constexpr double kNegligibleLight = 1.0 / 256.0;  // of what a place gets

/// What is met from a viewpoint, and the distance from `centre` within which lies kReachShare of it: nearest first, distances from there.
struct Met {
    std::vector<CoarseHit> hits;
    Vec3 centre{0.0f};
    double reach = 0.0;
};

/// Parallel rays have no point that they come from. They have what they meet: the middle of it, axis by axis.
Vec3 middleOf(const std::vector<CoarseHit>& hits)
{
    Vec3 middle(0.0f);
    std::vector<float> places(hits.size());
    for (int axis = 0; axis < 3 && !hits.empty(); ++axis) {
        for (std::size_t i = 0; i < hits.size(); ++i) places[i] = hits[i].position[axis];
        const auto median = places.begin() + std::ptrdiff_t(places.size() / 2);
        std::nth_element(places.begin(), median, places.end());
        middle[axis] = *median;
    }
    return middle;
}

Met metFrom(const Scene& scene, const Viewpoint& from, bool light)
{
    std::vector<CoarseHit> hits = coarseView(scene, from).hits;
    const Vec3 centre = from.parallel ? middleOf(hits) : from.position;
    // All that lies within the picture's own size counts alike.
    const double least = from.parallel ? double(from.halfHeight) : 1e-30;
    if (from.parallel)
        for (CoarseHit& hit : hits) hit.distance = glm::length(glm::dvec3(hit.position) - glm::dvec3(centre));
    std::stable_sort(hits.begin(), hits.end(), [](const CoarseHit& a, const CoarseHit& b) { return a.distance < b.distance; });
    const auto weight = [light, least](const CoarseHit& hit) {
        const double d = std::max(hit.distance, least);
        return light ? 1.0 / (d * d) : 1.0 / std::sqrt(d);
    };
    double all = 0.0, sum = 0.0;
    for (const CoarseHit& hit : hits) all += weight(hit);
    std::size_t count = 0;
    while (count < hits.size() && sum < kReachShare * all) sum += weight(hits[count++]);
    const double reach = count > 0 ? hits[count - 1].distance : 0.0;
    return {std::move(hits), centre, reach};
}

/// Adds what is reached from one viewpoint: the vertices about it, and what its rays meet within `struckReaches` reaches.
void include(Aabb& box, const Scene& scene, const Met& met, double struckReaches)
{
    if (met.hits.empty()) return;
    for (const CoarseHit& hit : met.hits)
        if (hit.distance <= struckReaches * met.reach) box.include(hit.position);
    const double radius = kVertexReaches * met.reach;
    for (const Mesh& mesh : scene.meshes)
        for (const auto& triangle : mesh.triangles)
            for (const std::uint32_t v : triangle) {
                const glm::dvec3 d = glm::dvec3(mesh.positions[v]) - glm::dvec3(met.centre);
                if (glm::dot(d, d) <= radius * radius) box.include(mesh.positions[v]);
            }
}

/// Of the brightest channel.
double most(const Vec3& channels)
{
    return double(std::max({channels.x, channels.y, channels.z}));
}

/// A local light and what it meets.
struct LocalLight {
    const Light& light;
    Met met;
    Vec3 middle;  ///< of what it strikes
    double flux;  ///< W onto it, per channel at most
};
LocalLight localLight(const Scene& scene, const Light& light)
{
    Met met = metFrom(scene, viewpointOf(light), true);
    const double solidAngle = light.type == LightType::spot ? 2.0 * double(kPi) * (1.0 - sinCos(double(light.outerConeAngle)).cos) : 4.0 * double(kPi) / 6.0;
    const double flux = met.hits.empty() ? 0.0 : solidAngle * most(light.intensity);
    const Vec3 middle = middleOf(met.hits);
    return {light, std::move(met), middle, flux};
}

/// The irradiance that it brings to a place at most, with nothing between, straight and from what it strikes.
double mostIrradiance(const LocalLight& local, const Vec3& p)
{
    const glm::dvec3 d = glm::dvec3(p) - glm::dvec3(local.middle);
    const double distance2 = std::max(glm::dot(d, d), local.met.reach * local.met.reach);
    return most(sampleLight(local.light, p).irradiance) + (local.flux > 0.0 ? local.flux / (double(kPi) * distance2) : 0.0);
}

/// Which of them matter to what the camera sees within its reach: the others together bring to no place of it more than kNegligibleLight of its light.
std::vector<bool> whichMatter(const std::vector<LocalLight>& lights, double sun, const Met& seen)
{
    std::vector<bool> matters(lights.size(), false);
    std::vector<double> brought(lights.size());
    for (const CoarseHit& hit : seen.hits) {
        if (hit.distance > seen.reach) break;
        double all = sun;
        for (std::size_t i = 0; i < lights.size(); ++i) all += brought[i] = mostIrradiance(lights[i], hit.position);
        for (std::size_t i = 0; i < lights.size(); ++i)
            if (brought[i] * double(lights.size()) > kNegligibleLight * all) matters[i] = true;
    }
    return matters;
}

/// Grown until no vertex is left within its own length: what stands together is not cut apart.
Aabb withNeighbours(Aabb box, const Scene& scene)
{
    for (;;) {
        const Vec3 margin(box.longestSide());
        const Aabb about{box.min - margin, box.max + margin};
        Aabb grown = box;
        for (const Mesh& mesh : scene.meshes)
            for (const auto& triangle : mesh.triangles)
                for (const std::uint32_t v : triangle) {
                    const Vec3& p = mesh.positions[v];
                    if (about.contains(p)) grown.include(p);
                }
        if (grown == box || kReachGain * grown.longestSide() > scene.bounds.longestSide()) return grown;
        box = grown;
    }
}

/// The part of a triangle inside a box.
CutPolygon pieceWithin(const std::array<Vec3, 3>& triangle, const Aabb& box)
{
    CutPolygon piece;
    for (const Vec3& p : triangle) piece.push(glm::dvec3(p));
    for (int axis = 0; axis < 3 && piece.count > 0; ++axis) piece = cut(cut(piece, axis, -1.0, double(box.min[axis])), axis, 1.0, double(box.max[axis]));
    return piece;
}

/// A sun lights the ground beyond what is seen, too, and that lights what is seen: of a ground without end a wall's point at height h gets the share
/// 1 - h / sqrt(h^2 + d^2) from within d. Grown to the surfaces within kSunMargin of its own length.
Aabb withSunlitGround(const Aabb& box, const Scene& scene)
{
    constexpr float kSunMargin = 1.0f;
    const Vec3 margin(kSunMargin * box.longestSide());
    const Aabb about{box.min - margin, box.max + margin};
    Aabb grown = box;
    for (const Mesh& mesh : scene.meshes) {
        if (isDrawnNowhere(scene, mesh)) continue;
        for (const auto& t : mesh.triangles) {
            const CutPolygon piece = pieceWithin({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]}, about);
            for (std::size_t k = 0; k < piece.count; ++k) grown.include(glm::clamp(Vec3(piece.corner[k]), scene.bounds.min, scene.bounds.max));
        }
    }
    return grown;
}

}  // namespace

std::optional<double> reachOf(const Scene& scene, const Camera& camera)
{
    const Met met = metFrom(scene, viewpointOf(camera), false);
    if (met.hits.empty()) return {};
    return glm::length(glm::dvec3(met.centre) - glm::dvec3(camera.position)) + met.reach;
}

Aabb measureReach(const Scene& scene, const Camera& camera)
{
    if (scene.bounds.empty()) return scene.bounds;
    double sun = 0.0;
    for (const Light& light : scene.lights)
        if (light.type == LightType::directional) sun += most(light.intensity);

    Aabb box;
    const auto gains = [&] { return box.empty() || kReachGain * box.longestSide() <= scene.bounds.longestSide(); };
    const Met seen = metFrom(scene, viewpointOf(camera), false);
    include(box, scene, seen, sun > 0.0 ? kVertexReaches : 0.0);  // a sun lights all of what is seen, and what reflects it is there
    if (!gains()) return scene.bounds;                            // the ordinary case, before any light is looked at
    std::vector<LocalLight> lights;
    for (const Light& light : scene.lights)
        if (light.type != LightType::directional && shines(light)) lights.push_back(localLight(scene, light));
    const std::vector<bool> matters = whichMatter(lights, sun, seen);
    for (std::size_t i = 0; i < lights.size() && gains(); ++i)
        if (matters[i]) include(box, scene, lights[i].met, 1.0);
    if (!gains() || box.empty() || !(box.longestSide() > 0.0f)) return scene.bounds;
    const Aabb whole = withNeighbours(box, scene);
    const Aabb& reached = kReachGain * whole.longestSide() <= scene.bounds.longestSide() ? whole : box;
    return sun > 0.0 ? withSunlitGround(reached, scene) : reached;
}

glm::dvec3 chooseOrigin(const Scene& scene, const Camera& camera)
{
    // Where nothing is seen, the scene's far end.
    const Vec3 far = glm::max(glm::abs(scene.bounds.min - camera.position), glm::abs(scene.bounds.max - camera.position));
    double reach = reachOf(scene, camera).value_or(double(std::max({far.x, far.y, far.z})));
    // So far away that all of it may have rounded to one place.
    const Vec3 away = glm::abs(camera.position);
    reach = std::max(reach, 0x1p-16 * double(std::max({away.x, away.y, away.z})));
    if (!(reach > 0.0) || !std::isfinite(reach)) return glm::dvec3(0.0);
    const double lattice = std::ldexp(1.0, std::ilogb(2.0 * kOriginReach * reach) + 1);  // the next power of two
    return glm::floor(glm::dvec3(camera.position) / lattice + 0.5) * lattice;
}

}  // namespace lrsm
