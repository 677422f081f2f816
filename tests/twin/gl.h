#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// As much of OpenGL 4.5 as the twin needs. Everything works on the current context of the calling thread.
namespace lrsm::twin {

/// A context without a window or surface (EGL_MESA_platform_surfaceless), current from create() until it is destroyed.
class GlContext {
  public:
    /// nullptr where there is no EGL display or no OpenGL 4.5; `whyNot` then says which.
    static std::unique_ptr<GlContext> create(std::string& whyNot);
    ~GlContext();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    /// GL_RENDERER, and the driver's version.
    std::string renderer() const;

  private:
    GlContext() = default;
    void *display_ = nullptr, *context_ = nullptr;
};

/// An object name that is deleted with it; `Delete` takes (1, &name).
template <auto Delete>
class GlObject {
  public:
    GlObject() = default;
    explicit GlObject(GLuint name) : name_(name) {}
    ~GlObject()
    {
        if (name_) Delete(name_);
    }
    GlObject(GlObject&& other) noexcept : name_(other.name_) { other.name_ = 0; }
    GlObject& operator=(GlObject&& other) noexcept
    {
        std::swap(name_, other.name_);
        return *this;
    }
    GLuint operator()() const { return name_; }

  private:
    GLuint name_ = 0;
};
void deleteTexture(GLuint name);
void deleteBuffer(GLuint name);
void deleteSampler(GLuint name);
void deleteFramebuffer(GLuint name);
void deleteProgram(GLuint name);
using Texture = GlObject<deleteTexture>;
using StorageBuffer = GlObject<deleteBuffer>;
using Sampler = GlObject<deleteSampler>;
using Framebuffer = GlObject<deleteFramebuffer>;

/// How texels lie in memory: the internal format, and the pair that moves them in and out without conversion.
struct TexelFormat {
    GLenum internal, format, type;
    std::size_t bytes;
};
inline constexpr TexelFormat kHalf4{GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, 8};
inline constexpr TexelFormat kUnorm16x4{GL_RGBA16, GL_RGBA, GL_UNSIGNED_SHORT, 8};
inline constexpr TexelFormat kUnorm16{GL_R16, GL_RED, GL_UNSIGNED_SHORT, 2};
inline constexpr TexelFormat kUnorm8{GL_R8, GL_RED, GL_UNSIGNED_BYTE, 1};
inline constexpr TexelFormat kUnorm8x4{GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
inline constexpr TexelFormat kFloat{GL_R32F, GL_RED, GL_FLOAT, 4};
inline constexpr TexelFormat kFloat4{GL_RGBA32F, GL_RGBA, GL_FLOAT, 16};
inline constexpr TexelFormat kUint8{GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, 1};
inline constexpr TexelFormat kUint8x4{GL_RGBA8UI, GL_RGBA_INTEGER, GL_UNSIGNED_BYTE, 4};
inline constexpr TexelFormat kUint16x4{GL_RGBA16UI, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT, 8};
inline constexpr TexelFormat kDepth{GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 4};

/// Immutable storage; `depth` is 1 for GL_TEXTURE_2D, layers or slices else.
Texture makeTexture(GLenum target, const TexelFormat& format, int width, int height, int depth, int levels);
void upload(const Texture& texture, GLenum target, const TexelFormat& format, int level, int width, int height, int depth, const void* texels);
/// Every texel of level 0 to zero.
void clear(const Texture& texture, const TexelFormat& format);
std::vector<std::byte> download(const Texture& texture, const TexelFormat& format, int level, std::size_t texels);
void bindTexture(GLuint unit, const Texture& texture, const Sampler* sampler = nullptr);

/// Linear within and between levels, border 0: how the cones read. Level by the shader.
Sampler borderSampler();

StorageBuffer makeBuffer(std::span<const std::byte> bytes);
StorageBuffer makeBuffer(std::size_t zeroBytes);
std::vector<std::byte> download(const StorageBuffer& buffer, std::size_t bytes);
void bindBuffer(GLuint binding, const StorageBuffer& buffer);

/// Colour attachments 0 .. and a depth buffer, all of one size.
Framebuffer makeFramebuffer(std::span<const Texture* const> colours, const Texture& depth);
/// No attachment at all: fragments only write to buffers.
Framebuffer emptyFramebuffer(int width, int height);

/// Shader files are read from tests/twin/shaders; a stage is the concatenation of its files after `#version 450 core` and the defines.
struct Stage {
    GLenum kind;
    std::vector<std::string> files;
};

/// A linked program. Throws std::runtime_error with file, line and the driver's words for a shader that does not compile.
class Program {
  public:
    Program(const std::vector<Stage>& stages, const std::vector<std::string>& defines);
    void use() const;
    /// Names that the shader does not use are passed over.
    void set(const char* name, float value) const;
    void set(const char* name, int value) const;
    void set(const char* name, const std::vector<float>& vector) const;  ///< 2 to 4 components
    void setArray(const char* name, const std::vector<float>& values) const;
    void setArray(const char* name, const std::vector<int>& values) const;
    void setMatrix(const char* name, const std::vector<float>& rows) const;  ///< 16, row by row
    /// `groups` work groups that cover `extent` invocations along each axis, in groups of `size`, and a barrier for all that they wrote.
    void dispatch(int width, int height, int depth, int sizeX, int sizeY, int sizeZ) const;

  private:
    GlObject<deleteProgram> program_;
};

/// Programs by their files and defines: made once, kept while this lives.
class Programs {
  public:
    const Program& get(const std::vector<Stage>& stages, const std::vector<std::string>& defines);

  private:
    std::map<std::string, Program> made_;
};

/// Throws std::runtime_error that begins with `where` if OpenGL has reported an error since the last call.
void checkErrors(const char* where);

}  // namespace lrsm::twin
