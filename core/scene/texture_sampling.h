#pragma once

#include "core/scene/scene.h"

namespace lrsm {

/// The sRGB decoding function of IEC 61966-2-1, rounded once to float.
float linearFromSrgb(std::uint8_t code);

/// Where a lookup reads: uv, and how far uv moves from pixel to pixel, right and down. No movement: the base level.
struct TexturePlace {
    Vec2 uv{0.0f};
    Vec2 uvRight{0.0f}, uvDown{0.0f};
};

/// D3D's level of detail (D3D11.3 functional specification, 7.18.11), isotropic: log2 of the longer of the two movements in texels of the base level, clamped
/// to [0, last]; 0 where they are not finite.
float textureLevel(const Image<Rgba8>& base, const TexturePlace& place, std::size_t levels);

/// Trilinear: between the two levels about `textureLevel`, each bilinear. Raw 8-bit channels / 255, by the texture's dataMips.
Vec4 sampleTexture(const Texture& texture, const TexturePlace& place);
/// The same with colours decoded from sRGB before filtering, by its colorMips.
Vec4 sampleTextureSrgb(const Texture& texture, const TexturePlace& place);

/// Bilinear (or nearest) lookup at uv with the texture's wrap modes, texel centres at +0.5. Raw 8-bit channels / 255, no sRGB decoding.
Vec4 sampleTexture(const Texture& texture, Vec2 uv);
/// The same, each texel's colour decoded from sRGB to linear before filtering (alpha is linear).
Vec4 sampleTextureSrgb(const Texture& texture, Vec2 uv);
/// The alpha of both alone.
float sampleTextureAlpha(const Texture& texture, Vec2 uv);

}  // namespace lrsm
