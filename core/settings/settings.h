#pragma once

#include "core/base/formats.h"

#include <cstdint>
#include <string>

/// Every choice of the program, as plain structs with defaults: one struct a stage, one line a field. The key of a field in
/// --set, JSON and docs is its name in snake_case (mip_filter); settings_table.cpp lists them all with range, unit and meaning.
/// The defaults below are the preset `balanced`.
namespace lrsm {

enum class Storage { gpu, float32 };          ///< Table 1's formats after every pass, or float32 throughout
enum class FilterFraction { exact, fixed8 };  ///< sampler fractions in float, or rounded to 1/256 (what D3D11 guarantees); key "8bit"

enum class Extent { reach, scene };  ///< what a grid or a map is fitted to: what camera and lights reach (Scene::reach), or the whole scene

enum class Voxelization { conservative, thin, raster };
enum class MipFilter { mean, coverage, max };
enum class VoxelWeight { area, count };             ///< of a triangle in its voxel's attributes: its area there, or 1
enum class OpacityAxes { isotropic, directional };  ///< one opacity a voxel, or an area density along each axis

enum class TextureFilter { trilinear, bilinear };  ///< by mips and the pixel's or RSM texel's own size; or the base level alone

struct SurfaceSettings {
    TextureFilter textureFilter = TextureFilter::trilinear;
    bool operator==(const SurfaceSettings&) const = default;
};

/// Finer cascades lie on every eighth voxel of the coarsest, of which the finest of four is an eighth wide.
inline constexpr int kLeastCascadeResolution = 64;

struct VoxelSettings {
    int resolution = 512;  ///< voxels along an edge, power of two, 1..2048
    Voxelization mode = Voxelization::thin;
    MipFilter mipFilter = MipFilter::mean;
    OpacityAxes axes = OpacityAxes::directional;
    Storage storage = Storage::gpu;
    Extent extent = Extent::reach;
    int cascades = 1;  ///< grids of `resolution`, each half as wide as the last, the finer ones about the eye, 1..4
    VoxelWeight surfaceWeight = VoxelWeight::area;
    bool operator==(const VoxelSettings&) const = default;
};

/// Of a sun's map, what keeps its texels where they are while things move.
enum class RsmSnap {
    texel,   ///< as wide as what it is fitted to, its centre on a whole texel of the light's lattice, which stands in the world
    sphere,  ///< that, and as wide as the fitted box's diagonal, rounded up: the texels' size hangs on no direction, and on the box's size in steps
    none,    ///< fitted as closely as it goes: texels slide and stretch with the box
};

struct RsmSettings {
    int resolution = 1024;  ///< texels along an edge, power of two, 2..8192
    Storage storage = Storage::gpu;
    HalfRounding halfRounding = HalfRounding::d3d;
    Extent extent = Extent::reach;
    RsmSnap snap = RsmSnap::texel;
    bool operator==(const RsmSettings&) const = default;
};

enum class LayerSelection {
    centre,  ///< the paper: layers whose depth range holds z_c, weighted by Eq. 15
    touched  ///< every layer that the cone sample touches, weight 1; needs overlap 0
};

struct LayerSettings {
    int depthLayers = 2;          ///< a + 1, 1..16
    int normalLayers = 2;         ///< b + 1, 1..8, equal slices of <n.l>
    float overlap = 0.0f;         ///< delta of Eq. 15 as a fraction of a depth slice, [0, 0.5]
    bool fitRanges = true;        ///< depth ranges fitted to the RSM's valid texels; false: equal slices of the light's whole range
    bool outermostDecay = false;  ///< true: Eq. 15 literally, also at the nearest and farthest end; false: the outer ranges reach delta further
    bool dropEmpty = true;        ///< layers without a lit texel are neither stored nor sampled (no bit of the picture changes)
    Storage storage = Storage::gpu;
    HalfRounding halfRounding = HalfRounding::d3d;
    bool operator==(const LayerSettings&) const = default;
};

enum class Shadows {
    exact,  ///< a shadow ray a pixel
    hard,   ///< comparison with the depth of one texel of the light's map
    pcf,    ///< the mean of such comparisons
    cone,   ///< the paper: a cone through the voxels
    off
};

struct DirectSettings {
    Shadows shadows = Shadows::exact;
    int shadowResolution = 1;                ///< hard, pcf: texels of the light's depth map over the RSM's, along an edge: 1 (the RSM itself), 2, 4
    float depthBiasTexels = 0.75f;           ///< hard, pcf: slope-scaled bias in texels of the map, >= 0, besides the receiver's own plane
    float pcfWidthTexels = 2.0f;             ///< pcf: edge of the square that is averaged, (0, 16]
    float shadowConeApertureDegrees = 2.0f;  ///< cone: full aperture, (0, 90]
    bool operator==(const DirectSettings&) const = default;
};

inline bool readsDepthMaps(const DirectSettings& settings)
{
    return settings.shadows == Shadows::hard || settings.shadows == Shadows::pcf;
}

/// Depth maps of their own, besides the RSMs'.
inline bool hasShadowMaps(const DirectSettings& settings)
{
    return readsDepthMaps(settings) && settings.shadowResolution > 1;
}

enum class Visibility {
    cones,     ///< the paper: cones through the voxels
    rays,      ///< a ray along each cone's axis, through the triangles
    voxelRays  ///< the same through the bits of level 0; key "voxel-rays"
};
enum class Estimator { paper, slab };
enum class OpacityModel { none, density };
enum class Backface { cosine, step };
enum class GaussianMethod { table, polynomial, exact };
enum class Rotation { none, azimuth, strata };  ///< per-pixel over 4x4: none; azimuth of the whole cone set; azimuth and polar angle stratified
enum class SpecularAperture { fixed, roughness };
enum class SpecularDirection { mirror, lobe };  ///< of a pixel's one specular cone: the mirror's, or one of 16 points of the lobe, averaged over 4x4 pixels
enum class TransmittanceModel { exponential, linear };

/// Which directions, and how many.
struct ConeSetSettings {
    int count = 6;               ///< diffuse cones, 1..256
    float apertureScale = 0.5f;  ///< traced aperture over the cone's own (60 degrees for the paper's six), (0, 2]
    Rotation rotation = Rotation::strata;
    bool filter = true;     ///< geometry-aware 4x4 filter of the irradiance; meant for rotation != none
    int filterPasses = 2;   ///< wider passes after it (none without it), each twice as wide as the last, 0..3; less where walls are near
    int gatherDivisor = 1;  ///< one pixel in a block of so many each way is gathered for, and lends the others its light, 1..4, power of two
    int setsPerPixel = 1;   ///< cone sets of the 16 rotations averaged in each pixel, 1..16
    /// Those that run.
    int smoothingPasses() const { return filter ? filterPasses : 0; }
    bool operator==(const ConeSetSettings&) const = default;
};

/// Where a cone samples, and what the voxels do to it.
struct MarchSettings {
    Visibility visibility = Visibility::cones;
    Estimator estimator = Estimator::slab;
    float step = 0.4f;                  ///< step length over sphere diameter, (0, 2]
    float startVoxels = 3.0f;           ///< first sample's distance along the cone, base voxels, >= 0
    float normalOffsetVoxels = 1.0f;    ///< origin off the surface along the geometric normal, base voxels, >= 0
    float minDiameterVoxels = 1.0f;     ///< smallest sphere diameter, base voxels, > 0
    float push = 0.0f;                  ///< sphere centre moved along the receiver's normal, in sphere radii, >= 0
    float transmittanceCutoff = 0.01f;  ///< stop below this transmittance, [0, 1)
    int maxSteps = 1024;                ///< 1..100000
    OpacityModel opacity = OpacityModel::density;
    float densityK = 2.0f;                                          ///< `paper`: optical depth of a one-voxel wall, > 0
    TransmittanceModel transmittance = TransmittanceModel::linear;  ///< `slab`
    float voxelLevelBias = -2.0f;                                   ///< added to log2(diameter in voxels)
    FilterFraction filterFraction = FilterFraction::exact;          ///< of voxel and LRSM lookups
    bool operator==(const MarchSettings&) const = default;
};

/// How the light of what a cone meets is taken from the LRSMs.
struct LrsmGatherSettings {
    float emitterDelayTaps = 3.0f;     ///< `slab`: an emitter's own voxels lie within this many tap widths before it ...
    float emitterDelayVoxels = 0.75f;  ///< ... plus this many base voxels,
    float emitterSlantCap = 0.5f;      ///< over max(cosine at the emitter, this)
    LayerSelection layerSelection = LayerSelection::touched;
    Backface backface = Backface::step;  ///< `paper`: N of Eq. 8 as it is, or 1 where N > 0
    float vRadiusScale = 1.0f;           ///< `paper`: depth window of Eq. 12 is z_c +- this r_c, > 0
    float rsmLevelBias = 0.0f;           ///< added to log2(diameter in LRSM texels)
    float rsmMinLevel = 0.0f;            ///< clamp (Fig. 8's trade), >= 0
    GaussianMethod gaussian = GaussianMethod::polynomial;
    int gaussianTableSize = 1024;  ///< entries, 2..65536
    bool operator==(const LrsmGatherSettings&) const = default;
};

struct SpecularSettings {
    SpecularDirection direction = SpecularDirection::lobe;
    SpecularAperture aperture = SpecularAperture::roughness;
    float apertureDegrees = 10.0f;  ///< full aperture when fixed, (0, 170]
    bool operator==(const SpecularSettings&) const = default;
};

/// All of a cone, by what reads it: methods share the first two and the last.
struct ConeSettings {
    ConeSetSettings set;
    MarchSettings march;
    LrsmGatherSettings gather;
    SpecularSettings specular;
    bool operator==(const ConeSettings&) const = default;
};

enum class Injection { rsm, voxel };                ///< a voxel's light: the mean over its RSM texels, or its own surface lit
enum class InjectionWeight { mean, area };          ///< `rsm`: as it is, or times the part of the voxel's surface that the texels cover
enum class DirectionWeights { absolute, squared };  ///< of the three directional textures: |d_k| or d_k^2
enum class StepOpacity { step, none };              ///< opacity of a texel's width scaled to the step's length, or taken as it is

/// Voxel cone tracing.
struct VctSettings {
    Storage storage = Storage::gpu;
    HalfRounding halfRounding = HalfRounding::d3d;
    Injection injection = Injection::rsm;
    InjectionWeight injectionWeight = InjectionWeight::mean;
    float facing = 0.1f;  ///< what faces a cone's way by more than this cosine sends nothing, [0, 2]; 2: everything sends
    DirectionWeights weights = DirectionWeights::absolute;
    StepOpacity opacity = StepOpacity::step;
    bool operator==(const VctSettings&) const = default;
};

enum class CacheMapping { equalArea, octahedral };  ///< of a cache's hemisphere to its square of texels
enum class CacheHorizon { renormalise, black };     ///< below a cache's own horizon: as the mean above it, or nothing
enum class CacheLobe { equivalent, cutoff };        ///< solid angle of a specular lobe: of a uniform one as peaked, or where it falls to 1 %
enum class CacheScoreScale { cluster, metre };      ///< length that the placement's score measures distances in

enum class CacheFill { lrsm, vct, voxels };  ///< what a cache's cones see: layered maps, six-direction voxels, or isotropic ones (its paper)
enum class CacheShadow { cone, rsm };        ///< `voxels`: of a lit voxel: a cone through the voxels, or the RSM's depth

/// Clustered pre-convolved radiance caching.
struct CacheSettings {
    CacheFill fill = CacheFill::lrsm;
    CacheShadow shadow = CacheShadow::cone;
    int tile = 32;           ///< pixels along an edge of a tile, power of two, 1..256
    int resolution = 16;     ///< texels (cones) along an edge of a cache, power of two, 2..32
    float radius = 1.0f;     ///< of a cache's influence in tiles, on screen and at its depth, (0, 8]
    float minCosine = 0.5f;  ///< least cosine between a pixel's normal and that of a cache it reads, [-1, 1)
    int minPixels = 0;       ///< smaller clusters join the tile's nearest of the same axis, 0..65536
    int maxCaches = 16384;   ///< beyond, tiles double, 1..2^22
    CacheMapping mapping = CacheMapping::equalArea;
    CacheHorizon horizon = CacheHorizon::renormalise;
    CacheLobe lobe = CacheLobe::equivalent;
    CacheScoreScale scoreScale = CacheScoreScale::cluster;
    Storage storage = Storage::gpu;
    HalfRounding halfRounding = HalfRounding::d3d;
    bool operator==(const CacheSettings&) const = default;
};

enum class VplSingularity { disc, clamp, none };  ///< of a light of area a = pi r^2 near by: a / (d^2 + r^2), exact on its axis; a / d^2 clamped; or bare
enum class VplLobe { gaussian, phong };           ///< weight of a light off the mirror direction: Eq. 7 of the proxies' paper, or cos^n

/// Virtual point lights, as proxies and imperfect shadow maps share them.
struct VplSettings {
    VplSingularity singularity = VplSingularity::disc;
    float clamp = 1.0f;  ///< `clamp`: most of a cos cos' / d^2, (0, 1000]
    VplLobe lobe = VplLobe::gaussian;
    float sigma = 0.25f;  ///< `gaussian`: sigma_theta of Eq. 7, (0, 10]
    bool operator==(const VplSettings&) const = default;
};

enum class ProxyHash { position, index };         ///< what Russian roulette draws from: the triangle's place, or its number
enum class ProxyFilterTest { printed, surface };  ///< whose lists a block takes: by depth and normal; or those of its own surface, near by
enum class ProxyCellWeight { seen, one };         ///< of a listed cell: by the part of it that rays see; or as it is
enum class ProxyLobeNorm { visible, lobe };       ///< what a specular sum is divided by: the weights of the proxies listed, or the whole lobe

/// Voxelized point proxies with a visibility filter.
struct ProxySettings {
    int count = 170000;  ///< proxies in the scene's reach, 1..2^22
    ProxyHash hash = ProxyHash::position;
    float radius = 1.6f;    ///< of a disc that occludes, over that of the surface a proxy stands for, (0, 8]
    int grid = 48;          ///< cells along the longest side, 1..256
    int rays = 64;          ///< shadow rays a marched pixel, 1..256
    int lobeRays = 16;      ///< more within the specular lobe, 0..256
    int marchDivisor = 4;   ///< one pixel in a block of so many each way is marched for, 1..16, power of two
    int gatherDivisor = 2;  ///< ... is gathered for, 1..8, power of two
    int filterRadius = 2;   ///< m = n of Eq. 4, marched pixels, 0..8; 0: no filter
    ProxyFilterTest filterTest = ProxyFilterTest::surface;
    ProxyCellWeight cellWeight = ProxyCellWeight::seen;
    float range = 8.0f;  ///< R of Eq. 6, cell diagonals: nearer cells shine proxy by proxy, [0, 1e6]
    ProxyLobeNorm lobeNorm = ProxyLobeNorm::visible;
    Storage storage = Storage::gpu;
    HalfRounding halfRounding = HalfRounding::d3d;
    bool operator==(const ProxySettings&) const = default;
};

enum class IsmSampling { importance, uniform };  ///< where virtual lights stand: by the flux of the RSM's texels, or by their number
enum class IsmFill { pullPush, splat, none };    ///< of holes in a map of points

/// Imperfect shadow maps.
struct IsmSettings {
    int lights = 4096;    ///< virtual ones, 1..65536
    int resolution = 64;  ///< texels along an edge of a map, power of two, 8..256
    int points = 8192;    ///< drawn into a map, 1..2^20
    IsmSampling sampling = IsmSampling::importance;
    IsmFill fill = IsmFill::pullPush;
    float bias = 0.01f;      ///< of depth, over the diagonal of the scene's reach, [0, 1]
    bool interleave = true;  ///< a pixel takes a 16th of the lights, and the 4x4 filter averages
    Storage storage = Storage::gpu;
    bool operator==(const IsmSettings&) const = default;
};

enum class Method { lrsm, vct, caches, proxies, ism };  ///< of indirect light

struct ForceSettings {
    bool everything = false;  ///< run every pass and branch that the scene analysis would leave out (tests that the analysis is safe)
    bool operator==(const ForceSettings&) const = default;
};

struct Settings {
    Method method = Method::lrsm;
    SurfaceSettings surface;
    VoxelSettings voxel;
    RsmSettings rsm;
    LayerSettings layers;
    DirectSettings direct;
    ConeSettings cones;
    VctSettings vct;
    CacheSettings caches;
    VplSettings vpl;
    ProxySettings proxies;
    IsmSettings ism;
    ForceSettings force;
    bool operator==(const Settings&) const = default;
};

}  // namespace lrsm
