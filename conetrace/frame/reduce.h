#pragma once

#include "conetrace/frame/gather.h"
#include "conetrace/frame/gbuffer.h"
#include "core/base/arrays.h"
#include "core/base/counters.h"

#include <cstdint>
#include <vector>

/// Fewer pixels to gather for (`gather_divisor`): one in the middle of each block, whose light the others take by joint bilateral upsampling (Kopf et al.
/// 2007; here normals and tangent planes in place of a range weight). Pixels that no block speaks for, at edges and on what is thinner than a block, are
/// gathered for themselves. It is a smaller G-buffer with its pixels in another order, so that every method gathers for it as for any other.
namespace lrsm {

inline constexpr float kLeastBlockWeight = 0.1f;  ///< bilinear weight of the blocks on a pixel's own surface, below which it stands alone

struct ReducedGBuffer {
    GBuffer gbuffer;                    ///< rows of blocks, then rows of pixels that stand alone, the last one filled up with nothing
    int divisor = 1;                    ///< edge of a block, pixels
    int blockRows = 0;                  ///< rows of the G-buffer that are blocks; what averages neighbours keeps to them
    std::vector<std::uint32_t> source;  ///< the full G-buffer's pixel of each of the reduced one's, as far as those that stand alone
    std::uint64_t alone = 0;

    std::size_t blockCount() const { return std::size_t(blockRows) * std::size_t(gbuffer.width); }
};

template <class Visit>
void forEachArray(const ReducedGBuffer& reduced, Visit&& visit)
{
    forEachArray(reduced.gbuffer, visit);
    visit(reduced.source, ArrayTraits{0});
}

inline Counters countersOf(const ReducedGBuffer& reduced)
{
    return {{"pixels_alone", double(reduced.alone)}};
}

/// All pixels, each a block of its own.
ReducedGBuffer everyPixel(const GBuffer& gbuffer);

/// divisor >= 2.
ReducedGBuffer reduceGBuffer(const GBuffer& gbuffer, int divisor);

/// Light gathered for `reduced` at each pixel of the G-buffer that it was made of: of the four blocks around a pixel those on its surface (same_surface.h), by
/// bilinear weights that sum to 1. Bilinear fields on a plane are kept between the outermost blocks' pixels. Where directions alternate over 4x4 pixels, those
/// that stand alone are averaged with their neighbours once they all have light.
Gathered upsample(const Gathered& light, const ReducedGBuffer& reduced, const GBuffer& gbuffer);

}  // namespace lrsm
