#include "conetrace/caches/places.h"

#include "conetrace/frame/cones.h"
#include "core/base/parallel.h"
#include "core/scene/camera.h"

namespace lrsm {
namespace {

constexpr std::size_t kClustersPerTask = 64;
constexpr float kCancelled = 1e-3f;  ///< of normals: their sum over their number

std::uint32_t bestPixel(const GBuffer& gbuffer, const ClusterFrame& cluster, std::span<const std::uint32_t> pixels)
{
    std::uint32_t best = pixels.front();
    float most = -kInfinity;
    for (const std::uint32_t pixel : pixels) {
        const float score = placementScore(cluster, gbuffer.position.texels[pixel], gbuffer.normal.texels[pixel]);
        if (!(score > most)) continue;
        most = score;
        best = pixel;
    }
    return best;
}

}  // namespace

ClusterFrame frameOfCluster(const GBuffer& gbuffer, std::span<const std::uint32_t> pixels, CacheScoreScale scale)
{
    Aabb box;
    Vec3 sum(0.0f);
    for (const std::uint32_t pixel : pixels) {
        box.include(gbuffer.position.texels[pixel]);
        sum += gbuffer.normal.texels[pixel];
    }
    const bool cancelled = !(glm::length(sum) > kCancelled * float(pixels.size()));
    const float diagonal = glm::length(box.extent());
    return {.centre = box.centre(),
            .normal = cancelled ? gbuffer.normal.texels[pixels.front()] : glm::normalize(sum),
            .length = scale == CacheScoreScale::cluster && diagonal > 0.0f ? diagonal : 1.0f};
}

float placementScore(const ClusterFrame& cluster, const Vec3& position, const Vec3& normal)
{
    const Vec3 fromCentre = position - cluster.centre;
    const float out = glm::dot(fromCentre, cluster.normal);
    const float aside = glm::length(fromCentre - out * cluster.normal);
    return (glm::dot(normal, cluster.normal) + out / cluster.length) / (1.0f + aside / cluster.length);
}

CachePlaces placeCaches(const GBuffer& gbuffer, const Camera& camera, const PixelClusters& clusters, const CacheSettings& settings, Rotation rotation)
{
    const float spacing = glm::length(pixelSpacing(camera, gbuffer.height).down);
    CachePlaces places;
    places.pixels.resize(clusters.size());
    places.positions.resize(clusters.size());
    places.normals.resize(clusters.size());
    places.pixelSizes.resize(clusters.size());
    places.rotations.resize(clusters.size());
    parallelFor(clusters.size(), kClustersPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            const auto pixels = std::span(clusters.pixels).subspan(clusters.first[c], clusters.first[c + 1] - clusters.first[c]);
            const std::uint32_t pixel = bestPixel(gbuffer, frameOfCluster(gbuffer, pixels, settings.scoreScale), pixels);
            places.pixels[c] = pixel;
            places.positions[c] = gbuffer.position.texels[pixel];
            places.normals[c] = gbuffer.geometricNormal.texels[pixel];
            const auto x = static_cast<int>(pixel) % gbuffer.width, y = static_cast<int>(pixel) / gbuffer.width;
            places.rotations[c] = static_cast<std::uint32_t>(rotationOfPixel(x / clusters.tile, y / clusters.tile, rotation));
            places.pixelSizes[c] = camera.perspective ? spacing * gbuffer.depthLinear.texels[pixel] : spacing;
        }
    });
    frameCaches(places);
    return places;
}

void frameCaches(CachePlaces& places)
{
    places.frames.clear();
    for (const Vec3& normal : places.normals) places.frames.push_back(basisFromNormal(normal));
}

}  // namespace lrsm
