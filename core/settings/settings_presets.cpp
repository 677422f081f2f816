#include "core/base/text.h"
#include "core/settings/settings_table.h"

#include "core/base/errors.h"

#include <sstream>

namespace lrsm {

namespace {

/// The paper word for word; where it gives no number, the mildest one.
Settings literal()
{
    Settings s;
    s.voxel = {.resolution = 256, .mode = Voxelization::raster, .mipFilter = MipFilter::mean, .axes = OpacityAxes::isotropic};
    s.layers = {.depthLayers = 2, .normalLayers = 2, .overlap = 0.1f, .fitRanges = false, .outermostDecay = true};
    s.direct.shadows = Shadows::cone;
    ConeSettings& c = s.cones;
    c.march.estimator = Estimator::paper;
    c.set.apertureScale = 1.0f;
    c.march.startVoxels = 1.5f;
    c.march.step = 0.5f;
    c.set.rotation = Rotation::none;
    c.set.filter = false;
    c.march.push = 0.0f;
    c.march.opacity = OpacityModel::none;
    c.march.transmittance = TransmittanceModel::exponential;
    c.march.voxelLevelBias = 0.0f;
    c.gather.layerSelection = LayerSelection::centre;
    c.gather.backface = Backface::cosine;
    c.gather.vRadiusScale = 1.0f;
    c.gather.gaussian = GaussianMethod::table;
    c.specular.direction = SpecularDirection::mirror;
    c.specular.aperture = SpecularAperture::fixed;
    c.specular.apertureDegrees = 10.0f;
    return s;
}

/// Algorithm 1 and Eq. 1, 5 to 15 as printed, and what the paper leaves open chosen by measurement over six scenes (docs/accuracy.md, "The paper's own"):
/// narrow cones turned from pixel to pixel in place of six of 60 degrees, that do not block themselves; a depth window of Eq. 12 that cones of this width meet;
/// opacity as a density.
Settings paper()
{
    Settings s = literal();
    s.voxel.resolution = 512;
    s.layers = {.depthLayers = 2, .normalLayers = 2, .overlap = 0.0f, .fitRanges = true, .outermostDecay = false};
    s.direct.shadowConeApertureDegrees = 0.5f;  // about the sun's; wider ones shine through walls of isotropic voxels
    ConeSettings& c = s.cones;
    c.set.apertureScale = 0.18f;
    c.set.rotation = Rotation::strata;
    c.set.filter = true;
    c.march.minDiameterVoxels = 2.0f;
    c.march.push = 0.75f;
    c.march.opacity = OpacityModel::density;
    c.march.densityK = 3.0f;
    c.march.voxelLevelBias = -1.5f;
    c.gather.layerSelection = LayerSelection::touched;
    c.gather.backface = Backface::step;
    c.gather.vRadiusScale = 2.25f;
    return s;
}

/// Half the cones, and half the resolution of voxels and light along an edge; fewer start voxels keep the cones' start near the same length.
/// The wide cones leak less when they read the voxels half a level finer.
Settings fast()
{
    Settings s;
    s.voxel.resolution = 256;
    s.rsm.resolution = 512;
    s.cones.set.count = 3;
    s.cones.march.startVoxels = 2.0f;
    s.cones.march.voxelLevelBias = -2.5f;
    return s;
}

Settings balanced()
{
    return {};
}

/// Sixteen cones through the default's voxels. They leave less to smooth, and gain nothing from shorter steps.
Settings fine()
{
    Settings s;
    s.cones.set.count = 16;
    s.cones.march.step = 0.5f;
    s.cones.set.filterPasses = 1;
    return s;
}

/// The default's cones through radiance in voxels. Voxels are lit at a point of theirs: the mean over a part-lit voxel's RSM texels would widen what is lit.
Settings vct()
{
    Settings s;
    s.method = Method::vct;
    s.voxel.resolution = 256;
    s.cones.march.step = 0.5f;
    s.vct.injection = Injection::voxel;
    return s;
}

/// As the paper compares itself with: six cones of 60 degrees and a dense grid, what is open as [CNS*11] and its followers have it.
Settings vctPaper()
{
    Settings s = vct();
    s.vct.injection = Injection::rsm;
    s.direct.shadows = Shadows::cone;
    ConeSettings& c = s.cones;
    c.set.apertureScale = 1.0f;
    c.set.rotation = Rotation::none;
    c.set.filter = false;
    c.march.startVoxels = 1.5f;
    c.march.transmittance = TransmittanceModel::exponential;
    c.march.voxelLevelBias = 0.0f;
    c.specular.direction = SpecularDirection::mirror;
    c.specular.aperture = SpecularAperture::fixed;
    c.specular.apertureDegrees = 10.0f;
    return s;
}

/// Radiance caches filled by the LRSM's cones.
Settings caches()
{
    Settings s;
    s.method = Method::caches;
    s.cones.set.apertureScale = 1.0f;
    s.cones.set.rotation = Rotation::none;
    s.cones.set.filter = false;
    return s;
}

/// As the caches' paper has them: lit voxels of 128^3, isotropic, tiles for about 4096 caches at two million pixels, all caches within two of them. It gives no
/// offset: a plane's voxels reach a voxel above it, and a trilinear lookup half of one further.
Settings cachesPaper()
{
    Settings s = caches();
    s.voxel.resolution = 128;
    s.cones.march.normalOffsetVoxels = 1.5f;
    s.cones.march.transmittance = TransmittanceModel::exponential;
    s.vct.opacity = StepOpacity::none;
    s.caches.fill = CacheFill::voxels;
    s.caches.tile = 64;
    s.caches.radius = 2.0f;
    s.caches.minCosine = -1.0f;
    s.caches.lobe = CacheLobe::cutoff;
    s.caches.scoreScale = CacheScoreScale::metre;
    return s;
}

/// Point proxies whose lists of seen cells are filtered.
Settings proxies()
{
    Settings s;
    s.method = Method::proxies;
    return s;
}

/// As the proxies' paper has its Cornell box, marched for every eighth pixel; what it says nothing of as in `proxies`, but a range that leaves far cells to
/// their harmonics.
Settings proxiesPaper()
{
    Settings s = proxies();
    s.proxies.count = 24000;
    s.proxies.grid = 6;
    s.proxies.marchDivisor = 8;
    s.proxies.radius = 2.0f;
    s.proxies.filterRadius = 3;
    s.proxies.filterTest = ProxyFilterTest::printed;
    s.proxies.cellWeight = ProxyCellWeight::one;
    s.proxies.range = 2.0f;
    return s;
}

/// Imperfect shadow maps as the proxies' paper compares itself with. Discs reach less far than those that stop rays: more would close what is open.
Settings ism()
{
    Settings s;
    s.method = Method::ism;
    s.proxies.count = 65536;
    s.proxies.radius = 1.5f;
    return s;
}

/// Sixteen rays a pixel through the triangles, each with a narrow lookup: no voxels, but a BVH.
Settings rays()
{
    Settings s;
    s.cones.march.visibility = Visibility::rays;
    s.cones.set.count = 16;
    s.cones.set.apertureScale = 0.0625f;
    return s;
}

/// Twice as many rays, which read maps of four times the texels at half the width. They leave less to smooth.
Settings accurate()
{
    Settings s = rays();
    s.rsm.resolution = 2048;
    s.cones.set.count = 32;
    s.cones.set.apertureScale = 0.03f;
    s.cones.set.filterPasses = 1;
    return s;
}

struct Preset {
    PresetInfo info;
    Settings (*make)();
};

std::vector<Preset> presets()
{
    return {{{"literal", "the paper word for word; far too dark, kept as the yardstick"}, literal},
            {{"paper", "the paper's equations and six cones, what it leaves open chosen by measurement, 512^3 voxels"}, paper},
            {{"fast", "three cones, 256^3 voxels, RSM of 512^2"}, fast},
            {{"balanced", "the default: six cones, 512^3 voxels with directional opacity"}, balanced},
            {{"fine", "16 cones, 512^3 voxels"}, fine},
            {{"accurate", "32 rays, RSM of 2048^2"}, accurate},
            {{"rays", "16 rays a pixel through the triangles, light from the LRSM where they hit"}, rays},
            {{"vct", "voxel cone tracing with the default's cones, 256^3 voxels"}, vct},
            {{"vct-paper", "voxel cone tracing as the paper compares itself with, 256^3 voxels"}, vctPaper},
            {{"caches", "clustered radiance caches, filled by the LRSM"}, caches},
            {{"caches-paper", "caches as their paper fills, places and shares them, 128^3 voxels"}, cachesPaper},
            {{"proxies", "point proxies in cells, seen by sparse shadow rays and a visibility filter"}, proxies},
            {{"proxies-paper", "proxies, cells and pictures' sizes as their paper has them for its Cornell box"}, proxiesPaper},
            {{"ism", "imperfect shadow maps: 4096 virtual lights, maps of 64^2 from 8192 points each"}, ism}};
}

}  // namespace

std::vector<PresetInfo> presetInfos()
{
    std::vector<PresetInfo> infos;
    for (const Preset& preset : presets()) infos.push_back(preset.info);
    return infos;
}

std::vector<std::string> presetNames()
{
    std::vector<std::string> names;
    for (const Preset& preset : presets()) names.push_back(preset.info.name);
    return names;
}

Settings preset(const std::string& name)
{
    for (const Preset& preset : presets())
        if (preset.info.name == name) return preset.make();
    throw InputError("preset \"" + name + "\"", "there is none of this name; the presets are " + joined(presetNames()));
}

std::string settingsMarkdown()
{
    // A | inside a table cell must be escaped.
    const auto cell = [](std::string text) {
        for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
        return text;
    };
    std::ostringstream out;
    out << "# Settings\n\nMade by `lrsm settings --markdown`; a test holds it against the program. Use them as `--set key=value`, or as a flat JSON\n"
           "object in a file for `--settings` (a `frame.json` serves too). Later ones win; what is not named keeps the preset's value.\n";
    std::string stage;
    for (const SettingInfo& info : describeSettings()) {
        if (info.stage != stage) {
            stage = info.stage;
            out << "\n## " << stage << "\n\n| key | balanced | allowed | unit | meaning | source |\n| --- | --- | --- | --- | --- | --- |\n";
        }
        out << "| `" << info.key << "` | " << info.defaultValue << " | " << cell(info.allowed) << " | " << info.unit << " | " << cell(info.meaning) << " | "
            << cell(info.source) << " |\n";
    }
    out << "\n## Presets\n\nWhat each changes against `balanced`.\n";
    for (const Preset& preset : presets()) {
        out << "\n**" << preset.info.name << "**: " << preset.info.summary << ".\n";
        const auto changes = differences(balanced(), preset.make());
        if (!changes.empty()) out << "\n";
        for (const SettingDifference& change : changes) out << "- `" << change.key << " = " << change.b << "` (" << change.a << ")\n";
    }
    return out.str();
}

}  // namespace lrsm
