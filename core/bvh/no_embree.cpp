#include "core/bvh/embree_scene.h"

#include "core/base/errors.h"

/// Where Embree is not built with: a scene cannot be made, so the rest is never called.
namespace lrsm {

struct EmbreeScene::GeometryData {};
struct EmbreeScene::Memory {};

EmbreeScene::EmbreeScene(const Scene& scene, RayKinds /*kinds*/) : scene_(&scene)
{
    throw MachineError("Embree", "this build has none (LRSM_PASSES_ONLY); take visibility=cones or voxel-rays");
}
EmbreeScene::~EmbreeScene() = default;
EmbreeScene::EmbreeScene(EmbreeScene&&) noexcept = default;
std::size_t EmbreeScene::bytes() const
{
    return 0;
}
std::optional<RayHit> EmbreeScene::closestHit(const Ray& /*ray*/) const
{
    return {};
}
bool EmbreeScene::occluded(const Ray& /*ray*/) const
{
    return false;
}
void EmbreeScene::Release::operator()(RTCDeviceTy* /*device*/) const {}
void EmbreeScene::Release::operator()(RTCSceneTy* /*scene*/) const {}

}  // namespace lrsm
