#include "core/scene/coarse_view.h"

#include "core/base/elementary.h"
#include "core/scene/invisible.h"

#include <array>

namespace lrsm {
namespace {

using DVec3 = glm::dvec3;

/// Rays by column and row of the pencil.
struct Pencil {
    DVec3 position, right, up, forward;
    double halfWidth, halfHeight;
    bool parallel;

    explicit Pencil(const Viewpoint& from)
        : position(from.position),
          right(glm::cross(DVec3(from.forward), DVec3(from.up))),
          up(from.up),
          forward(from.forward),
          halfWidth(double(from.halfWidth)),
          halfHeight(double(from.halfHeight)),
          parallel(from.parallel)
    {
    }
    /// Of column or row i, in [-1, 1].
    static double coordinate(int i) { return (2.0 * i + 1.0) / kCoarseEdge - 1.0; }
    DVec3 direction(int x, int y) const { return parallel ? forward : forward + aside(x, y); }
    /// Relative to the pencil's point.
    DVec3 origin(int x, int y) const { return parallel ? aside(x, y) : DVec3(0.0); }

  private:
    DVec3 aside(int x, int y) const { return right * (coordinate(x) * halfWidth) + up * (coordinate(y) * halfHeight); }
};

/// Columns and rows whose rays may meet a triangle, inclusive.
struct RayBox {
    int x0 = 0, x1 = kCoarseEdge - 1, y0 = 0, y1 = kCoarseEdge - 1;
};

/// First and last index whose coordinate lies in [low, high].
void clip(double low, double high, int& first, int& last)
{
    first = std::max(first, int(std::ceil(std::clamp(0.5 * ((low + 1.0) * kCoarseEdge - 1.0), -1.0, double(kCoarseEdge)))));
    last = std::min(last, int(std::floor(std::clamp(0.5 * ((high + 1.0) * kCoarseEdge - 1.0), -1.0, double(kCoarseEdge)))));
}

/// `corners` relative to the pencil's point. A triangle that reaches behind the point may be anywhere.
RayBox raysAt(const Pencil& pencil, const std::array<DVec3, 3>& corners)
{
    constexpr double kSlack = 1e-9;
    RayBox box;
    DVec3 low(1e300), high(-1e300);
    int behind = 0;
    for (const DVec3& p : corners) {
        const double z = pencil.parallel ? 1.0 : glm::dot(p, pencil.forward);
        if (z > 0.0) {
            const DVec3 seen(glm::dot(p, pencil.right) / (z * pencil.halfWidth), glm::dot(p, pencil.up) / (z * pencil.halfHeight), 0.0);
            low = glm::min(low, seen);
            high = glm::max(high, seen);
        } else {
            ++behind;
        }
    }
    if (behind == 3) return {.x0 = 0, .x1 = -1, .y0 = 0, .y1 = -1};
    if (behind > 0) return box;
    clip(low.x - kSlack, high.x + kSlack, box.x0, box.x1);
    clip(low.y - kSlack, high.y + kSlack, box.y0, box.y1);
    return box;
}

/// The triangle that is nearest along a ray so far.
struct Struck {
    DVec3 normal{0.0}, corners{0.0};  ///< not unit; their sum
    bool inside = false;              ///< by more than its edge
};

/// Nearest hits of one mesh after the other.
class Caster {
  public:
    Caster(const Scene& scene, const Viewpoint& from)
        : scene_(scene), pencil_(from), struck_(kCoarseEdge * kCoarseEdge), nearest_(struck_.size()), t_(struck_.size(), 1e300)
    {
    }

    void cast(std::uint32_t m)
    {
        const Mesh& mesh = scene_.meshes[m];
        if (isDrawnNowhere(scene_, mesh)) return;
        const bool doubleSided = scene_.materials[std::size_t(mesh.material)].doubleSided;
        for (const auto& triangle : mesh.triangles) {
            std::array<DVec3, 3> corners;
            for (std::size_t k = 0; k < 3; ++k) corners[k] = DVec3(mesh.positions[triangle[k]]) - pencil_.position;
            const DVec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
            const bool front = glm::dot(normal, pencil_.parallel ? pencil_.forward : corners[0]) < 0.0;
            if (!front && !doubleSided) continue;
            const RayBox box = raysAt(pencil_, corners);
            for (int y = box.y0; y <= box.y1; ++y)
                for (int x = box.x0; x <= box.x1; ++x) meet(corners, normal, front, m, x, y);
        }
    }

