#pragma once

#include "apps/capture/capture.h"
#include "apps/capture/catalogue.h"
#include "lrsm/depth_map.h"
#include "lrsm/layers.h"

/// The buffers of the passes of a light: "rsm 0", "lrsm 0", ... Values as the passes hold them (float32 that the storage can represent) to the
/// storage's own bits, and back: what comes back has the very bits that went in.
namespace lrsm {

void describeRsm(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeShadow(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeLrsm(Catalogue& out, const DescribedFrame& frame, std::size_t light);

// Fill in the bytes of those that are in the list; the others are left out.
void toBuffers(const Rsm& rsm, std::size_t light, std::vector<Buffer>& buffers);
void toBuffers(const DepthMap& map, std::size_t light, std::vector<Buffer>& buffers);
void toBuffers(const Lrsm& lrsm, std::size_t light, std::vector<Buffer>& buffers);

// InputError naming the buffer that is not in the capture.
Rsm rsmFromCapture(const Capture& capture, std::size_t light);
/// What shadows are compared with: a map of its own, or the depth of the RSM.
DepthMap depthMapFromCapture(const Capture& capture, std::size_t light);
Lrsm lrsmFromCapture(const Capture& capture, std::size_t light);

}  // namespace lrsm
