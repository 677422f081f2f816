#pragma once

#include "reference/light_guide.h"
#include "reference/light_map.h"
#include "reference/tracer.h"

#include <vector>

/// Lit points found from the lights' side, for many receivers to choose from.
///
/// Light that a point x receives by one more reflection is E f = integral of L(y) f(w) dw over directions w, y what is seen along w, f the receiver's response
/// (<n.w> for irradiance). Two techniques find y, and each light's part of L is shared out between them by the balance heuristic (Veach 1997, 9.2.2):
///
///     a: draw w by its density p_a, trace the ray              share s_a = p_a / (p_a + c p_b)
///     b: draw a ray of a light, take the point y it strikes    share s_b = c p_b / (p_a + c p_b)
///
/// p_b is b's density over w. A ray of the light through (u, v) of its square, drawn with density q(u, v) (light_density.h), strikes a surface of normal n at
/// y:
///
///     p_b(w) = q |d(u, v) / dA| <n.l> d^2 / <n.-w>,    d = |y - x|
///
/// c, the candidates of b for each sample of a, may be any constant: s_a + s_b = 1 whatever it is.
///
/// Of a pool of N points b evaluates s_b L f / p_b everywhere but for what lies between, and looks only at a few, drawn in proportion to these weights w_j
/// (resampled importance sampling: Talbot, Cline and Egbert, EGSR 2005). With V_j = 1 where x sees y_j,
///
///     estimate = (sum of w) / N * [s_b L f / p_b]_j V_j / w_j
///
/// has the mean (1/N) sum of [s_b L f / p_b]_i V_i over the choice of j, and integral of s_b L f dw over the pool, for any w_j that is positive where light can
/// come.
namespace lrsm {

inline constexpr std::size_t kPoolLanes = 4;

struct LightPool {
    std::size_t drawn = 0;  ///< N: with the rays that found nothing lit

    // What weighing reads, an array a number: the points of subset 0, those of subset 1 ..., each with zeros up to a multiple of kPoolLanes.
    std::size_t subsets = 1;        ///< point i is of subset i % subsets: a receiver weighs one of them
    std::vector<float> x, y, z;     ///< position
    std::vector<float> gx, gy, gz;  ///< unit geometric normal, on the lit side
    std::vector<float> nx, ny, nz;  ///< unit shading normal
    std::vector<float> density;     ///< q |d(u, v) / dA| <n.l>: over the surface, 1/m^2
    std::vector<float> brightness;  ///< sum of the diffuse radiance's channels, times `reach`
    /// The rest, side by side for who has chosen a point.
    struct Point {
        Surface surface;
        float density = 0.0f, brightness = 0.0f;  ///< as above
        float reach = 1.0f;                       ///< how likely the point is to be seen
        bool glossy = false;                      ///< its specular reflection counts, too
        Vec3 diffuse{0.0f};                       ///< its diffuse radiance
        std::uint32_t light = 0;
        SurfaceHit hit;
        LightSample sample;  ///< of the light
        Vec3 radianceTowards(const Vec3& toViewer) const { return glossy ? diffuse + specularRadiance(surface, sample, toViewer) : diffuse; }
    };
    std::vector<Point> points;
    std::vector<std::uint32_t> glossy;  ///< which points are
    Transport transport = Transport::single;

    std::size_t size() const { return points.size(); }
    std::size_t slotsASubset() const { return (subsetSize(0) + kPoolLanes - 1) / kPoolLanes * kPoolLanes; }
    std::size_t subsetSize(std::size_t subset) const { return size() > subset ? (size() - subset - 1) / subsets + 1 : 0; }
    Vec3 position(std::size_t i) const { return points[i].surface.position; }
};

/// N = `count` points of the lights' squares, `first` .. first + count - 1 of `points`, to what they strike.
LightPool drawPool(Tracer& tracer, std::span<const LightMap> maps, const TileGuide& guide, const SobolBlock& points, std::uint32_t first, std::uint32_t count,
                   Transport transport);

/// Sets the arrays that weighing reads. drawPool leaves them as one subset.
void layOut(LightPool& pool, std::size_t subsets);

/// A shading normal turned away from who looks, or from its own triangle, depends on who looks (evaluateSurface): technique b leaves such points to a.
bool seenAlike(const Vec3& geometricNormal, const Vec3& normal, const Vec3& toViewer);
inline constexpr float kLeastFacing = 1e-4f;

}  // namespace lrsm
