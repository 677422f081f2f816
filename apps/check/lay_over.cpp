#include "apps/capture/fill.h"
#include "apps/check/candidate.h"
#include "apps/check/compare.h"

namespace lrsm {

namespace {

/// Bits of one packing into the other.
void repack(const Buffer& from, Buffer& to)
{
    to.bytes.assign(to.elements() * sizeOf(to.dtype), std::byte{0});
    const std::vector<std::size_t> extents = extentsOf(to);
    for (std::size_t bit = 0; bit < valueCount(from); ++bit) {
        if (decodedValue(from, bit) == 0.0) continue;
        const std::vector<std::size_t> at = indicesOf(from, bit);
        if (at[0] >= extents[0] || at[1] >= extents[1] || at[2] >= extents[2]) continue;
        const std::size_t target = elementAt(to, at);
        to.bytes[target / 8] |= std::byte(1u << (target & 7));
    }
}

}  // namespace

Capture layOver(const Capture& golden, const Candidate& candidate)
{
    Capture mixed = golden;
    for (const CandidateBuffer& from : candidate.buffers) findBuffer(mixed.buffers, from.buffer.name)->bytes = from.buffer.bytes;
    Buffer* rows = findBuffer(mixed.buffers, "voxel.bits");
    Buffer* bricks = findBuffer(mixed.buffers, "voxel.bricks");
    if (rows && bricks) {
        if (candidate.find("voxel.bits"))
            repack(*rows, *bricks);
        else if (candidate.find("voxel.bricks"))
            repack(*bricks, *rows);
    }
    return mixed;
}

}  // namespace lrsm
