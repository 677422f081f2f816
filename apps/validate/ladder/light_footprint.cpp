#include "apps/validate/ladder/light_footprint.h"

#include "apps/validate/equations/oracle.h"

#include <algorithm>
#include <cmath>

namespace lrsm {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double kLeastAcross = 16.0;  // texels (or parts of texels) across the sphere
constexpr double kMostAcross = 384.0;  // beyond, one texel stands for a block
constexpr int kVisibilityBlocks = 32;  // across the footprint
constexpr double kLeastCosine = 1e-3;  // of <n.l> in Eq. 4
constexpr double kBesideMap = 1.0;     // map widths beyond the border that still count as Omega

struct Interval {
    double low, high;
};

/// The light's rays, as the RSM's texels see them.
class LightRays {
  public:
    explicit LightRays(const LightProjection& p)
        : directional_(p.type == LightType::directional),
          origin_(p.position),
          right_(p.right),
          up_(p.up),
          forward_(p.forward),
          half_(double(p.halfWidth)),
          near_(double(p.depthNear)),
          range_(double(p.depthFar) - double(p.depthNear))
    {
    }

    struct Ray {
        dvec3 origin, direction;
        double solidAngle;  ///< relative
    };
    Ray at(double u, double v) const
    {
        const double x = (2.0 * u - 1.0) * half_, y = (1.0 - 2.0 * v) * half_;
        if (directional_) return {origin_ + right_ * x + up_ * y, forward_, 1.0};
        const double length2 = 1.0 + x * x + y * y, length = std::sqrt(length2);
        return {origin_, (forward_ + right_ * x + up_ * y) / length, 1.0 / (length * length2)};
    }
    double metres(double depth) const { return near_ + depth * range_; }
    double depthOf(double metres) const { return (metres - near_) / range_; }
    double range() const { return range_; }
    bool directional() const { return directional_; }
    double halfWidth() const { return half_; }
    /// Depth of a point, metres from the light as the map measures it.
    double metresOf(const dvec3& p) const
    {
        const dvec3 d = p - origin_;
        return directional_ ? glm::dot(d, forward_) : glm::length(d);
    }
    bool meets(const Ray& ray, const CoveredSphere& sphere) const
    {
        const dvec3 toCentre = sphere.centre - ray.origin;
        const double along = glm::dot(toCentre, ray.direction);
        if (!directional_ && along <= 0.0 && glm::dot(toCentre, toCentre) > sphere.radius * sphere.radius) return false;
        const dvec3 beside = toCentre - ray.direction * along;
        return glm::dot(beside, beside) <= sphere.radius * sphere.radius;
    }

    /// Map coordinates that the sphere can reach.
    void bounds(const CoveredSphere& sphere, Interval& u, Interval& v) const
    {
        const dvec3 d = sphere.centre - origin_;
        const Interval x = extent(glm::dot(d, right_), glm::dot(d, forward_), sphere.radius);
        const Interval y = extent(glm::dot(d, up_), glm::dot(d, forward_), sphere.radius);
        const auto clip = [](double w) { return std::clamp(w, -kBesideMap, 1.0 + kBesideMap); };
        u = {clip(0.5 + 0.5 * x.low / half_), clip(0.5 + 0.5 * x.high / half_)};
        v = {clip(0.5 - 0.5 * y.high / half_), clip(0.5 - 0.5 * y.low / half_)};
    }

  private:
    /// Of the sphere's shadow in one axis: metres, or slopes from a point light.
    Interval extent(double across, double ahead, double radius) const
    {
        if (directional_) return {across - radius, across + radius};
        if (!(ahead > radius)) return {-1e30, 1e30};
        const double root = radius * std::sqrt(across * across + ahead * ahead - radius * radius), below = ahead * ahead - radius * radius;
        return {(across * ahead - root) / below, (across * ahead + root) / below};
    }

