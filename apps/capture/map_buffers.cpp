#include "apps/capture/map_buffers.h"

#include "apps/capture/fill.h"
#include "apps/capture/tolerances.h"
#include "core/base/formats.h"
#include "core/base/parallel.h"

namespace lrsm {

namespace {

constexpr std::size_t kChannels = 4;
constexpr std::size_t kTexelsPerTask = 65536;

/// Four channels of `count` texels; `texel(i)` yields a pointer to them. The values are representable, so rounding modes do not matter.
template <class Texel>
void store(Buffer& buffer, std::size_t count, const Texel& texel)
{
    const auto each = [&]<class T>(T* to, auto&& convert) {
        parallelFor(count, kTexelsPerTask, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const float* from = texel(i);
                for (std::size_t c = 0; c < kChannels; ++c) to[i * kChannels + c] = convert(from[c]);
            }
        });
    };
    if (buffer.dtype == Dtype::f4) return each(allocate<float>(buffer), [](float v) { return v; });
    auto* to = allocate<std::uint16_t>(buffer);
    if (buffer.encoding == Encoding::unorm) return each(to, [](float v) { return unorm16FromFloat(v); });
    each(to, [](float v) { return halfFromFloat(v, HalfRounding::nearestEven); });
}

/// The inverse: texel(i) is where the four channels go.
template <class Texel>
void load(const Capture& capture, const std::string& name, std::size_t count, const Texel& texel)
{
    const Buffer& buffer = capture.at(name);
    const auto each = [&]<class T>(std::span<const T> from, auto&& convert) {
        parallelFor(count, kTexelsPerTask, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                float* to = texel(i);
                for (std::size_t c = 0; c < kChannels; ++c) to[c] = convert(from[i * kChannels + c]);
            }
        });
    };
    if (buffer.dtype == Dtype::f4) return each(valuesOf<float>(capture, name, Dtype::f4, count * kChannels), [](float v) { return v; });
    if (buffer.encoding == Encoding::unorm)
        return each(valuesOf<std::uint16_t>(capture, name, Dtype::u2, count * kChannels), [](std::uint16_t v) { return floatFromUnorm16(v); });
    each(valuesOf<std::uint16_t>(capture, name, Dtype::f2, count * kChannels), [](std::uint16_t v) { return floatFromHalf(v); });
}

// The two textures of an RSM texel: four floats each, one after the other.
static_assert(sizeof(RsmTexel) == 2 * kChannels * sizeof(float) && offsetof(RsmTexel, normal) == kChannels * sizeof(float));

std::string rsmPrefix(std::size_t light)
{
    return "rsm" + std::to_string(light) + ".";
}
std::string shadowName(std::size_t light)
{
    return "shadow" + std::to_string(light) + ".depth";
}
std::string lrsmName(std::size_t light, const char* texture, int lod)
{
    return mipName("lrsm" + std::to_string(light) + "." + texture, lod);
}

struct LrsmTexture {
    const char* name;
    float (LrsmTexel::*part)[4];
};
constexpr LrsmTexture kLrsmTextures[] = {{"radiance", &LrsmTexel::radiance}, {"normal", &LrsmTexel::normal}, {"depth", &LrsmTexel::depth}};

/// Index within an Lrsm's texels of texel i of the buffer, which holds one mip of all layers.
std::size_t texelOf(const Lrsm& lrsm, int lod, std::size_t i)
{
    const auto n = static_cast<std::size_t>(lrsm.resolutionAt(lod)), perLayer = n * n;
    return i / perLayer * lrsm.texelsPerLayer + lrsm.levelOffset[static_cast<std::size_t>(lod)] + i % perLayer;
}

const CapturedLight& lightOf(const Capture& capture, std::size_t light)
{
    if (light >= capture.lights.size()) throw InputError("capture", "has no light " + std::to_string(light));
    return capture.lights[light];
}

constexpr TexelFormat kHalf4 = {Dtype::f2, Encoding::number, DxgiFormat::R16G16B16A16_FLOAT};
constexpr TexelFormat kUnorm4 = {Dtype::u2, Encoding::unorm, DxgiFormat::R16G16B16A16_UNORM};
constexpr TexelFormat kFloat4 = {Dtype::f4, Encoding::number, DxgiFormat::R32G32B32A32_FLOAT};

}  // namespace

