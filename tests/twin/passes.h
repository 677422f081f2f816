#pragma once

#include "tests/twin/frame.h"
#include "tests/twin/gl.h"

/// The passes of docs/capture.md once more, on OpenGL. Each reads its inputs from the frame by the buffers' names and leaves its outputs
/// there; nothing of the program's own passes is used.
namespace lrsm::twin {

/// An error to make on purpose: its shaders see PLANT_<name>.
struct Plant {
    const char* name;
    const char* pass;  ///< that a check must name
    const char* meaning;
    const char* scene = "cornell-box";  ///< that shows it
};
std::span<const Plant> plants();

/// What every pass gets besides the frame.
struct Options {
    Programs& programs;
    std::string plant = {};  ///< none if empty
    /// Conversions and filtering left to the driver: halves and UNORM by its stores, opacity in 8-bit textures. Else as the page has them.
    bool driverFormats = false;
    /// The program of a pass ("lrsm" for "lrsm 0"), with the plant if it belongs to this pass, and DRIVER_FORMATS.
    const Program& program(const std::string& pass, const std::vector<Stage>& stages, std::vector<std::string> defines) const;
    const Program& compute(const std::string& pass, const std::vector<std::string>& files, std::vector<std::string> defines) const;
};

void voxelize(Frame& frame, const Options& options);  ///< voxelization=raster alone
void voxelMips(Frame& frame, const Options& options);
void rsm(Frame& frame, const Options& options, int light);
void lrsm(Frame& frame, const Options& options, int light);
void gbuffer(Frame& frame, const Options& options);
void direct(Frame& frame, const Options& options);
void cones(Frame& frame, const Options& options);
void vctMips(Frame& frame, const Options& options);
void vctCones(Frame& frame, const Options& options);
void filter(Frame& frame, const Options& options);
void specularFilter(Frame& frame, const Options& options);
void composite(Frame& frame, const Options& options);

/// All of them in the order of the data flow. What the capture cannot give (a textured scene's surfaces) or GL 4.5 has not (conservative
/// rasterization) is left out: later passes then read the golden's. Returns a line for each pass left out.
std::vector<std::string> runAll(Frame& frame, const Options& options);

// Shared by the passes.

/// Binds an input as a buffer of floats or words; keep it while it is bound.
StorageBuffer inputBuffer(Frame& frame, const std::string& name, GLuint binding);
/// Texels of `format` from an input of that very layout, (rows, columns) or (slices, rows, columns).
Texture inputTexture(Frame& frame, const std::string& name, GLenum target, const TexelFormat& format, int width, int height, int depth);
/// The records of light.glsl, at binding 8.
StorageBuffer lightBuffer(const Frame& frame);
/// How many layers light i's LRSM has.
int layersStored(const Frame& frame, int light);

}  // namespace lrsm::twin
