// What happens in each pixel: direct light, cones, filter, composite.
#include "tests/twin/pixels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace lrsm::twin {

namespace {

/// Voxels and mips as one volume for a sampler. 16 bits a channel hold a UNORM8 exactly (v 257 / 65535 = v / 255); samplers may filter 8-bit
/// textures in 8-bit arithmetic.
Texture opacityTexture(Frame& frame, bool eightBits)
{
    const Json& grid = frame.manifest()["grid"];
    const int n = grid["resolution"], levels = grid["levels"];
    const bool directional = frame.is("opacity_axes", "directional");
    const TexelFormat format = eightBits ? (directional ? kUnorm8x4 : kUnorm8) : directional ? kUnorm16x4 : kUnorm16;
    Texture texture = makeTexture(GL_TEXTURE_3D, format, n, n, n, levels);
    for (int level = 0; level < levels; ++level) {
        const std::size_t m = std::size_t(n >> level), channels = directional ? 4 : 1, rowBytes = (m + 7) / 8;
        const NpyArray& from = frame.input(level == 0 ? "voxel.bits" : "voxel.mip" + std::to_string(level));
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(from.bytes.data());
        std::vector<std::uint16_t> texels(m * m * m * channels);
        std::vector<std::uint8_t> narrow(eightBits ? texels.size() : 0);
        for (std::size_t i = 0; i < m * m * m; ++i)
            for (std::size_t c = 0; c < std::min<std::size_t>(channels, 3); ++c) {
                const std::size_t x = i % m, row = i / m;
                const int value = level > 0 ? bytes[i * (directional ? 3 : 1) + c] : 255 * (bytes[row * rowBytes + x / 8] >> (x & 7) & 1);
                texels[i * channels + c] = std::uint16_t(257 * value);
                if (eightBits) narrow[i * channels + c] = std::uint8_t(value);
            }
        const void* data = eightBits ? static_cast<const void*>(narrow.data()) : texels.data();
        upload(texture, GL_TEXTURE_3D, format, level, int(m), int(m), int(m), data);
    }
    return texture;
}

/// One array texture of a buffer that every light has, its layers one after the other.
Texture allLights(Frame& frame, const std::string& kind, const std::string& suffix, const TexelFormat& format, int resolution, int layers, int levels)
{
    Texture texture = makeTexture(GL_TEXTURE_2D_ARRAY, format, resolution, resolution, std::max(layers, 1), levels);
    for (int level = 0; level < levels; ++level) {
        std::vector<std::byte> all;
        for (std::size_t i = 0; i < frame.manifest()["lights"].size(); ++i) {
            if (kind == "lrsm" && layersStored(frame, int(i)) == 0) continue;
            const std::string name = kind + std::to_string(i) + "." + suffix + (kind == "lrsm" ? ".mip" + std::to_string(level) : "");
            const std::vector<std::byte>& bytes = frame.input(name).bytes;
            all.insert(all.end(), bytes.begin(), bytes.end());
        }
        if (layers > 0) upload(texture, GL_TEXTURE_2D_ARRAY, format, level, resolution >> level, resolution >> level, layers, all.data());
    }
    return texture;
}

/// Every layer of every light as lrsm.glsl has them.
StorageBuffer layerBuffer(const Frame& frame)
{
    std::vector<float> layers;
    for (const Json& light : frame.manifest()["lights"])
        for (const Json& layer : light["partition"])
            if (!layer["stored"].is_null())
                for (const char* key : {"depth_min", "depth_max", "delta", "decay_at_min", "decay_at_max"})
                    layers.push_back(numbers(Json::array({layer[key]}))[0]);
    StorageBuffer buffer = makeBuffer(std::as_bytes(std::span(layers)));
    bindBuffer(9, buffer);
    return buffer;
}

std::string choice(const Frame& frame, const char* key, const char* define, std::initializer_list<const char*> names)
{
    int i = 0;
    for (const char* name : names) {
        if (frame.is(key, name)) return std::string(define) + " " + std::to_string(i);
        ++i;
    }
    throw std::runtime_error(std::string(key) + "=" + frame.setting(key) + ": the twin has no such choice");
}

void setGaussian(const Frame& frame, const Program& program)
{
    const Json& gaussian = frame.manifest()["gaussian"];
    program.set("phiHalfWidth", gaussian["table_half_width"].get<float>());
    program.set("phiEntries", gaussian["table_entries"].get<int>());
    const Json& polynomial = gaussian["polynomial"];
    program.set("phiLimit", polynomial["limit"].get<float>());
    program.setArray("phiNumerator", numbers(polynomial["numerator"]));
    program.setArray("phiDenominator", numbers(polynomial["denominator"]));
}

/// Most voxel lookups of any schedule: the last two columns of its steps are their number and the index of the first.
int longestInTaps(const NpyArray& table)
{
    const std::size_t columns = std::size_t(table.shape.at(2)), rows = table.bytes.size() / sizeof(float) / columns;
    float longest = 1.0f;
    for (std::size_t i = 0; i < rows; ++i) {
        float last[2];
        std::memcpy(last, table.bytes.data() + (i * columns + columns - 2) * sizeof(float), sizeof last);
        longest = std::max(longest, last[0] + last[1]);
    }
    return int(longest);
}

std::vector<std::string> coneDefines(const Frame& frame, const NpyArray& schedules, std::size_t rings)
{
    std::vector<std::string> defines = lobeDefines(frame);
    defines.push_back("MAX_STEPS " + std::to_string(schedules.shape.at(1)));
    defines.push_back("MAX_TAPS " + std::to_string(longestInTaps(schedules)));
    defines.push_back("RINGS " + std::to_string(rings));
    defines.push_back(frame.is("gaussian", "table") ? "GAUSSIAN 0" : "GAUSSIAN 1");
    defines.push_back(choice(frame, "backface", "BACKFACE", {"cosine", "step"}));
    const auto when = [&](const char* key, const char* value, const char* define) {
        if (frame.is(key, value)) defines.push_back(define);
    };
    when("opacity_axes", "directional", "DIRECTIONAL");
    when("layer_selection", "centre", "CENTRED");
    when("opacity", "density", "DENSITY");
    when("transmittance", "exponential", "EXPONENTIAL");
    return defines;
}

}  // namespace

