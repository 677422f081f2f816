#pragma once

#include "conetrace/frame/cone_record.h"
#include "conetrace/frame/gather.h"
#include "lrsm/layers.h"

/// method = lrsm: cones through binary voxels that take their light from layered reflective shadow maps (Sec. 4).
namespace lrsm {

/// The pre-filtered layers of every light's map; passes "lrsm 0", "lrsm 1", ...
std::vector<Lrsm> buildLrsms(const std::vector<Rsm>& rsms, const LayerSettings& settings, PassLog& log);
/// The same for a frame: in `own`, unless the world outlives the frame: then they are kept with it, each as long as its RSM.
const std::vector<Lrsm>& layersOf(const GatherInput& input, PassLog& log, std::vector<Lrsm>& own);

/// Final gathering (Sec. 3.2) of all covered pixels, parallel over 16x16 tiles; the same bits for any number of threads.
/// Irradiance is pi * sum of weight * I over the diffuse cones, opacity their weighted mean, specular the I of the specular cone.
/// `opacity` and `lrsms` are the world; the camera decides the mirror direction. `record`, when given, is filled besides. `lanes`: as marchSlabBatch
/// takes it; the bits are the same.
Gathered traceCones(const GBuffer& gbuffer, const Camera& camera, const OpacityPyramid& opacity, const std::vector<Lrsm>& lrsms, const Requirements& needs,
                    const ConeSettings& settings, ConeRecord* record = nullptr, int lanes = 0);

/// The passes "lrsm 0", ..., then "cones", or "bvh" (rays through triangles) and "rays" (gather_rays.h). Whoever watches the log is shown the ConeRecord too.
Gathered gatherLrsm(const GatherInput& input, PassLog& log);

/// The line of the frame's switch. Rays through triangles read no voxels.
GatherMethod lrsmMethod(Visibility visibility);

}  // namespace lrsm
