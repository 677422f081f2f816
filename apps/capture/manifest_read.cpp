#include "apps/capture/manifest_read.h"

#include "core/base/json_reader.h"
#include "core/settings/settings_table.h"

#include <algorithm>
#include <limits>
#include <set>

namespace lrsm {

namespace {

constexpr std::int64_t kMaxInt = std::numeric_limits<std::int32_t>::max();
constexpr std::int64_t kMaxEdge = 16384;

TextureUse textureUse(const JsonReader& in)
{
    TextureUse use;
    if (in.isNull()) return use;
    use.texture = static_cast<int>(in["texture"].whole(0, kMaxInt));
    use.uvSet = static_cast<int>(in["uv_set"].whole(0, 1));
    const auto rows = in["scale_rotation"].items(2);
    for (int row = 0; row < 2; ++row)
        for (int column = 0; column < 2; ++column)
            use.uvScaleRotation[column][row] = rows[static_cast<std::size_t>(row)].items(2)[static_cast<std::size_t>(column)].real();
    const auto offset = in["offset"].items(2);
    use.uvOffset = Vec2(offset[0].real(), offset[1].real());
    return use;
}

Material material(const JsonReader& in)
{
    Material m;
    m.name = in["name"].text();
    const auto color = in["base_color"].items(4);
    for (int k = 0; k < 4; ++k) m.baseColor[k] = color[static_cast<std::size_t>(k)].real();
    m.metallic = in["metallic"].real();
    m.roughness = in["roughness"].real();
    m.normalScale = in["normal_scale"].real();
    m.alphaMask = in["alpha_mask"].flag();
    m.alphaCutoff = in["alpha_cutoff"].real();
    m.doubleSided = in["double_sided"].flag();
    m.baseColorTexture = textureUse(in["base_color_texture"]);
    m.metallicRoughnessTexture = textureUse(in["metallic_roughness_texture"]);
    m.normalTexture = textureUse(in["normal_texture"]);
    return m;
}

Aabb box(const JsonReader& in)
{
    return in.isNull() ? Aabb{} : Aabb{in["min"].vector(), in["max"].vector()};
}

Requirements requirements(const JsonReader& in)
{
    return {in["specular"].flag(), in["alpha_test"].flag(), in["normal_maps"].flag(), in["textures"].flag(), in["vertex_colors"].flag(), {}};
}

Camera camera(const JsonReader& in)
{
    Camera c;
    c.name = in["name"].text();
    c.position = in["position"].vector();
    c.forward = in["forward"].vector();
    c.up = in["up"].vector();
    c.perspective = in["perspective"].flag();
    if (c.perspective)
        c.verticalFov = in["vertical_fov"].real();
    else
        c.verticalExtent = in["vertical_extent"].real();
    c.nearPlane = in["near_plane"].real();
    return c;
}

LightType lightType(const JsonReader& in)
{
    const std::string name = in.text();
    if (name == "directional") return LightType::directional;
    if (name == "spot") return LightType::spot;
    if (name == "cube_face") return LightType::cubeFace;
    in.fail("\"" + name + "\" is none of directional, spot, cube_face");
}

LightProjection projection(const JsonReader& in, LightType type, int rsmResolution)
{
    LightProjection p;
    p.type = type;
    p.position = in["position"].vector();
    p.right = in["right"].vector();
    p.up = in["up"].vector();
    p.forward = in["forward"].vector();
    p.halfWidth = in["half_width"].real();
    p.depthNear = in["depth_near"].real();
    p.depthFar = in["depth_far"].real();
    p.resolution = static_cast<int>(in["resolution"].whole(rsmResolution, rsmResolution));
    if (!(p.halfWidth > 0.0f)) in["half_width"].fail("must be above 0");
    if (!(p.depthFar > p.depthNear)) in["depth_far"].fail("must be above depth_near");
    return p;
}

void readPartition(const JsonReader& in, CapturedLight& light)
{
    for (const JsonReader& item : in.items()) {
        LayerRange range;
        range.depthMin = item["depth_min"].real();
        range.depthMax = item["depth_max"].real();
        range.delta = item["delta"].real();
        range.decayAtMin = item["decay_at_min"].flag();
        range.decayAtMax = item["decay_at_max"].flag();
        range.nDotLMin = item["n_dot_l_min"].real();
        range.nDotLMax = item["n_dot_l_max"].real();
        if (!(range.depthMax > range.depthMin)) item["depth_max"].fail("must be above depth_min");
        light.partition.push_back(range);
        if (item["stored"].isNull()) {
            light.stored.push_back(-1);
            continue;
        }
        const auto next = static_cast<std::int64_t>(light.validTexels.size());
        light.stored.push_back(static_cast<int>(item["stored"].whole(next, next)));
        light.validTexels.push_back(static_cast<std::uint64_t>(item["valid_texels"].whole(0, std::numeric_limits<std::int64_t>::max())));
    }
}

CapturedLight capturedLight(const JsonReader& in, const Settings& settings)
{
    CapturedLight captured;
    Light& light = captured.light;
    light.name = in["name"].text();
    light.type = lightType(in["type"]);
    light.position = in["position"].vector();
    light.direction = in["direction"].vector();
    light.up = in["up"].vector();
    light.intensity = in["intensity"].vector();
    light.innerConeAngle = in["inner_cone_angle"].real();
    light.outerConeAngle = in["outer_cone_angle"].real();
    light.range = in["range"].isNull() ? kInfinity : in["range"].real();
    captured.projection = projection(in["projection"], light.type, settings.rsm.resolution);
    readPartition(in["partition"], captured);
    return captured;
}

/// A file's name without folders: a manifest must not reach out of its own.
std::string fileName(const JsonReader& in)
{
    const std::string name = in.text();
    if (name.empty() || name[0] == '.' || name.find_first_of("/\\") != std::string::npos || name.find('\0') != std::string::npos)
        in.fail("must be the name of a file in the capture's own folder");
    return name;
}

Tolerance tolerance(const JsonReader& in)
{
    Tolerance t;
    t.kind = toleranceKindByName(in["kind"].text(), in["kind"].path());
    t.value = in["value"].number();
    if (in.has("floor")) t.floor = in["floor"].number();
    if (in.has("outliers")) t.outliers = in["outliers"].number();
    if (in.has("differing")) t.differing = in["differing"].number();
    t.reason = in["reason"].text();
    if (!(t.value >= 0.0 && t.floor >= 0.0 && t.outliers >= 0.0 && t.outliers <= 1.0 && t.differing >= 0.0 && t.differing <= 1.0))
        in.fail("must hold no negative number, and fractions up to 1");
    return t;
}

Buffer buffer(const JsonReader& in)
{
    Buffer b;
    b.name = in["name"].text();
    if (b.name.empty() || b.name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.") != std::string::npos)
        in["name"].fail("must be of letters, digits, '_' and '.'");
    const JsonReader named(in.json(), in.path() + " (" + b.name + ")", ": ");
    b.pass = named["pass"].text();
    b.file = fileName(named["file"]);
    b.dtype = dtypeByName(named["dtype"].text(), named["dtype"].path());
    b.encoding = encodingByName(named["encoding"].text(), named["encoding"].path());
    for (const JsonReader& extent : named["shape"].items())
        b.shape.push_back(static_cast<std::size_t>(extent.whole(0, std::numeric_limits<std::int64_t>::max())));
    b.axes = named["axes"].texts();
    if (b.axes.size() != b.shape.size()) named["axes"].fail("must name each of the shape's axes");
    elementCount(b.shape, named["shape"].path());
    if (named.has("components")) {
        for (const JsonReader& name : named["components"].items()) b.components.push_back(name.isNull() ? "" : name.text());
        if (b.shape.empty() || b.components.size() != b.shape.back()) named["components"].fail("must be as many as the last axis is long");
    }
    if (b.encoding == Encoding::unorm && b.dtype != Dtype::u1 && b.dtype != Dtype::u2) named["encoding"].fail("unorm needs u1 or u2");
    if (named.has("dds")) {
        const JsonReader dds = named["dds"];
        b.dds = DdsPlace{fileName(dds["file"]), static_cast<std::uint32_t>(dds["mip"].whole(0, 31)),
                         dxgiFormatByName(dds["format"].text(), dds["format"].path()), dds["volume"].flag()};
    }
    b.meaning = named["meaning"].text();
    b.space = named["space"].text();
    b.unit = named["unit"].text();
    b.tolerance = tolerance(named["tolerance"]);
    b.sha256 = named["sha256"].text();
    return b;
}

}  // namespace

Capture captureFromManifest(const nlohmann::ordered_json& manifest, const std::string& place)
{
    const JsonReader in(manifest, place, ": ");
    if (in["format"].text() != kCaptureFormat) in["format"].fail("must be \"" + std::string(kCaptureFormat) + "\": this is no capture");
    if (in["format_version"].whole(0, kMaxInt) != kCaptureFormatVersion)
        in["format_version"].fail("is not " + std::to_string(kCaptureFormatVersion) + ", which this program reads; make the capture anew");

    Capture c;
    c.version = in["version"].text();
    const auto size = in["size"].items(2);
    c.width = static_cast<int>(size[0].whole(1, kMaxEdge));
    c.height = static_cast<int>(size[1].whole(1, kMaxEdge));
    const JsonReader scene = in["scene"];
    c.sceneName = scene["name"].text();
    c.sceneHash = scene["sha256"].text();
    const auto origin = scene["origin"].items(3);
    c.origin = {origin[0].number(), origin[1].number(), origin[2].number()};
    c.sceneBounds = box(scene["bounds"]);
    c.sceneReach = box(scene["reach"]);
    c.sceneComplete = scene["complete"].flag();
    for (const JsonReader& item : scene["materials"].items()) c.materials.push_back(material(item));
    c.preExposure = in["pre_exposure"].real();
    if (!(c.preExposure > 0.0f)) in["pre_exposure"].fail("must be above 0");
    applySettingsJson(c.settings, in["settings"].json(), in["settings"].path());
    validate(c.settings);
    c.needs = requirements(in["requires"]);
    c.camera = camera(in["camera"]);
    const JsonReader grid = in["grid"];
    c.grid.origin = grid["origin"].vector();
    c.grid.voxelSize = grid["voxel_size"].real();
    if (!(c.grid.voxelSize > 0.0f)) grid["voxel_size"].fail("must be above 0");
    c.grid.resolution = static_cast<int>(grid["resolution"].whole(c.settings.voxel.resolution, c.settings.voxel.resolution));
    for (const JsonReader& item : in["lights"].items()) c.lights.push_back(capturedLight(item, c.settings));
    for (const JsonReader& item : in["passes"].items()) c.passes.push_back({item["name"].text(), item["inputs"].texts(), item["sha256"].text()});
    std::set<std::string> names;
    for (const JsonReader& item : in["buffers"].items()) {
        c.buffers.push_back(buffer(item));
        if (!names.insert(c.buffers.back().name).second) item.fail("\"" + c.buffers.back().name + "\" is there twice");
    }
    for (const JsonReader& item : in["history"].items()) c.history.push_back({item["reason"].text(), item["version"].text(), item["buffers"].texts()});
    return c;
}

}  // namespace lrsm
