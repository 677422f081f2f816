// What the rasterizer draws of the scene, RSM and G-buffer; and the RSM's layers.
#include "tests/twin/passes.h"

#include <array>

namespace lrsm::twin {

namespace {

/// The scene's buffers at the bindings of scene.vert.glsl and surface.glsl, drawn mesh by mesh in the order of submission.
class SceneDrawing {
  public:
    explicit SceneDrawing(Frame& frame)
        : buffers_{inputBuffer(frame, "scene.positions", 0),     inputBuffer(frame, "scene.triangles", 1), inputBuffer(frame, "scene.normals", 2),
                   inputBuffer(frame, "scene.triangle_mesh", 3), inputBuffer(frame, "scene.meshes", 4),    inputBuffer(frame, "scene.materials", 5)}
    {
        const NpyArray &meshes = frame.input("scene.meshes"), &materials = frame.input("scene.materials");
        const auto* mesh = reinterpret_cast<const std::uint32_t*>(meshes.bytes.data());
        const auto* material = reinterpret_cast<const float*>(materials.bytes.data());
        for (std::size_t i = 0; i < meshes.shape.at(0); ++i, mesh += 6) {
            const bool doubleSided = material[9 * mesh[0] + 7] != 0.0f;
            if (runs_.empty() || runs_.back().doubleSided != doubleSided) runs_.push_back({doubleSided, GLint(3 * mesh[3]), 0});
            runs_.back().vertices += GLsizei(3 * mesh[4]);
        }
        glCreateVertexArrays(1, &vertexArray_);
    }
    ~SceneDrawing() { glDeleteVertexArrays(1, &vertexArray_); }
    SceneDrawing(const SceneDrawing&) = delete;
    SceneDrawing& operator=(const SceneDrawing&) = delete;

    /// As D3D has it: row 0 on top, depth in [0, 1], nearer wins, the first of equals stays. The vertex shader turns y over, which turns
    /// the triangles over too; glClipControl(GL_UPPER_LEFT) would do both, but has Mesa give a pixel on an edge to the triangle above it.
    void draw(const Framebuffer& target, int width, int height, const Program& program) const
    {
        glBindFramebuffer(GL_FRAMEBUFFER, target());
        glViewport(0, 0, width, height);
        glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
        glFrontFace(GL_CW);
        glCullFace(GL_BACK);
        const float one = 1.0f;
        glClearNamedFramebufferfv(target(), GL_DEPTH, 0, &one);
        glBindVertexArray(vertexArray_);
        program.use();
        for (const Run& run : runs_) {
            (run.doubleSided ? glDisable : glEnable)(GL_CULL_FACE);
            glDrawArrays(GL_TRIANGLES, run.first, run.vertices);
        }
    }

