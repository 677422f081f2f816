#pragma once

#include "conetrace/caches/gather.h"
#include "core/imageio/display.h"

namespace lrsm {

/// What happens in method=caches: above, the picture's clusters in colours of their own with a white cross on each cache's pixel; below, at most as high, level
/// 0 of the caches in their order.
Image<Rgb8> cachesPicture(const Caches& caches, float exposureStops);

}  // namespace lrsm
