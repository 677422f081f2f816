#pragma once

#include "core/scene/brdf.h"
#include "reference/sobol.h"

/// Maps from the unit square to directions, with their densities over solid angle. All vectors are unit unless stated.
namespace lrsm {

/// About `normal` with density <n.w> / pi.
Vec3 cosineDirection(const Vec3& normal, UnitPoint xi);

/// Uniform within the cone of half angle with cosine `cosHalf` about `axis`; density 1 / (2 pi (1 - cosHalf)).
Vec3 coneDirection(const Vec3& axis, float cosHalf, UnitPoint xi);

/// Direction of a GGX reflection (reflectLobe). May point below the surface: its lobe is then 0.
Vec3 lobeDirection(const Surface& surface, const Vec3& toViewer, UnitPoint xi);

/// Density of lobeDirection: D_v(h) / (4 <v.h>).
float lobeDensity(const Surface& surface, const Vec3& toViewer, const Vec3& toLight);

}  // namespace lrsm
