#include "apps/capture/vct_buffers.h"

#include "apps/capture/fill.h"
#include "apps/capture/tolerances.h"
#include "apps/capture/volume_buffers.h"

#include <algorithm>

namespace lrsm {

namespace {

using Names = Catalogue::Names;

constexpr const char *kBase = "vct.base", *kNormal = "vct.normal";
/// In the order of RadianceVolume::faces.
constexpr std::array<const char*, kTravelDirections> kFaces = {"vct.px", "vct.nx", "vct.py", "vct.ny", "vct.pz", "vct.nz"};

/// visit(place in the dense grid, place in the surfels) of every occupied voxel.
template <class Visit>
void forSurfels(const BitGrid& bits, const VoxelIndex& index, const Visit& visit)
{
    for (std::size_t brick = 0; brick < bits.bricks.size(); ++brick)
        forEachBit(bits.bricks[brick], [&](int bit) { visit(denseIndex(voxelOf(bits, brick, bit), bits.grid.resolution), index.at(bits, brick, bit)); });
}

}  // namespace

void describeVctSurface(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const auto n = static_cast<std::size_t>(frame.settings.voxel.resolution);
    const auto volume = [&](const std::string& name, const Names& components, const Catalogue::Text& text) {
        out.add("vct.surface." + name, Dtype::f4, {n, n, n}, {"z", "y", "x"}, components, text, tolerances::kVoxelSurface);
    };
    volume("albedo", {"r", "g", "b"}, {"mean over the voxel's fragments; 0 where no voxel is occupied, as all below", "linear", ""});
    volume("normal", {"x", "y", "z"}, {"mean of the outward normals, shorter than 1 where they differ", "world", ""});
    volume("position", {"x", "y", "z"}, {"mean of the fragments' points, from the voxel's corner", kGridSpace, "voxels"});
    volume("area", {}, {"of all surfaces within the voxel", kGridSpace, "faces of a voxel"});
}

void describeVctBase(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const int n = frame.settings.voxel.resolution;
    const bool half = frame.settings.vct.storage == Storage::gpu;
    addVolume(out, kBase, n, half, {"r", "g", "b", "occlusion"},
              {"radiance times pre_exposure that the voxel sends out, and its bit", kGridSpace, kRadianceUnit}, tolerances::kInjected, 0);
    addVolume(out, kNormal, n, half, {"x", "y", "z", ""}, {"mean normal of what emits, shorter than 1 where normals differ", "world", ""},
              tolerances::kInjectedNormal, 0);
}

void describeVctMips(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const bool half = frame.settings.vct.storage == Storage::gpu;
    for (std::size_t d = 0; d < kFaces.size(); ++d)
        for (int level = 1; frame.settings.voxel.resolution >> level >= 1; ++level)
            addVolume(out, mipName(kFaces[d], level), frame.settings.voxel.resolution >> level, half, {"r", "g", "b", "opacity"},
                      {std::string("premultiplied radiance times pre_exposure, and opacity, seen travelling along ") + (d & 1 ? "-" : "+") + "xyz"[d / 2],
                       kGridSpace, kRadianceUnit},
                      tolerances::layerHalf(half), static_cast<std::uint32_t>(level - 1));
}

void toBuffers(const PlacedSurface& placed, std::vector<Buffer>& buffers)
{
    const auto fill = [&](const std::string& name, std::size_t channels, auto&& part) {
        Buffer* buffer = findBuffer(buffers, "vct.surface." + name);
        if (!buffer) return;
        auto* to = allocate<float>(*buffer);
        forSurfels(placed.bits, placed.surface.index, [&](std::size_t dense, std::uint32_t i) {
            const float* from = part(placed.surface.surfels[i]);
            std::copy_n(from, channels, to + dense * channels);
        });
    };
    fill("albedo", 3, [](const VoxelSurfel& s) { return &s.albedo.x; });
    fill("normal", 3, [](const VoxelSurfel& s) { return &s.normal.x; });
    fill("position", 3, [](const VoxelSurfel& s) { return &s.position.x; });
    fill("area", 1, [](const VoxelSurfel& s) { return &s.area; });
}

void baseToBuffers(const RadianceVolume& volume, std::vector<Buffer>& buffers)
{
    if (Buffer* buffer = findBuffer(buffers, kBase)) toDense(volume.maps.front(), volume.base, *buffer);
    if (Buffer* buffer = findBuffer(buffers, kNormal)) toDense(volume.maps.front(), volume.normals, *buffer);
}

void mipsToBuffers(const RadianceVolume& volume, std::vector<Buffer>& buffers)
{
    for (std::size_t level = 1; level < volume.faces.size(); ++level)
        for (std::size_t d = 0; d < kFaces.size(); ++d)
            if (Buffer* buffer = findBuffer(buffers, mipName(kFaces[d], static_cast<int>(level)))) toDense(volume.maps[level], volume.faces[level][d], *buffer);
}

VoxelSurface surfaceFromCapture(const Capture& capture, const BitGrid& bits)
{
    VoxelSurface surface;
    surface.resolution = bits.grid.resolution;
    surface.index = indexVoxels(bits);
    surface.surfels.resize(surface.index.count());
    const std::size_t count = cubed(bits.grid.resolution);
    const auto take = [&](const std::string& name, std::size_t channels, auto&& part) {
        const auto from = valuesOf<float>(capture, "vct.surface." + name, Dtype::f4, count * channels);
        forSurfels(bits, surface.index,
                   [&](std::size_t dense, std::uint32_t i) { std::copy_n(from.data() + dense * channels, channels, part(surface.surfels[i])); });
    };
    take("albedo", 3, [](VoxelSurfel& s) { return &s.albedo.x; });
    take("normal", 3, [](VoxelSurfel& s) { return &s.normal.x; });
    take("position", 3, [](VoxelSurfel& s) { return &s.position.x; });
    take("area", 1, [](VoxelSurfel& s) { return &s.area; });
    return surface;
}

RadianceVolume radianceFromCapture(const Capture& capture)
{
    const int n = capture.grid.resolution;
    const std::vector<Vec4> base = texelsOf(capture, kBase, cubed(n)), normals = texelsOf(capture, kNormal, cubed(n));
    BitGrid occupied = nothingOccupied(capture);
    markTexels(base, 0, nullptr, occupied);
    markTexels(normals, 0, nullptr, occupied);

    RadianceVolume volume;
    volume.preExposure = capture.preExposure;
    volume.maps = mapBricks(occupied);
    std::vector<std::array<std::vector<Vec4>, kTravelDirections>> faces(volume.maps.size());
    const std::vector<std::uint64_t> before = occupied.bricks;
    for (int level = 1; level < volume.levels(); ++level)
        for (std::size_t d = 0; d < kFaces.size(); ++d) {
            std::vector<Vec4>& face = faces[std::size_t(level)][d];
            face = texelsOf(capture, mipName(kFaces[d], level), cubed(n >> level));
            markTexels(face, level, &volume.maps[std::size_t(level)], occupied);
        }
    if (occupied.bricks != before) volume.maps = mapBricks(occupied);  // mips say that something is where the base says nothing is
    volume.base = toBricks(volume.maps.front(), base);
    volume.normals = toBricks(volume.maps.front(), normals);
    volume.faces.assign(volume.maps.size(), {});
    for (std::size_t level = 1; level < faces.size(); ++level)
        for (std::size_t d = 0; d < kFaces.size(); ++d) volume.faces[level][d] = toBricks(volume.maps[level], faces[level][d]);
    return volume;
}

}  // namespace lrsm
