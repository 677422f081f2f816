#include "apps/capture/manifest_write.h"

#include "apps/capture/tables.h"
#include "apps/common/describe.h"
#include "conetrace/frame/direct.h"
#include "conetrace/frame/lobe.h"
#include "conetrace/frame/shadow_map.h"
#include "core/base/elementary.h"
#include "core/scene/brdf.h"
#include "core/settings/settings_table.h"

#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

Json rowsOf(const Mat4& m)
{
    Json rows = Json::array();
    for (int row = 0; row < 4; ++row) rows.push_back({m[0][row], m[1][row], m[2][row], m[3][row]});
    return rows;
}

Json finiteOrNull(float value)
{
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

const char* nameOf(LightType type)
{
    return type == LightType::directional ? "directional" : type == LightType::spot ? "spot" : "cube_face";
}

Json textureUse(const TextureUse& use)
{
    if (!use) return nullptr;
    const glm::mat2& m = use.uvScaleRotation;
    return {{"texture", use.texture},
            {"uv_set", use.uvSet},
            {"scale_rotation", {{m[0][0], m[1][0]}, {m[0][1], m[1][1]}}},
            {"offset", {use.uvOffset.x, use.uvOffset.y}}};
}

Json materialJson(const Material& m)
{
    return {{"name", m.name},
            {"base_color", {m.baseColor.x, m.baseColor.y, m.baseColor.z, m.baseColor.w}},
            {"metallic", m.metallic},
            {"roughness", m.roughness},
            {"normal_scale", m.normalScale},
            {"alpha_mask", m.alphaMask},
            {"alpha_cutoff", m.alphaCutoff},
            {"double_sided", m.doubleSided},
            {"base_color_texture", textureUse(m.baseColorTexture)},
            {"metallic_roughness_texture", textureUse(m.metallicRoughnessTexture)},
            {"normal_texture", textureUse(m.normalTexture)}};
}

Json sceneJson(const Capture& c)
{
    Json materials = Json::array();
    for (const Material& material : c.materials) materials.push_back(materialJson(material));
    return {{"name", c.sceneName},
            {"sha256", c.sceneHash},
            {"origin", vectorJson(c.origin)},
            {"bounds", boxJson(c.sceneBounds)},
            {"reach", boxJson(c.sceneReach)},
            {"complete", c.sceneComplete},
            {"materials", materials}};
}

Json cameraJson(const Capture& c)
{
    Json json = cameraJson(c.camera, Angle::radians);
    json["right"] = vectorJson(glm::normalize(glm::cross(c.camera.forward, c.camera.up)));
    json["clip_from_world"] = rowsOf(clipFromWorld(c.camera, c.width, c.height, c.sceneReach.empty() ? c.sceneBounds : c.sceneReach));
    return json;
}

Json gridJson(const Capture& c)
{
    OpacityPyramid shape;
    shape.axes = c.settings.voxel.axes;
    Json scales = Json::array();
    for (int level = 0; c.grid.resolution >> level >= 1; ++level) scales.push_back(densityScale(shape, level));
    return {{"origin", vectorJson(c.grid.origin)}, {"voxel_size", c.grid.voxelSize}, {"edge", double(c.grid.voxelSize) * c.grid.resolution},
            {"resolution", c.grid.resolution},     {"levels", scales.size()},        {"density_scale", scales}};
}

Json projectionJson(const LightProjection& p)
{
    return {{"position", vectorJson(p.position)},
            {"right", vectorJson(p.right)},
            {"up", vectorJson(p.up)},
            {"forward", vectorJson(p.forward)},
            {"half_width", p.halfWidth},
            {"depth_near", p.depthNear},
            {"depth_far", p.depthFar},
            {"resolution", p.resolution},
            {"clip_from_world", rowsOf(clipFromWorld(p))}};
}

Json partitionJson(const CapturedLight& light)
{
    Json layers = Json::array();
    for (std::size_t i = 0; i < light.partition.size(); ++i) {
        const LayerRange& range = light.partition[i];
        const int stored = light.stored[i];
        layers.push_back({{"depth_min", range.depthMin},
                          {"depth_max", range.depthMax},
                          {"delta", range.delta},
                          {"decay_at_min", range.decayAtMin},
                          {"decay_at_max", range.decayAtMax},
                          {"n_dot_l_min", range.nDotLMin},
                          {"n_dot_l_max", range.nDotLMax},
                          {"stored", stored < 0 ? Json(nullptr) : Json(stored)},
                          {"valid_texels", stored < 0 ? std::uint64_t(0) : light.validTexels[static_cast<std::size_t>(stored)]}});
    }
    return layers;
}

Json capturedLightJson(const CapturedLight& from)
{
    const Light& light = from.light;
    int levels = 0;
    for (int n = from.projection.resolution / 2; n >= 1; n /= 2) ++levels;
    return {{"name", light.name},
            {"type", nameOf(light.type)},
            {"position", vectorJson(light.position)},
            {"direction", vectorJson(light.direction)},
            {"up", vectorJson(light.up)},
            {"intensity", vectorJson(light.intensity)},
            {"inner_cone_angle", light.innerConeAngle},
            {"outer_cone_angle", light.outerConeAngle},
            {"cos_inner", static_cast<float>(sinCos(light.innerConeAngle).cos)},
            {"cos_outer", static_cast<float>(sinCos(light.outerConeAngle).cos)},
            {"range", finiteOrNull(light.range)},
            {"projection", projectionJson(from.projection)},
            {"base_resolution", from.projection.resolution / 2},
            {"levels", levels},
            {"partition", partitionJson(from)}};
}

Json conesJson(const Capture& c, const GatherPlan& plan)
{
    Json rings = Json::array();
    for (std::size_t r = 0; r < plan.cones.rings.size(); ++r) {
        const ConeRing& ring = plan.cones.rings[r];
        rings.push_back({{"first", ring.first},
                         {"count", ring.count},
                         {"inner_angle", ring.innerAngle},
                         {"outer_angle", ring.outerAngle},
                         {"axis_angle", ring.axisAngle},
                         {"tan_half", ring.tanHalf},
                         {"weight", ring.weight},
                         {"schedule", r}});
    }
    Json specular = Json::array();
    for (std::size_t i = 0; i < plan.specularSchedules.size(); ++i)
        specular.push_back({{"tan_half", plan.specularSchedules[i].tanHalf}, {"schedule", plan.ringSchedules.size() + i}});
    const ConeSettings& cones = c.settings.cones;
    return {{"a_pixel", cones.set.count * cones.set.setsPerPixel}, {"rotations", kRotations}, {"rings", rings}, {"specular", specular}};
}

Json gaussianJson(const NormalCdf& phi)
{
    Json json = {{"table_half_width", kTableHalfWidth}, {"table_entries", phi.table().size()}};
    json["polynomial"] = {{"numerator", kCdfNumerator}, {"denominator", kCdfDenominator}, {"limit", kCdfLimit}};
    return json;
}

Json constantsJson()
{
    return {{"pi", kPi},
            {"variance_floor", kVarianceFloor},
            {"shadow_flat_bias", kFlatBias},
            {"shadow_max_bias_slope", kMaxBiasSlope},
            {"shadow_snapping_texels", kSnappingTexels},
            {"shadow_grazing_cosine", kGrazingCosine},
            {"min_specular_alpha", kMinSpecularAlpha},
            {"least_sampled_roughness", kLeastSampledRoughness}};
}

Json toleranceJson(const Tolerance& t)
{
    Json json = {{"kind", nameOf(t.kind)}, {"value", t.value}};
    if (t.floor != 0.0) json["floor"] = t.floor;
    if (t.outliers != 0.0) json["outliers"] = t.outliers;
    if (t.differing != 1.0) json["differing"] = t.differing;
    json["reason"] = t.reason;
    return json;
}

Json bufferJson(const Buffer& b)
{
    Json json = {{"name", b.name},   {"pass", b.pass}, {"file", b.file}, {"dtype", nameOf(b.dtype)}, {"encoding", nameOf(b.encoding)},
                 {"shape", b.shape}, {"axes", b.axes}};
    if (!b.components.empty()) {
        json["components"] = Json::array();
        for (const std::string& component : b.components) json["components"].push_back(component.empty() ? Json(nullptr) : Json(component));
    }
    if (b.dds) json["dds"] = {{"file", b.dds->file}, {"mip", b.dds->mip}, {"format", nameOf(b.dds->format)}, {"volume", b.dds->volume}};
    json["meaning"] = b.meaning;
    json["space"] = b.space;
    json["unit"] = b.unit;
    json["tolerance"] = toleranceJson(b.tolerance);
    json["sha256"] = b.sha256;
    return json;
}

template <class T, class ToJson>
Json listOf(const std::vector<T>& items, ToJson&& toJson)
{
    Json list = Json::array();
    for (const T& item : items) list.push_back(toJson(item));
    return list;
}

}  // namespace