void direct(Frame& frame, const Options& options)
{
    const Json &lights = frame.manifest()["lights"], &constants = frame.manifest()["constants"];
    std::vector<std::string> defines = specularDefine(frame);
    defines.push_back(choice(frame, "shadows", "SHADOWS", {"hard", "pcf", "cone", "off"}));
    if (frame.is("opacity_axes", "directional")) defines.push_back("DIRECTIONAL");
    const Program& program = options.compute("direct", {"pixel.glsl", "light.glsl", "opacity.glsl", "direct.comp.glsl"}, defines);
    const Pixels pixels(frame, program);
    setGrid(frame, program);
    program.set("lightCount", int(lights.size()));
    program.set("depthBiasTexels", frame.number("depth_bias_texels"));
    program.set("flatBias", constants["shadow_flat_bias"].get<float>());
    program.set("maxBiasSlope", constants["shadow_max_bias_slope"].get<float>());
    program.set("snappingTexels", constants["shadow_snapping_texels"].get<float>());
    program.set("grazingCosine", constants["shadow_grazing_cosine"].get<float>());
    program.set("pcfWidthTexels", frame.number("pcf_width_texels"));
    program.set("minSpecularAlpha", constants["min_specular_alpha"].get<float>());
    program.set("tanHalfAperture", float(std::tan(double(frame.number("shadow_cone_aperture_degrees")) * 3.14159265358979323846 / 360.0)));

    const StorageBuffer lightRecords = lightBuffer(frame);
    Texture depth, opacity;
    if ((frame.is("shadows", "hard") || frame.is("shadows", "pcf")) && !lights.empty()) {
        const int finer = int(frame.number("shadow_resolution")), n = finer * lights[0]["projection"]["resolution"].get<int>();
        depth = allLights(frame, finer > 1 ? "shadow" : "rsm", "depth", kFloat, n, int(lights.size()), 1);
        program.set("mapResolution", float(n));
        bindTexture(0, depth);
    }
    const Sampler sampler = borderSampler();
    if (frame.is("shadows", "cone")) {
        opacity = opacityTexture(frame, options.driverFormats);
        bindTexture(3, opacity, &sampler);
    }
    const StorageBuffer out = outputBuffer(12 * pixels.count(), 7);
    frame.time("direct", [&] { pixels.run(program); });
    frame.output("direct.radiance", download(out, 12 * pixels.count()));
}

