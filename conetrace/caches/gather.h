#pragma once

#include "conetrace/caches/evaluate.h"
#include "conetrace/caches/fill.h"

/// method = caches: Rehfeld, Zirr and Dachsbacher, "Clustered Pre-convolved Radiance Caching", EGPGV 2014 ([C] here). Pixels are clustered by tile, depth and
/// normal, a cache is placed in each cluster, a cone traced for each of its texels and the caches pre-convolved; pixels take the mean of the caches near them.
namespace lrsm {

/// Clusters, their caches, and what these see.
struct Caches {
    PixelClusters clusters;
    CachePlaces places;
    CacheAtlas atlas;
};

/// The passes "rc clusters", "rc places", those of what fills the caches, "rc fill" and "rc convolve". What fills them by rc_fill: the LRSMs ("lrsm 0", ...);
/// method vct's volume ("vct surface", "vct inject", "vct mips"); lit voxels ("vct surface", "rc light", "rc mips").
Caches buildCaches(const GatherInput& input, PassLog& log);

/// The passes above and "rc gather". Whoever watches the log is shown the Caches under "rc gather" too.
Gathered gatherCaches(const GatherInput& input, PassLog& log);

/// The line of the frame's switch.
GatherMethod cachesMethod(const CacheSettings& settings);

}  // namespace lrsm
