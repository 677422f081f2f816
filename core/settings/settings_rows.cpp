#include "core/settings/settings_rows.h"

#include <type_traits>
#include <utility>

namespace lrsm {

namespace {

/// Where each struct of settings lies, and the stage that it belongs to; the pointer only names the struct.
struct Places {
    static auto of(auto& s, SurfaceSettings*) { return std::pair(&s.surface, "surface"); }
    static auto of(auto& s, VoxelSettings*) { return std::pair(&s.voxel, "voxel"); }
    static auto of(auto& s, RsmSettings*) { return std::pair(&s.rsm, "rsm"); }
    static auto of(auto& s, LayerSettings*) { return std::pair(&s.layers, "layers"); }
    static auto of(auto& s, DirectSettings*) { return std::pair(&s.direct, "direct"); }
    static auto of(auto& s, ConeSetSettings*) { return std::pair(&s.cones.set, "cones"); }
    static auto of(auto& s, MarchSettings*) { return std::pair(&s.cones.march, "cones"); }
    static auto of(auto& s, LrsmGatherSettings*) { return std::pair(&s.cones.gather, "cones"); }
    static auto of(auto& s, SpecularSettings*) { return std::pair(&s.cones.specular, "cones"); }
    static auto of(auto& s, VctSettings*) { return std::pair(&s.vct, "vct"); }
    static auto of(auto& s, CacheSettings*) { return std::pair(&s.caches, "caches"); }
    static auto of(auto& s, VplSettings*) { return std::pair(&s.vpl, "vpl"); }
    static auto of(auto& s, ProxySettings*) { return std::pair(&s.proxies, "proxies"); }
    static auto of(auto& s, IsmSettings*) { return std::pair(&s.ism, "ism"); }
    static auto of(auto& s, ForceSettings*) { return std::pair(&s.force, "force"); }
};

template <class Member>
struct MemberOf;
template <class Stage, class Value>
struct MemberOf<Value Stage::*> {
    using Struct = Stage;
};

// One accessor pair a field, from its member pointer.
template <auto Field>
struct Access {
    static auto place(auto& settings) { return Places::of(settings, static_cast<typename MemberOf<decltype(Field)>::Struct*>(nullptr)); }
    static double get(const Settings& settings) { return static_cast<double>(place(settings).first->*Field); }
    static void set(Settings& settings, double value)
    {
        auto& field = place(settings).first->*Field;
        field = static_cast<std::remove_reference_t<decltype(field)>>(value);
    }
};

struct Text {
    std::string_view key, unit, meaning, source;
};

template <auto Field>
SettingRow row(const Text& text, SettingKind kind, SettingRange range, std::vector<std::string_view> choices = {})
{
    const Settings any;
    return {.key = text.key,
            .stage = Access<Field>::place(any).second,
            .unit = text.unit,
            .meaning = text.meaning,
            .source = text.source,
            .kind = kind,
            .range = range,
            .choices = std::move(choices),
            .get = &Access<Field>::get,
            .set = &Access<Field>::set};
}

template <auto Field>
SettingRow flag(const Text& text)
{
    return row<Field>(text, SettingKind::flag, {0, 1});
}

template <auto Field>
SettingRow choice(const Text& text, std::vector<std::string_view> names)
{
    const float last = static_cast<float>(names.size() - 1);
    return row<Field>(text, SettingKind::choice, {0, last}, std::move(names));
}

template <auto Field>
SettingRow whole(const Text& text, SettingRange range)
{
    return row<Field>(text, SettingKind::whole, range);
}

template <auto Field>
SettingRow real(const Text& text, SettingRange range)
{
    return row<Field>(text, SettingKind::real, range);
}

SettingRow shorthand(SettingRow row, void (*set)(Settings&, double))
{
    row.stage = "several";
    row.set = set;
    row.shorthand = true;
    return row;
}

constexpr SettingRange powersOfTwo(float min, float max)
{
    return {min, max, false, false, true};
}
constexpr SettingRange above(float min, float max)
{
    return {min, max, true, false, false};
}
constexpr SettingRange below(float min, float max)
{
    return {min, max, false, true, false};
}

using V = VoxelSettings;
using R = RsmSettings;
using L = LayerSettings;
using D = DirectSettings;
using Set = ConeSetSettings;
using March = MarchSettings;
using Gather = LrsmGatherSettings;
using Specular = SpecularSettings;
using Vct = VctSettings;
using C = CacheSettings;
using Vpl = VplSettings;
using P = ProxySettings;
using Ism = IsmSettings;
using F = ForceSettings;
using Names = std::vector<std::string_view>;

/// In the order of the enumeration Method.
SettingRow methodRow()
{
    const Names names = {"lrsm", "vct", "caches", "proxies", "ism"};
    return {
        .key = "method",
        .stage = "method",
        .unit = "",
        .meaning = "of indirect light: layered reflective shadow maps, voxel cone tracing, clustered radiance caches, point proxies, or imperfect shadow maps",
        .source = "paper: lrsm",
        .kind = SettingKind::choice,
        .range = {0, static_cast<float>(names.size() - 1)},
        .choices = names,
        .get = [](const Settings& settings) { return static_cast<double>(settings.method); },
        .set = [](Settings& settings, double value) { settings.method = static_cast<Method>(value); }};
}

void addBuildingRows(std::vector<SettingRow>& rows)
{
    const Names storage = {"gpu", "float32"}, rounding = {"d3d", "nearest_even"}, extent = {"reach", "scene"};

    rows.push_back(choice<&SurfaceSettings::textureFilter>(
        {"texture_filter", "", "of RSM and G-buffer: mips by derivatives, or the base level alone", "D3D11.3 spec 7.18: trilinear"},
        {"trilinear", "bilinear"}));
    rows.push_back(whole<&V::resolution>({"voxel_resolution", "voxels", "voxels along an edge of the grid", "paper Table 2: 256, 512"}, powersOfTwo(1, 2048)));
    rows.push_back(
        choice<&V::mode>({"voxelization", "", "exact box overlap; 6-separating; or sampled along the dominant axis (has holes)", "paper Sec. 3.2: raster"},
                         {"conservative", "thin", "raster"}));
    rows.push_back(choice<&V::mipFilter>({"mip_filter", "", "a mip voxel is the mean of its 8 children, their sum / 4, or their maximum", "paper: mean"},
                                         {"mean", "coverage", "max"}));
    rows.push_back(
        choice<&V::axes>({"opacity_axes", "", "one opacity a voxel, or an area density along each axis", "paper: isotropic"}, {"isotropic", "directional"}));
    rows.push_back(choice<&V::storage>({"voxel_storage", "", "mips in UNORM8 or in float32", "paper Table 1: gpu"}, storage));
    rows.push_back(choice<&V::extent>(
        {"voxel_extent", "", "grid over what camera and lights reach, where that is far less than the scene; or over all of it", "ours; paper: scene"},
        extent));
    rows.push_back(whole<&V::cascades>(
        {"voxel_cascades", "grids", "the grid, and others of as many voxels about the eye, each half as wide as the last", "paper: future work"}, {1, 4}));

    rows.push_back(
        choice<&V::surfaceWeight>({"vox_weight", "", "of a triangle in the albedo and normal of its voxel: its area there, or 1", "ours"}, {"area", "count"}));

    rows.push_back(
        whole<&R::resolution>({"rsm_resolution", "texels", "texels along an edge of the reflective shadow map", "paper Table 2: 1024"}, powersOfTwo(2, 8192)));
    rows.push_back(choice<&R::storage>({"rsm_storage", "", "RSM attributes in half or in float32", "paper Table 1: gpu"}, storage));
    rows.push_back(
        choice<&R::halfRounding>({"rsm_half_rounding", "", "float to half: toward zero (D3D11) or to nearest even", "D3D11.3 spec 3.2.2: d3d"}, rounding));
    rows.push_back(choice<&R::extent>({"rsm_extent", "", "a light's map over the same reach, or over the whole scene", "ours; paper: scene"}, extent));
    rows.push_back(choice<&R::snap>(
        {"rsm_snap", "",
         "a sun's map stands on whole texels of the world; that, with texels of one size from all directions; or is fitted closely (docs/sequences.md)",
         "ours"},
        {"texel", "sphere", "none"}));

    rows.push_back(whole<&L::depthLayers>({"depth_layers", "", "depth slices, a + 1", "paper Table 2: 2, 3"}, {1, 16}));
    rows.push_back(whole<&L::normalLayers>({"normal_layers", "", "slices of <n.l>, b + 1", "paper Table 2: 2"}, {1, 8}));
    rows.push_back(
        real<&L::overlap>({"layer_overlap", "depth slices", "delta of Eq. 15; 0 with layer_selection=touched", "paper Sec. 4.3, no value given"}, {0, 0.5f}));
    rows.push_back(flag<&L::fitRanges>(
        {"fit_ranges", "", "fit the depth slices to the RSM's valid texels; false: slices of the light's whole range", "ours; paper: static"}));
    rows.push_back(flag<&L::outermostDecay>(
        {"outermost_decay", "", "Eq. 15 also falls off at the nearest and farthest end; false: the outer ranges reach delta further", "paper Eq. 15: true"}));
    rows.push_back(
        flag<&L::dropEmpty>({"drop_empty", "", "layers without a lit texel are neither stored nor sampled (changes no bit of the picture)", "ours"}));
    rows.push_back(choice<&L::storage>({"layer_storage", "", "LRSM in half and UNORM16, or in float32", "paper Table 1: gpu"}, storage));
    rows.push_back(choice<&L::halfRounding>({"layer_half_rounding", "", "as rsm_half_rounding", "D3D11.3 spec 3.2.2: d3d"}, rounding));

    rows.push_back(
        choice<&D::shadows>({"shadows", "", "a shadow ray a pixel; depth map, one texel or a mean; cones through the voxels; or none", "paper Table 3: cone"},
                            {"exact", "hard", "pcf", "cone", "off"}));
    rows.push_back(whole<&D::shadowResolution>({"shadow_resolution", "RSM resolutions", "of the depth map of hard and pcf; 1: the RSM's own depth", "ours"},
                                               powersOfTwo(1, 4)));
    rows.push_back(
        real<&D::depthBiasTexels>({"depth_bias_texels", "map texels", "hard, pcf: slope-scaled bias besides the receiver's plane", "ours"}, {0, 1000}));
    rows.push_back(real<&D::pcfWidthTexels>({"pcf_width_texels", "map texels", "pcf: edge of the square averaged; 1 is bilinear", "ours"}, above(0, 16)));
    rows.push_back(real<&D::shadowConeApertureDegrees>({"shadow_cone_aperture_degrees", "degrees", "full aperture of a shadow cone", "ours"}, above(0, 90)));
}

void addConeRows(std::vector<SettingRow>& rows)
{
    rows.push_back(choice<&March::visibility>(
        {"visibility", "", "of the gather: cones through the voxels; or a ray along each cone's axis through the triangles, or through the voxels",
         "paper: cones"},
        {"cones", "rays", "voxel-rays"}));
    rows.push_back(choice<&March::estimator>(
        {"estimator", "", "Algorithm 1 and Eq. 1 as printed; or V and N as one term with linear transmittance", "paper: paper"}, {"paper", "slab"}));
    rows.push_back(whole<&Set::count>({"cone_count", "", "diffuse cones a pixel", "paper Sec. 6: 6"}, {1, 256}));
    rows.push_back(real<&Set::apertureScale>({"aperture_scale", "", "traced aperture over the cone's own (60 degrees for six)", "paper: 1"}, above(0, 2)));
    rows.push_back(
        choice<&Set::rotation>({"rotation", "", "per pixel over 4x4: none; azimuth of the cone set; azimuth and polar angle in strata", "ours; paper: none"},
                               {"none", "azimuth", "strata"}));
    rows.push_back(flag<&Set::filter>({"irradiance_filter", "", "geometry-aware 4x4 filter of the irradiance, for rotation != none", "ours; paper: false"}));
    rows.push_back(whole<&Set::filterPasses>(
        {"filter_passes", "", "after it, if it is on: 3x3 taps 4, 8, 16 pixels apart on the same surface, less where other surfaces are near",
         "ours; paper: 0"},
        {0, 3}));
    rows.push_back(whole<&Set::gatherDivisor>(
        {"gather_divisor", "pixels", "edge of the blocks of which one pixel is gathered for; the others are joint bilaterally upsampled", "ours; paper: 1"},
        powersOfTwo(1, 4)));
    rows.push_back(whole<&Set::setsPerPixel>({"sets_per_pixel", "", "cone sets of the 16 rotations averaged in each pixel", "ours"}, {1, 16}));

    rows.push_back(real<&March::step>({"step", "sphere diameters", "step length", "ours; the paper gives none"}, above(0, 2)));
    rows.push_back(real<&March::startVoxels>({"start_voxels", "base voxels", "distance of the first sample along the cone", "ours"}, {0, 1024}));
    rows.push_back(
        real<&March::normalOffsetVoxels>({"normal_offset_voxels", "base voxels", "origin off the surface, along the geometric normal", "ours"}, {0, 1024}));
    rows.push_back(real<&March::minDiameterVoxels>({"min_diameter_voxels", "base voxels", "smallest sphere diameter", "ours"}, above(0, 1024)));
    rows.push_back(real<&March::push>({"push", "sphere radii", "sphere centre moved along the receiver's normal", "ours; paper: 0"}, {0, 16}));
    rows.push_back(real<&March::transmittanceCutoff>({"transmittance_cutoff", "", "a cone ends below this transmittance", "ours"}, below(0, 1)));
    rows.push_back(whole<&March::maxSteps>({"max_steps", "", "steps a cone", "ours"}, {1, 100000}));

    rows.push_back(choice<&March::opacity>({"opacity", "", "mip value as opacity, or as density along the step", "paper: none"}, {"none", "density"}));
    rows.push_back(real<&March::densityK>({"density_k", "", "estimator paper: optical depth of a wall one voxel thick", "ours"}, above(0, 1000)));
    rows.push_back(choice<&March::transmittance>({"transmittance", "", "slab, vct: coverage multiplies (exponential) or adds (linear)", "ours"},
                                                 {"exponential", "linear"}));
    rows.push_back(real<&March::voxelLevelBias>({"voxel_level_bias", "mip levels", "added to log2(diameter in voxels)", "paper: 0"}, {-16, 16}));
    rows.push_back(real<&Gather::emitterDelayTaps>(
        {"emitter_delay_taps", "tap widths", "estimator slab: an emitter's own voxels lie no farther before it", "ours"}, {0, 16}));
    rows.push_back(real<&Gather::emitterDelayVoxels>({"emitter_delay_voxels", "base voxels", "... plus this", "ours"}, {0, 16}));
    rows.push_back(real<&Gather::emitterSlantCap>({"emitter_slant_cap", "", "... over max(cosine at the emitter, this)", "ours"}, above(0, 1)));
}

void addLookupRows(std::vector<SettingRow>& rows)
{
    rows.push_back(choice<&Gather::layerSelection>(
        {"layer_selection", "", "layers that hold z_c, weighted by Eq. 15; or every layer touched, weight 1", "paper Sec. 4.3: centre"},
        {"centre", "touched"}));
    rows.push_back(choice<&Gather::backface>({"backface", "", "estimator paper: N of Eq. 8, or 1 where N > 0", "paper Eq. 8: cosine"}, {"cosine", "step"}));
    rows.push_back(
        real<&Gather::vRadiusScale>({"v_radius_scale", "sphere radii", "estimator paper: depth window of Eq. 12 about z_c", "paper Eq. 12: 1"}, above(0, 16)));
    rows.push_back(real<&Gather::rsmLevelBias>({"rsm_level_bias", "mip levels", "added to log2(diameter in LRSM texels)", "paper: 0"}, {-16, 16}));
    rows.push_back(
        real<&Gather::rsmMinLevel>({"rsm_min_level", "mip levels", "finest LRSM level sampled: stability against sharpness", "paper Fig. 8"}, {0, 16}));
    rows.push_back(
        choice<&Gather::gaussian>({"gaussian", "", "normal distribution: table of gaussian_table_size, polynomial, or exact in double", "paper Sec. 5: table"},
                                  {"table", "polynomial", "exact"}));
    rows.push_back(
        whole<&Gather::gaussianTableSize>({"gaussian_table_size", "entries", "over [-5, 5], linear between", "paper Sec. 5, no size given"}, {2, 65536}));
    rows.push_back(choice<&March::filterFraction>(
        {"filter_fraction", "", "sampler fractions in float, or rounded to 1/256 (all that D3D11 guarantees)", "D3D11.3 spec 7.18.16"}, {"exact", "8bit"}));

    rows.push_back(choice<&Specular::direction>(
        {"specular_direction", "", "the mirror's; or points of the lobe that alternate and are averaged as the rotations are", "paper: mirror"},
        {"mirror", "lobe"}));
    rows.push_back(choice<&Specular::aperture>({"specular_aperture", "", "fixed, or from the material's roughness", "paper: fixed"}, {"fixed", "roughness"}));
    rows.push_back(real<&Specular::apertureDegrees>({"specular_aperture_degrees", "degrees", "full aperture when fixed", "paper Fig. 7: 10"}, above(0, 170)));

    rows.push_back(choice<&Vct::storage>({"vct_storage", "", "radiance volumes in half or in float32", "paper Sec. 6: gpu"}, {"gpu", "float32"}));
    rows.push_back(choice<&Vct::halfRounding>({"vct_half_rounding", "", "as rsm_half_rounding", "D3D11.3 spec 3.2.2: d3d"}, {"d3d", "nearest_even"}));
    rows.push_back(choice<&Vct::injection>({"vct_injection", "", "a voxel's light: the mean over its RSM texels, or its own surface lit", "[CNS*11]: rsm"},
                                           {"rsm", "voxel"}));
    rows.push_back(choice<&Vct::injectionWeight>(
        {"vct_injection_weight", "", "rsm: the mean as it is, or times the part of the voxel's surface that the texels cover", "ours"}, {"mean", "area"}));
    rows.push_back(
        real<&Vct::facing>({"vct_facing", "", "a surface that faces a cone's way by more than this cosine is dark to it; 2: none is", "ours"}, {0, 2}));
    rows.push_back(
        choice<&Vct::weights>({"vct_weights", "", "of the three directional volumes: |d|, or d^2", "ours; [CNS*11] gives none"}, {"absolute", "squared"}));
    rows.push_back(choice<&Vct::opacity>({"vct_opacity", "", "a texel's opacity scaled to the step's length, or as it is", "ours"}, {"step", "none"}));
}

/// [C]: Rehfeld, Zirr and Dachsbacher, "Clustered Pre-convolved Radiance Caching", EGPGV 2014.
void addCacheRows(std::vector<SettingRow>& rows)
{
    rows.push_back(choice<&C::fill>({"rc_fill", "", "what the caches' cones see: the LRSM, the voxels of method vct, or isotropic lit voxels", "[C]: voxels"},
                                    {"lrsm", "vct", "voxels"}));
    rows.push_back(choice<&C::shadow>(
        {"rc_shadow", "", "rc_fill=voxels: light of a voxel shadowed by a cone through the voxels, or by the RSM", "[C] Sec. 3.1: cone"}, {"cone", "rsm"}));
    rows.push_back(
        whole<&C::tile>({"rc_tile", "pixels", "edge of the tiles whose pixels are clustered", "[C]: about 64 for 4096 caches"}, powersOfTwo(1, 256)));
    rows.push_back(whole<&C::resolution>({"rc_resolution", "texels", "edge of a cache: a cone a texel of it", "[C] Sec. 5: 16"}, powersOfTwo(2, 32)));
    rows.push_back(real<&C::radius>({"rc_radius", "tiles", "how far a cache lends its light, on screen and at its depth", "[C] Sec. 3.3: 2"}, above(0, 8)));
    rows.push_back(
        real<&C::minCosine>({"rc_min_cosine", "", "least cosine between a pixel's normal and that of a cache it reads", "ours; [C]: -1"}, below(-1, 1)));
    rows.push_back(whole<&C::minPixels>({"rc_min_pixels", "pixels", "smaller clusters join the tile's nearest of the same axis", "ours; [C]: 0"}, {0, 65536}));
    rows.push_back(whole<&C::maxCaches>({"rc_max", "caches", "with more clusters, tiles are doubled", "ours; [C]: 4096 caches"}, {1, 1 << 22}));
    rows.push_back(choice<&C::mapping>({"rc_mapping", "", "of a cache's hemisphere to its texels: all of one solid angle, or an octahedron's", "ours"},
                                       {"equal_area", "octahedral"}));
    rows.push_back(
        choice<&C::horizon>({"rc_horizon", "", "diffuse light from below a cache's horizon: as the mean above it, or none", "ours"}, {"renormalise", "black"}));
    rows.push_back(
        choice<&C::lobe>({"rc_lobe", "", "solid angle of a specular lobe: of a uniform one with its peak, or where it falls to 1 %", "[C] Sec. 3.3: cutoff"},
                         {"equivalent", "cutoff"}));
    rows.push_back(choice<&C::scoreScale>(
        {"rc_score_scale", "", "lengths in the placement's score over the cluster's diagonal, or in metres", "ours; [C] Sec. 3.2: metre"},
        {"cluster", "metre"}));
    rows.push_back(choice<&C::storage>({"rc_storage", "", "caches in half or in float32", "[C]: none given"}, {"gpu", "float32"}));
    rows.push_back(choice<&C::halfRounding>({"rc_half_rounding", "", "as rsm_half_rounding", "D3D11.3 spec 3.2.2: d3d"}, {"d3d", "nearest_even"}));
}

/// [P]: "Voxelized Point Proxies" with a visibility filter, 2014; [ISM]: Ritschel et al., "Imperfect Shadow Maps", SIGGRAPH Asia 2008.
void addProxyRows(std::vector<SettingRow>& rows)
{
    rows.push_back(choice<&Vpl::singularity>(
        {"vpl_singularity", "", "a virtual light near by: area / (d^2 + r^2), exact on its disc's axis; area / d^2 up to vpl_clamp; or area / d^2", "ours"},
        {"disc", "clamp", "none"}));
    rows.push_back(real<&Vpl::clamp>({"vpl_clamp", "", "vpl_singularity=clamp: most of area cos cos' / d^2", "ours"}, above(0, 1000)));
    rows.push_back(choice<&Vpl::lobe>({"vpl_lobe", "", "specular weight of a light: Eq. 7, a Gaussian of 1 - cos^n; or cos^n itself", "[P] Eq. 7: gaussian"},
                                      {"gaussian", "phong"}));
    rows.push_back(real<&Vpl::sigma>({"vpl_sigma", "", "vpl_lobe=gaussian: sigma of Eq. 7", "ours; [P] gives none"}, above(0, 10)));

    rows.push_back(
        whole<&P::count>({"pp_count", "proxies", "points that stand for the scene's surfaces, in proportion to area", "[P] Sec. 4: 24k, 170k"}, {1, 1 << 22}));
    rows.push_back(choice<&P::hash>(
        {"pp_hash", "", "what decides the fraction of a triangle's proxies: its place, or its number (steady where it moves)", "[P] Sec. 3.1: position"},
        {"position", "index"}));
    rows.push_back(real<&P::radius>(
        {"pp_radius", "", "radius of the disc that stops rays, over that of a disc as large as the surface a proxy stands for", "ours; [P] gives none"},
        above(0, 8)));
    rows.push_back(whole<&P::grid>({"pp_grid", "cells", "along the longest side of the scene's reach", "[P] Sec. 4: 6, 20"}, {1, 256}));
    rows.push_back(whole<&P::rays>({"pp_rays", "", "shadow rays a marched pixel", "ours; [P] gives none"}, {1, 256}));
    rows.push_back(whole<&P::lobeRays>({"pp_lobe_rays", "", "more of them within the specular lobe, where there is one", "ours; [P] gives none"}, {0, 256}));
    rows.push_back(whole<&P::marchDivisor>({"pp_march_divisor", "pixels", "edge of the blocks of which one pixel sends shadow rays", "[P] Sec. 4: 8, 4"},
                                           powersOfTwo(1, 16)));
    rows.push_back(whole<&P::gatherDivisor>(
        {"pp_gather_divisor", "pixels", "edge of the blocks of which one pixel is gathered for; the others are joint bilaterally upsampled", "[P] Sec. 4: 2"},
        powersOfTwo(1, 8)));
    rows.push_back(whole<&P::filterRadius>(
        {"pp_filter_radius", "marched pixels", "m = n of Eq. 4, the visibility filter: 3 for a window of 7x7; 0: none", "[P] Sec. 4: 3"}, {0, 8}));
    rows.push_back(choice<&P::filterTest>({"pp_filter_test", "",
                                           "whose lists of the window a block takes: all of like depth and normal; or those of its own surface, joined to it "
                                           "within the window and near by what its rays meet",
                                           "ours; [P] Eq. 4: printed"},
                                          {"printed", "surface"}));
    rows.push_back(
        choice<&P::cellWeight>({"pp_cell_weight", "",
                                "a listed cell counts by the part of it that is seen, the rays that met it over those that would were it all seen; or "
                                "as it is",
                                "ours; [P] Eq. 5: one"},
                               {"seen", "one"}));
    rows.push_back(real<&P::range>(
        {"pp_range", "cell diagonals", "R of Eq. 6: nearer cells shine proxy by proxy, farther ones by their spherical harmonics", "ours; [P] gives none"},
        {0, 1e6f}));
    rows.push_back(choice<&P::lobeNorm>({"pp_lobe_norm", "",
                                         "a specular sum over the weights of the proxies that a pixel sees ([P]'s effective number), times the part of the "
                                         "lobe that meets any; or over the whole lobe",
                                         "[P] Sec. 3.3: visible"},
                                        {"visible", "lobe"}));
    rows.push_back(choice<&P::storage>({"pp_storage", "", "radiance of proxies in half or in float32", "[P]: none given"}, {"gpu", "float32"}));
    rows.push_back(choice<&P::halfRounding>({"pp_half_rounding", "", "as rsm_half_rounding", "D3D11.3 spec 3.2.2: d3d"}, {"d3d", "nearest_even"}));

    rows.push_back(whole<&Ism::lights>({"ism_lights", "lights", "virtual lights drawn from the reflective shadow maps", "[P] Sec. 4: 4096"}, {1, 65536}));
    rows.push_back(whole<&Ism::resolution>({"ism_resolution", "texels", "edge of a virtual light's depth map", "[P] Sec. 4: 64"}, powersOfTwo(8, 256)));
    rows.push_back(
        whole<&Ism::points>({"ism_points", "points", "drawn into each map, a window of the pp_count proxies of its own", "[P] Sec. 4: 8192"}, {1, 1 << 20}));
    rows.push_back(choice<&Ism::sampling>({"ism_sampling", "", "lights by the flux of the maps' texels, or evenly over the texels", "[ISM]: importance"},
                                          {"importance", "uniform"}));
    rows.push_back(choice<&Ism::fill>(
        {"ism_fill", "", "holes between points: by pull and push as far as each point's disc reaches; by drawing discs; or left open", "[ISM]: pull_push"},
        {"pull_push", "splat", "none"}));
    rows.push_back(real<&Ism::bias>({"ism_bias", "diagonals of the reach", "a receiver so much behind a map's depth is still lit", "ours"}, {0, 1}));
    rows.push_back(flag<&Ism::interleave>(
        {"ism_interleave", "", "each pixel of a block of 4x4 takes a 16th of the lights, and the geometry-aware filter averages them", "[ISM]: true"}));
    rows.push_back(choice<&Ism::storage>({"ism_storage", "", "depth of the maps in UNORM16 or in float32", "[ISM]: gpu"}, {"gpu", "float32"}));
}

void addForceRows(std::vector<SettingRow>& rows)
{
    rows.push_back(
        flag<&F::everything>({"force_everything", "", "run every pass and branch that the scene analysis would leave out (changes no bit)", "ours"}));
}

void addShorthands(std::vector<SettingRow>& rows)
{
    rows.push_back(shorthand(
        choice<&V::storage>(
            {"storage", "", "the storage of voxels, maps, layers, radiance volumes, caches, proxies and imperfect maps at once", "paper Table 1: gpu"},
            {"gpu", "float32"}),
        [](Settings& settings, double value) {
            settings.voxel.storage = settings.rsm.storage = settings.layers.storage = settings.vct.storage = settings.caches.storage =
                settings.proxies.storage = settings.ism.storage = static_cast<Storage>(value);
        }));
    rows.push_back(
        shorthand(choice<&L::halfRounding>(
                      {"half_rounding", "", "rsm_half_rounding, layer_half_rounding, vct_half_rounding, rc_half_rounding and pp_half_rounding at once",
                       "D3D11.3 spec 3.2.2: d3d"},
                      {"d3d", "nearest_even"}),
                  [](Settings& settings, double value) {
                      settings.rsm.halfRounding = settings.layers.halfRounding = settings.vct.halfRounding = settings.caches.halfRounding =
                          settings.proxies.halfRounding = static_cast<HalfRounding>(value);
                  }));
}

}  // namespace

std::span<const SettingRow> settingRows()
{
    static const std::vector<SettingRow> table = [] {
        std::vector<SettingRow> rows = {methodRow()};
        addBuildingRows(rows);
        addConeRows(rows);
        addLookupRows(rows);
        addCacheRows(rows);
        addProxyRows(rows);
        addForceRows(rows);
        addShorthands(rows);
        return rows;
    }();
    return table;
}

}  // namespace lrsm
