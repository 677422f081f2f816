#pragma once

#include "conetrace/frame/gbuffer.h"

namespace lrsm {

/// 1 / (distance of what a pixel sees), cosine-weighted mean over the hemisphere, as far as the picture itself shows it, 1/m: along eight directions of the
/// screen the horizon rises with what stands above the tangent plane, and a rise of the sine from e0 to e1 covers e1^2 - e0^2 of that slice's weight. What
/// the picture does not show counts as far. 0 where nothing was drawn.
Image<float> nearnessOf(const GBuffer& gbuffer);

/// `passes` (1..3) a-trous passes after filterIrradiance: tents of 3x3 taps, 4, 8, 16 pixels apart, over pixels of the same surface (same_surface.h) that it
/// joins: all pixels between two taps belong to it, so nothing is lent across a thin wall seen from its edge. A tap at distance x weighs
/// max(0, 1 - x nearness / kGradientTolerance) besides, by the larger nearness of the two: the irradiance gradient on a wall is bounded by nearness (Ward and
/// Heckbert, "Irradiance Gradients", 1992), so open walls are smoothed and corners and contacts keep their shading. Opposite taps weigh the lesser of
/// both: a field that changes evenly over the picture stays as it is, up to the edge of its surface. The tolerance is measured: at 320x180 .25 takes the
/// Cornell box from .106 to .118.
inline constexpr float kGradientTolerance = 0.125f;
Image<Vec3> smoothIrradiance(const Image<Vec3>& irradiance, const GBuffer& gbuffer, int passes);

}  // namespace lrsm
