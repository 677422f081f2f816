#pragma once

#include "conetrace/caches/clusters.h"

/// A cache a cluster: [C] Sec. 3.2, "Placing Caches".
namespace lrsm {

struct CachePlaces {
    std::vector<std::uint32_t> pixels;  ///< whose surface a cache stands on
    std::vector<Vec3> positions;        ///< world
    std::vector<Vec3> normals;          ///< geometric, unit: axis of the cache's hemisphere
    std::vector<float> pixelSizes;      ///< metres between pixels at the cache's depth
    std::vector<Mat3> frames;           ///< basisFromNormal of the normals, made once: z is the axis

    std::vector<std::uint32_t> rotations;  ///< which set of directions the cones take, 0 .. kRotations - 1: alternates over blocks of 4x4 tiles

    std::size_t size() const { return pixels.size(); }
};

template <class Visit>
void forEachArray(const CachePlaces& places, Visit&& visit)
{
    const auto visitAll = [&](const auto& array) { visit(array, ArrayTraits{array.size() * sizeof(array[0])}); };
    visitAll(places.pixels);
    visitAll(places.positions);
    visitAll(places.normals);
    visitAll(places.pixelSizes);
    visit(places.frames, ArrayTraits{0, false});
    visitAll(places.rotations);
}

/// Makes `frames` from `normals`.
void frameCaches(CachePlaces& places);

/// What the score of a cluster's pixels is taken against.
struct ClusterFrame {
    Vec3 centre{0.0f};    ///< c, of the bounding box of its positions
    Vec3 normal{0.0f};    ///< n_c, mean of its shading normals, unit; where they cancel, its first pixel's
    float length = 1.0f;  ///< s, metres: that box's diagonal, or 1
};
ClusterFrame frameOfCluster(const GBuffer& gbuffer, std::span<const std::uint32_t> pixels, CacheScoreScale scale);

/// (n_p.n_c + (p - c).n_c / s) / (1 + d_c / s), d_c the distance of p from the line through c along n_c. [C] prints it without s, which adds metres to cosines.
float placementScore(const ClusterFrame& cluster, const Vec3& position, const Vec3& normal);

/// Each cluster's pixel of the highest score (ties: the first in the picture).
CachePlaces placeCaches(const GBuffer& gbuffer, const Camera& camera, const PixelClusters& clusters, const CacheSettings& settings, Rotation rotation);

}  // namespace lrsm
