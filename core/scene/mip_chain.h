#pragma once

#include "core/scene/scene.h"

namespace lrsm {

enum class TexelMeaning { color, data };  ///< sRGB, averaged in linear light; or numbers, averaged as they are (normal, roughness, and any alpha)

/// The next level: half the texels along each edge, rounded down, 1 at least. A texel is the mean of what it covers of the level below, by area (odd edges
/// have thirds, not a dropped row), rounded to 8 bits once; a colour's to the sRGB code nearest in linear light. Alpha is averaged by itself, as GPUs do.
/// Normal maps become shorter where they vary; the lookup makes them unit again.
Image<Rgba8> halveTexture(const Image<Rgba8>& level, TexelMeaning meaning);

/// Chains of all textures, as the materials use them. Parallel; the same bits everywhere.
void buildMipChains(const std::vector<std::shared_ptr<Texture>>& textures, const std::vector<Material>& materials);

}  // namespace lrsm
