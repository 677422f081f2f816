#pragma once

#include "core/scene/scene.h"

namespace lrsm {

/// Bilinear (or nearest) lookup at uv with the texture's wrap modes, texel centres at +0.5. Raw 8-bit channels / 255, no sRGB decoding.
Vec4 sampleTexture(const Texture& texture, Vec2 uv);
/// The same, each texel's colour decoded from sRGB to linear before filtering (alpha is linear).
Vec4 sampleTextureSrgb(const Texture& texture, Vec2 uv);

}  // namespace lrsm
