#pragma once

#include "apps/capture/capture.h"
#include "apps/capture/catalogue.h"
#include "conetrace/vct/gather.h"

/// The volumes of method=vct, as the dense grids that a GPU has; in memory only bricks near surfaces are held. What comes back has the very bits that went in.
namespace lrsm {

void describeVctSurface(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeVctBase(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeVctMips(Catalogue& out, const DescribedFrame& frame, std::size_t light);

// Fill in the bytes of those that are in the list; the others are left out.
void toBuffers(const PlacedSurface& placed, std::vector<Buffer>& buffers);
void baseToBuffers(const RadianceVolume& volume, std::vector<Buffer>& buffers);
void mipsToBuffers(const RadianceVolume& volume, std::vector<Buffer>& buffers);

// InputError naming the buffer that is not in the capture.
VoxelSurface surfaceFromCapture(const Capture& capture, const BitGrid& bits);
/// Base and mips as they are, whether or not the ones follow from the other.
RadianceVolume radianceFromCapture(const Capture& capture);

}  // namespace lrsm
