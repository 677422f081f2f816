// The list of all buffers: names, shapes and what they mean, in the order of the data flow.
#include "apps/capture/convert.h"
#include "apps/capture/scene_buffers.h"
#include "apps/capture/tables.h"
#include "apps/capture/tolerances.h"

namespace lrsm {

namespace {

using Names = std::vector<std::string>;
using Shape = std::vector<std::size_t>;

constexpr const char* kWorld = "world";

std::size_t sz(int n)
{
    return static_cast<std::size_t>(n);
}

struct Text {
    std::string meaning, space, unit;
};

/// What a texture's storage makes of it.
struct TexelFormat {
    Dtype dtype;
    Encoding encoding;
    DxgiFormat dds;
};
constexpr TexelFormat kHalf4 = {Dtype::f2, Encoding::number, DxgiFormat::R16G16B16A16_FLOAT};
constexpr TexelFormat kUnorm4 = {Dtype::u2, Encoding::unorm, DxgiFormat::R16G16B16A16_UNORM};
constexpr TexelFormat kFloat4 = {Dtype::f4, Encoding::number, DxgiFormat::R32G32B32A32_FLOAT};

class Catalogue {
  public:
    std::vector<Buffer> buffers;

    Buffer& add(const std::string& name, const std::string& pass, Dtype dtype, const Shape& shape, const Names& axes, const Names& components, const Text& text,
                const Tolerance& tolerance)
    {
        Buffer buffer;
        buffer.name = name;
        buffer.pass = pass;
        buffer.dtype = dtype;
        buffer.shape = shape;
        buffer.axes = axes;
        buffer.components = components;
        buffer.meaning = text.meaning;
        buffer.space = text.space;
        buffer.unit = text.unit;
        buffer.tolerance = tolerance;
        buffer.file = name + ".npy";
        buffers.push_back(std::move(buffer));
        return buffers.back();
    }

