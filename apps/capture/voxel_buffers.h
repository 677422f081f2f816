#pragma once

#include "apps/capture/capture.h"
#include "apps/capture/catalogue.h"
#include "voxel/opacity_pyramid.h"

/// The buffers of "voxelize" and "voxel mips". What comes back has the very bits that went in.
namespace lrsm {

void describeBits(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeVoxelMips(Catalogue& out, const DescribedFrame& frame, std::size_t light);

// Fill in the bytes of those that are in the list; the others are left out.
void toBuffers(const BitGrid& grid, std::vector<Buffer>& buffers);
void toBuffers(const OpacityPyramid& opacity, std::vector<Buffer>& buffers);  ///< the levels above the bits

// InputError naming the buffer that is not in the capture.
BitGrid bitsFromCapture(const Capture& capture);
/// The base level and its mips as they are, whether or not the one follows from the other.
OpacityPyramid opacityFromCapture(const Capture& capture);

}  // namespace lrsm
