#include "core/scene/texture_sampling.h"

#include "core/base/elementary.h"
#include "core/base/formats.h"

#include <array>

namespace lrsm {
namespace {

/// What each of the 256 stored values stands for, rounded once to float.
using Decoded = std::array<double, 256>;
template <class Decode>
Decoded decoded(const Decode& decode)
{
    Decoded table{};
    for (int i = 0; i < 256; ++i) table[std::size_t(i)] = double(decode(static_cast<std::uint8_t>(i)));
    return table;
}
const Decoded kFromSrgb = decoded(linearFromSrgb8);  ///< the sRGB decoding function of IEC 61966-2-1
const Decoded kFromUnorm = decoded([](std::uint8_t value) { return float(value) / 255.0f; });

/// One axis of a lookup: the two texels and the weight of the second. Wrapping the coordinate before scaling keeps any finite
/// uv inside int; a non-finite one reads texel 0.
struct Taps {
    int i0, i1;
    float fraction;
};

float wrapCoordinate(float u, Wrap wrap)
{
    if (!std::isfinite(u)) return 0.0f;
    switch (wrap) {
    case Wrap::clampToEdge: return std::clamp(u, 0.0f, 1.0f);
    case Wrap::mirroredRepeat: {
        const float period = u - 2.0f * std::floor(0.5f * u);  // in [0, 2]
        return period <= 1.0f ? period : 2.0f - period;
    }
    default: return u - std::floor(u);  // in [0, 1]: a tiny negative u rounds to 1
    }
}

/// Index of a neighbour that lies one texel outside: the far edge when repeating; the edge texel itself when clamping, and
/// when mirroring, since the mirror image begins with the same texel.
int wrapIndex(int i, int size, Wrap wrap)
{
    if (i >= 0 && i < size) return i;
    if (wrap == Wrap::repeat) return i < 0 ? size - 1 : 0;
    return i < 0 ? 0 : size - 1;
}

Taps tapsAlong(float u, int size, Wrap wrap, bool nearest)
{
    const float x = wrapCoordinate(u, wrap) * float(size);
    if (nearest) {
        const int i = wrapIndex(int(x), size, wrap);
        return {i, i, 0.0f};
    }
    const float cell = std::floor(x - 0.5f);
    const int i = int(cell);
    return {wrapIndex(i, size, wrap), wrapIndex(i + 1, size, wrap), (x - 0.5f) - cell};
}

/// In double, where the products below are exact or rounded towards neither texel's outside: a constant stays the constant and
/// the result lies between the texels.
double bilinear(double v00, double v10, double v01, double v11, double tx, double ty)
{
    const double top = v00 + (v10 - v00) * tx;
    const double bottom = v01 + (v11 - v01) * tx;
    return top + (bottom - top) * ty;
}

/// The four texels about uv, and the weights of those to the right and below.
struct Texels {
    Rgba8 t00, t10, t01, t11;
    float tx, ty;
};

Texels texelsAt(const Texture& texture, const Image<Rgba8>& image, bool nearest, Vec2 uv)
{
    const Taps x = tapsAlong(uv.x, image.width, texture.wrapS, nearest);
    const Taps y = tapsAlong(uv.y, image.height, texture.wrapT, nearest);
    return {image.at(x.i0, y.i0), image.at(x.i1, y.i0), image.at(x.i0, y.i1), image.at(x.i1, y.i1), x.fraction, y.fraction};
}

float alphaOf(const Texels& t)
{
    return float(bilinear(t.t00.a, t.t10.a, t.t01.a, t.t11.a, t.tx, t.ty) / 255.0);
}

Vec4 sampleLevel(const Texture& texture, const Image<Rgba8>& image, bool nearest, Vec2 uv, const Decoded& decode)
{
    const Texels t = texelsAt(texture, image, nearest, uv);
    const auto colour = [&](std::uint8_t Rgba8::*c) {
        return float(bilinear(decode[t.t00.*c], decode[t.t10.*c], decode[t.t01.*c], decode[t.t11.*c], t.tx, t.ty));
    };
    return Vec4(colour(&Rgba8::r), colour(&Rgba8::g), colour(&Rgba8::b), alphaOf(t));
}

/// Minified textures are read bilinearly whatever magFilter says.
Vec4 sample(const Texture& texture, const std::vector<Image<Rgba8>>& mips, const TexturePlace& place, const Decoded& decode)
{
    if (texture.image.empty()) return Vec4(1.0f);
    const float level = textureLevel(texture.image, place, mips.size() + 1);
    const auto at = [&](std::size_t i) {
        return sampleLevel(texture, i == 0 ? texture.image : mips[i - 1], texture.nearest && !(level > 0.0f), place.uv, decode);
    };
    const auto lower = static_cast<std::size_t>(level);
    const float fraction = level - static_cast<float>(lower);
    const Vec4 fine = at(lower);
    return fraction > 0.0f ? fine + (at(lower + 1) - fine) * fraction : fine;
}

}  // namespace

float linearFromSrgb(std::uint8_t code)
{
    return static_cast<float>(kFromSrgb[code]);
}

float textureLevel(const Image<Rgba8>& base, const TexturePlace& place, std::size_t levels)
{
    const Vec2 size(float(base.width), float(base.height)), right = place.uvRight * size, down = place.uvDown * size;
    const float length2 = std::max(glm::dot(right, right), glm::dot(down, down));  // texels squared
    if (!(length2 > 1.0f) || !std::isfinite(length2)) return 0.0f;
    return std::min(0.5f * fastLog2(length2), static_cast<float>(levels - 1));
}

Vec4 sampleTexture(const Texture& texture, const TexturePlace& place)
{
    return sample(texture, texture.dataMips, place, kFromUnorm);
}

Vec4 sampleTextureSrgb(const Texture& texture, const TexturePlace& place)
{
    return sample(texture, texture.colorMips, place, kFromSrgb);
}

float sampleTextureAlpha(const Texture& texture, Vec2 uv)
{
    if (texture.image.empty()) return 1.0f;
    return alphaOf(texelsAt(texture, texture.image, texture.nearest, uv));
}

Vec4 sampleTexture(const Texture& texture, Vec2 uv)
{
    return sample(texture, {}, {.uv = uv, .uvRight = {}, .uvDown = {}}, kFromUnorm);
}

Vec4 sampleTextureSrgb(const Texture& texture, Vec2 uv)
{
    return sample(texture, {}, {.uv = uv, .uvRight = {}, .uvDown = {}}, kFromSrgb);
}

}  // namespace lrsm
