#pragma once

#include "apps/capture/capture.h"
#include "conetrace/lrsm/gather.h"
#include "conetrace/render.h"

/// Each pass's output to its buffers, and back: from a capture (or a candidate's buffers laid over one) any pass can be run anew on what
/// the pass before it left. What comes back has the very bits that went in: equal hashes (hashOf, arrays.h).
namespace lrsm {

/// Every buffer of a frame, described but empty: names, shapes, meanings, tolerances. `layersStored` has one entry a light.
std::vector<Buffer> describeBuffers(const Scene& scene, const Requirements& needs, const Settings& settings, int width, int height,
                                    const std::vector<int>& layersStored);

// To buffers: fill in the bytes of those of the pass that are in the list; the others are left out.
void toBuffers(const Scene& scene, std::vector<Buffer>& buffers);
void toBuffers(const OpacityPyramid& opacity, std::vector<Buffer>& buffers);
void toBuffers(const Rsm& rsm, std::size_t light, std::vector<Buffer>& buffers);
void toBuffers(const Lrsm& lrsm, std::size_t light, std::vector<Buffer>& buffers);
void toBuffers(const GBuffer& gbuffer, std::vector<Buffer>& buffers);
void toBuffers(const Gathered& gathered, std::vector<Buffer>& buffers);
void toBuffers(const ConeRecord& cones, std::vector<Buffer>& buffers);
void toBuffers(const Image<Vec3>& picture, const std::string& name, std::vector<Buffer>& buffers);

// From buffers. Each throws InputError naming the buffer that is not in the capture.
/// The base level and its mips as they are, whether or not the one follows from the other.
OpacityPyramid opacityFromCapture(const Capture& capture);
BitGrid bitsFromCapture(const Capture& capture);
Rsm rsmFromCapture(const Capture& capture, std::size_t light);
Lrsm lrsmFromCapture(const Capture& capture, std::size_t light);
GBuffer gbufferFromCapture(const Capture& capture);
Gathered gatheredFromCapture(const Capture& capture);
Image<Vec3> pictureFromCapture(const Capture& capture, const std::string& name);
/// The irradiance that the composite reads: the filter's where it ran.
Image<Vec3> irradianceFromCapture(const Capture& capture);

/// Lights, camera, bounds and materials; with sceneComplete also the meshes: everything that voxelize, renderRsm and renderGBuffer read.
Scene sceneFromCapture(const Capture& capture);

}  // namespace lrsm
