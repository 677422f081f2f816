#include "conetrace/pass_log.h"

#include "core/base/hash.h"
#include "core/base/parallel.h"

#include <bit>

namespace lrsm {
namespace {

constexpr std::size_t kHalf4Bytes = 8;

template <class T>
Sha256& addImage(Sha256& hash, const Image<T>& image)
{
    return hash.add(image.texels);
}

/// Of `count` floats in a row: those whose exponent is all ones.
std::uint64_t countNonFiniteFloats(const float* values, std::size_t count)
{
    constexpr std::size_t kGrain = std::size_t(1) << 18;
    constexpr std::uint32_t kExponent = 0x7f800000u;
    std::vector<std::uint64_t> partial((count + kGrain - 1) / kGrain, 0);
    parallelFor(count, kGrain, [&](std::size_t begin, std::size_t end) {
        std::uint32_t found = 0;
        for (std::size_t i = begin; i < end; ++i) found += (std::bit_cast<std::uint32_t>(values[i]) & kExponent) == kExponent ? 1u : 0u;
        partial[begin / kGrain] = found;
    });
    std::uint64_t total = 0;
    for (const std::uint64_t found : partial) total += found;
    return total;
}

/// Of structs that hold floats alone.
template <class T>
std::uint64_t countIn(const std::vector<T>& values)
{
    static_assert(sizeof(T) % sizeof(float) == 0 && alignof(T) % alignof(float) == 0);
    return countNonFiniteFloats(reinterpret_cast<const float*>(values.data()), values.size() * (sizeof(T) / sizeof(float)));
}

}  // namespace

PassSize sizeOf(const BitGrid& grid)
{
    // A GPU has no 1-bit format: one byte a voxel (Sec. 5).
    const auto n = static_cast<std::size_t>(grid.frame.resolution);
    return {grid.byteSize(), n * n * n};
}

PassSize sizeOf(const OpacityPyramid& pyramid)
{
    const VoxelSettings settings{.resolution = pyramid.base.frame.resolution, .mipFilter = pyramid.mipFilter, .axes = pyramid.axes, .storage = pyramid.storage};
    return {pyramid.byteSize(), predictPyramidGpuBytes(settings)};
}

PassSize sizeOf(const Rsm& rsm)
{
    return {rsm.byteSize(), Rsm::gpuBytes(rsm.texels.width)};
}

PassSize sizeOf(const Lrsm& lrsm)
{
    return {lrsm.byteSize(), lrsm.gpuBytes()};
}

PassSize sizeOf(const GBuffer& gbuffer)
{
    return {gbuffer.byteSize(), gbuffer.byteSize()};
}

PassSize sizeOf(const Gathered& gathered)
{
    const std::size_t half4 = (gathered.irradiance.texels.size() + gathered.specular.texels.size()) * kHalf4Bytes;
    return {gathered.byteSize(), half4};  // irradiance with opacity, and specular, as half x4
}

PassSize sizeOf(const Image<Vec3>& image)
{
    return {image.byteSize(), image.texels.size() * kHalf4Bytes};
}

std::string hashOf(const BitGrid& grid)
{
    return Sha256().add(grid.bricks).hex();
}

std::string hashOf(const OpacityPyramid& pyramid)
{
    return Sha256().add(pyramid.base.bricks).add(pyramid.unorm8).add(pyramid.float32).hex();
}

std::string hashOf(const Rsm& rsm)
{
    Sha256 hash;
    addImage(hash, rsm.texels);
    return addImage(hash, rsm.depthLinear).hex();
}

std::string hashOf(const Lrsm& lrsm)
{
    return Sha256().add(lrsm.texels).hex();
}

std::string hashOf(const GBuffer& gbuffer)
{
    Sha256 hash;
    addImage(hash, gbuffer.position);
    addImage(hash, gbuffer.geometricNormal);
    addImage(hash, gbuffer.normal);
    addImage(hash, gbuffer.albedo);
    addImage(hash, gbuffer.specularColor);
    addImage(hash, gbuffer.roughness);
    addImage(hash, gbuffer.depthLinear);
    return addImage(hash, gbuffer.objectId).hex();
}

std::string hashOf(const Gathered& gathered)
{
    Sha256 hash;
    addImage(hash, gathered.irradiance);
    addImage(hash, gathered.specular);
    return addImage(hash, gathered.opacity).hex();
}

std::string hashOf(const Image<Vec3>& image)
{
    return Sha256().add(image.texels).hex();
}

std::uint64_t countNonFinite(const BitGrid&)
{
    return 0;  // bits
}

std::uint64_t countNonFinite(const OpacityPyramid& pyramid)
{
    return countIn(pyramid.float32);
}

std::uint64_t countNonFinite(const Rsm& rsm)
{
    return countIn(rsm.texels.texels) + countIn(rsm.depthLinear.texels);
}

std::uint64_t countNonFinite(const Lrsm& lrsm)
{
    return countIn(lrsm.texels);
}

std::uint64_t countNonFinite(const GBuffer& gbuffer)
{
    return countIn(gbuffer.position.texels) + countIn(gbuffer.geometricNormal.texels) + countIn(gbuffer.normal.texels) + countIn(gbuffer.albedo.texels) +
           countIn(gbuffer.specularColor.texels) + countIn(gbuffer.roughness.texels) + countIn(gbuffer.depthLinear.texels);
}

std::uint64_t countNonFinite(const Gathered& gathered)
{
    return countIn(gathered.irradiance.texels) + countIn(gathered.specular.texels) + countIn(gathered.opacity.texels);
}

std::uint64_t countNonFinite(const Image<Vec3>& image)
{
    return countIn(image.texels);
}

}  // namespace lrsm
