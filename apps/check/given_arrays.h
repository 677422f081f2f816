#pragma once

#include "apps/capture/dds.h"
#include "apps/check/arrange.h"
#include "core/imageio/image_io.h"

/// What files hold, as arrays (internal to the candidate's reader).
namespace lrsm {

GivenArray fromNpy(NpyArray array);

/// One mip of all layers. Typeless formats are taken as the golden's.
GivenArray fromTexture(const Buffer& golden, const DdsTexture& texture, std::uint32_t mip);

GivenArray fromLayer(const LayeredImage& image, const ImageLayer& layer);

/// One channel as a layer of its own: "gbuffer.depth" of a buffer without components.
ImageLayer channelOf(const ImageLayer& layer, std::size_t channel);

}  // namespace lrsm
