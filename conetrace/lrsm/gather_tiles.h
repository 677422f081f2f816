#pragma once

#include "conetrace/lrsm/gather.h"

/// What the gathers by cones and by rays have in common.
namespace lrsm {

/// Pictures of the G-buffer's size, all 0; `record`, where given, is made ready for the frame's cones.
Gathered emptyGathered(const GBuffer& gbuffer, const Requirements& needs, const ConeSettings& settings, ConeRecord* record);

}  // namespace lrsm