  private:
    struct Run {
        bool doubleSided;
        GLint first;
        GLsizei vertices;
    };
    std::array<StorageBuffer, 6> buffers_;
    std::vector<Run> runs_;
    GLuint vertexArray_ = 0;
};

std::vector<std::string> rounding(const Frame& frame, const char* key)
{
    return frame.is(key, "d3d") ? std::vector<std::string>{} : std::vector<std::string>{"HALF_NEAREST_EVEN"};
}

/// The stored layers of a light for lrsm_split.comp.glsl: bounds, and whether they are the outermost.
std::vector<float> layerBounds(const Frame& frame, int light)
{
    const Json& partition = frame.manifest()["lights"][std::size_t(light)]["partition"];
    const int normals = frame.whole("normal_layers"), depths = frame.whole("depth_layers");
    std::vector<float> bounds;
    for (int k = 0; k < int(partition.size()); ++k) {
        const Json& layer = partition[std::size_t(k)];
        if (layer["stored"].is_null()) continue;
        const int depth = k / normals, normal = k % normals;
        for (const float value :
             {layer["depth_min"].get<float>(), layer["depth_max"].get<float>(), depth == 0 ? 1.0f : 0.0f, depth == depths - 1 ? 1.0f : 0.0f,
              layer["n_dot_l_min"].get<float>(), layer["n_dot_l_max"].get<float>(), normal == 0 ? 1.0f : 0.0f, normal == normals - 1 ? 1.0f : 0.0f})
            bounds.push_back(value);
    }
    return bounds;
}

}  // namespace

void rsm(Frame& frame, const Options& options, int light)
{
    const Json& projection = frame.manifest()["lights"][std::size_t(light)]["projection"];
    const int n = projection["resolution"];
    const Program& program =
        options.program("rsm", {{GL_VERTEX_SHADER, {"scene.vert.glsl"}}, {GL_FRAGMENT_SHADER, {"formats.glsl", "light.glsl", "surface.glsl", "rsm.frag.glsl"}}},
                        rounding(frame, "rsm_half_rounding"));
    program.setMatrix("clipFromWorld", numbers(projection["clip_from_world"]));
    program.set("light", light);
    const StorageBuffer lights = lightBuffer(frame);
    const SceneDrawing scene(frame);

    const TexelFormat half = options.driverFormats ? kHalf4 : kUint16x4;
    const Texture radiance = makeTexture(GL_TEXTURE_2D, half, n, n, 1, 1), normal = makeTexture(GL_TEXTURE_2D, half, n, n, 1, 1);
    const Texture depth = makeTexture(GL_TEXTURE_2D, kFloat, n, n, 1, 1), zBuffer = makeTexture(GL_TEXTURE_2D, kDepth, n, n, 1, 1);
    const Texture* const colours[] = {&radiance, &normal, &depth};
    const Framebuffer target = makeFramebuffer(colours, zBuffer);
    const std::string index = std::to_string(light), prefix = "rsm" + index + ".";
    frame.time("rsm " + index, [&] {
        const std::array<float, 4> far = {1.0f, 0.0f, 0.0f, 0.0f};
        clear(radiance, half);
        clear(normal, half);
        glClearNamedFramebufferfv(target(), GL_COLOR, 2, far.data());
        scene.draw(target, n, n, program);
    });
    const std::size_t texels = std::size_t(n) * std::size_t(n);
    frame.output(prefix + "radiance", download(radiance, half, 0, texels));
    frame.output(prefix + "normal", download(normal, half, 0, texels));
    frame.output(prefix + "depth", download(depth, kFloat, 0, texels));
}

void lrsm(Frame& frame, const Options& options, int light)
{
    const std::string index = std::to_string(light), rsmName = "rsm" + index + ".", name = "lrsm" + index + ".";
    const int n = frame.manifest()["lights"][std::size_t(light)]["projection"]["resolution"], base = n / 2;
    const int levels = frame.manifest()["lights"][std::size_t(light)]["levels"], layers = layersStored(frame, light);
    const std::vector<std::string> defines = rounding(frame, "layer_half_rounding");
    const Program& split = options.compute("lrsm", {"formats.glsl", "lrsm_split.comp.glsl"}, defines);
    const Program& mip = options.compute("lrsm", {"formats.glsl", "lrsm_mip.comp.glsl"}, defines);

    const std::array<Texture, 3> maps = {inputTexture(frame, rsmName + "radiance", GL_TEXTURE_2D, kUint16x4, n, n, 1),
                                         inputTexture(frame, rsmName + "normal", GL_TEXTURE_2D, kUint16x4, n, n, 1),
                                         inputTexture(frame, rsmName + "depth", GL_TEXTURE_2D, kFloat, n, n, 1)};
    const TexelFormat half = options.driverFormats ? kHalf4 : kUint16x4, unorm = options.driverFormats ? kUnorm16x4 : kUint16x4;
    const std::array<TexelFormat, 3> formats = {half, half, unorm};
    std::array<Texture, 3> out;
    for (std::size_t i = 0; i < 3; ++i) out[i] = makeTexture(GL_TEXTURE_2D_ARRAY, formats[i], base, base, layers, levels);
    const std::vector<float> bounds = layerBounds(frame, light);
    const StorageBuffer layerBuffer = makeBuffer(std::as_bytes(std::span(bounds)));
    bindBuffer(0, layerBuffer);
    const auto target = [&](int level) {
        for (GLuint i = 0; i < 3; ++i) glBindImageTexture(i, out[i](), level, GL_TRUE, 0, GL_WRITE_ONLY, formats[i].internal);
    };
    frame.time("lrsm " + index, [&] {
        for (GLuint i = 0; i < 3; ++i) bindTexture(i, maps[i]);
        target(0);
        split.set("baseResolution", base);
        split.dispatch(base, base, layers, 8, 8, 1);
        for (GLuint i = 0; i < 3; ++i) bindTexture(i, out[i]);
        for (int level = 1; level < levels; ++level) {
            target(level);
            mip.set("resolution", base >> level);
            mip.set("level", level);
            mip.dispatch(base >> level, base >> level, layers, 8, 8, 1);
        }
    });
    const char* const parts[] = {"radiance", "normal", "depth"};
    for (std::size_t i = 0; i < 3; ++i)
        for (int level = 0; level < levels; ++level) {
            const std::size_t edge = std::size_t(base >> level);
            frame.output(name + parts[i] + ".mip" + std::to_string(level), download(out[i], formats[i], level, edge * edge * std::size_t(layers)));
        }
}

void gbuffer(Frame& frame, const Options& options)
{
    const Json& camera = frame.manifest()["camera"];
    const int width = frame.width(), height = frame.height();
    const Program& program =
        options.program("gbuffer", {{GL_VERTEX_SHADER, {"scene.vert.glsl"}}, {GL_FRAGMENT_SHADER, {"surface.glsl", "gbuffer.frag.glsl"}}}, {});
    program.setMatrix("clipFromWorld", numbers(camera["clip_from_world"]));
    program.set("eye", numbers(camera["position"]));
    program.set("forward", numbers(camera["forward"]));
    program.set("perspective", camera["perspective"].get<bool>() ? 1 : 0);
    const SceneDrawing scene(frame);

    std::array<Texture, 5> maps;
    std::array<const Texture*, 5> colours;
    for (std::size_t i = 0; i < maps.size(); ++i) {
        maps[i] = makeTexture(GL_TEXTURE_2D, kFloat4, width, height, 1, 1);
        colours[i] = &maps[i];
    }
    const Texture zBuffer = makeTexture(GL_TEXTURE_2D, kDepth, width, height, 1, 1);
    const Framebuffer target = makeFramebuffer(colours, zBuffer);
    frame.time("gbuffer", [&] {
        for (const Texture& map : maps) clear(map, kFloat4);
        scene.draw(target, width, height, program);
    });

    // Four channels a texture to the capture's arrays.
    const std::size_t pixels = std::size_t(width) * std::size_t(height);
    const auto split = [&](std::size_t map, const char* xyz, const char* w) {
        const std::vector<std::byte> bytes = download(maps[map], kFloat4, 0, pixels);
        const auto* from = reinterpret_cast<const float*>(bytes.data());
        std::vector<float> three(3 * pixels), last(pixels);
        for (std::size_t i = 0; i < pixels; ++i) {
            for (std::size_t c = 0; c < 3; ++c) three[3 * i + c] = from[4 * i + c];
            last[i] = from[4 * i + 3];
        }
        const auto bytesOf = [](const auto& values) {
            const auto view = std::as_bytes(std::span(values));
            return std::vector<std::byte>(view.begin(), view.end());
        };
        frame.output(std::string("gbuffer.") + xyz, bytesOf(three));
        if (std::string(w) == "object_id")
            frame.output("gbuffer.object_id", bytesOf(std::vector<std::uint32_t>(last.begin(), last.end())));
        else if (*w)
            frame.output(std::string("gbuffer.") + w, bytesOf(last));
    };
    split(0, "position", "depth");
    split(1, "geometric_normal", "object_id");
    split(2, "normal", "roughness");
    split(3, "albedo", "");
    split(4, "specular_color", "");
}

}  // namespace lrsm::twin
