#pragma once

#include "tests/twin/passes.h"

#include <cstring>

/// What passes that run in each pixel share (internal to them).
namespace lrsm::twin {

inline constexpr int kGroup = 8;

/// The G-buffer's arrays at the bindings of pixel.glsl, and the camera.
class Pixels {
  public:
    Pixels(Frame& frame, const Program& program) : width_(frame.width()), height_(frame.height())
    {
        const char* const names[] = {"position", "geometric_normal", "normal", "albedo", "object_id", "specular_color", "roughness"};
        for (GLuint i = 0; i < (frame.specular() ? 7u : 5u); ++i) buffers_.push_back(inputBuffer(frame, std::string("gbuffer.") + names[i], i));
        const Json& camera = frame.manifest()["camera"];
        program.set("width", width_);
        program.set("height", height_);
        program.set("eye", numbers(camera["position"]));
        program.set("forward", numbers(camera["forward"]));
        program.set("perspective", camera["perspective"].get<bool>() ? 1 : 0);
    }
    std::size_t count() const { return std::size_t(width_) * std::size_t(height_); }
    void run(const Program& program) const { program.dispatch(width_, height_, 1, kGroup, kGroup, 1); }

  private:
    int width_, height_;
    std::vector<StorageBuffer> buffers_;
};

inline std::vector<std::string> specularDefine(const Frame& frame)
{
    return frame.specular() ? std::vector<std::string>{"SPECULAR"} : std::vector<std::string>{};
}

/// SPECULAR, and LOBES where a specular cone looks along a point of the lobe.
inline std::vector<std::string> lobeDefines(const Frame& frame)
{
    std::vector<std::string> defines = specularDefine(frame);
    if (frame.has("cones.lobe_weight")) defines.push_back("LOBES");
    return defines;
}

/// Binding of an output, all zero.
inline StorageBuffer outputBuffer(std::size_t bytes, GLuint binding)
{
    StorageBuffer buffer = makeBuffer(bytes);
    bindBuffer(binding, buffer);
    return buffer;
}

inline void setGrid(const Frame& frame, const Program& program)
{
    const Json& grid = frame.manifest()["grid"];
    program.set("origin", numbers(grid["origin"]));
    program.set("voxelSize", grid["voxel_size"].get<float>());
    program.set("resolution", grid["resolution"].get<int>());
    program.set("levels", grid["levels"].get<int>());
}

inline std::vector<float> floats(const NpyArray& array)
{
    const auto* from = reinterpret_cast<const float*>(array.bytes.data());
    return {from, from + array.bytes.size() / sizeof(float)};
}

/// Rings, then the directions of all rotations: the buffer Tables.
inline StorageBuffer coneTables(Frame& frame)
{
    std::vector<float> values;
    for (const Json& ring : frame.manifest()["cones"]["rings"])
        for (const char* key : {"first", "count", "weight", "schedule"}) values.push_back(ring[key].get<float>());
    const std::vector<float> directions = floats(frame.input("tables.cone_directions"));
    values.insert(values.end(), directions.begin(), directions.end());
    StorageBuffer buffer = makeBuffer(std::as_bytes(std::span(values)));
    bindBuffer(15, buffer);
    return buffer;
}

/// Uniforms of cones.comp.glsl.
inline void setCones(const Frame& frame, const Program& program)
{
    const Json& table = frame.manifest()["cones"];
    program.set("coneCount", frame.whole("cone_count"));
    program.set("setsPerPixel", frame.whole("sets_per_pixel"));
    program.set("specularFirst", int(table["rings"].size()));
    program.set("specularClasses", int(table["specular"].size()));
    program.set("originOffset", frame.number("normal_offset_voxels"));
    program.set("normalOffsetVoxels", frame.number("normal_offset_voxels"));
}

/// Runs a program made of cones.comp.glsl, whose march has its inputs bound, and takes its outputs.
inline void traceCones(Frame& frame, const Program& program, const Pixels& pixels, const std::string& pass)
{
    std::vector<int> rotation;
    for (const std::byte value : frame.input("tables.rotation").bytes) rotation.push_back(int(value));
    program.setArray("rotation", rotation);

    const bool lobes = frame.has("cones.lobe_weight");
    if (lobes) {
        program.setArray("lobePoints", floats(frame.input("tables.lobe_points")));
        program.set("leastSampledRoughness", frame.constant("least_sampled_roughness"));
        program.set("minSpecularAlpha", frame.constant("min_specular_alpha"));
    }

    const StorageBuffer tables = coneTables(frame), schedules = inputBuffer(frame, "tables.schedules", 11);
    const std::size_t conesAPixel = frame.manifest()["cones"]["a_pixel"];
    const StorageBuffer diffuse = outputBuffer(16 * conesAPixel * pixels.count(), 7), irradiance = outputBuffer(12 * pixels.count(), 12),
                        opacityOut = outputBuffer(4 * pixels.count(), 13), specular = outputBuffer((lobes ? 32 : 16) * pixels.count(), 14);
    frame.time(pass, [&] { pixels.run(program); });
    frame.output("cones.diffuse", download(diffuse, 16 * conesAPixel * pixels.count()));
    frame.output("cones.irradiance", download(irradiance, 12 * pixels.count()));
    frame.output("cones.opacity", download(opacityOut, 4 * pixels.count()));
    std::vector<std::byte> reflected = download(specular, (lobes ? 32 : 16) * pixels.count());
    if (lobes) {
        std::vector<std::byte> weights(4 * pixels.count());
        for (std::size_t i = 0; i < pixels.count(); ++i) std::memcpy(weights.data() + 4 * i, reflected.data() + 16 * (pixels.count() + i), 4);
        frame.output("cones.lobe_weight", std::move(weights));
        reflected.resize(16 * pixels.count());
    }
    frame.output("cones.specular", std::move(reflected));
}

}  // namespace lrsm::twin
