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

struct TexelCount {
    std::uint32_t texel = 0;
    std::uint32_t light = 0;               ///< that has been found there, in shares of a mean ray
    std::uint32_t tried = 0, reached = 0;  ///< points there that were looked at, and that could be seen
};

/// What a tile draws its pools by.
struct TileGuide {
    LightDensity density;      ///< q; empty: the tile has no technique b
    std::vector<float> reach;  ///< [texel]: how likely a point there is to be seen, > 0
};

/// Counts of all texels.
struct SpreadCounts {
    explicit SpreadCounts(const LightGrids& grids);
    void add(const TexelCount& count, std::uint32_t weight);
    /// Spreads what has been added over each texel's neighbours, by a tent of 3 x 3.
    void spread();
    std::uint64_t totalLight() const;

    std::size_t side;
    std::vector<std::uint32_t> light, tried, reached;  ///< [texel], as in TexelCount
};

/// Counts of light found, in texels of the lights' squares: integers, a function of scene, view, size and model alone.
struct LightGuide {
    std::vector<LightMap> maps;  ///< one a light
    std::shared_ptr<const LightGrids> grids;
    TileGrid tiles;
    std::vector<std::vector<TexelCount>> seen;  ///< [tile], ascending texel: light that one reflection brings to what the tile shows
    std::vector<std::uint8_t> even;             ///< [tile]: 1 where all rays find the same light, and technique b would but add noise
    std::vector<float> base;                    ///< weights, sum 1: `seen` of the whole picture, and a uniform part
    TileGuide further;                          ///< for vertices behind those that the eye sees; empty in the single-bounce model
    std::string sha256;                         ///< of all counts

    /// Technique b can find light here: the pilot has.
    bool useful() const { return !base.empty(); }
    /// For one tile: what it and its neighbours have seen, mixed with `base`, so that no ray of a light is left out.
    TileGuide guideFor(std::size_t tile) const;
};

/// Runs the pilot: cosine rays from a sparse grid of pixels find lit points; then pools drawn by what they have found, as in the rendering itself, find more.
/// Random numbers of its own, none of them used again: a density that a sample had helped to make would be biased for that sample.
LightGuide learnLightGuide(const EmbreeScene& embree, std::span<const LightSampler> lights, const PrimaryHits& primary, Transport transport);

}  // namespace lrsm
