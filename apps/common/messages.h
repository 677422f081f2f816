#pragma once

#include "conetrace/frame/pass_log.h"
#include "core/base/image.h"
#include "core/scene/scene.h"
#include "core/settings/settings.h"

#include <string>
#include <vector>

/// What a user should know that the picture alone does not tell: one line a kind, on standard error, whatever --quiet says.
namespace lrsm {

/// What loading skipped, replaced or assumed (Scene::notes), notes that differ in a name alone put together unless `all`; and lights of intensity 0.
std::vector<std::string> loadMessages(const Scene& scene, bool all = false);

/// Where the scene's extent costs: the grid covers a part, a voxel is larger than what is in view, a light's depths are coarser than a shadow's bias.
std::vector<std::string> extentMessages(const Scene& scene, const Camera& camera, const Settings& settings);

/// What the passes dropped or clamped.
std::vector<std::string> passMessages(const std::vector<PassReport>& passes);

/// The surfaces of a picture; depth 0 where there is none.
struct SeenSurfaces {
    const Image<Vec3>& position;
    const Image<Vec3>& geometricNormal;
    const Image<float>& depth;
};

/// Why no pixel has direct light; empty where one has.
std::vector<std::string> darknessMessages(const Scene& scene, const SeenSurfaces& seen, const Image<Vec3>& direct, const Image<Vec3>& combined);

/// "lrsm: note: ..." a line.
void say(const std::vector<std::string>& messages);

/// Says each kind of message once, for many pictures of one scene: what differs in its numbers alone is one kind.
class SayOnce {
  public:
    void operator()(const std::vector<std::string>& messages);

  private:
    std::vector<std::string> said_;
};

}  // namespace lrsm
