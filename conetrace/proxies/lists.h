#pragma once

#include "conetrace/frame/blocks.h"
#include "core/base/arrays.h"
#include "core/base/counters.h"
#include "core/base/image.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

/// Which cells the marched pixels see: V_p of [P] Sec. 3.1.
namespace lrsm {

/// One pixel in the middle of each block has a list, row by row; hashes of cells, rising, none twice.
struct VisibilityLists {
    int divisor = 1;                   ///< edge of a block, pixels
    std::vector<std::uint32_t> first;  ///< list of block b: cells[first[b]] .. cells[first[b + 1] - 1]
    std::vector<std::uint32_t> cells;
    std::vector<std::uint32_t> hits;  ///< of each of `cells`: how many of the list's diffuse shadow rays met it
    std::vector<float> opacity;       ///< of each block's pixel: part of its diffuse shadow rays that met a disc
    std::vector<float> lobeOpacity;   ///< the same of its rays in the specular lobe; 1 where it has none
    std::vector<std::uint32_t> rays;  ///< diffuse shadow rays that a block's list is of; of a filtered one those of all lists joined
    /// With pp_cell_weight=seen, for each slot of ProxyCells::numbers: how many of all marched pixels' shadow rays met that proxy first. Of filtered lists
    /// none.
    std::vector<std::uint32_t> proxyHits;

    /// The part of block b's diffuse rays that met the cell of an entry of its list.
    float share(std::size_t block, std::size_t entry) const { return rays[block] > 0 ? float(hits[entry]) / float(rays[block]) : 0.0f; }
    std::span<const std::uint32_t> of(std::size_t block) const { return std::span(cells).subspan(first[block], first[block + 1] - first[block]); }
    std::size_t size() const { return opacity.size(); }
};

template <class Visit>
void forEachArray(const VisibilityLists& lists, Visit&& visit)
{
    const auto visitAll = [&](const auto& array) { visit(array, ArrayTraits{array.size() * sizeof(array[0])}); };
    visitAll(lists.first);
    visitAll(lists.cells);
    visitAll(lists.hits);
    visitAll(lists.opacity);
    visitAll(lists.lobeOpacity);
    visitAll(lists.rays);
    visitAll(lists.proxyHits);
}

inline Counters countersOf(const VisibilityLists& lists)
{
    return {{"marched_pixels", double(lists.size())}, {"listed_cells", double(lists.cells.size())}};
}

/// A set of cells and how many rays met each, filled and emptied again and again; comes out in order.
class CellSet {
  public:
    explicit CellSet(std::size_t cells) : words_((cells + 63) / 64), groups_((words_.size() + 63) / 64), hits_(cells, 0) {}
    void add(std::uint32_t cell, std::uint32_t hits)
    {
        hits_[cell] += hits;
        words_[cell / 64] |= bit(cell);
        groups_[cell / 64 / 64] |= bit(cell / 64);
    }
    /// Appends the cells, rising, and their hits, and is empty then.
    void moveTo(VisibilityLists& out)
    {
        for (std::size_t g = 0; g < groups_.size(); ++g)
            for (std::uint64_t group = std::exchange(groups_[g], 0u); group != 0; group &= group - 1) {
                const std::size_t index = g * 64 + std::size_t(std::countr_zero(group));
                for (std::uint64_t word = std::exchange(words_[index], 0u); word != 0; word &= word - 1) {
                    const std::size_t cell = index * 64 + std::size_t(std::countr_zero(word));
                    out.cells.push_back(static_cast<std::uint32_t>(cell));
                    out.hits.push_back(std::exchange(hits_[cell], 0u));
                }
            }
    }

  private:
    static std::uint64_t bit(std::uint32_t place) { return std::uint64_t(1) << (place % 64); }

    std::vector<std::uint64_t> words_, groups_;  ///< bits of cells; of words that are not 0
    std::vector<std::uint32_t> hits_;            ///< by cell
};

/// Lists of each row of blocks, made apart, one after the other.
VisibilityLists joinRows(const std::vector<VisibilityLists>& rows, int divisor);

}  // namespace lrsm
