#pragma once

#include "conetrace/proxies/gather.h"
#include "core/imageio/display.h"

namespace lrsm {

/// What of method=proxies a picture is made of, as its passes show it.
struct SeenProxies {
    ProxyCells cells;
    VisibilityLists marched, filtered;  ///< `filtered` is empty where there is no filter
};

/// Four parts: above, the proxies as discs by what they reflect (those that reflect nothing dark blue), and the cells, a colour each; below, how many cells
/// each pixel's list has, before and after the filter, both from dark blue (none) to yellow (the longest list of all).
Image<Rgb8> proxiesPicture(const SeenProxies& seen, const Camera& camera, int width, int height, float exposureStops);

}  // namespace lrsm
