// Radiance in voxels: its mips, and the cones through it.
#include "tests/twin/pixels.h"

#include <array>

namespace lrsm::twin {

namespace {

constexpr std::array<const char*, 6> kFaces = {"vct.px", "vct.nx", "vct.py", "vct.ny", "vct.pz", "vct.nz"};
constexpr int kGroup3 = 4;

std::string mip(const char* face, int level)
{
    return std::string(face) + ".mip" + std::to_string(level);
}

std::size_t cubed(int n)
{
    return std::size_t(n) * std::size_t(n) * std::size_t(n);
}

}  // namespace

void vctMips(Frame& frame, const Options& options)
{
    const Json& grid = frame.manifest()["grid"];
    const int n = grid["resolution"], levels = grid["levels"];
    if (levels < 2) return;
    std::vector<std::string> defines;
    if (!frame.is("vct_half_rounding", "d3d")) defines.push_back("HALF_NEAREST_EVEN");
    const Program& fromBelow = options.compute("vct mips", {"formats.glsl", "vct_mip.comp.glsl"}, defines);
    defines.push_back("FROM_BASE");
    const Program& fromBase = options.compute("vct mips", {"formats.glsl", "vct_mip.comp.glsl"}, defines);
    const Texture base = inputTexture(frame, "vct.base", GL_TEXTURE_3D, kUint16x4, n, n, n),
                  normals = inputTexture(frame, "vct.normal", GL_TEXTURE_3D, kUint16x4, n, n, n);
    std::array<Texture, kFaces.size()> faces;
    for (Texture& face : faces) face = makeTexture(GL_TEXTURE_3D, kUint16x4, n / 2, n / 2, n / 2, levels - 1);  // level l is mip l - 1
    frame.time("vct mips", [&] {
        for (std::size_t d = 0; d < faces.size(); ++d)
            for (int level = 1; level < levels; ++level) {
                const Program& program = level == 1 ? fromBase : fromBelow;
                bindTexture(0, level == 1 ? base : faces[d]);
                bindTexture(1, normals);
                program.set("resolution", n >> level);
                program.set("level", level);
                program.set("axis", int(d / 2));
                program.set("backwards", int(d & 1));
                program.set("facing", frame.number("vct_facing"));
                glBindImageTexture(0, faces[d](), level - 1, GL_TRUE, 0, GL_WRITE_ONLY, kUint16x4.internal);
                program.dispatch(n >> level, n >> level, n >> level, kGroup3, kGroup3, kGroup3);
            }
    });
    for (std::size_t d = 0; d < faces.size(); ++d)
        for (int level = 1; level < levels; ++level) frame.output(mip(kFaces[d], level), download(faces[d], kUint16x4, level - 1, cubed(n >> level)));
}

void vctCones(Frame& frame, const Options& options)
{
    const Json &grid = frame.manifest()["grid"], &table = frame.manifest()["cones"];
    const int n = grid["resolution"], levels = grid["levels"];
    std::vector<std::string> defines = lobeDefines(frame);
    defines.push_back("MAX_STEPS " + std::to_string(frame.input("tables.schedules").shape.at(1)));
    defines.push_back("RINGS " + std::to_string(table["rings"].size()));
    if (frame.is("vct_weights", "squared")) defines.push_back("SQUARED");
    if (frame.is("vct_opacity", "step")) defines.push_back("STEPWISE");
    if (frame.is("transmittance", "exponential")) defines.push_back("EXPONENTIAL");
    const Program& program = options.compute("vct cones", {"pixel.glsl", "light.glsl", "schedule.glsl", "march_vct.glsl", "cones.comp.glsl"}, defines);
    const Pixels pixels(frame, program);
    setGrid(frame, program);
    setCones(frame, program);
    program.set("push", frame.number("push"));
    program.set("transmittanceCutoff", frame.number("transmittance_cutoff"));
    program.set("facing", frame.number("vct_facing"));
    program.set("preExposure", frame.manifest()["pre_exposure"].get<float>());

    const Texture base = inputTexture(frame, "vct.base", GL_TEXTURE_3D, kHalf4, n, n, n),
                  normals = inputTexture(frame, "vct.normal", GL_TEXTURE_3D, kHalf4, n, n, n);
    std::array<Texture, kFaces.size()> faces;
    const Sampler sampler = borderSampler();
    bindTexture(0, base);
    bindTexture(1, normals);
    for (std::size_t d = 0; d < faces.size(); ++d) {
        faces[d] = makeTexture(GL_TEXTURE_3D, kHalf4, n / 2, n / 2, n / 2, levels - 1);
        for (int level = 1; level < levels; ++level) {
            const int m = n >> level;
            upload(faces[d], GL_TEXTURE_3D, kHalf4, level - 1, m, m, m, frame.input(mip(kFaces[d], level)).bytes.data());
        }
        bindTexture(GLuint(2 + d), faces[d], &sampler);
    }
    traceCones(frame, program, pixels, "vct cones");
}

}  // namespace lrsm::twin
