#pragma once

#include "apps/capture/capture.h"
#include "apps/capture/catalogue.h"
#include "conetrace/caches/gather.h"

/// The buffers of method=caches. How many clusters, pixels and tiles there are is known only when they are made: until then buffers are described with the most
/// that can be. What comes back has the very bits that went in.
namespace lrsm {

void describeLitVoxels(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeVoxelRadiance(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeClusters(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describePlaces(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeFill(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeConvolved(Catalogue& out, const DescribedFrame& frame, std::size_t light);
void describeCachedLight(Catalogue& out, const DescribedFrame& frame, std::size_t light);

/// Gives the buffers in the list the shapes of what was made.
void shapeBuffers(const PixelClusters& clusters, std::vector<Buffer>& buffers);
void shapeBuffers(const CachePlaces& places, std::vector<Buffer>& buffers);

// Fill in the bytes of those that are in the list, in the shapes that they have: where less was made the rest is 0, where more it is left out.
void litToBuffers(const IsotropicVolume& volume, std::vector<Buffer>& buffers);
void prefilteredToBuffers(const IsotropicVolume& volume, std::vector<Buffer>& buffers);
void toBuffers(const PixelClusters& clusters, std::vector<Buffer>& buffers);
void toBuffers(const CachePlaces& places, std::vector<Buffer>& buffers);
void filledToBuffers(const CacheAtlas& atlas, std::vector<Buffer>& buffers);
void convolvedToBuffers(const CacheAtlas& atlas, std::vector<Buffer>& buffers);
void cachedLightToBuffers(const Gathered& gathered, std::vector<Buffer>& buffers);

// InputError naming the buffer that is not in the capture, or holds an index beyond what it counts.
/// All levels as they are, whether or not the ones follow from the other.
IsotropicVolume isotropicFromCapture(const Capture& capture);
PixelClusters clustersFromCapture(const Capture& capture);
CachePlaces placesFromCapture(const Capture& capture);
/// Level 0 alone; or all, whether or not the ones follow from the other.
CacheAtlas filledFromCapture(const Capture& capture);
CacheAtlas atlasFromCapture(const Capture& capture);

}  // namespace lrsm
