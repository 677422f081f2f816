#include "core/scene/mip_chain.h"

#include "core/base/parallel.h"
#include "core/scene/texture_sampling.h"

#include <algorithm>

namespace lrsm {
namespace {

/// Texels along one edge that one texel of the next level covers, and their shares.
struct Cover {
    int first = 0, count = 0;
    std::array<double, 3> share{};
};

/// Level of `size` to one of `half` = max(1, size / 2): two texels each, or parts of three where the size is odd.
std::vector<Cover> coversOf(int size, int half)
{
    std::vector<Cover> covers(static_cast<std::size_t>(half));
    for (int i = 0; i < half; ++i) {
        // In units of 1 / half texel, where all bounds are whole.
        const int begin = i * size, end = begin + size;
        Cover& cover = covers[static_cast<std::size_t>(i)];
        cover.first = begin / half;
        for (int texel = cover.first; texel * half < end; ++texel)
            cover.share[static_cast<std::size_t>(cover.count++)] = double(std::min(end, (texel + 1) * half) - std::max(begin, texel * half)) / double(size);
    }
    return covers;
}

/// The code whose linear value is nearest: codes by the middles between neighbours.
class SrgbEncoder {
  public:
    SrgbEncoder()
    {
        for (std::size_t code = 0; code < 255; ++code)
            middles_[code] = 0.5 * (double(linearFromSrgb(std::uint8_t(code))) + double(linearFromSrgb(std::uint8_t(code + 1))));
        std::size_t code = 0;
        for (std::size_t i = 0; i < kStarts; ++i) {
            while (code < 255 && middles_[code] <= double(i) / kStarts) ++code;
            starts_[i] = std::uint8_t(code);
        }
    }
    std::uint8_t operator()(double linear) const
    {
        std::size_t code = starts_[std::min(kStarts - 1, static_cast<std::size_t>(linear * kStarts))];
        while (code < 255 && middles_[code] <= linear) ++code;
        return std::uint8_t(code);
    }

  private:
    static constexpr std::size_t kStarts = 4096;
    std::array<double, 255> middles_{};
    std::array<std::uint8_t, kStarts> starts_{};
};

std::uint8_t rounded(double code)
{
    return static_cast<std::uint8_t>(code + 0.5);
}

std::vector<Image<Rgba8>> chainOf(const Image<Rgba8>& base, TexelMeaning meaning)
{
    std::vector<Image<Rgba8>> chain;
    const auto last = [&]() -> const Image<Rgba8>& { return chain.empty() ? base : chain.back(); };
    while (last().width > 1 || last().height > 1) {
        Image<Rgba8> next = halveTexture(last(), meaning);
        chain.push_back(std::move(next));
    }
    return chain;
}

}  // namespace

Image<Rgba8> halveTexture(const Image<Rgba8>& level, TexelMeaning meaning)
{
    static const SrgbEncoder encode;
    const int width = std::max(1, level.width / 2), height = std::max(1, level.height / 2);
    const std::vector<Cover> columns = coversOf(level.width, width), rows = coversOf(level.height, height);
    const bool color = meaning == TexelMeaning::color;

    Image<Rgba8> next(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Cover &across = columns[static_cast<std::size_t>(x)], &down = rows[static_cast<std::size_t>(y)];
            double r = 0.0, g = 0.0, b = 0.0, a = 0.0;
            for (int j = 0; j < down.count; ++j)
                for (int i = 0; i < across.count; ++i) {
                    const Rgba8 texel = level.at(across.first + i, down.first + j);
                    const double share = across.share[static_cast<std::size_t>(i)] * down.share[static_cast<std::size_t>(j)];
                    const auto value = [&](std::uint8_t code) { return color ? double(linearFromSrgb(code)) : double(code); };
                    r += share * value(texel.r);
                    g += share * value(texel.g);
                    b += share * value(texel.b);
                    a += share * double(texel.a);
                }
            const auto code = [&](double value) { return color ? encode(value) : rounded(value); };
            next.at(x, y) = {code(r), code(g), code(b), rounded(a)};
        }
    return next;
}

void buildMipChains(const std::vector<std::shared_ptr<Texture>>& textures, const std::vector<Material>& materials)
{
    std::vector<std::pair<std::size_t, TexelMeaning>> wanted;
    const auto want = [&](const TextureUse& use, TexelMeaning meaning) {
        if (use) wanted.push_back({std::size_t(use.texture), meaning});
    };
    for (const Material& material : materials) {
        want(material.baseColorTexture, TexelMeaning::color);
        want(material.metallicRoughnessTexture, TexelMeaning::data);
        want(material.normalTexture, TexelMeaning::data);
    }
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    parallelFor(wanted.size(), 1, [&](std::size_t i, std::size_t) {
        Texture& texture = *textures[wanted[i].first];
        (wanted[i].second == TexelMeaning::color ? texture.colorMips : texture.dataMips) = chainOf(texture.image, wanted[i].second);
    });
}

}  // namespace lrsm
