#pragma once

#include "conetrace/caches/normal_axes.h"
#include "conetrace/frame/gbuffer.h"

#include <vector>

/// Pixels that share a cache: [C] Sec. 3.2, after Olsson, Billeter and Assarsson, "Clustered Deferred and Forward Shading", HPG 2012.
namespace lrsm {

/// Clusters are numbered tile by tile, in a tile by key; the pixels of a cluster are in the picture's order.
struct PixelClusters {
    int tile = 0;       ///< pixels along its edge: rc_tile, doubled while there were more than rc_max clusters
    int doublings = 0;  ///< how often that was
    int tilesX = 0, tilesY = 0;
    std::vector<NormalAxes> axes;          ///< of each tile, row by row; 0 where nothing was drawn in it
    std::vector<std::uint32_t> tileFirst;  ///< clusters of tile t: [tileFirst[t], tileFirst[t + 1])
    std::vector<std::uint32_t> keys;       ///< of each cluster: slice << 3 | axis << 1 | normals point against it
    std::vector<std::uint32_t> first;      ///< pixels of cluster c: pixels[first[c]] .. pixels[first[c + 1] - 1]
    std::vector<std::uint32_t> pixels;     ///< all covered ones
    Image<std::uint32_t> clusterOf;        ///< of each pixel, + 1; 0 where nothing was drawn

    std::size_t size() const { return keys.size(); }
};

inline constexpr int kSliceShift = 3;

template <class Visit>
void forEachArray(const PixelClusters& clusters, Visit&& visit)
{
    const auto visitAll = [&](const auto& array) { visit(array, ArrayTraits{array.size() * sizeof(array[0])}); };
    visitAll(clusters.axes);
    visitAll(clusters.tileFirst);
    visitAll(clusters.keys);
    visitAll(clusters.first);
    visitAll(clusters.pixels);
    visitAll(clusters.clusterOf.texels);
}

/// Depth slices grow with distance so that clusters are about as deep as a tile is wide: floor(log2(z/near) / log2(1 + 2 tan(fov/2) / S_y)), S_y tiles on the
/// picture's height. Of an orthographic camera: floor(z / height of a tile).
class DepthSlices {
  public:
    DepthSlices(const Camera& camera, int pictureHeight, int tile);
    std::uint32_t operator()(float depth) const;

  private:
    bool perspective_;
    float nearPlane_, scale_;
};

/// Sorts the covered pixels by tile, slice and axis.
PixelClusters clusterPixels(const GBuffer& gbuffer, const Camera& camera, const CacheSettings& settings);

Counters countersOf(const PixelClusters& clusters);

}  // namespace lrsm