void describeRsm(Catalogue& out, const DescribedFrame& frame, std::size_t light)
{
    const RsmSettings& settings = frame.settings.rsm;
    const std::string prefix = rsmPrefix(light);
    const TexelFormat format = settings.storage == Storage::gpu ? kHalf4 : kFloat4;
    const int n = settings.resolution;
    const auto map = [&](const std::string& name, const Catalogue::Names& components, const Catalogue::Text& text, const Tolerance& tolerance,
                         const TexelFormat& as) {
        Buffer& buffer = out.picture(prefix + name, n, n, components, text, tolerance, as.dtype);
        buffer.dds = DdsPlace{prefix + name + ".dds", 0, as.dds, false};
    };
    map("radiance", {"r", "g", "b", "coverage"},
        {"reflected radiance albedo L <n.l> / pi, times pre_exposure; coverage 1 where a surface was drawn", "light's map", kRadianceUnit},
        tolerances::mapRadiance(n), format);
    map("normal", {"x", "y", "z", "n_dot_l"}, {"shading normal towards the light, and its cosine to it", kWorldSpace, ""}, tolerances::mapNormal(n), format);
    map("depth", {}, {"linear depth in [0, 1] over the projection's range; 1 where empty", "light's map", ""}, tolerances::mapDepth(n), {});
}

void describeShadow(Catalogue& out, const DescribedFrame& frame, std::size_t light)
{
    const int n = frame.settings.rsm.resolution * frame.settings.direct.shadowResolution;
    Buffer& buffer =
        out.picture(shadowName(light), n, n, {}, {"linear depth as the RSM's, in the same frustum; 1 where empty", "light's map", ""}, tolerances::mapDepth(n));
    buffer.dds = DdsPlace{stemOf(buffer.name) + ".dds", 0, TexelFormat{}.dds, false};
}

void describeLrsm(Catalogue& out, const DescribedFrame& frame, std::size_t light)
{
    const auto layers = static_cast<std::size_t>(frame.layersStored[light]);
    if (layers == 0) return;
    const bool gpu = frame.settings.layers.storage == Storage::gpu;
    const auto texture = [&](const char* name, const Catalogue::Names& components, const Catalogue::Text& text, const auto& tolerance,
                             const TexelFormat& format) {
        for (int lod = 0, size = frame.settings.rsm.resolution / 2; size >= 1; ++lod, size /= 2) {
            const auto n = static_cast<std::size_t>(size);
            Buffer& buffer = out.add(lrsmName(light, name, lod), format.dtype, {layers, n, n}, {"layer", "row", "column"}, components, text, tolerance(lod));
            buffer.encoding = format.encoding;
            buffer.dds = DdsPlace{stemOf(buffer.name) + ".dds", static_cast<std::uint32_t>(lod), format.dds, false};
        }
    };
    const auto half = [&](int) { return tolerances::layerHalf(gpu); };
    texture("radiance", {"r", "g", "b", ""}, {"radiance times the layer's coverage alpha and pre_exposure", "light's map", kRadianceUnit}, half,
            gpu ? kHalf4 : kFloat4);
    texture("normal", {"x", "y", "z", "alpha"}, {"normal times alpha, and alpha", kWorldSpace, ""}, half, gpu ? kHalf4 : kFloat4);
    texture(
        "depth", {"z", "z2", "alpha", ""}, {"alpha z, alpha z^2 (z warped to [0, 1] in the layer's range), and alpha", "layer's depth", ""},
        [&](int lod) { return tolerances::layerDepth(gpu, lod); }, gpu ? kUnorm4 : kFloat4);
}

void toBuffers(const Rsm& rsm, std::size_t light, std::vector<Buffer>& buffers)
{
    const std::string prefix = rsmPrefix(light);
    const auto part = [&](std::size_t i, std::size_t texture) { return reinterpret_cast<const float*>(&rsm.texels.texels[i]) + texture * kChannels; };
    if (Buffer* buffer = findBuffer(buffers, prefix + "radiance")) store(*buffer, rsm.texels.texels.size(), [&](std::size_t i) { return part(i, 0); });
    if (Buffer* buffer = findBuffer(buffers, prefix + "normal")) store(*buffer, rsm.texels.texels.size(), [&](std::size_t i) { return part(i, 1); });
    copyTo(buffers, prefix + "depth", rsm.depthLinear.texels);
}

