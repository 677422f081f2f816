#include "apps/capture/volume_buffers.h"

#include "apps/capture/fill.h"
#include "core/base/formats.h"

namespace lrsm {
namespace {

constexpr std::size_t kVolumeChannels = 4;

}  // namespace

void addVolume(Catalogue& out, const std::string& name, int resolution, bool half, const Catalogue::Names& components, const Catalogue::Text& text,
               const Tolerance& tolerance, std::uint32_t ddsMip)
{
    const auto n = static_cast<std::size_t>(resolution);
    Buffer& buffer = out.add(name, half ? Dtype::f2 : Dtype::f4, {n, n, n}, {"z", "y", "x"}, components, text, tolerance);
    buffer.dds = DdsPlace{stemOf(name) + ".dds", ddsMip, half ? DxgiFormat::R16G16B16A16_FLOAT : DxgiFormat::R32G32B32A32_FLOAT, true};
}

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

BitGrid nothingOccupied(const Capture& capture)
{
    BitGrid none;
    none.grid = capture.grid;
    none.bricks.assign(predictBitGridBytes(none.grid.resolution) / sizeof(std::uint64_t), 0);
    return none;
}

}  // namespace lrsm