void cones(Frame& frame, const Options& options)
{
    const Json &lights = frame.manifest()["lights"], &table = frame.manifest()["cones"];
    const bool slab = frame.is("estimator", "slab");
    const std::vector<std::string> files = {
        "pixel.glsl",     "light.glsl", "opacity.glsl", "lrsm.glsl", "terms.glsl", "schedule.glsl", slab ? "march_slab.glsl" : "march_paper.glsl",
        "cones.comp.glsl"};
    const Program& program = options.compute("cones", files, coneDefines(frame, frame.input("tables.schedules"), table["rings"].size()));
    const Pixels pixels(frame, program);
    setGrid(frame, program);
    setGaussian(frame, program);
    program.set("lightCount", int(lights.size()));
    setCones(frame, program);
    program.set("varianceFloor", frame.manifest()["constants"]["variance_floor"].get<float>());
    const std::pair<const char*, const char*> reals[] = {{"push", "push"},
                                                         {"densityK", "density_k"},
                                                         {"vRadiusScale", "v_radius_scale"},
                                                         {"transmittanceCutoff", "transmittance_cutoff"},
                                                         {"emitterDelayTaps", "emitter_delay_taps"},
                                                         {"emitterDelayVoxels", "emitter_delay_voxels"},
                                                         {"emitterSlantCap", "emitter_slant_cap"},
                                                         {"rsmLevelBias", "rsm_level_bias"},
                                                         {"rsmMinLevel", "rsm_min_level"}};
    for (const auto& [uniform, key] : reals) program.set(uniform, frame.number(key));
    const StorageBuffer lightRecords = lightBuffer(frame), layers = layerBuffer(frame);
    const StorageBuffer phi = frame.has("tables.gaussian") ? inputBuffer(frame, "tables.gaussian", 10) : outputBuffer(4, 10);
    int layerCount = 0;
    for (std::size_t i = 0; i < lights.size(); ++i) layerCount += layersStored(frame, int(i));
    const int base = lights.empty() ? 1 : lights[0]["base_resolution"].get<int>(), levels = lights.empty() ? 1 : lights[0]["levels"].get<int>();
    const Texture radiance = allLights(frame, "lrsm", "radiance", kHalf4, base, layerCount, levels),
                  normal = allLights(frame, "lrsm", "normal", kHalf4, base, layerCount, levels),
                  depth = allLights(frame, "lrsm", "depth", kUnorm16x4, base, layerCount, levels), opacity = opacityTexture(frame, options.driverFormats);
    const Sampler sampler = borderSampler();
    bindTexture(0, radiance, &sampler);
    bindTexture(1, normal, &sampler);
    bindTexture(2, depth, &sampler);
    bindTexture(3, opacity, &sampler);

    traceCones(frame, program, pixels, "cones");
}

void filter(Frame& frame, const Options& options)
{
    const Program& program = options.compute("filter", {"pixel.glsl", "filter.comp.glsl"}, specularDefine(frame));
    const Pixels pixels(frame, program);
    const StorageBuffer irradiance = inputBuffer(frame, "cones.irradiance", 9), out = outputBuffer(12 * pixels.count(), 7);
    frame.time("filter", [&] { pixels.run(program); });
    frame.output("filter.irradiance", download(out, 12 * pixels.count()));
}

void specularFilter(Frame& frame, const Options& options)
{
    const Program& program = options.compute("specular filter", {"pixel.glsl", "filter.comp.glsl"}, {"SPECULAR", "LOBES"});
    const Pixels pixels(frame, program);
    program.set("leastSampledRoughness", frame.constant("least_sampled_roughness"));
    const StorageBuffer specular = inputBuffer(frame, "cones.specular", 9), weight = inputBuffer(frame, "cones.lobe_weight", 10),
                        out = outputBuffer(12 * pixels.count(), 7);
    frame.time("specular filter", [&] { pixels.run(program); });
    frame.output("filter.specular", download(out, 12 * pixels.count()));
}

void composite(Frame& frame, const Options& options)
{
    std::vector<std::string> defines = specularDefine(frame);
    const bool filtered = frame.has("filter.specular");
    defines.push_back(filtered ? "SPECULAR_STRIDE 3" : "SPECULAR_STRIDE 4");
    const Program& program = options.compute("composite", {"pixel.glsl", "composite.comp.glsl"}, defines);
    const Pixels pixels(frame, program);
    const std::string irradianceName = frame.has("filter.irradiance") ? "filter.irradiance" : "cones.irradiance";
    const StorageBuffer irradiance = inputBuffer(frame, irradianceName, 9), direct = inputBuffer(frame, "direct.radiance", 10);
    std::vector<StorageBuffer> specularInputs;
    if (frame.specular()) {
        specularInputs.push_back(inputBuffer(frame, filtered ? "filter.specular" : "cones.specular", 11));
        specularInputs.push_back(inputBuffer(frame, "tables.specular_albedo", 12));
    }
    const std::size_t bytes = 12 * pixels.count();
    const StorageBuffer diffuse = outputBuffer(bytes, 7), specular = outputBuffer(bytes, 13), combined = outputBuffer(bytes, 14);
    frame.time("composite", [&] { pixels.run(program); });
    frame.output("composite.diffuse", download(diffuse, bytes));
    frame.output("composite.specular", download(specular, bytes));
    frame.output("composite.combined", download(combined, bytes));
}

}  // namespace lrsm::twin
