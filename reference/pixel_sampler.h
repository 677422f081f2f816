#pragma once

#include "reference/path_trace.h"
#include "reference/purposes.h"
#include "reference/sample_layout.h"

/// One sample of one pixel: every layer's value, drawn by both techniques (light_pool.h).
namespace lrsm {

using Sample = std::array<float, kConeChannels>;

/// One block of one picture: what numbers its random draws.
struct BlockKey {
    std::uint64_t block = 0;
    int blockBits = 0;
    std::array<std::uint32_t, 2> key{};

    /// Points of a pixel or a tile, 2^(blockBits + moreBits) of them.
    SobolBlock points(std::uint32_t index, Purpose purpose, int moreBits = 0) const
    {
        return {philox({index, std::uint32_t(block), std::uint32_t(block >> 32), std::uint32_t(purpose)}, key), blockBits + moreBits};
    }
    PathRandom path(std::uint32_t pixel, Purpose purpose, std::uint32_t index) const
    {
        // The low 24 bits of the last word count the path's vertices.
        return {{pixel, std::uint32_t(block << blockBits) | index, std::uint32_t(block >> (32 - blockBits)), std::uint32_t(purpose) << 24}, key};
    }
};

/// What the pixels of a tile share while they draw one group of samples. Pools are fresh in every group: block means stay independent. Within a block, the
/// errors of a tile's pixels are not.
struct GroupPools {
    LightPool diffuse, lobe, furtherDiffuse, furtherLobe;
};

/// Draws the samples of a tile in one block.
class TileSampler {
  public:
    TileSampler(const PathTracer& tracer, std::size_t tile, const BlockKey& key);

    /// visit(pixel, its number in the tile, Sample) for every pixel that sees something and samples [first, last) of the block.
    template <class Visit>
    void drawSamples(Tracer& tracer, std::uint32_t first, std::uint32_t last, const Visit& visit)
    {
        const std::uint32_t size = 1u << groupBits_;
        for (std::uint32_t begin = first; begin < last; begin = (begin / size + 1) * size) {
            const std::uint32_t end = std::min(last, (begin / size + 1) * size);
            const GroupPools pools = drawPools(tracer, begin);
            forEachPixel(tracer_.guide().tiles, tile_, [&](std::size_t pixel, std::size_t number) {
                if (!tracer_.primary().covered.texels[pixel]) return;
                beginPixel(tracer, pools, pixel, begin, end);
                for (std::uint32_t index = begin; index < end; ++index) visit(pixel, number, sample(tracer, index));
            });
        }
    }

  private:
    /// A point of a pool on the way to a sample.
    struct Connection {
        std::size_t index = 0;
        Vec3 direction{0.0f};
        Vec3 factor{0.0f};  ///< of the radiance that comes from there
    };
    /// One layer's way to draw directions and from a pool: for all of a group's samples at once, so that the arithmetic of one need not wait for that of
    /// another.
    struct Draws {
        std::vector<Vec3> directions;  ///< one a sample
        const LightPool* pool = nullptr;
        PoolWeights weights;
        std::vector<Connection> connections;  ///< 2^kDrawBits a sample; empty: no light comes from the pool
        PathLight light;
    };

    /// The pools of the group that sample `first` is of. Their rays are counted with the group's first sample alone: ranges that cut a group count them once.
    GroupPools drawPools(Tracer& tracer, std::uint32_t first) const;
    /// For samples [begin, end), which are of one group.
    void beginPixel(Tracer& tracer, const GroupPools& pools, std::size_t pixel, std::uint32_t begin, std::uint32_t end);
    /// \param direct  UnitPoint to Vec3
    template <class Direct>
    void aim(Draws& draws, Purpose purpose, std::uint32_t begin, std::uint32_t end, const Direct& direct) const;
    template <class Respond>
    void connect(Draws& draws, Purpose purpose, std::uint32_t begin, std::uint32_t end, const Respond& respond) const;
    Sample sample(Tracer& tracer, std::uint32_t index);
    Vec3 traced(Tracer& tracer, const Vec3& direction, const Response& response, const PathLight& light, Purpose purpose, std::uint32_t index, bool& hit) const;
    Vec3 connected(Tracer& tracer, const Draws& draws, std::uint32_t index) const;

    const PathTracer& tracer_;
    const ReferenceSettings& settings_;
    std::size_t tile_;
    BlockKey key_;
    int channels_, groupBits_;
    bool specular_ = false;
    float cosHalf_;
    TileGuide guide_;

    // Of the pixel at hand
    std::uint32_t pixel_ = 0, begin_ = 0;
    const Surface* surface_ = nullptr;
    Vec3 toEye_{0.0f};
    LightReceiver receiver_;
    Draws diffuse_, lobe_, cone_;
    PoolWeights scratch_;
};

}  // namespace lrsm