    CoarseView finish(bool round) const
    {
        CoarseView view;
        for (int y = 0; y < kCoarseEdge; ++y)
            for (int x = 0; x < kCoarseEdge; ++x) {
                const double u = Pencil::coordinate(x), v = Pencil::coordinate(y);
                if (round && u * u + v * v > 1.0) continue;
                ++view.rays;
                const auto i = std::size_t(y * kCoarseEdge + x);
                if (t_[i] < 1e300) view.hits.push_back(nearest_[i]);
            }
        return view;
    }

  private:
    /// Does the ray lie on the same side of the three planes through its origin and the triangle's edges?
    void meet(const std::array<DVec3, 3>& corners, const DVec3& normal, bool front, std::uint32_t mesh, int x, int y)
    {
        const DVec3 direction = pencil_.direction(x, y), origin = pencil_.origin(x, y);
        const std::array<DVec3, 3> p{corners[0] - origin, corners[1] - origin, corners[2] - origin};
        const double a = glm::dot(direction, glm::cross(p[1], p[0])), b = glm::dot(direction, glm::cross(p[2], p[1])),
                     c = glm::dot(direction, glm::cross(p[0], p[2]));
        if (!((a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0))) return;
        const double t = glm::dot(normal, p[0]) / glm::dot(normal, direction);
        const auto i = std::size_t(y * kCoarseEdge + x);
        if (!(t > 0.0)) return;
        const Struck struck{.normal = normal, .corners = p[0] + p[1] + p[2], .inside = a * b > 0.0 && b * c > 0.0};
        const bool contends = struck.inside && contest(struck, t, mesh, i);
        if (!(t < t_[i])) {
            if (contends) nearest_[i].contender = mesh;
            return;
        }
        const std::optional<std::uint32_t> contender = contends ? std::optional(nearest_[i].mesh) : std::nullopt;
        t_[i] = t;
        struck_[i] = struck;
        // Within the triangle's own bounds: rounding must not lead out of the scene's.
        const DVec3 low = glm::min(glm::min(p[0], p[1]), p[2]), high = glm::max(glm::max(p[0], p[1]), p[2]);
        nearest_[i] = {.distance = t * std::sqrt(glm::dot(direction, direction)),
                       .position = Vec3(pencil_.position + origin + glm::clamp(direction * t, low, high)),
                       .mesh = mesh,
                       .front = front,
                       .contender = contender};
    }

    /// Does a triangle lie in the plane of the nearest so far, over it and not on its corners, with another material?
    bool contest(const Struck& struck, double t, std::uint32_t mesh, std::size_t i) const
    {
        constexpr double kSame = 1e-6;
        const Struck& other = struck_[i];
        if (!other.inside || struck.corners == other.corners || std::abs(t - t_[i]) > kSame * t) return false;
        const DVec3 across = glm::cross(struck.normal, other.normal);
        const double sine2 = glm::dot(across, across), lengths2 = glm::dot(struck.normal, struck.normal) * glm::dot(other.normal, other.normal);
        return sine2 <= kSame * kSame * lengths2 && scene_.meshes[mesh].material != scene_.meshes[nearest_[i].mesh].material;
    }

    const Scene& scene_;
    Pencil pencil_;
    std::vector<Struck> struck_;
    std::vector<CoarseHit> nearest_;
    std::vector<double> t_;
};

}  // namespace

Viewpoint viewpointOf(const Camera& camera)
{
    constexpr float kAspect = 16.0f / 9.0f;
    const float half = camera.perspective ? float(tangent(0.5 * double(camera.verticalFov))) : 0.5f * camera.verticalExtent;
    return {.position = camera.position,
            .forward = camera.forward,
            .up = camera.up,
            .halfWidth = kAspect * half,
            .halfHeight = half,
            .parallel = !camera.perspective};
}

Viewpoint viewpointOf(const Light& light)
{
    const bool spot = light.type == LightType::spot;
    const float half = spot ? float(tangent(double(light.outerConeAngle))) : 1.0f;
    return {.position = light.position, .forward = light.direction, .up = light.up, .halfWidth = half, .halfHeight = half, .round = spot};
}

CoarseView coarseView(const Scene& scene, const Viewpoint& from)
{
    Caster caster(scene, from);
    for (std::uint32_t m = 0; m < scene.meshes.size(); ++m) caster.cast(m);
    return caster.finish(from.round);
}

}  // namespace lrsm