    bool directional_;
    dvec3 origin_, right_, up_, forward_;
    double half_, near_, range_;
};

/// Is a point seen from outside the sphere? Remembered for blocks of the lattice.
class LocalVisibility {
  public:
    LocalVisibility(const EmbreeScene* embree, const CoveredSphere& sphere, int across, double texelMetres)
        : embree_(embree),
          sphere_(sphere),
          block_(std::max(1, (across + kVisibilityBlocks - 1) / kVisibilityBlocks)),
          edge_(across / block_ + 1),
          off_(texelMetres / 64.0),
          known_(embree ? std::size_t(edge_) * std::size_t(edge_) : 0, kUnknown)
    {
    }
    bool operator()(int i, int j, const dvec3& x, const dvec3& n)
    {
        if (!embree_) return true;
        signed char& state = known_[std::size_t(j / block_) * std::size_t(edge_) + std::size_t(i / block_)];
        if (state == kUnknown) state = trace(x, n) ? 1 : 0;
        return state == 1;
    }

  private:
    static constexpr signed char kUnknown = -1;

    bool trace(const dvec3& x, const dvec3& n) const
    {
        const double off = off_ + double(embree_->offset(Vec3(x)));
        const dvec3 start = x + n * off;
        const dvec3 d = start - sphere_.centre;
        const double along = glm::dot(d, sphere_.toReceiver);
        const double exit = -along + std::sqrt(std::max(0.0, along * along - glm::dot(d, d) + sphere_.radius * sphere_.radius));
        if (!(exit > 0.0)) return true;
        return !embree_->occluded({Vec3(start), Vec3(sphere_.toReceiver), static_cast<float>(off), static_cast<float>(exit), RayKind::bounce});
    }

    const EmbreeScene* embree_;
    const CoveredSphere& sphere_;
    int block_, edge_;
    double off_;
    std::vector<signed char> known_;
};

/// mean (A R) * V of one layer, `facing` already in.
dvec3 layerRadiance(const TexelSums& sums, double omega, const TermSettings& terms, const CoveredSphere& sphere)
{
    if (!(sums.weight > 0.0)) return dvec3(0.0);
    const double facing = facingTerm(terms, glm::dot(sums.normal, sphere.toReceiver) / sums.weight);
    const double mean = sums.z / sums.weight, variance = std::max(0.0, sums.z2 / sums.weight - mean * mean);
    return sums.radiance / omega * (facing * gaussianShare(-mean, variance, sphere.radius * terms.vRadiusScale));
}

/// The points of the map at which a footprint is read: one a texel, or several in small footprints, or one for a block of texels in huge ones.
struct Lattice {
    double perMap = 1.0;  ///< points along the map's edge
    std::int64_t iBegin = 0, iEnd = 0, jBegin = 0, jEnd = 0;
    double texelMetres = 0.0;

    Lattice(const LightRays& rays, const CoveredSphere& sphere, int resolution)
    {
        Interval u{}, v{};
        rays.bounds(sphere, u, v);
        const double across = std::max(u.high - u.low, v.high - v.low) * resolution;
        if (!(across > 0.0)) return;
        const double parts = across < kLeastAcross ? std::min(std::ceil(kLeastAcross / across), 1e6) : 1.0;
        perMap = resolution * parts / std::ceil(across / kMostAcross);
        iBegin = static_cast<std::int64_t>(std::floor(u.low * perMap));
        iEnd = static_cast<std::int64_t>(std::ceil(u.high * perMap));
        jBegin = static_cast<std::int64_t>(std::floor(v.low * perMap));
        jEnd = static_cast<std::int64_t>(std::ceil(v.high * perMap));
        texelMetres = 2.0 * sphere.radius / across;
    }
    int longest() const { return static_cast<int>(std::max(iEnd - iBegin, jEnd - jBegin)); }
};

/// One pass over a footprint: adds up everything that the rungs need.
class FootprintPass {
  public:
    FootprintPass(const Rsm& rsm, const LayerModel& layers, const TermSettings& terms, const CoveredSphere& sphere, const EmbreeScene* embree)
        : rsm_(rsm),
          layers_(layers),
          terms_(terms),
          sphere_(sphere),
          rays_(rsm.projection),
          lattice_(rays_, sphere, rsm.projection.resolution),
          visible_(embree, sphere, lattice_.longest(), lattice_.texelMetres),
          zc_(rays_.metresOf(sphere.centre)),
          chosen_(layers.select(rays_.depthOf(zc_), sphere.radius * terms.vRadiusScale / rays_.range(), terms.selection)),
          parts_(std::size_t(layers.depthSlices() * layers.normalSlices())),
          selected_(chosen_.size() * std::size_t(layers.normalSlices()))
    {
    }

