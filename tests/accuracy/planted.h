#pragma once

#include "conetrace/render.h"

/// Frames with a loss in them: what the limits must not let through.
namespace lrsm::accuracy {

enum class Loss {
    none,           ///< the frame of renderFrame: what the others are told apart from
    layer,          ///< each light's LRSM lacks the layer that it drew fewest texels into
    transmittance,  ///< what is gathered is dimmed by the voxels up to a step nearer to the emitter than it should be
    albedo          ///< the diffuse part has the receiver's albedo twice
};

/// The passes of a frame in their order, with the loss planted between two of them. Of the frame, the four pictures that are held.
Frame renderWithLoss(const Scene& scene, const Camera& camera, Settings settings, int width, int height, Loss loss);

}  // namespace lrsm::accuracy
