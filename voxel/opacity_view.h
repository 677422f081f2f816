#pragma once

#include "voxel/cascades.h"
#include "voxel/lookup_cells.h"
#include "voxel/opacity_pyramid.h"

#include <array>
#include <cassert>
#include <cstring>
#include <memory>

namespace lrsm {

/// Bytes of which four may be read at any place: readers stop at `last` and shift. Arrays too short for that are copied.
class ByteView {
  public:
    explicit ByteView(const std::vector<std::uint8_t>& bytes) : data_(bytes.data()), last_(0)
    {
        assert(bytes.size() <= 0xffffffffu);
        if (bytes.size() >= kLeast) {
            last_ = static_cast<std::uint32_t>(bytes.size() - 4);
            return;
        }
        if (!bytes.empty()) std::memcpy(short_.data(), bytes.data(), bytes.size());
        data_ = short_.data();
        last_ = static_cast<std::uint32_t>(short_.size() - 4);
    }
    ByteView(const ByteView&) = delete;
    ByteView& operator=(const ByteView&) = delete;

    const std::uint8_t* data() const { return data_; }
    std::uint32_t last() const { return last_; }  ///< the last offset at which four bytes may be read

  private:
    static constexpr std::size_t kLeast = 16;
    const std::uint8_t* data_;
    std::uint32_t last_;
    std::array<std::uint8_t, kLeast + 4> short_{};
};

/// A pyramid as the wide lookups read it (voxel/sample_opacity_lanes.inc): made once a frame.
struct OpacityView {
    const OpacityPyramid& pyramid;
    FilterFraction fraction;
    ByteView unorm8;
    LookupCells cells;
    const std::int32_t* bits;  ///< two words a brick, the lower half of z first
    int resolution, brickEdge, topLevel;
    VoxelBox outermost;                          ///< of all cascades
    std::unique_ptr<const OpacityView> coarser;  ///< the next cascade, or none

    OpacityView(const OpacityPyramid& source, FilterFraction filterFraction)
        : pyramid(source),
          fraction(filterFraction),
          unorm8(source.unorm8),
          cells(source),
          bits(reinterpret_cast<const std::int32_t*>(source.base.bricks.data())),
          resolution(source.base.grid.resolution),
          brickEdge(BitGrid::bricksPerEdge(resolution)),
          topLevel(source.levels() - 1),
          outermost(outermostBox(source)),
          coarser(nextCascade(source) ? std::make_unique<const OpacityView>(*nextCascade(source), filterFraction) : nullptr)
    {
    }
};

}  // namespace lrsm
