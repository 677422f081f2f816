#pragma once

#include "core/scene/scene.h"

#include <string_view>

namespace lrsm {

/// The notes that the two functions below leave.
inline constexpr std::string_view kDefaultLightNote = "no lights in the file: a sun of 10 W/m^2 from above and the front is assumed";
inline constexpr std::string_view kDefaultCameraNote = "no camera in the file: one that frames the scene from the front, right and above is assumed";

/// The `up` of a light that travels along `direction` (unit): world up made orthogonal to it, or -z for a light that shines
/// (nearly) straight up or down. Unit.
Vec3 uprightFor(const Vec3& direction);

/// A white sun of 10 W/m^2 from above and the front, at an angle to every axis. Says so in the notes.
void addDefaultLight(Scene& scene);

/// Near plane, in metres, of a perspective camera whose file gives none: 1 cm, but no nearer than 10^-5 of the way to the scene's farthest point
/// (beyond, float32 depths cannot order surfaces) and no farther than a hundredth of it (a scene of millimetres must not be cut away).
float nearPlaneFor(const Camera& camera, const Aabb& bounds);

/// A perspective camera outside the bounds that looks at their centre from the front, right and above, far enough away that the
/// whole box is in view for any picture at least as wide as high. A flat scene (one extent 0 or nearly) is looked at from its
/// larger side. Says so in the notes. The bounds must not be empty.
void addDefaultCamera(Scene& scene);

}  // namespace lrsm
