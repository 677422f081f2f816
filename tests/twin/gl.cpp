#include "tests/twin/gl.h"

#include <epoxy/egl.h>

#include <array>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace lrsm::twin {

namespace {

constexpr int kMajor = 4, kMinor = 5;

std::string readShader(const std::string& file)
{
    const std::string path = std::string(LRSM_SOURCE_DIR) + "/tests/twin/shaders/" + file;
    std::ifstream in(path);
    if (!in) throw std::runtime_error(path + ": cannot be read");
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

/// The driver's complaints speak of "string number:line": the number of the file in `files`.
std::string legend(const std::vector<std::string>& files)
{
    std::string text;
    for (std::size_t i = 0; i < files.size(); ++i) text += (i ? ", " : "") + std::to_string(i + 1) + " = " + files[i];
    return text;
}

GLuint compile(const Stage& stage, const std::vector<std::string>& defines)
{
    std::string text = "#version 450 core\n";
    for (const std::string& define : defines) text += "#define " + define + "\n";
    for (std::size_t i = 0; i < stage.files.size(); ++i) text += "#line 1 " + std::to_string(i + 1) + "\n" + readShader(stage.files[i]) + "\n";
    const char* source = text.c_str();
    const GLuint shader = glCreateShader(stage.kind);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint fine = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &fine);
    if (fine) return shader;
    std::string log(8192, '\0');
    GLsizei length = 0;
    glGetShaderInfoLog(shader, GLsizei(log.size()), &length, log.data());
    log.resize(std::size_t(length));
    glDeleteShader(shader);
    throw std::runtime_error("shader does not compile (" + legend(stage.files) + "):\n" + log);
}

}  // namespace

std::unique_ptr<GlContext> GlContext::create(std::string& whyNot)
{
    if (!epoxy_has_egl()) {
        whyNot = "there is no libEGL";
        return nullptr;
    }
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
        whyNot = "EGL has no surfaceless platform";
        return nullptr;
    }
    const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) {
        whyNot = "no EGL display";
        return nullptr;
    }
    std::unique_ptr<GlContext> context(new GlContext);
    context->display_ = display;
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,           kMajor,  EGL_CONTEXT_MINOR_VERSION, kMinor, EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    if (eglBindAPI(EGL_OPENGL_API)) context->context_ = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (!context->context_ || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context->context_)) {
        whyNot = "no OpenGL 4.5 core context";
        return nullptr;
    }
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    return context;
}

GlContext::~GlContext()
{
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context_) eglDestroyContext(display_, context_);
    eglTerminate(display_);
}

std::string GlContext::renderer() const
{
    return std::string(reinterpret_cast<const char*>(glGetString(GL_RENDERER))) + ", " + reinterpret_cast<const char*>(glGetString(GL_VERSION));
}

void deleteTexture(GLuint name)
{
    glDeleteTextures(1, &name);
}
void deleteBuffer(GLuint name)
{
    glDeleteBuffers(1, &name);
}
void deleteSampler(GLuint name)
{
    glDeleteSamplers(1, &name);
}
void deleteFramebuffer(GLuint name)
{
    glDeleteFramebuffers(1, &name);
}
void deleteProgram(GLuint name)
{
    glDeleteProgram(name);
}

Texture makeTexture(GLenum target, const TexelFormat& format, int width, int height, int depth, int levels)
{
    GLuint name = 0;
    glCreateTextures(target, 1, &name);
    if (target == GL_TEXTURE_2D)
        glTextureStorage2D(name, levels, format.internal, width, height);
    else
        glTextureStorage3D(name, levels, format.internal, width, height, depth);
    // Complete, for texelFetch without a sampler object, whatever its mips.
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return Texture(name);
}

void upload(const Texture& texture, GLenum target, const TexelFormat& format, int level, int width, int height, int depth, const void* texels)
{
    if (target == GL_TEXTURE_2D)
        glTextureSubImage2D(texture(), level, 0, 0, width, height, format.format, format.type, texels);
    else
        glTextureSubImage3D(texture(), level, 0, 0, 0, width, height, depth, format.format, format.type, texels);
}

void clear(const Texture& texture, const TexelFormat& format)
{
    glClearTexImage(texture(), 0, format.format, format.type, nullptr);
}

std::vector<std::byte> download(const Texture& texture, const TexelFormat& format, int level, std::size_t texels)
{
    std::vector<std::byte> bytes(texels * format.bytes);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    glGetTextureImage(texture(), level, format.format, format.type, GLsizei(bytes.size()), bytes.data());
    return bytes;
}

void bindTexture(GLuint unit, const Texture& texture, const Sampler* sampler)
{
    glBindTextureUnit(unit, texture());
    glBindSampler(unit, sampler ? (*sampler)() : 0);
}

Sampler borderSampler()
{
    GLuint name = 0;
    glCreateSamplers(1, &name);
    glSamplerParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glSamplerParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) glSamplerParameteri(name, axis, GL_CLAMP_TO_BORDER);
    const std::array<float, 4> border{};
    glSamplerParameterfv(name, GL_TEXTURE_BORDER_COLOR, border.data());
    return Sampler(name);
}