Json manifestJson(const Capture& c)
{
    const CaptureTables tables = makeTables(c.needs, c.settings);
    const GatherPlan& plan = tables.plan;
    Json needs = requirementsJson(c.needs);
    needs.erase("left_out");
    return {{"format", kCaptureFormat},
            {"format_version", kCaptureFormatVersion},
            {"version", c.version},
            {"size", {c.width, c.height}},
            {"scene", sceneJson(c)},
            {"pre_exposure", c.preExposure},
            {"settings", settingsToJson(c.settings)},
            {"requires", needs},
            {"camera", cameraJson(c)},
            {"grid", gridJson(c)},
            {"lights", listOf(c.lights, capturedLightJson)},
            {"cones", conesJson(c, plan)},
            {"gaussian", gaussianJson(tables.phi)},
            {"constants", constantsJson()},
            {"passes", listOf(c.passes,
                              [](const CapturedPass& p) {
                                  return Json{{"name", p.name}, {"inputs", p.inputs}, {"sha256", p.sha256}};
                              })},
            {"buffers", listOf(c.buffers, bufferJson)},
            {"history", listOf(c.history, [](const Blessing& b) {
                 return Json{{"reason", b.reason}, {"version", b.version}, {"buffers", b.buffers}};
             })}};
}

}  // namespace lrsm
