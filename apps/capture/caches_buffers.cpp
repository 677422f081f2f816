#include "apps/capture/caches_buffers.h"

#include "apps/capture/fill.h"
#include "apps/capture/tolerances.h"
#include "apps/capture/volume_buffers.h"
#include "conetrace/frame/tiles.h"

#include <algorithm>

namespace lrsm {

namespace {

using Names = Catalogue::Names;

constexpr const char *kIndices = "", *kAtlas = "rc.atlas", *kDiffuse = "rc.diffuse", *kVoxels = "rc.voxels";

std::size_t mostCaches(const DescribedFrame& frame)
{
    return std::min(std::size_t(frame.settings.caches.maxCaches), std::size_t(frame.width) * std::size_t(frame.height));
}

/// Texels that are representable in the buffer's type.
void fitTexels(std::vector<Buffer>& buffers, const std::string& name, const std::vector<Vec4>& texels)
{
    const Buffer* buffer = findBuffer(buffers, name);
    if (!buffer) return;
    if (buffer->dtype == Dtype::f4) return fit(buffers, name, texels);
    std::vector<std::uint16_t> halves;
    halves.reserve(texels.size() * 4);
    for (const Vec4& texel : texels)
        for (int c = 0; c < 4; ++c) halves.push_back(halfFromFloat(texel[c], HalfRounding::nearestEven));
    fit(buffers, name, halves);
}

std::vector<Vec4> allTexelsOf(const Capture& capture, const std::string& name)
{
    return texelsOf(capture, name, capture.at(name).elements() / 4);
}

void addLevel(Catalogue& out, const DescribedFrame& frame, int level, const Tolerance& tolerance)
{
    addVolume(out, mipName(kVoxels, level), frame.settings.voxel.resolution >> level, frame.settings.caches.storage == Storage::gpu, kRgbOpacity,
              {"radiance times opacity and pre_exposure, and opacity, alike for all directions", kGridSpace, kRadianceUnit}, tolerance,
              static_cast<std::uint32_t>(level));
}

void addAtlas(Catalogue& out, const DescribedFrame& frame, int level)
{
    const CacheSettings& settings = frame.settings.caches;
    const bool half = settings.storage == Storage::gpu;
    const auto n = std::size_t(settings.resolution >> level);
    out.add(mipName(kAtlas, level), half ? Dtype::f2 : Dtype::f4, {mostCaches(frame), n, n}, {"cache", "row", "column"}, kRgbOpacity,
            {"radiance times pre_exposure, and opacity, towards the texel's part of the cache's hemisphere", "cache", kRadianceUnit},
            level == 0 ? tolerances::kCones : tolerances::layerHalf(half));
}

}  // namespace

void describeLitVoxels(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    addLevel(out, frame, 0, tolerances::kInjected);
}

void describeVoxelRadiance(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    for (int level = 1; frame.settings.voxel.resolution >> level >= 1; ++level)
        addLevel(out, frame, level, tolerances::layerHalf(frame.settings.caches.storage == Storage::gpu));
}

void describeClusters(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const auto width = std::size_t(frame.width), height = std::size_t(frame.height);
    const auto across = std::size_t(tilesAlong(frame.width, frame.settings.caches.tile)),
               down = std::size_t(tilesAlong(frame.height, frame.settings.caches.tile));
    const auto list = [&](const std::string& name, std::size_t count, const std::string& axis, const std::string& meaning) {
        out.add(name, Dtype::u4, {count}, {axis}, {}, {meaning, kIndices, ""}, tolerances::kClusters);
    };
    out.add("rc.axes", Dtype::f4, {down, across, 3}, {"tile_row", "tile_column", "axis"}, kXyz,
            {"the tile's three directions; 0 where it is empty", kWorldSpace, ""}, tolerances::kClusterAxes);
    list("rc.tile_first", down * across + 1, "tile", "clusters of tile t are tile_first[t] .. tile_first[t + 1] - 1");
    list("rc.keys", mostCaches(frame), "cluster", "depth slice << 3 | axis << 1 | normals point against it");
    list("rc.first", mostCaches(frame) + 1, "cluster", "pixels of cluster c are pixels[first[c]] .. pixels[first[c + 1] - 1]");
    list("rc.pixels", width * height, "covered_pixel", "row * width + column, cluster by cluster");
    out.picture("rc.cluster", frame.width, frame.height, {}, {"cluster + 1; 0 where nothing was drawn", kPicture, ""}, tolerances::kClusters, Dtype::u4);
}

void describePlaces(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const std::size_t caches = mostCaches(frame);
    const auto list = [&](const std::string& name, Dtype dtype, const Names& components, const Catalogue::Text& text) {
        out.add("rc." + name, dtype, {caches}, {"cache"}, components, text, tolerances::kPlaces);
    };
    list("pixel", Dtype::u4, {}, {"row * width + column of the pixel that the cache stands on", kPicture, ""});
    list("position", Dtype::f4, kXyz, {"of that pixel", kWorldSpace, "m"});
    list("normal", Dtype::f4, kXyz, {"geometric normal of that pixel, z of the cache's frame", kWorldSpace, ""});
    list("pixel_size", Dtype::f4, {}, {"between pixels at that depth", kWorldSpace, "m"});
    list("rotation", Dtype::u4, {}, {"which of tables.cone_directions its cones take", kIndices, ""});
}

void describeFill(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    addAtlas(out, frame, 0);
}

void describeConvolved(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const CacheSettings& settings = frame.settings.caches;
    for (int level = 1; settings.resolution >> level >= 1; ++level) addAtlas(out, frame, level);
    const bool half = settings.storage == Storage::gpu;
    out.add(kDiffuse, half ? Dtype::f2 : Dtype::f4, {mostCaches(frame), kDiffuseNodes, kDiffuseNodes}, {"cache", "row", "column"}, kRgbOpacity,
            {"irradiance times pre_exposure of the normal at (column, row) / (nodes - 1), and opacity of its hemisphere", "cache", kIrradianceUnit},
            tolerances::kFolded);
}

void describeCachedLight(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const int width = frame.width, height = frame.height;
    out.picture("cones.irradiance", width, height, kRgb, {"weighted mean over the pixel's caches", kPicture, kIrradianceUnit}, tolerances::kCached);
    out.picture("cones.opacity", width, height, {}, {"the same of the hemisphere's opacity", kPicture, ""}, tolerances::kConeOpacity);
    if (frame.needs.specular)
        out.picture("cones.specular", width, height, {"r", "g", "b", ""}, {"the same of the mean radiance over the specular lobe", kPicture, kRadianceUnit},
                    tolerances::kCached);
}

void shapeBuffers(const PixelClusters& clusters, std::vector<Buffer>& buffers)
{
    shape(buffers, "rc.axes", {std::size_t(clusters.tilesY), std::size_t(clusters.tilesX)});
    shape(buffers, "rc.tile_first", {clusters.tileFirst.size()});
    shape(buffers, "rc.keys", {clusters.keys.size()});
    shape(buffers, "rc.first", {clusters.first.size()});
    shape(buffers, "rc.pixels", {clusters.pixels.size()});
}

void shapeBuffers(const CachePlaces& places, std::vector<Buffer>& buffers)
{
    for (Buffer& buffer : buffers)
        if (buffer.pass == "rc places" || buffer.pass == "rc fill" || buffer.pass == "rc convolve") buffer.shape[0] = places.size();
}

void litToBuffers(const IsotropicVolume& volume, std::vector<Buffer>& buffers)
{
    if (Buffer* buffer = findBuffer(buffers, mipName(kVoxels, 0))) toDense(volume.maps.front(), volume.levels.front(), *buffer);
}

void prefilteredToBuffers(const IsotropicVolume& volume, std::vector<Buffer>& buffers)
{
    for (std::size_t level = 1; level < volume.levels.size(); ++level)
        if (Buffer* buffer = findBuffer(buffers, mipName(kVoxels, static_cast<int>(level)))) toDense(volume.maps[level], volume.levels[level], *buffer);
}

void toBuffers(const PixelClusters& clusters, std::vector<Buffer>& buffers)
{
    fit(buffers, "rc.axes", clusters.axes);
    fit(buffers, "rc.tile_first", clusters.tileFirst);
    fit(buffers, "rc.keys", clusters.keys);
    fit(buffers, "rc.first", clusters.first);
    fit(buffers, "rc.pixels", clusters.pixels);
    fit(buffers, "rc.cluster", clusters.clusterOf.texels);
}

void toBuffers(const CachePlaces& places, std::vector<Buffer>& buffers)
{
    fit(buffers, "rc.pixel", places.pixels);
    fit(buffers, "rc.position", places.positions);
    fit(buffers, "rc.normal", places.normals);
    fit(buffers, "rc.pixel_size", places.pixelSizes);
    fit(buffers, "rc.rotation", places.rotations);
}

void filledToBuffers(const CacheAtlas& atlas, std::vector<Buffer>& buffers)
{
    fitTexels(buffers, mipName(kAtlas, 0), atlas.levels.at(0));
}

void convolvedToBuffers(const CacheAtlas& atlas, std::vector<Buffer>& buffers)
{
    for (std::size_t level = 1; level < atlas.levels.size(); ++level) fitTexels(buffers, mipName(kAtlas, static_cast<int>(level)), atlas.levels[level]);
    fitTexels(buffers, kDiffuse, atlas.diffuse);
}

void cachedLightToBuffers(const Gathered& gathered, std::vector<Buffer>& buffers)
{
    fit(buffers, "cones.irradiance", gathered.irradiance.texels);
    fit(buffers, "cones.opacity", gathered.opacity.texels);
    std::vector<Vec4> specular;
    for (const Vec3& radiance : gathered.specular.texels) specular.emplace_back(radiance, 0.0f);
    fit(buffers, "cones.specular", specular);
}

IsotropicVolume isotropicFromCapture(const Capture& capture)
{
    const int n = capture.grid.resolution;
    std::vector<std::vector<Vec4>> dense;
    for (int level = 0; n >> level >= 1; ++level) dense.push_back(texelsOf(capture, mipName(kVoxels, level), cubed(n >> level)));
    BitGrid occupied = nothingOccupied(capture);
    markTexels(dense.front(), 0, nullptr, occupied);
    IsotropicVolume volume;
    volume.preExposure = capture.preExposure;
    volume.maps = mapBricks(occupied);
    const std::vector<std::uint64_t> before = occupied.bricks;
    for (std::size_t level = 1; level < dense.size(); ++level) markTexels(dense[level], static_cast<int>(level), &volume.maps[level], occupied);
    if (occupied.bricks != before) volume.maps = mapBricks(occupied);  // mips say that something is where the base says nothing is
    for (std::size_t level = 0; level < dense.size(); ++level) volume.levels.push_back(toBricks(volume.maps[level], dense[level]));
    return volume;
}

PixelClusters clustersFromCapture(const Capture& capture)
{
    PixelClusters clusters;
    const Buffer& axes = capture.at("rc.axes");
    clusters.tilesY = static_cast<int>(axes.shape[0]);
    clusters.tilesX = static_cast<int>(axes.shape[1]);
    clusters.tile = capture.settings.caches.tile;
    while (clusters.tilesX > 1 && std::size_t(tilesAlong(capture.width, clusters.tile)) > axes.shape[1]) clusters.tile *= 2;
    clusters.axes = allOf<NormalAxes>(capture, "rc.axes", Dtype::f4);
    clusters.keys = allOf<std::uint32_t>(capture, "rc.keys", Dtype::u4);
    clusters.pixels = allOf<std::uint32_t>(capture, "rc.pixels", Dtype::u4);
    clusters.tileFirst = allOf<std::uint32_t>(capture, "rc.tile_first", Dtype::u4);
    clusters.first = allOf<std::uint32_t>(capture, "rc.first", Dtype::u4);
    clusters.clusterOf = Image<std::uint32_t>(capture.width, capture.height);
    clusters.clusterOf.texels = allOf<std::uint32_t>(capture, "rc.cluster", Dtype::u4);
    refuseUnsorted(clusters.tileFirst, clusters.size(), "rc.tile_first");
    refuseUnsorted(clusters.first, clusters.pixels.size(), "rc.first");
    refuseBeyond(clusters.pixels, clusters.clusterOf.texels.size() - 1, "rc.pixels");
    refuseBeyond(clusters.clusterOf.texels, clusters.size(), "rc.cluster");
    for (std::size_t c = 0; c + 1 < clusters.first.size(); ++c)
        if (clusters.first[c] == clusters.first[c + 1]) throw InputError("rc.first", "cluster " + std::to_string(c) + " has no pixel");
    return clusters;
}

CachePlaces placesFromCapture(const Capture& capture)
{
    CachePlaces places;
    places.pixels = allOf<std::uint32_t>(capture, "rc.pixel", Dtype::u4);
    places.positions = allOf<Vec3>(capture, "rc.position", Dtype::f4);
    places.normals = allOf<Vec3>(capture, "rc.normal", Dtype::f4);
    places.pixelSizes = allOf<float>(capture, "rc.pixel_size", Dtype::f4);
    places.rotations = allOf<std::uint32_t>(capture, "rc.rotation", Dtype::u4);
    frameCaches(places);
    refuseBeyond(places.pixels, std::size_t(capture.width) * std::size_t(capture.height) - 1, "rc.pixel");
    refuseBeyond(places.rotations, kRotations - 1, "rc.rotation");
    return places;
}

CacheAtlas filledFromCapture(const Capture& capture)
{
    const CacheSettings& settings = capture.settings.caches;
    CacheAtlas atlas;
    atlas.resolution = settings.resolution;
    atlas.preExposure = capture.preExposure;
    atlas.half = settings.storage == Storage::gpu;
    atlas.levels.push_back(allTexelsOf(capture, mipName(kAtlas, 0)));
    return atlas;
}

CacheAtlas atlasFromCapture(const Capture& capture)
{
    CacheAtlas atlas = filledFromCapture(capture);
    for (int level = 1; atlas.resolution >> level >= 1; ++level) atlas.levels.push_back(allTexelsOf(capture, mipName(kAtlas, level)));
    atlas.diffuse = allTexelsOf(capture, kDiffuse);
    return atlas;
}

}  // namespace lrsm
