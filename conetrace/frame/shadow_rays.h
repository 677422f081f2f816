#pragma once

#include "conetrace/frame/gbuffer.h"
#include "core/scene/light.h"

namespace lrsm {

/// V of every pixel's surface towards one light, exactly: 1 where the straight line to the light is free or no light arrives anyway, 0 where a triangle is in
/// its way.
///
/// An irregular z-buffer (Johnson et al., "The Irregular Z-Buffer", TOG 24(4), 2005; Aila and Laine, "Alias-Free Shadow Maps", EGSR 2004; frustum-traced: Wyman
/// et al., I3D 2015): the light's picture is taken at the surfaces' own places instead of texel centres. They are sorted into a grid over the light's view, and
/// each triangle meets those in the cells that it touches. No map, no texel, no bias.
///
/// As the path tracer's shadow rays, shared by no line of code: a line starts kShadowRayOffset off the surface; faces that turn their back to the light stop
/// nothing unless double-sided; alpha masks are read where the line meets them. Decisions are in double, and neighbours leave no gap: the same sums with the
/// other sign decide both sides of an edge.
Image<std::uint8_t> traceShadowRays(const Scene& scene, const GBuffer& gbuffer, const Light& light, const Requirements& needs);

/// How far off the surface, along the geometric normal: these shares of its own largest coordinate and of the scene's.
inline constexpr float kShadowRayOffset = 0x1p-19f;
inline constexpr float kShadowRaySceneOffset = 0x1p-22f;

}  // namespace lrsm