StorageBuffer makeBuffer(std::span<const std::byte> bytes)
{
    // Whole words, and never none: shaders see arrays of uint or float.
    const std::size_t size = std::max<std::size_t>(4, (bytes.size() + 3) / 4 * 4);
    GLuint name = 0;
    glCreateBuffers(1, &name);
    glNamedBufferStorage(name, GLsizeiptr(size), nullptr, GL_DYNAMIC_STORAGE_BIT);
    glNamedBufferSubData(name, 0, GLsizeiptr(bytes.size()), bytes.data());
    return StorageBuffer(name);
}

StorageBuffer makeBuffer(std::size_t zeroBytes)
{
    return makeBuffer(std::vector<std::byte>(zeroBytes));
}

std::vector<std::byte> download(const StorageBuffer& buffer, std::size_t size)
{
    std::vector<std::byte> bytes(size);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    glGetNamedBufferSubData(buffer(), 0, GLsizeiptr(size), bytes.data());
    return bytes;
}

void bindBuffer(GLuint binding, const StorageBuffer& buffer)
{
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer());
}

Framebuffer makeFramebuffer(std::span<const Texture* const> colours, const Texture& depth)
{
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    std::vector<GLenum> attachments;
    for (std::size_t i = 0; i < colours.size(); ++i) {
        attachments.push_back(GLenum(GL_COLOR_ATTACHMENT0 + i));
        glNamedFramebufferTexture(name, attachments.back(), (*colours[i])(), 0);
    }
    glNamedFramebufferDrawBuffers(name, GLsizei(attachments.size()), attachments.data());
    glNamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, depth(), 0);
    return Framebuffer(name);
}

Framebuffer emptyFramebuffer(int width, int height)
{
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    glNamedFramebufferParameteri(name, GL_FRAMEBUFFER_DEFAULT_WIDTH, width);
    glNamedFramebufferParameteri(name, GL_FRAMEBUFFER_DEFAULT_HEIGHT, height);
    return Framebuffer(name);
}

Program::Program(const std::vector<Stage>& stages, const std::vector<std::string>& defines) : program_(glCreateProgram())
{
    std::string files;
    for (const Stage& stage : stages) {
        const GLuint shader = compile(stage, defines);
        glAttachShader(program_(), shader);
        glDeleteShader(shader);
        files += legend(stage.files) + "; ";
    }
    glLinkProgram(program_());
    GLint fine = 0;
    glGetProgramiv(program_(), GL_LINK_STATUS, &fine);
    if (fine) return;
    std::string log(8192, '\0');
    GLsizei length = 0;
    glGetProgramInfoLog(program_(), GLsizei(log.size()), &length, log.data());
    log.resize(std::size_t(length));
    throw std::runtime_error("shaders do not link (" + files + "):\n" + log);
}

const Program& Programs::get(const std::vector<Stage>& stages, const std::vector<std::string>& defines)
{
    std::string key;
    for (const Stage& stage : stages) key += legend(stage.files) + "; ";
    for (const std::string& define : defines) key += define + "; ";
    const auto found = made_.find(key);
    return found != made_.end() ? found->second : made_.emplace(key, Program(stages, defines)).first->second;
}

void Program::use() const
{
    glUseProgram(program_());
}
void Program::set(const char* name, float value) const
{
    glProgramUniform1f(program_(), glGetUniformLocation(program_(), name), value);
}
void Program::set(const char* name, int value) const
{
    glProgramUniform1i(program_(), glGetUniformLocation(program_(), name), value);
}
void Program::set(const char* name, const std::vector<float>& v) const
{
    const GLint at = glGetUniformLocation(program_(), name);
    if (v.size() == 2) glProgramUniform2fv(program_(), at, 1, v.data());
    if (v.size() == 3) glProgramUniform3fv(program_(), at, 1, v.data());
    if (v.size() == 4) glProgramUniform4fv(program_(), at, 1, v.data());
}
void Program::setArray(const char* name, const std::vector<float>& values) const
{
    glProgramUniform1fv(program_(), glGetUniformLocation(program_(), name), GLsizei(values.size()), values.data());
}
void Program::setArray(const char* name, const std::vector<int>& values) const
{
    glProgramUniform1iv(program_(), glGetUniformLocation(program_(), name), GLsizei(values.size()), values.data());
}
void Program::setMatrix(const char* name, const std::vector<float>& rows) const
{
    glProgramUniformMatrix4fv(program_(), glGetUniformLocation(program_(), name), 1, GL_TRUE, rows.data());
}

void Program::dispatch(int width, int height, int depth, int sizeX, int sizeY, int sizeZ) const
{
    const auto groups = [](int extent, int size) { return GLuint((extent + size - 1) / size); };
    use();
    glDispatchCompute(groups(width, sizeX), groups(height, sizeY), groups(depth, sizeZ));
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

void checkErrors(const char* where)
{
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) return;
    while (glGetError() != GL_NO_ERROR) {
    }
    char text[16];
    std::snprintf(text, sizeof text, "0x%04x", error);
    throw std::runtime_error(std::string(where) + ": OpenGL error " + text);
}

}  // namespace lrsm::twin