    void run()
    {
        const int resolution = rsm_.projection.resolution;
        for (std::int64_t j = lattice_.jBegin; j < lattice_.jEnd; ++j)
            for (std::int64_t i = lattice_.iBegin; i < lattice_.iEnd; ++i) {
                const double u = (double(i) + 0.5) / lattice_.perMap, v = (double(j) + 0.5) / lattice_.perMap;
                const LightRays::Ray ray = rays_.at(u, v);
                if (!rays_.meets(ray, sphere_)) continue;
                omega_ += ray.solidAngle;
                const bool onMap = u >= 0.0 && u < 1.0 && v >= 0.0 && v < 1.0;
                const std::size_t index = onMap ? rsm_.texels.index(static_cast<int>(u * resolution), static_cast<int>(v * resolution)) : 0;
                if (onMap && rsm_.texels.texels[index].coverage > 0.0f)
                    addTexel(ray, index, static_cast<int>(i - lattice_.iBegin), static_cast<int>(j - lattice_.jBegin));
                else
                    addUnlit(ray);
            }
    }

    FootprintRadiance result() const
    {
        FootprintRadiance result;
        if (!(omega_ > 0.0)) return result;
        if (surface_ > 0.0) result.eq3 = litSurface_ / surface_;
        TexelSums whole;
        for (const TexelSums& part : parts_) whole += part;
        if (!(whole.weight > 0.0)) return result;

        const double facing = facingTerm(terms_, glm::dot(whole.normal, sphere_.toReceiver) / whole.weight);
        result.eq5 = whole.radiance / omega_ * (facing * inside_ / whole.weight);
        result.eq12 = layerRadiance(whole, omega_, terms_, sphere_);
        for (const TexelSums& part : parts_) result.eq14 += layerRadiance(part, omega_, terms_, sphere_);
        for (std::size_t i = 0; i < selected_.size(); ++i) {
            result.eq15 += chosen_[i / std::size_t(layers_.normalSlices())].share * layerRadiance(selected_[i], omega_, terms_, sphere_);
            result.layers += selected_[i].weight > 0.0 ? 1 : 0;
        }
        result.slope = inside_ > 0.0 ? insideSlope_ / inside_ : slope_ / whole.weight;
        result.insideShare = inside_ / omega_;
        return result;
    }

  private:
    /// Eq. 3's second assumption: where no ray ends inside the sphere there is unlit surface that faces the light.
    void addUnlit(const LightRays::Ray& ray) { surface_ += ray.solidAngle * std::max(0.0, -glm::dot(ray.direction, sphere_.toReceiver)); }

    void addTexel(const LightRays::Ray& ray, std::size_t index, int i, int j)
    {
        const RsmTexel& texel = rsm_.texels.texels[index];
        const double w = ray.solidAngle, depth = double(rsm_.depthLinear.texels[index]), metres = rays_.metres(depth), nDotL = double(texel.nDotL);
        const dvec3 x = ray.origin + ray.direction * metres, n(texel.normal), radiance(texel.radiance), fromCentre = x - sphere_.centre;
        slope_ += w * nDotL;
        if (glm::dot(fromCentre, fromCentre) <= sphere_.radius * sphere_.radius) {
            inside_ += w;
            insideSlope_ += w * nDotL;
            const double nDotV = glm::dot(n, sphere_.toReceiver);
            if (nDotV > 0.0 && visible_(i, j, x, n)) {
                const double seen = w * nDotV / std::max(nDotL, kLeastCosine);  // Eq. 4
                litSurface_ += seen * radiance;
                surface_ += seen;
            }
        } else {
            addUnlit(ray);
        }

        const double z = metres - zc_;
        const TexelSums one{w, w * radiance, w * n, w * z, w * z * z};
        const auto normals = static_cast<std::size_t>(layers_.normalSlices()), normalSlice = static_cast<std::size_t>(layers_.normalSlice(nDotL));
        parts_[static_cast<std::size_t>(layers_.depthSlice(depth)) * normals + normalSlice] += one;
        for (std::size_t s = 0; s < chosen_.size(); ++s)
            if (depth >= chosen_[s].range.depthMin && (depth < chosen_[s].range.depthMax || chosen_[s].holdsEnd)) selected_[s * normals + normalSlice] += one;
    }

