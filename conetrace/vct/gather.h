#pragma once

#include "conetrace/frame/cone_record.h"
#include "conetrace/frame/gather.h"
#include "conetrace/frame/gather_plan.h"
#include "voxel/radiance/radiance_volume.h"
#include "voxel/surface/voxel_surface.h"

/// method = vct: voxel cone tracing (Crassin et al. 2011) in a dense grid, as the LRSM paper compares itself with. Light is injected into the voxels, which
/// are pre-filtered for six directions of travel, and cones take radiance and occlusion from them. Cone sets, receivers, places of samples and the filter are
/// those of the other methods; its schedule is the one of `estimator=paper`, one sample a step.
namespace lrsm {

/// A surface beside the voxels that it is of: what whoever watches "vct surface" is shown besides.
struct PlacedSurface {
    const BitGrid& bits;
    const VoxelSurface& surface;
};

/// The pass "vct surface", which radiance caches of voxels have too.
VoxelSurface buildSurface(const GatherInput& input, PassLog& log);

/// The passes "vct surface" (where the injection reads one), "vct inject" and "vct mips".
RadianceVolume buildRadiance(const GatherInput& input, PassLog& log);
/// The same for a frame: in `own`, unless the world outlives the frame: then it is kept with it. Who watches sees each pass's output, and those on the way are
/// not kept.
const RadianceVolume& radianceOf(const GatherInput& input, PassLog& log, RadianceVolume& own);

/// Cones and schedules of VCT: one sample a step, whatever the estimator of other methods.
GatherPlan planVct(const ConeSettings& settings, const Requirements& needs, int gridResolution);

/// Final gathering of all covered pixels, parallel over tiles; the same bits for any number of threads. `record`, when given, is filled besides.
Gathered traceRadiance(const GatherInput& input, const RadianceVolume& volume, ConeRecord* record = nullptr);

/// The passes above and "vct cones". Whoever watches the log is shown the ConeRecord too.
Gathered gatherVct(const GatherInput& input, PassLog& log);

/// The line of the frame's switch.
GatherMethod vctMethod();

}  // namespace lrsm
