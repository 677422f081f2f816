#include "tests/twin/passes.h"

#include <array>
#include <cmath>
#include <stdexcept>

namespace lrsm::twin {

namespace {

constexpr Plant kPlants[] = {
    {"voxel_depth", "voxelize", "depth rounded to the nearest voxel, not down"},
    {"mip_shift", "voxel mips", "children one voxel off"},
    {"rsm_v", "rsm", "map upside down"},
    {"rsm_pi", "rsm", "radiance not divided by pi"},
    {"swapped_layer", "lrsm", "neighbouring layers exchanged"},
    {"half_rounding", "lrsm", "half to nearest even, not toward zero"},
    {"lrsm_mip_shift", "lrsm", "children one texel off in the mips"},
    {"normal_length", "gbuffer", "normals not normalised"},
    {"unclamped", "direct", "<n.l> not clamped to 0"},
    {"shadow_bias", "direct", "no bias in the shadow's depth comparison"},
    {"level_off_by_one", "cones", "voxels read one mip level too high"},
    {"alpha", "cones", "filtered depth and normal not divided by alpha"},
    {"texel_centre", "cones", "LRSM sampled half a texel off"},
    {"light_v", "cones", "v axis of the light's map flipped"},
    {"irradiance_pi", "cones", "sum of the cones not multiplied by pi"},
    {"lobe_weight", "cones", "points of the lobe all count the same", "cornell-glossy"},
    {"vct_front", "vct mips", "the hidden texel of a column hides the other"},
    {"vct_facing", "vct cones", "voxels that face away are lit"},
    {"vct_direction", "vct cones", "the volume of +x for cones towards -x too"},
    {"filter_edges", "filter", "outer rows and columns count in full"},
    {"albedo", "composite", "irradiance not multiplied by albedo"},
};

/// Light i's partition: entry k is stored as layer `stored`.
const Json& partition(const Frame& frame, int light)
{
    return frame.manifest()["lights"][std::size_t(light)]["partition"];
}

float cubeFace(const std::vector<float>& d)
{
    const std::array<float, 3> a = {std::abs(d[0]), std::abs(d[1]), std::abs(d[2])};
    const std::size_t axis = a[0] >= a[1] && a[0] >= a[2] ? 0 : a[1] >= a[2] ? 1 : 2;
    return float(2 * axis + (d[axis] < 0.0f ? 1 : 0));
}

}  // namespace

std::span<const Plant> plants()
{
    return kPlants;
}

const Program& Options::program(const std::string& pass, const std::vector<Stage>& stages, std::vector<std::string> defines) const
{
    for (const Plant& known : kPlants)
        if (plant == known.name && pass == known.pass) defines.push_back("PLANT_" + plant);
    if (driverFormats) defines.push_back("DRIVER_FORMATS");
    return programs.get(stages, defines);
}

const Program& Options::compute(const std::string& pass, const std::vector<std::string>& files, std::vector<std::string> defines) const
{
    return program(pass, {{GL_COMPUTE_SHADER, files}}, std::move(defines));
}

StorageBuffer inputBuffer(Frame& frame, const std::string& name, GLuint binding)
{
    StorageBuffer buffer = makeBuffer(frame.input(name).bytes);
    bindBuffer(binding, buffer);
    return buffer;
}

Texture inputTexture(Frame& frame, const std::string& name, GLenum target, const TexelFormat& format, int width, int height, int depth)
{
    const NpyArray& array = frame.input(name);
    if (array.bytes.size() != std::size_t(width) * std::size_t(height) * std::size_t(depth) * format.bytes)
        throw std::runtime_error(name + ": does not fit its texture");
    Texture texture = makeTexture(target, format, width, height, depth, 1);
    upload(texture, target, format, 0, width, height, depth, array.bytes.data());
    return texture;
}

int layersStored(const Frame& frame, int light)
{
    int count = 0;
    for (const Json& layer : partition(frame, light)) count += layer["stored"].is_null() ? 0 : 1;
    return count;
}

StorageBuffer lightBuffer(const Frame& frame)
{
    std::vector<float> records;
    const auto push = [&](const std::vector<float>& xyz, float w) {
        records.insert(records.end(), xyz.begin(), xyz.end());
        records.push_back(w);
    };
    int firstLayer = 0;
    const Json& lights = frame.manifest()["lights"];
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const Json &light = lights[i], &projection = light["projection"];
        const std::vector<float> direction = numbers(light["direction"]);
        const std::string type = light["type"];
        const int layers = layersStored(frame, int(i));
        push(numbers(light["position"]), type == "directional" ? 0.0f : type == "spot" ? 1.0f : 2.0f);
        push(direction, light["range"].is_null() ? 0.0f : light["range"].get<float>());
        push(numbers(light["intensity"]), light["cos_inner"]);
        push(numbers(projection["position"]), light["cos_outer"]);
        push(numbers(projection["right"]), projection["half_width"]);
        push(numbers(projection["up"]), projection["depth_near"]);
        push(numbers(projection["forward"]), projection["depth_far"]);
        push({float(firstLayer), float(layers), projection["resolution"].get<float>()}, cubeFace(direction));
        firstLayer += layers;
    }
    StorageBuffer buffer = makeBuffer(std::as_bytes(std::span(records)));
    bindBuffer(8, buffer);
    return buffer;
}

std::vector<std::string> runAll(Frame& frame, const Options& options)
{
    std::vector<std::string> leftOut;
    if (frame.is("voxelization", "raster"))
        voxelize(frame, options);
    else
        leftOut.push_back("voxelize: voxelization=" + frame.setting("voxelization") + " needs conservative rasterization, which OpenGL 4.5 has not");
    const bool vct = frame.is("method", "vct");
    if (frame.has("voxel.mip1")) voxelMips(frame, options);

    const bool drawable = frame.manifest()["scene"]["complete"].get<bool>() && !frame.manifest()["requires"]["vertex_colors"].get<bool>();
    if (!drawable) leftOut.push_back("rsm, gbuffer: the capture holds no textures");
    const int lights = int(frame.manifest()["lights"].size());
    if (lights > 0 && frame.has("shadow0.depth")) leftOut.push_back("shadow: an RSM without its colours");
    for (int light = 0; light < lights; ++light) {
        if (drawable) rsm(frame, options, light);
        if (!vct && layersStored(frame, light) > 0) lrsm(frame, options, light);
    }
    if (drawable) gbuffer(frame, options);
    if (frame.is("shadows", "exact"))
        leftOut.push_back("direct: shadows=exact needs the scene's triangles, and no map");
    else
        direct(frame, options);
    if (vct) {
        leftOut.push_back("vct surface, vct inject: sums over lists of texels");
        vctMips(frame, options);
        vctCones(frame, options);
    } else {
        cones(frame, options);
    }
    if (frame.has("filter.irradiance")) filter(frame, options);
    if (frame.has("filter.specular")) specularFilter(frame, options);
    composite(frame, options);
    return leftOut;
}

}  // namespace lrsm::twin
