// Voxelization by the rasterizer, and the opacity pyramid.
#include "tests/twin/passes.h"

#include <algorithm>

namespace lrsm::twin {

void voxelize(Frame& frame, const Options& options)
{
    const Json& grid = frame.manifest()["grid"];
    const int n = grid["resolution"];
    const Program& program = options.program("voxelize", {{GL_VERTEX_SHADER, {"voxelize.vert.glsl"}}, {GL_FRAGMENT_SHADER, {"voxelize.frag.glsl"}}}, {});
    program.set("origin", numbers(grid["origin"]));
    program.set("voxelSize", grid["voxel_size"].get<float>());
    program.set("resolution", n);
    const StorageBuffer positions = inputBuffer(frame, "scene.positions", 0), triangles = inputBuffer(frame, "scene.triangles", 1);
    const std::size_t bytes = std::size_t(n) * std::size_t(n) * std::size_t((n + 7) / 8);
    const StorageBuffer bits = makeBuffer(bytes);
    bindBuffer(2, bits);

    const Framebuffer target = emptyFramebuffer(n, n);
    glBindFramebuffer(GL_FRAMEBUFFER, target());
    glViewport(0, 0, n, n);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    const auto vertices = GLsizei(3 * frame.input("scene.triangles").shape.at(0));
    GLuint vertexArray = 0;  // vertices come from buffers
    glCreateVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    frame.time("voxelize", [&] {
        glClearNamedBufferData(bits(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
        program.use();
        glDrawArrays(GL_TRIANGLES, 0, vertices);
    });
    glDeleteVertexArrays(1, &vertexArray);
    frame.output("voxel.bits", download(bits, bytes));
}

void voxelMips(Frame& frame, const Options& options)
{
    const Json& grid = frame.manifest()["grid"];
    const int n = grid["resolution"], levels = grid["levels"];
    if (levels < 2) return;
    const bool directional = frame.is("opacity_axes", "directional");
    const TexelFormat format = directional ? kUint8x4 : kUint8;
    const std::string filterOf = frame.setting("mip_filter");
    const std::string filter = std::string("FILTER ") + (filterOf == "mean" ? "0" : filterOf == "coverage" ? "1" : "2");

    std::vector<std::string> defines = {filter};
    if (directional) defines.push_back("DIRECTIONAL");
    const Program& fromBelow = options.compute("voxel mips", {"opacity_mip.comp.glsl"}, defines);
    defines.push_back("FROM_BITS");
    const Program& fromBits = options.compute("voxel mips", {"opacity_mip.comp.glsl"}, defines);

    const StorageBuffer bits = inputBuffer(frame, "voxel.bits", 0);
    const Texture mips = makeTexture(GL_TEXTURE_3D, format, n / 2, n / 2, n / 2, levels - 1);  // level l is mip l - 1
    bindTexture(0, mips);
    frame.time("voxel mips", [&] {
        for (int level = 1; level < levels; ++level) {
            const Program& program = level <= (directional ? 3 : 1) ? fromBits : fromBelow;
            program.set("resolution", n);
            program.set("level", level);
            glBindImageTexture(0, mips(), level - 1, GL_TRUE, 0, GL_WRITE_ONLY, format.internal);
            program.dispatch(n >> level, n >> level, n >> level, 4, 4, 4);
        }
    });
    for (int level = 1; level < levels; ++level) {
        const std::size_t m = std::size_t(n >> level), texels = m * m * m;
        std::vector<std::byte> bytes = download(mips, format, level - 1, texels);
        if (directional) {  // the fourth component is padding
            for (std::size_t i = 0; i < texels; ++i) std::copy_n(bytes.begin() + std::ptrdiff_t(4 * i), 3, bytes.begin() + std::ptrdiff_t(3 * i));
            bytes.resize(3 * texels);
        }
        frame.output("voxel.mip" + std::to_string(level), std::move(bytes));
    }
}

}  // namespace lrsm::twin