Rsm rsmFromCapture(const Capture& capture, std::size_t light)
{
    Rsm rsm;
    rsm.projection = lightOf(capture, light).projection;
    rsm.preExposure = capture.preExposure;
    const int n = rsm.projection.resolution;
    const std::string prefix = rsmPrefix(light);
    rsm.texels = Image<RsmTexel>(n, n);
    const auto part = [&](std::size_t i, std::size_t texture) { return reinterpret_cast<float*>(&rsm.texels.texels[i]) + texture * kChannels; };
    load(capture, prefix + "radiance", rsm.texels.texels.size(), [&](std::size_t i) { return part(i, 0); });
    load(capture, prefix + "normal", rsm.texels.texels.size(), [&](std::size_t i) { return part(i, 1); });
    rsm.depthLinear = Image<float>(n, n);
    rsm.depthLinear.texels = copyFrom<float>(capture, prefix + "depth", Dtype::f4, rsm.texels.texels.size());
    return rsm;
}

void toBuffers(const DepthMap& map, std::size_t light, std::vector<Buffer>& buffers)
{
    copyTo(buffers, shadowName(light), map.depthLinear.texels);
}

DepthMap depthMapFromCapture(const Capture& capture, std::size_t light)
{
    const LightProjection& ofRsm = lightOf(capture, light).projection;
    const DirectSettings& settings = capture.settings.direct;
    DepthMap map{refine(ofRsm, settings.shadowResolution), {}, {}};
    const int n = map.projection.resolution;
    map.depthLinear = Image<float>(n, n);
    map.depthLinear.texels =
        copyFrom<float>(capture, hasShadowMaps(settings) ? shadowName(light) : rsmPrefix(light) + "depth", Dtype::f4, map.depthLinear.texels.size());
    return map;
}

void toBuffers(const Lrsm& lrsm, std::size_t light, std::vector<Buffer>& buffers)
{
    for (const LrsmTexture& texture : kLrsmTextures)
        for (int lod = 0; lod < lrsm.levels(); ++lod) {
            Buffer* buffer = findBuffer(buffers, lrsmName(light, texture.name, lod));
            if (!buffer) continue;
            const auto n = static_cast<std::size_t>(lrsm.resolutionAt(lod));
            store(*buffer, static_cast<std::size_t>(lrsm.layers()) * n * n, [&](std::size_t i) { return lrsm.texels[texelOf(lrsm, lod, i)].*texture.part; });
        }
}

Lrsm lrsmFromCapture(const Capture& capture, std::size_t light)
{
    const CapturedLight& from = lightOf(capture, light);
    Lrsm lrsm;
    lrsm.projection = from.projection;
    lrsm.preExposure = capture.preExposure;
    lrsm.baseResolution = from.projection.resolution / 2;
    lrsm.ranges = from.storedRanges();
    lrsm.validTexelsPerLayer = from.validTexels;
    lrsm.layersAsked = static_cast<int>(from.partition.size());
    for (int n = lrsm.baseResolution; n >= 1; n /= 2) {
        lrsm.levelOffset.push_back(lrsm.texelsPerLayer);
        lrsm.texelsPerLayer += static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
    }
    lrsm.texels.resize(lrsm.texelsPerLayer * lrsm.ranges.size());
    if (lrsm.ranges.empty()) return lrsm;
    for (const LrsmTexture& texture : kLrsmTextures)
        for (int lod = 0; lod < lrsm.levels(); ++lod) {
            const auto n = static_cast<std::size_t>(lrsm.resolutionAt(lod));
            load(capture, lrsmName(light, texture.name, lod), lrsm.ranges.size() * n * n,
                 [&](std::size_t i) { return lrsm.texels[texelOf(lrsm, lod, i)].*texture.part; });
        }
    return lrsm;
}

}  // namespace lrsm
