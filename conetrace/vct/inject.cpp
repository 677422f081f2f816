#include "conetrace/vct/inject.h"

#include "conetrace/vct/light_surfels.h"
#include "core/base/parallel.h"
#include "core/scene/exposure.h"
#include "lrsm/texel_area.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lrsm {
namespace {

constexpr std::size_t kGrain = 8192;
constexpr std::uint32_t kNowhere = ~std::uint32_t(0);

struct Placement {
    std::uint64_t texels = 0, moved = 0, lost = 0;
    Placement& operator+=(const Placement& other)
    {
        texels += other.texels;
        moved += other.moved;
        lost += other.lost;
        return *this;
    }
};

/// The occupied voxel that a place belongs to: its own, or the nearest about it.
std::uint32_t voxelAt(const BitGrid& bits, const VoxelIndex& index, const Vec3& pVoxels, Placement& counts)
{
    const IVec3 own(glm::floor(pVoxels));
    if (bits.occupied(own.x, own.y, own.z)) return index.at(bits, own);
    float nearest = kInfinity;
    IVec3 found(0);
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                const IVec3 voxel = own + IVec3(x, y, z);
                const Vec3 d = Vec3(voxel) + 0.5f - pVoxels;
                if (!bits.occupied(voxel.x, voxel.y, voxel.z) || !(glm::dot(d, d) < nearest)) continue;
                nearest = glm::dot(d, d);
                found = voxel;
            }
    if (nearest == kInfinity) {
        ++counts.lost;
        return kNowhere;
    }
    ++counts.moved;
    return index.at(bits, found);
}

/// Of each texel of the map the number of its voxel.
std::vector<std::uint32_t> placeTexels(const Rsm& rsm, const BitGrid& bits, const VoxelIndex& index, Placement& counts)
{
    std::vector<std::uint32_t> voxels(rsm.texels.texels.size(), kNowhere);
    std::vector<Placement> partial(voxels.size() / kGrain + 1);
    parallelFor(voxels.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        Placement& own = partial[begin / kGrain];
        for (std::size_t i = begin; i < end; ++i) {
            if (rsm.texels.texels[i].coverage == 0.0f) continue;
            ++own.texels;
            voxels[i] = voxelAt(bits, index, bits.grid.voxelsFromWorld(texelPosition(rsm, i)), own);
        }
    });
    for (const Placement& p : partial) counts += p;
    return voxels;
}

/// The texels of each voxel, in the map's order: those of voxel i stand from first[i] to first[i + 1].
struct TexelLists {
    std::vector<std::uint32_t> first, texels;
};
TexelLists listTexels(const std::vector<std::uint32_t>& voxels, std::uint32_t count)
{
    TexelLists lists;
    lists.first.assign(std::size_t(count) + 1, 0);
    for (const std::uint32_t voxel : voxels)
        if (voxel != kNowhere) ++lists.first[std::size_t(voxel) + 1];
    for (std::size_t i = 1; i < lists.first.size(); ++i) lists.first[i] += lists.first[i - 1];
    lists.texels.resize(lists.first.back());
    std::vector<std::uint32_t> next = lists.first;
    for (std::size_t i = 0; i < voxels.size(); ++i)
        if (voxels[i] != kNowhere) lists.texels[next[voxels[i]]++] = std::uint32_t(i);
    return lists;
}

void injectMap(const Rsm& rsm, const BitGrid& bits, const VoxelIndex& index, const VoxelSurface* area, std::vector<VoxelLight>& lights, Placement& counts)
{
    const TexelLists lists = listTexels(placeTexels(rsm, bits, index, counts), index.count());
    const double voxelFace = double(bits.grid.voxelSize) * double(bits.grid.voxelSize);
    parallelFor(lights.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t voxel = begin; voxel < end; ++voxel) {
            const std::uint32_t from = lists.first[voxel], to = lists.first[voxel + 1];
            if (from == to) continue;
            glm::dvec3 radiance(0.0), normal(0.0);
            double covered = 0.0;
            for (std::uint32_t i = from; i < to; ++i) {
                const RsmTexel& texel = rsm.texels.texels[lists.texels[i]];
                radiance += glm::dvec3(texel.radiance);
                normal += glm::dvec3(texel.normal);
                if (area) covered += double(texelArea(rsm, lists.texels[i]));
            }
            double scale = 1.0 / double(to - from);
            normal *= scale;
            if (area) {
                const double surface = double(area->surfels[voxel].area) * voxelFace;
                if (surface > covered) scale *= covered / surface;
            }
            lights[voxel].add(Vec3(radiance * scale), Vec3(normal));
        }
    });
}

/// Into the texels of level 0.
void store(const std::vector<VoxelLight>& lights, const BitGrid& bits, const VoxelIndex& index, const VctSettings& settings, RadianceVolume& volume)
{
    const BrickMap& map = volume.maps.front();
    for (std::size_t place = 1; place < map.coordinate.size(); ++place) {
        const std::size_t brick = map.coordinate[place];
        forEachBit(bits.bricks[brick], [&](int bit) {
            const VoxelLight& light = lights[index.at(bits, brick, bit)];
            const std::size_t at = place * BrickMap::kTexels + std::size_t(bit);
            volume.base[at] = storedTexel(Vec4(light.radiance, 1.0f), settings, volume.conversions);
            if (light.luminance > 0.0f) volume.normals[at] = storedTexel(Vec4(light.normal / light.luminance, 0.0f), settings, volume.conversions);
        });
    }
}

}  // namespace

RadianceVolume injectRadiance(const GatherInput& input, const VoxelSurface* surface)
{
    const VctSettings& settings = input.settings.vct;
    assert(surface || !readsSurface(settings));
    const BitGrid& bits = input.opacity.base;
    RadianceVolume volume = darkVolume(bits);
    volume.preExposure = preExposureOf(input.scene);
    const VoxelIndex own = surface ? VoxelIndex{} : indexVoxels(bits);
    const VoxelIndex& index = surface ? surface->index : own;

    std::vector<VoxelLight> lights(index.count());
    if (settings.injection == Injection::voxel) {
        std::vector<DepthMapView> depths;
        for (const Rsm& rsm : input.rsms) depths.emplace_back(rsm);
        lightSurfels(input, *surface, volume.preExposure, lights, [&](std::size_t light, const ShadowReceiver& receiver, const LightSample&) {
            return shadowFromMap(depths[light], receiver, input.settings.direct.depthBiasTexels);
        });
    } else {
        Placement placed;
        const VoxelSurface* area = settings.injectionWeight == InjectionWeight::area ? surface : nullptr;
        for (const Rsm& rsm : input.rsms) injectMap(rsm, bits, index, area, lights, placed);
        volume.counters = {{"texels_injected", double(placed.texels)}, {"texels_moved", double(placed.moved)}, {"texels_lost", double(placed.lost)}};
    }
    store(lights, bits, index, settings, volume);
    return volume;
}

}  // namespace lrsm