    const Rsm& rsm_;
    const LayerModel& layers_;
    const TermSettings& terms_;
    const CoveredSphere& sphere_;
    LightRays rays_;
    Lattice lattice_;
    LocalVisibility visible_;
    double zc_;
    std::vector<SelectedSlice> chosen_;

    double omega_ = 0.0;     ///< all of it
    dvec3 litSurface_{0.0};  ///< Eq. 3, numerator
    double surface_ = 0.0;   ///< and denominator
    double inside_ = 0.0, insideSlope_ = 0.0, slope_ = 0.0;
    std::vector<TexelSums> parts_;     ///< Eq. 13's layers, a partition
    std::vector<TexelSums> selected_;  ///< Eq. 15's
};

}  // namespace

TexelSums& TexelSums::operator+=(const TexelSums& other)
{
    weight += other.weight;
    radiance += other.radiance;
    normal += other.normal;
    z += other.z;
    z2 += other.z2;
    return *this;
}

double facingTerm(const TermSettings& terms, double cosine)
{
    if (!(cosine > 0.0)) return 0.0;
    return terms.backface == Backface::step ? 1.0 : cosine;
}

double gaussianShare(double distance, double variance, double radius)
{
    // Below 1e-14 of the radius squared the moments of equal depths differ by rounding alone.
    return static_cast<double>(oracle::visibility(0.0L, variance > 1e-14 * radius * radius ? variance : 0.0, distance, radius));
}

FootprintRadiance footprintRadiance(const Rsm& rsm, const LayerModel& layers, const TermSettings& terms, const CoveredSphere& sphere, const EmbreeScene* embree)
{
    FootprintPass pass(rsm, layers, terms, sphere, embree);
    pass.run();
    return pass.result();
}

dvec3 beamEmission(const Rsm& rsm, const CoveredBeam& beam)
{
    const LightRays rays(rsm.projection);
    const CoveredSphere around{beam.middle, std::sqrt(beam.radius * beam.radius + 0.25 * beam.length * beam.length), -beam.direction};
    const Lattice lattice(rays, around, rsm.projection.resolution);
    const double resolution = rsm.projection.resolution, cell = 2.0 * rays.halfWidth() / lattice.perMap;
    dvec3 sum(0.0);
    for (std::int64_t j = lattice.jBegin; j < lattice.jEnd; ++j)
        for (std::int64_t i = lattice.iBegin; i < lattice.iEnd; ++i) {
            const double u = (double(i) + 0.5) / lattice.perMap, v = (double(j) + 0.5) / lattice.perMap;
            if (!(u >= 0.0 && u < 1.0 && v >= 0.0 && v < 1.0)) continue;
            const std::size_t index = rsm.texels.index(static_cast<int>(u * resolution), static_cast<int>(v * resolution));
            const RsmTexel& texel = rsm.texels.texels[index];
            if (!(texel.coverage > 0.0f)) continue;
            const LightRays::Ray ray = rays.at(u, v);
            const double metres = rays.metres(double(rsm.depthLinear.texels[index]));
            const dvec3 fromMiddle = ray.origin + ray.direction * metres - beam.middle;
            const double along = glm::dot(fromMiddle, beam.direction);
            const dvec3 beside = fromMiddle - along * beam.direction;
            if (std::abs(along) > 0.5 * beam.length || glm::dot(beside, beside) > beam.radius * beam.radius) continue;
            const double across = ray.solidAngle * cell * cell * (rays.directional() ? 1.0 : metres * metres);  // across the light's ray
            const double facing = std::max(0.0, -glm::dot(dvec3(texel.normal), beam.direction));
            sum += dvec3(texel.radiance) * (across * facing / std::max(double(texel.nDotL), kLeastCosine));
        }
    return sum / (3.14159265358979323846 * beam.radius * beam.radius);
}

}  // namespace lrsm