    /// (height, width, components), or (height, width) without components.
    Buffer& picture(const std::string& name, const std::string& pass, int width, int height, const Names& components, const Text& text,
                    const Tolerance& tolerance, Dtype dtype = Dtype::f4)
    {
        Shape shape = {sz(height), sz(width)};
        Names axes = {"row", "column"};
        if (!components.empty()) {
            shape.push_back(components.size());
            axes.push_back("component");
        }
        return add(name, pass, dtype, shape, axes, components, text, tolerance);
    }
};

void describeScene(Catalogue& out, const Scene& scene)
{
    const SceneCounts n = countScene(scene);
    const Tolerance given = tolerances::given();
    const auto list = [&](const std::string& name, Dtype dtype, std::size_t count, const Names& components, const std::string& item, const Text& text) {
        Shape shape = {count};
        Names axes = {item};
        if (!components.empty()) {
            shape.push_back(components.size());
            axes.push_back("component");
        }
        out.add("scene." + name, "scene", dtype, shape, axes, components, text, given);
    };
    list("positions", Dtype::f4, n.vertices, {"x", "y", "z"}, "vertex", {"of all meshes, one after the other", kWorld, "m"});
    list("normals", Dtype::f4, n.vertices, {"x", "y", "z"}, "vertex", {"unit", kWorld, ""});
    if (n.uv0) list("uv0", Dtype::f4, n.vertices, {"u", "v"}, "vertex", {"first texture coordinates; 0 for meshes without", "texture", ""});
    if (n.uv1) list("uv1", Dtype::f4, n.vertices, {"u", "v"}, "vertex", {"second texture coordinates; 0 for meshes without", "texture", ""});
    if (n.tangents)
        list("tangents", Dtype::f4, n.vertices, {"x", "y", "z", "sign"}, "vertex",
             {"bitangent = sign cross(normal, tangent); 0 for meshes without", kWorld, ""});
    if (n.colors) list("colors", Dtype::f4, n.vertices, {"r", "g", "b", "a"}, "vertex", {"multiply the base colour; 0 for meshes without", "linear", ""});
    list("triangles", Dtype::u4, n.triangles, {"a", "b", "c"}, "triangle",
         {"vertices, counter-clockwise seen from the front; submitted in this order", "", ""});
    list("triangle_mesh", Dtype::u4, n.triangles, {}, "triangle", {"mesh; object id minus 1", "", ""});
    list("meshes", Dtype::u4, scene.meshes.size(), {"material", "first_vertex", "vertices", "first_triangle", "triangles", "streams"}, "mesh",
         {"streams: 1 uv0, 2 uv1, 4 tangents, 8 colors", "", ""});
    list("materials", Dtype::f4, scene.materials.size(), {"albedo.r", "albedo.g", "albedo.b", "f0.r", "f0.g", "f0.b", "roughness", "double_sided", "textured"},
         "material", {"as without textures and vertex colours; f0 is 0 where there is no specular part", "linear", ""});
}

void describeTables(Catalogue& out, const CaptureTables& tables)
{
    const auto rows = [&](const Table& t, const Names& axes, const Names& components, const Text& text) {
        out.add(t.name, "tables", t.dtype, t.shape, axes, components, text, tolerances::given());
    };
    rows(tables.directions, {"rotation", "cone", "component"}, {"x", "y", "z"}, {"axes of the diffuse cones, unit", "tangent frame, z along the normal", ""});
    rows(tables.rotation, {"row", "column"}, {}, {"rotation of the pixel at (row & 3, column & 3)", "", ""});
    rows(tables.schedules, {"schedule", "step", "component"}, {"middle", "begin", "end", "diameter", "level", "tap_width", "reads_voxels", "settled"},
         {"where a cone takes its samples; rows of 0 after the last step", "along the cone from its apex", "base voxels"});
    rows(tables.steps, {"schedule"}, {}, {"steps of each schedule", "", ""});
    if (!tables.gaussian.shape.empty()) rows(tables.gaussian, {"entry"}, {}, {"Phi over [-5, 5], linear between entries", "", ""});
    if (!tables.specularAlbedo.shape.empty())
        rows(tables.specularAlbedo, {"roughness", "root_n_dot_v", "component"}, {"scale", "bias"},
             {"directional albedo of the lobe = F0 scale + bias; over roughness and sqrt(n.v), both 0 .. 1", "", ""});
}

void describeVoxels(Catalogue& out, const VoxelSettings& settings)
{
    const std::size_t n = sz(settings.resolution), bricks = sz(BitGrid::bricksPerEdge(settings.resolution));
    const bool directional = settings.axes == OpacityAxes::directional, unorm = settings.storage == Storage::gpu;
    Buffer& bits = out.add("voxel.bits", "voxelize", Dtype::u1, {n, n, (n + 7) / 8}, {"z", "y", "x_byte"}, {},
                           {"occupied voxels: bit x & 7 of byte x >> 3", "grid", ""}, tolerances::voxels());
    bits.encoding = Encoding::bits;
    bits.dds = DdsPlace{"voxel.dds", 0, DxgiFormat::R8_UNORM, true};
    Buffer& words = out.add("voxel.bricks", "voxelize", Dtype::u8, {bricks, bricks, bricks}, {"brick_z", "brick_y", "brick_x"}, {},
                            {"the same, 4x4x4 voxels a word: bit (x & 3) + 4 (y & 3) + 16 (z & 3)", "grid", ""}, tolerances::voxels());
    words.encoding = Encoding::bits;

    // One value a texel continues the base level's texture; three need a texture of their own.
    const bool oneChain = unorm && !directional;
    for (int level = 1; settings.resolution >> level >= 1; ++level) {
        const std::size_t m = n >> level;
        Shape shape = {m, m, m};
        Names axes = {"z", "y", "x"}, components;
        if (directional) {
            shape.push_back(3);
            axes.push_back("component");
            components = {"x", "y", "z"};
        }
        Buffer& mip = out.add("voxel.mip" + std::to_string(level), "voxel mips", unorm ? Dtype::u1 : Dtype::f4, shape, axes, components,
                              {directional ? "share of columns along the axis that are covered" : "opacity", "grid", ""}, tolerances::voxelMip(unorm));
        if (unorm) mip.encoding = Encoding::unorm;
        const DxgiFormat format =
            unorm ? (directional ? DxgiFormat::R8G8B8A8_UNORM : DxgiFormat::R8_UNORM) : (directional ? DxgiFormat::R32G32B32A32_FLOAT : DxgiFormat::R32_FLOAT);
        const auto mipNumber = static_cast<std::uint32_t>(level);
        mip.dds = oneChain ? DdsPlace{"voxel.dds", mipNumber, format, true} : DdsPlace{"voxel.mips.dds", mipNumber - 1, format, true};
    }
}

void describeRsm(Catalogue& out, const RsmSettings& settings, std::size_t light)
{
    const std::string index = std::to_string(light), pass = "rsm " + index, prefix = "rsm" + index + ".";
    const TexelFormat format = settings.storage == Storage::gpu ? kHalf4 : kFloat4;
    const int n = settings.resolution;
    const auto map = [&](const std::string& name, const Names& components, const Text& text, const Tolerance& tolerance, const TexelFormat& as) {
        Buffer& buffer = out.picture(prefix + name, pass, n, n, components, text, tolerance, as.dtype);
        buffer.dds = DdsPlace{prefix + name + ".dds", 0, as.dds, false};
    };
    map("radiance", {"r", "g", "b", "coverage"}, {"reflected radiance albedo L <n.l> / pi; coverage 1 where a surface was drawn", "light's map", "W/(m^2 sr)"},
        tolerances::mapRadiance(n), format);
    map("normal", {"x", "y", "z", "n_dot_l"}, {"shading normal towards the light, and its cosine to it", kWorld, ""}, tolerances::mapNormal(n), format);
    map("depth", {}, {"linear depth in [0, 1] over the projection's range; 1 where empty", "light's map", ""}, tolerances::mapDepth(n),
        {Dtype::f4, Encoding::number, DxgiFormat::R32_FLOAT});
}

void describeLrsm(Catalogue& out, const Settings& settings, std::size_t light, int layers)
{
    if (layers == 0) return;
    const std::string index = std::to_string(light), pass = "lrsm " + index, prefix = "lrsm" + index + ".";
    const bool gpu = settings.layers.storage == Storage::gpu;
    const auto texture = [&](const std::string& name, const Names& components, const Text& text, const auto& tolerance, const TexelFormat& format) {
        for (int lod = 0, n = settings.rsm.resolution / 2; n >= 1; ++lod, n /= 2) {
            Buffer& buffer = out.add(prefix + name + ".mip" + std::to_string(lod), pass, format.dtype, {sz(layers), sz(n), sz(n), 4},
                                     {"layer", "row", "column", "component"}, components, text, tolerance(lod));
            buffer.encoding = format.encoding;
            buffer.dds = DdsPlace{prefix + name + ".dds", static_cast<std::uint32_t>(lod), format.dds, false};
        }
    };
    const auto half = [&](int) { return tolerances::layerHalf(gpu); };
    texture("radiance", {"r", "g", "b", ""}, {"radiance times the layer's coverage alpha", "light's map", "W/(m^2 sr)"}, half, gpu ? kHalf4 : kFloat4);
    texture("normal", {"x", "y", "z", "alpha"}, {"normal times alpha, and alpha", kWorld, ""}, half, gpu ? kHalf4 : kFloat4);
    texture(
        "depth", {"z", "z2", "alpha", ""}, {"alpha z, alpha z^2 (z warped to [0, 1] in the layer's range), and alpha", "layer's depth", ""},
        [&](int lod) { return tolerances::layerDepth(gpu, lod); }, gpu ? kUnorm4 : kFloat4);
}

void describeGBuffer(Catalogue& out, int width, int height, bool specular, double diagonal)
{
    const Names xyz = {"x", "y", "z"}, rgb = {"r", "g", "b"};
    const auto picture = [&](const std::string& name, const Names& components, const Text& text, const Tolerance& tolerance, Dtype dtype = Dtype::f4) {
        out.picture("gbuffer." + name, "gbuffer", width, height, components, text, tolerance, dtype);
    };
    picture("position", xyz, {"of the surface; 0 where nothing was drawn, as all below", kWorld, "m"}, tolerances::length(diagonal, height));
    picture("geometric_normal", xyz, {"of the triangle, unit, towards the eye", kWorld, ""}, tolerances::surface());
    picture("normal", xyz, {"shading normal, unit, towards the eye", kWorld, ""}, tolerances::surfaceNormal(height));
    picture("albedo", rgb, {"diffuse", "linear", ""}, tolerances::surface());
    if (specular) {
        picture("specular_color", rgb, {"F0; 0 where the material has no specular part", "linear", ""}, tolerances::surface());
        picture("roughness", {}, {"perceptual: GGX alpha is its square", "", ""}, tolerances::surface());
    }
    picture("depth", {}, {"along the viewing axis", "eye", "m"}, tolerances::length(diagonal, height));
    picture("object_id", {}, {"mesh + 1; 0 where nothing was drawn", "", ""}, tolerances::objectId(), Dtype::u4);
}

void describeLight(Catalogue& out, int width, int height, const ConeSettings& cones, bool specular)
{
    const Names rgb = {"r", "g", "b"}, rgba = {"r", "g", "b", "opacity"};
    const std::string radiance = "W/(m^2 sr)", irradiance = "W/m^2", eye = "picture";
    out.picture("direct.radiance", "direct", width, height, rgb, {"direct light reflected towards the eye", eye, radiance}, tolerances::direct());
    out.add("cones.diffuse", "cones", Dtype::f4, {sz(cones.set.count * cones.set.setsPerPixel), sz(height), sz(width), 4},
            {"cone", "row", "column", "component"}, rgba, {"I of Eq. 1 and opacity of each diffuse cone, in the order of their sum", eye, radiance},
            tolerances::cones());
    out.picture("cones.irradiance", "cones", width, height, rgb, {"pi times the weighted sum of the diffuse cones", eye, irradiance}, tolerances::cones());
    out.picture("cones.opacity", "cones", width, height, {}, {"weighted mean opacity of the diffuse cones", eye, ""}, tolerances::coneOpacity());
    if (specular) out.picture("cones.specular", "cones", width, height, rgba, {"I and opacity of the specular cone", eye, radiance}, tolerances::cones());
    if (cones.set.filter)
        out.picture("filter.irradiance", "filter", width, height, rgb, {"irradiance averaged over 4x4 pixels of the same surface", eye, irradiance},
                    tolerances::filter());
    out.picture("composite.diffuse", "composite", width, height, rgb, {"albedo irradiance / pi", eye, radiance}, tolerances::product());
    out.picture("composite.specular", "composite", width, height, rgb, {"specular cone times the lobe's directional albedo", eye, radiance},
                tolerances::specularPart());
    out.picture("composite.combined", "composite", width, height, rgb, {"direct + diffuse + specular", eye, radiance}, tolerances::product());
}

}  // namespace

std::vector<Buffer> describeBuffers(const Scene& scene, const Requirements& needs, const Settings& settings, int width, int height,
                                    const std::vector<int>& layersStored)
{
    Catalogue out;
    describeScene(out, scene);
    describeTables(out, makeTables(needs, settings));
    describeVoxels(out, settings.voxel);
    for (std::size_t light = 0; light < layersStored.size(); ++light) {
        describeRsm(out, settings.rsm, light);
        describeLrsm(out, settings, light, layersStored[light]);
    }
    const double diagonal = scene.bounds.empty() ? 0.0 : double(glm::length(scene.bounds.extent()));
    describeGBuffer(out, width, height, needs.specular, diagonal);
    describeLight(out, width, height, settings.cones, needs.specular);
    return std::move(out.buffers);
}

}  // namespace lrsm
