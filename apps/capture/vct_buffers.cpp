#include "apps/capture/vct_buffers.h"

#include "apps/capture/fill.h"
#include "apps/capture/tolerances.h"
#include "core/base/formats.h"
#include "core/base/parallel.h"

#include <algorithm>

namespace lrsm {

namespace {

using Names = Catalogue::Names;

constexpr std::size_t kVolumeChannels = 4;
constexpr const char *kGridSpace = "grid", *kBase = "vct.base", *kNormal = "vct.normal";
/// In the order of RadianceVolume::faces.
constexpr std::array<const char*, kTravelDirections> kFaces = {"vct.px", "vct.nx", "vct.py", "vct.ny", "vct.pz", "vct.nz"};

std::size_t cubed(int n)
{
    return std::size_t(n) * std::size_t(n) * std::size_t(n);
}

/// Of a texel in the dense grid of edge n.
std::size_t denseIndex(const IVec3& at, int n)
{
    return (std::size_t(at.z) * std::size_t(n) + std::size_t(at.y)) * std::size_t(n) + std::size_t(at.x);
}

void addVolume(Catalogue& out, const std::string& name, int resolution, const VctSettings& settings, const Names& components, const Catalogue::Text& text,
               const Tolerance& tolerance, std::uint32_t ddsMip)
{
    const bool half = settings.storage == Storage::gpu;
    const auto n = static_cast<std::size_t>(resolution);
    Buffer& buffer = out.add(name, half ? Dtype::f2 : Dtype::f4, {n, n, n}, {"z", "y", "x"}, components, text, tolerance);
    buffer.dds = DdsPlace{stemOf(name) + ".dds", ddsMip, half ? DxgiFormat::R16G16B16A16_FLOAT : DxgiFormat::R32G32B32A32_FLOAT, true};
}

/// Texels of the held bricks into the dense grid; all else is 0. The values are representable, so rounding modes do not matter.
void toDense(const BrickMap& map, const std::vector<Vec4>& texels, Buffer& buffer)
{
    const auto each = [&]<class T>(T* to, auto&& convert) {
        forTexels(map, [&](const IVec3& texel, std::size_t at, std::size_t) {
            T* out = to + denseIndex(texel, map.resolution) * kVolumeChannels;
            for (int c = 0; c < int(kVolumeChannels); ++c) out[c] = convert(texels[at][c]);
        });
    };
    if (buffer.dtype == Dtype::f4)
        each(allocate<float>(buffer), [](float v) { return v; });
    else
        each(allocate<std::uint16_t>(buffer), [](float v) { return halfFromFloat(v, HalfRounding::nearestEven); });
}

/// Marks the first voxel of every texel that is not 0 and lies in no brick that `held` has.
void markTexels(const std::vector<Vec4>& texels, int level, const BrickMap* held, BitGrid& occupied)
{
    const int n = occupied.grid.resolution >> level;
    std::size_t i = 0;
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x, ++i) {
                if (texels[i] == Vec4(0.0f) || (held && held->bricks[held->brickIndex(x, y, z)] != 0)) continue;
                const IVec3 v(x << level, y << level, z << level);
                occupied.bricks[occupied.brickIndex(v.x, v.y, v.z)] |= std::uint64_t(1) << BitGrid::bitIndex(v.x, v.y, v.z);
            }
}

std::vector<Vec4> toBricks(const BrickMap& map, const std::vector<Vec4>& dense)
{
    std::vector<Vec4> texels(map.texelCount(), Vec4(0.0f));
    forTexels(map, [&](const IVec3& texel, std::size_t at, std::size_t) { texels[at] = dense[denseIndex(texel, map.resolution)]; });
    return texels;
}

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
    const VctSettings& vct = frame.settings.vct;
    addVolume(out, kBase, n, vct, {"r", "g", "b", "occlusion"},
              {"radiance times pre_exposure that the voxel sends out, and its bit", kGridSpace, kRadianceUnit}, tolerances::kInjected, 0);
    addVolume(out, kNormal, n, vct, {"x", "y", "z", ""}, {"mean normal of what emits, shorter than 1 where normals differ", "world", ""},
              tolerances::kInjectedNormal, 0);
}

void describeVctMips(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const VctSettings& vct = frame.settings.vct;
    for (std::size_t d = 0; d < kFaces.size(); ++d)
        for (int level = 1; frame.settings.voxel.resolution >> level >= 1; ++level)
            addVolume(out, mipName(kFaces[d], level), frame.settings.voxel.resolution >> level, vct, {"r", "g", "b", "opacity"},
                      {std::string("premultiplied radiance times pre_exposure, and opacity, seen travelling along ") + (d & 1 ? "-" : "+") + "xyz"[d / 2],
                       kGridSpace, kRadianceUnit},
                      tolerances::layerHalf(vct.storage == Storage::gpu), static_cast<std::uint32_t>(level - 1));
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
    BitGrid occupied;
    occupied.grid = capture.grid;
    occupied.bricks.assign(predictBitGridBytes(n) / sizeof(std::uint64_t), 0);
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
