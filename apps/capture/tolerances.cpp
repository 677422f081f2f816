#include "apps/capture/tolerances.h"

#include <cmath>

namespace lrsm::tolerances {

namespace {

constexpr double kFloorOfMean = 0.05;
constexpr double kEdges = 0.005;  // pixels and texels on silhouettes

// What a snapped vertex moves: 1/256 pixel as seen, four times as much on a surface seen at a slant. Measured with a GPU-style rasterizer (docs/twin.md):
// of three scenes of flat and round walls in three sizes each, 99.5 % of the texels are within 0.65 of it; a mesh of 200,000
// triangles says what it does to normals and to <n.l>.
double snapping(int pixels)
{
    return 1.0 / (64.0 * pixels);
}

Tolerance exact(double outliers, std::string reason)
{
    return {Tolerance::Kind::exact, 0.0, 0.0, outliers, 1.0, std::move(reason)};
}
Tolerance ulp(double value, double outliers, double differing, std::string reason)
{
    return {Tolerance::Kind::ulp, value, 0.0, outliers, differing, std::move(reason)};
}
Tolerance absolute(double value, double outliers, std::string reason)
{
    return {Tolerance::Kind::absolute, value, 0.0, outliers, 1.0, std::move(reason)};
}
Tolerance relative(double value, double outliers, std::string reason)
{
    return {Tolerance::Kind::relative, value, 0.0, outliers, 1.0, std::move(reason)};
}

}  // namespace

const Tolerance kGiven = exact(0.0, "an input: not computed");
const Tolerance kVoxels = exact(0.01, "a hardware rasterizer snaps to 1/256 pixel, we to 1/4096 voxel: a voxel whose centre is that near an edge may flip");
const Tolerance kSurface = absolute(2e-3, kEdges, "interpolation, and 8 bits of sampler fraction in textures; silhouettes flip");
const Tolerance kObjectId = exact(kEdges, "silhouettes flip where snapping differs");
const Tolerance kDirect = relative(1e-3, kEdges, "float32 in another order; a shadow's edge flips where its depth comparison is a tie");
const Tolerance kCones = relative(2e-2, 0.01, "sampler fractions of 8 bits, log2 to a few ULP; a cone that ends one step earlier or later is an outlier");
const Tolerance kConeOpacity = absolute(1e-2, 0.01, "as the cones' radiance");
const Tolerance kFilter = relative(1e-4, kEdges, "the order of 25 additions; a neighbour at the limit of \"same surface\" is an outlier");
const Tolerance kProduct = relative(1e-5, 0.0, "float32 in another order");
const Tolerance kSpecularPart = relative(2e-3, 0.0, "table lookup by a sampler's 8-bit fractions");

const Tolerance kVoxelSurface = absolute(2e-3, kEdges, "means in another precision; a triangle that only touches a voxel is a fragment or none");
const Tolerance kInjected = relative(2e-2, 0.01, "two steps of half; a texel on the face between two voxels falls into the one or the other");
const Tolerance kInjectedNormal = absolute(1e-2, 0.01, "as the voxel's radiance");

const Tolerance kClusters = exact(0.02, "a normal between two axes or a depth between two slices falls to the one or the other");
const Tolerance kClusterAxes = absolute(1e-4, 0.02, "a normal on the edge of a bin of the histogram falls to its neighbour, and the axis with it");
const Tolerance kPlaces = absolute(1e-5, 0.02, "of two pixels of nearly one score either may hold the cache");
const Tolerance kFolded = relative(2e-3, 0.0, "the order of N^2 additions, and a step of half");
const Tolerance kCached = relative(5e-3, 0.002, "a sampler's 8-bit fractions; a cache at the limit of its radius or cosine");

const Tolerance kPoints = absolute(1e-4, 0.02, "a few roundings of place and normal; where the map's shadow ends a point is lit or not");
const Tolerance kCellSums = absolute(1e-4, 0.001, "the order of a cell's additions");
const Tolerance kLists = exact(0.02, "a ray past a disc's rim meets another cell, and all that follows in the list moves");
const Tolerance kMapDepths = absolute(1e-4, 0.02, "a point on a texel's border, or at the edge of a disc's reach");
const Tolerance kListed = relative(5e-3, 0.01, "the order of many additions; a cell or light that is seen or not");

Tolerance voxelMip(bool unorm)
{
    if (!unorm) return absolute(1e-6, 0.0, "the order of eight additions");
    return ulp(1, 0.0, 0.25, "D3D allows 0.6 ULP in float to UNORM: one code, where the exact value lies near the middle of two; GenerateMips likewise");
}

Tolerance mapRadiance(int resolution)
{
    return relative(2e-3 + 96.0 * snapping(resolution), kEdges,
                    "two steps of half; 1/256 texel of snapping turns the normals of curved surfaces; coverage flips on silhouettes");
}

Tolerance mapNormal(int resolution)
{
    return absolute(1e-3 + 16.0 * snapping(resolution), kEdges,
                    "a step of half at 1 is 2^-11; 1/256 texel of snapping on curved surfaces; coverage flips on silhouettes");
}

Tolerance mapDepth(int resolution)
{
    return absolute(snapping(resolution), kEdges, "1/256 texel of snapping on a slanted surface; coverage flips on silhouettes");
}

Tolerance layerHalf(bool half)
{
    if (!half) return absolute(1e-5, 0.0, "the order of four additions");
    return ulp(1, 0.0, 0.25,
               "four additions in another order may cross a step of half; more than a quarter of the texels: the rounding mode differs (half_rounding)");
}

Tolerance layerDepth(bool unorm, int level)
{
    if (!unorm) return absolute(1e-6, 0.0, "the order of four additions");
    const std::string reason = "D3D allows 0.6 ULP in float to UNORM: one code, where the exact value lies near the middle of two; GenerateMips likewise";
    if (level < 2) return ulp(1, 0.0, 0.25, reason);
    // Measured with a driver's own stores (docs/twin.md): of the mips from the third on up to half differ, a few by 2.
    return ulp(2, 0.0, 0.6, reason + "; a mip inherits what those below it are off by");
}

Tolerance length(double sceneDiagonal, int height)
{
    return absolute(sceneDiagonal * snapping(height), kEdges,
                    "1/256 pixel of snapping on a slanted surface, for a picture as high as the scene; silhouettes flip");
}

Tolerance surfaceNormal(int height)
{
    return absolute(2e-3 + 16.0 * snapping(height), kEdges,
                    "8 bits of sampler fraction in normal maps; 1/256 pixel of snapping on curved surfaces; silhouettes flip");
}

void setFloor(Buffer& buffer)
{
    if (buffer.tolerance.kind != Tolerance::Kind::relative) return;
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < valueCount(buffer); ++i) {
        const double value = decodedValue(buffer, i);
        if (value == 0.0 || !std::isfinite(value)) continue;
        sum += std::abs(value);
        ++count;
    }
    buffer.tolerance.floor = count ? kFloorOfMean * sum / static_cast<double>(count) : 0.0;
}

}  // namespace lrsm::tolerances
