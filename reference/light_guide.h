#pragma once

#include "reference/light_density.h"
#include "reference/light_map.h"
#include "reference/tiles.h"
#include "reference/tracer.h"

#include <string>
#include <vector>

/// Which of the lights' rays matter to which part of the picture, as a pilot has found out.
namespace lrsm {

struct PrimaryHits;
enum class Transport;

struct TexelCount {
    std::uint32_t texel = 0, count = 0;
};

/// Counts of light found, in texels of the lights' squares: integers, a function of scene, view, size and model alone.
struct LightGuide {
    std::vector<LightMap> maps;  ///< one a light
    std::shared_ptr<const LightGrids> grids;
    TileGrid tiles;
    std::vector<std::vector<TexelCount>> seen;  ///< [tile], ascending texel: light that one reflection brings to what the tile shows
    std::vector<float> base;                    ///< weights, sum 1: `seen` of the whole picture, and a uniform part
    LightDensity further;                       ///< for vertices behind those that the eye sees; empty in the single-bounce model
    std::string sha256;                         ///< of all counts

    /// Technique b can find light here: the pilot has.
    bool useful() const { return !base.empty(); }
    /// For one tile: what it and its neighbours have seen, mixed with `base`, so that no ray of a light is left out.
    LightDensity densityFor(std::size_t tile) const;
};

/// Runs the pilot: cosine rays from a sparse grid of pixels find lit points; then pools drawn by what they have found, as in the rendering itself, find more.
/// Random numbers of its own, none of them used again: a density that a sample had helped to make would be biased for that sample.
LightGuide learnLightGuide(const EmbreeScene& embree, std::span<const LightSampler> lights, const PrimaryHits& primary, Transport transport);

}  // namespace lrsm
