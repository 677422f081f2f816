#pragma once

#include "apps/capture/capture.h"
#include "apps/capture/catalogue.h"

/// What is given, of pass "scene".
namespace lrsm {

void describeScene(Catalogue& out, const DescribedFrame& frame, std::size_t light);
/// Fills in the bytes of those that are in the list; the others are left out.
void toBuffers(const Scene& scene, std::vector<Buffer>& buffers);

/// Lights, camera, bounds and materials; with sceneComplete also the meshes: everything that voxelize, renderRsm and renderGBuffer read.
Scene sceneFromCapture(const Capture& capture);

/// No material that a mesh wears reads a texture.
bool withoutTextures(const Scene& scene);

}  // namespace lrsm
