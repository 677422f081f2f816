#pragma once

#include "core/scene/scene.h"

namespace lrsm {

/// A white sun of 10 W/m^2 from above and the front, at an angle to every axis. Says so in the notes.
void addDefaultLight(Scene& scene);

/// A perspective camera outside the bounds that looks at their centre from the front, right and above, far enough away that the
/// whole box is in view for any picture at least as wide as high. A flat scene (one extent 0 or nearly) is looked at from its
/// larger side. Says so in the notes. The bounds must not be empty.
void addDefaultCamera(Scene& scene);

}  // namespace lrsm
