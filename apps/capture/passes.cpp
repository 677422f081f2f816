#include "apps/capture/passes.h"

#include "apps/capture/caches_buffers.h"
#include "apps/capture/map_buffers.h"
#include "apps/capture/picture_buffers.h"
#include "apps/capture/proxy_buffers.h"
#include "apps/capture/scene_buffers.h"
#include "apps/capture/tables.h"
#include "apps/capture/vct_buffers.h"
#include "apps/capture/voxel_buffers.h"
#include "conetrace/vct/inject.h"

#include <algorithm>
#include <iterator>

namespace lrsm {

namespace {

using Families = std::vector<std::string>;

template <class T>
void keep(const PassOutput& output, std::size_t, Capture& capture)
{
    if (const T* made = output.as<T>()) toBuffers(*made, capture.buffers);
}

constexpr char kDirect[] = "direct.radiance", kFilter[] = "filter.irradiance", kSmooth[] = "smooth.irradiance", kSpecularFilter[] = "filter.specular";
template <const char* name>
void keepPicture(const PassOutput& output, std::size_t, Capture& capture)
{
    if (const auto* made = output.as<Image<Vec3>>()) toBuffers(*made, name, capture.buffers);
}

void keepBits(const PassOutput& output, std::size_t light, Capture& capture)
{
    if (const auto* bits = output.as<BitGrid>()) capture.grid = bits->grid;
    keep<BitGrid>(output, light, capture);
}

void keepRsm(const PassOutput& output, std::size_t light, Capture& capture)
{
    const auto* rsm = output.as<Rsm>();
    if (!rsm) return;
    CapturedLight& to = capture.lights.at(light);
    to.projection = rsm->projection;
    to.partition = partition(*rsm, capture.settings.layers);
    to.stored.assign(to.partition.size(), -1);
    toBuffers(*rsm, light, capture.buffers);
}

void keepShadow(const PassOutput& output, std::size_t light, Capture& capture)
{
    if (const auto* map = output.as<DepthMap>()) toBuffers(*map, light, capture.buffers);
}

void keepLrsm(const PassOutput& output, std::size_t light, Capture& capture)
{
    const auto* lrsm = output.as<Lrsm>();
    if (!lrsm) return;
    // Which of the partition's layers it holds: they come in the same order.
    CapturedLight& to = capture.lights.at(light);
    to.validTexels = lrsm->validTexelsPerLayer;
    int next = 0;
    for (std::size_t i = 0; i < to.partition.size(); ++i)
        if (next < lrsm->layers() && lrsm->ranges[static_cast<std::size_t>(next)] == to.partition[i]) to.stored[i] = next++;
    // How many layers there are is known only now: the buffers were described with all of them.
    const auto own = [&](const Buffer& b) { return passFamily(b.pass) == "lrsm" && lightOfPass(b.pass) == light; };
    if (lrsm->layers() == 0) std::erase_if(capture.buffers, own);
    for (Buffer& buffer : capture.buffers)
        if (own(buffer)) buffer.shape[0] = static_cast<std::size_t>(lrsm->layers());
    toBuffers(*lrsm, light, capture.buffers);
}

void keepCones(const PassOutput& output, std::size_t light, Capture& capture)
{
    keep<Gathered>(output, light, capture);
    keep<ConeRecord>(output, light, capture);
}

void keepComposite(const Frame& frame, Capture& capture)
{
    toBuffers(frame.indirectDiffuse, "composite.diffuse", capture.buffers);
    toBuffers(frame.indirectSpecular, "composite.specular", capture.buffers);
    toBuffers(frame.combined, "composite.combined", capture.buffers);
}

void keepVctBase(const PassOutput& output, std::size_t, Capture& capture)
{
    if (const auto* volume = output.as<RadianceVolume>()) baseToBuffers(*volume, capture.buffers);
}

void keepVctMips(const PassOutput& output, std::size_t, Capture& capture)
{
    if (const auto* volume = output.as<RadianceVolume>()) mipsToBuffers(*volume, capture.buffers);
}

/// What has a size of its own.
template <class T>
void keepShaped(const PassOutput& output, std::size_t, Capture& capture)
{
    const auto* made = output.as<T>();
    if (!made) return;
    shapeBuffers(*made, capture.buffers);
    toBuffers(*made, capture.buffers);
}

void keepLit(const PassOutput& output, std::size_t, Capture& capture)
{
    if (const auto* volume = output.as<IsotropicVolume>()) litToBuffers(*volume, capture.buffers);
}

void keepPrefiltered(const PassOutput& output, std::size_t, Capture& capture)
{
    if (const auto* volume = output.as<IsotropicVolume>()) prefilteredToBuffers(*volume, capture.buffers);
}

void keepFilled(const PassOutput& output, std::size_t, Capture& capture)
{
    if (const auto* atlas = output.as<CacheAtlas>()) filledToBuffers(*atlas, capture.buffers);
}

void keepConvolved(const PassOutput& output, std::size_t, Capture& capture)
{
    if (const auto* atlas = output.as<CacheAtlas>()) convolvedToBuffers(*atlas, capture.buffers);
}

void keepCachedLight(const PassOutput& output, std::size_t, Capture& capture)
{
    if (const auto* gathered = output.as<Gathered>()) cachedLightToBuffers(*gathered, capture.buffers);
}

template <const char* name>
void keepLists(const PassOutput& output, std::size_t, Capture& capture)
{
    const auto* lists = output.as<VisibilityLists>();
    if (!lists) return;
    shapeBuffers(*lists, name, capture.buffers);
    toBuffers(*lists, name, capture.buffers);
}

void keepWeighed(const PassOutput& output, std::size_t, Capture& capture)
{
    if (const auto* seen = output.as<WeighedProxies>()) toBuffers(*seen, capture.buffers);
}

void keepListed(const PassOutput& output, std::size_t, Capture& capture)
{
    if (const auto* gathered = output.as<Gathered>()) cachedLightToBuffers(*gathered, capture.buffers);
}

// What of the passes a frame has.
bool ofLrsm(const Settings& settings)
{
    return settings.method == Method::lrsm;
}
bool ofVct(const Settings& settings)
{
    return settings.method == Method::vct;
}
bool ofCaches(const Settings& settings)
{
    return settings.method == Method::caches;
}
bool ofProxies(const Settings& settings)
{
    return settings.method == Method::proxies;
}
bool ofIsm(const Settings& settings)
{
    return settings.method == Method::ism;
}
bool placesProxies(const Settings& settings)
{
    return ofProxies(settings) || ofIsm(settings);
}
bool filtersLists(const Settings& settings)
{
    return ofProxies(settings) && settings.proxies.filterRadius > 0;
}
bool weighsProxies(const Settings& settings)
{
    return ofProxies(settings) && settings.proxies.cellWeight == ProxyCellWeight::seen;
}
bool fillsCaches(const Settings& settings, CacheFill from)
{
    return ofCaches(settings) && settings.caches.fill == from;
}
bool fromVoxels(const Settings& settings)
{
    return fillsCaches(settings, CacheFill::voxels);
}
bool hasLayers(const Settings& settings)
{
    return ofLrsm(settings) || fillsCaches(settings, CacheFill::lrsm);
}
bool hasVctVolume(const Settings& settings)
{
    return ofVct(settings) || fillsCaches(settings, CacheFill::vct);
}
bool hasVoxelSurface(const Settings& settings)
{
    return fromVoxels(settings) || (hasVctVolume(settings) && readsSurface(settings.vct));
}
bool readsVoxels(const Settings& settings)
{
    return !placesProxies(settings) || settings.direct.shadows == Shadows::cone;
}
bool readsVoxelMips(const Settings& settings)
{
    return hasLayers(settings) || settings.direct.shadows == Shadows::cone || (fromVoxels(settings) && settings.caches.shadow == CacheShadow::cone);
}
bool comparesShadows(const Settings& settings)
{
    return hasShadowMaps(settings.direct);
}
bool filters(const Settings& settings)
{
    return filtersIrradiance(settings);
}
bool smooths(const Settings& settings)
{
    return filters(settings) && settings.cones.set.smoothingPasses() > 0;
}

Families readForShadows(const Settings& settings)
{
    if (hasShadowMaps(settings.direct)) return {"shadow"};
    if (readsDepthMaps(settings.direct)) return {"rsm"};
    if (settings.direct.shadows == Shadows::exact) return {"scene"};
    if (settings.direct.shadows == Shadows::cone) return {"voxelize", "voxel mips"};
    return {};
}

Families readForFill(const Settings& settings)
{
    switch (settings.caches.fill) {
    case CacheFill::vct: return {"vct inject", "vct mips"};
    case CacheFill::voxels: return {"rc light", "rc mips"};
    case CacheFill::lrsm: break;
    }
    return {"voxelize", "voxel mips", "lrsm"};
}

Families readForVoxelShadows(const Settings& settings)
{
    return settings.caches.shadow == CacheShadow::cone ? Families{"voxel mips"} : Families{"rsm"};
}

const std::vector<std::string> kReceivers = {"gbuffer.position", "gbuffer.geometric_normal", "gbuffer.normal", "gbuffer.object_id"};

// clang-format off
const std::vector<PassRow> kRows = {
    {.family = "scene", .given = true, .describe = describeScene},
    {.family = "tables", .given = true, .describe = describeTables},
    {.family = "voxelize", .stages = {"voxel"}, .exists = readsVoxels, .reads = {"scene"},
     .describe = describeBits, .record = keepBits, .rerun = rerunVoxelize},
    {.family = "voxel mips", .stages = {"voxel"}, .exists = readsVoxelMips, .reads = {"voxelize"},
     .describe = describeVoxelMips, .record = keep<OpacityPyramid>, .rerun = rerunVoxelMips},
    {.family = "rsm", .perLight = true, .stages = {"rsm"}, .reads = {"scene"},
     .describe = describeRsm, .record = keepRsm, .makeMap = makeRsm,
     .sameTexel = {"rsm#.depth", "rsm#.radiance", "rsm#.normal"}},
    {.family = "shadow", .perLight = true, .stages = {"direct"}, .exists = comparesShadows, .reads = {"scene"},
     .describe = describeShadow, .record = keepShadow, .rerun = rerunShadow},
    {.family = "lrsm", .perLight = true, .stages = {"layers"}, .exists = hasLayers, .reads = {"rsm"},
     .describe = describeLrsm, .record = keepLrsm, .rerun = rerunLrsm, .makeMap = makeLrsmBase},
    {.family = "vct surface", .stages = {"voxel"}, .exists = hasVoxelSurface, .reads = {"scene", "voxelize"},
     .describe = describeVctSurface, .record = keep<PlacedSurface>, .rerun = rerunVctSurface},
    {.family = "vct inject", .stages = {"vct"}, .exists = hasVctVolume, .reads = {"scene", "voxelize", "rsm", "vct surface"},
     .describe = describeVctBase, .record = keepVctBase, .makeMap = makeVctBase},
    {.family = "vct mips", .stages = {"vct"}, .exists = hasVctVolume, .reads = {"vct inject"},
     .describe = describeVctMips, .record = keepVctMips, .rerun = rerunVctMips},
    {.family = "rc light", .stages = {"caches", "direct"}, .exists = fromVoxels, .reads = {"scene", "voxelize", "vct surface"}, .readsBesides = readForVoxelShadows,
     .describe = describeLitVoxels, .record = keepLit, .makeMap = makeLitVoxels},
    {.family = "rc mips", .stages = {"caches"}, .exists = fromVoxels, .reads = {"rc light"},
     .describe = describeVoxelRadiance, .record = keepPrefiltered, .rerun = rerunVoxelRadiance},
    {.family = "gbuffer", .reads = {"scene"},
     .describe = describeGBuffer, .record = keep<GBuffer>, .rerun = rerunGBuffer,
     .sameTexel = {"gbuffer.object_id", "gbuffer.depth", "gbuffer.position", "gbuffer.geometric_normal", "gbuffer.normal", "gbuffer.albedo"}},
    {.family = "direct", .stages = {"direct"}, .reads = {"gbuffer"}, .readsBesides = readForShadows,
     .describe = describeDirect, .record = keepPicture<kDirect>, .rerun = rerunDirect,
     .sameTexel = {"gbuffer.position", "gbuffer.geometric_normal", "gbuffer.normal", "gbuffer.albedo"}},
    {.family = "cones", .stages = {"cones"}, .exists = ofLrsm, .reads = {"tables", "gbuffer", "voxelize", "voxel mips", "lrsm"},
     .describe = describeCones, .record = keepCones, .rerun = rerunCones,
     .sameTexel = kReceivers},
    {.family = "vct cones", .stages = {"cones", "vct"}, .exists = ofVct, .reads = {"tables", "gbuffer", "vct inject", "vct mips"},
     .describe = describeCones, .record = keepCones, .rerun = rerunVctCones,
     .sameTexel = kReceivers},
    {.family = "rc clusters", .stages = {"caches"}, .exists = ofCaches, .reads = {"gbuffer"},
     .describe = describeClusters, .record = keepShaped<PixelClusters>, .rerun = rerunClusters},
    {.family = "rc places", .stages = {"caches"}, .exists = ofCaches, .reads = {"gbuffer", "rc clusters"},
     .describe = describePlaces, .record = keepShaped<CachePlaces>, .rerun = rerunPlaces},
    {.family = "rc fill", .stages = {"cones", "caches", "vct"}, .exists = ofCaches, .reads = {"tables", "rc places"}, .readsBesides = readForFill,
     .describe = describeFill, .record = keepFilled, .rerun = rerunFill},
    {.family = "rc convolve", .stages = {"caches"}, .exists = ofCaches, .reads = {"tables", "rc fill"},
     .describe = describeConvolved, .record = keepConvolved, .rerun = rerunConvolve},
    {.family = "rc gather", .stages = {"caches"}, .exists = ofCaches, .reads = {"gbuffer", "rc clusters", "rc places", "rc fill", "rc convolve"},
     .describe = describeCachedLight, .record = keepCachedLight, .rerun = rerunCachedLight,
     .sameTexel = kReceivers},
    {.family = "pp place", .stages = {"proxies"}, .exists = placesProxies, .reads = {"scene"},
     .describe = describeProxies, .record = keepShaped<PointProxies>, .rerun = rerunProxies},
    {.family = "pp light", .stages = {"proxies"}, .exists = ofProxies, .reads = {"scene", "rsm", "pp place"},
     .describe = describeProxyLight, .record = keepShaped<ProxyLight>, .rerun = rerunProxyLight},
    {.family = "pp cells", .stages = {"proxies"}, .exists = ofProxies, .reads = {"scene", "pp place", "pp light"},
     .describe = describeProxyCells, .record = keepShaped<ProxyCells>, .rerun = rerunProxyCells},
    {.family = "pp march", .stages = {"proxies"}, .exists = ofProxies, .reads = {"tables", "scene", "gbuffer", "pp cells"},
     .describe = describeMarched, .record = keepLists<kMarched>, .rerun = rerunProxyMarch},
    {.family = "pp filter", .stages = {"proxies"}, .exists = filtersLists, .reads = {"scene", "gbuffer", "pp cells", "pp march"},
     .describe = describeFiltered, .record = keepLists<kFilteredLists>, .rerun = rerunProxyFilter},
    {.family = "pp weigh", .stages = {"proxies"}, .exists = weighsProxies, .reads = {"scene", "pp cells", "pp march"},
     .describe = describeWeighed, .record = keepWeighed, .rerun = rerunWeighProxies},
    {.family = "pp gather", .stages = {"proxies", "vpl"}, .exists = ofProxies, .reads = {"scene", "gbuffer", "pp cells", "pp march", "pp filter", "pp weigh"},
     .describe = describeListed, .record = keepListed, .rerun = rerunProxyGather},
    {.family = "ism lights", .stages = {"ism"}, .exists = ofIsm, .reads = {"rsm"},
     .describe = describeVirtualLights, .record = keepShaped<VirtualLights>, .rerun = rerunIsmLights},
    {.family = "ism maps", .stages = {"ism", "proxies"}, .exists = ofIsm, .reads = {"scene", "pp place", "ism lights"},
     .describe = describeImperfectMaps, .record = keepShaped<ImperfectMaps>, .rerun = rerunIsmMaps},
    {.family = "ism gather", .stages = {"ism", "vpl"}, .exists = ofIsm, .reads = {"scene", "gbuffer", "ism lights", "ism maps"},
     .describe = describeListed, .record = keepListed, .rerun = rerunIsmGather},
    {.family = "filter", .exists = filters, .reads = {"gbuffer", "cones", "vct cones", "rc gather", "ism gather"},
     .describe = describeFilter, .record = keepPicture<kFilter>, .rerun = rerunFilter,
     .sameTexel = {"cones.irradiance", "gbuffer.position", "gbuffer.geometric_normal", "gbuffer.normal"}},
    {.family = "specular filter", .specular = true, .exists = filtersLobes, .reads = {"gbuffer", "cones", "vct cones"},
     .describe = describeSpecularFilter, .record = keepPicture<kSpecularFilter>, .rerun = rerunSpecularFilter,
     .sameTexel = {"cones.specular", "cones.lobe_weight", "gbuffer.position", "gbuffer.geometric_normal", "gbuffer.normal", "gbuffer.roughness"}},
    {.family = "smooth", .exists = smooths, .reads = {"gbuffer", "cones", "vct cones", "rc gather", "ism gather", "filter"},
     .describe = describeSmooth, .record = keepPicture<kSmooth>, .rerun = rerunSmooth},
    {.family = "composite", .reads = {"tables", "gbuffer", "direct", "cones", "vct cones", "rc gather", "pp gather", "ism gather", "filter", "specular filter", "smooth"},
     .describe = describeComposite, .recordFrame = keepComposite, .rerun = rerunComposite,
     .sameTexel = {"gbuffer.albedo", "smooth.irradiance", "filter.irradiance", "cones.irradiance", "filter.specular", "cones.specular", "direct.radiance", "composite.diffuse",
                   "composite.specular"}},
};
// clang-format on

std::string passName(const PassRow& row, std::size_t light)
{
    return row.perLight ? row.family + " " + std::to_string(light) : row.family;
}

/// "lrsm 0" and "lrsm0" are one pass, "voxel-mips" is "voxel mips".
std::string plain(std::string pass)
{
    std::erase_if(pass, [](char letter) { return letter == ' ' || letter == '-' || letter == '_'; });
    return pass;
}

}  // namespace

const std::vector<PassRow>& passRows()
{
    return kRows;
}

const PassRow* findPassRow(const std::string& pass)
{
    const std::string family = passFamily(pass);
    const auto found = std::find_if(passRows().begin(), passRows().end(), [&](const PassRow& row) { return row.family == family; });
    return found == passRows().end() ? nullptr : &*found;
}

bool existsIn(const PassRow& row, const Settings& settings, const Requirements& needs)
{
    return (needs.specular || !row.specular) && (!row.exists || row.exists(settings));
}

bool isGiven(const std::string& pass)
{
    const PassRow* row = findPassRow(pass);
    return row && row->given;
}

std::size_t lightOfPass(const std::string& pass)
{
    const std::size_t family = passFamily(pass).size();
    return family == pass.size() ? 0 : static_cast<std::size_t>(std::strtoul(pass.c_str() + family, nullptr, 10));
}

HalfRounding halfRoundingOf(const Settings& settings, const std::string& pass)
{
    const std::string family = passFamily(pass);
    return family == "rsm"             ? settings.rsm.halfRounding
           : family.starts_with("vct") ? settings.vct.halfRounding
           : family.starts_with("rc")  ? settings.caches.halfRounding
           : family.starts_with("pp")  ? settings.proxies.halfRounding
                                       : settings.layers.halfRounding;
}

std::vector<std::string> inputsOf(const std::string& pass, const Settings& settings, const Requirements& needs, std::size_t lights)
{
    std::vector<std::string> inputs;
    const PassRow* row = findPassRow(pass);
    if (!row) return inputs;
    Families families = row->reads;
    if (row->readsBesides) std::ranges::copy(row->readsBesides(settings), std::back_inserter(families));
    for (const std::string& family : families) {
        const PassRow* input = findPassRow(family);
        if (input && !existsIn(*input, settings, needs)) continue;
        const bool all = input && input->perLight && !row->perLight;
        for (std::size_t light = 0; light < (all ? lights : 1); ++light) inputs.push_back(input ? passName(*input, all ? light : lightOfPass(pass)) : family);
    }
    return inputs;
}

bool isAskedFor(const std::vector<std::string>& asked, const std::string& pass)
{
    return asked.empty() || std::any_of(asked.begin(), asked.end(),
                                        [&](const std::string& each) { return plain(each) == plain(pass) || plain(each) == plain(passFamily(pass)); });
}

std::string passNames(const std::string& ofLights)
{
    std::string text;
    const std::vector<PassRow>& rows = passRows();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].given) continue;
        std::string name = rows[i].family;
        std::replace(name.begin(), name.end(), ' ', '-');
        const bool lastOfLights = rows[i].perLight && (i + 1 == rows.size() || !rows[i + 1].perLight);
        text += (text.empty() ? "" : ", ") + name + (lastOfLights ? ofLights : "");
    }
    return text;
}

std::string passNameError(const std::string& asked)
{
    const std::vector<PassRow>& rows = passRows();
    const std::string family = plain(passFamily(asked));
    const bool known = std::any_of(rows.begin(), rows.end(), [&](const PassRow& row) {
        return !row.given && (plain(row.family) == plain(asked) || (row.perLight && plain(row.family) == family));
    });
    return known ? "" : "\"" + asked + "\" is no pass; they are " + passNames(" (of all lights; rsm0 of one)");
}

std::vector<Buffer> describeBuffers(const DescribedFrame& frame)
{
    Catalogue out;
    const auto describe = [&](const PassRow& row, std::size_t light) {
        if (!existsIn(row, frame.settings, frame.needs)) return;
        out.pass = passName(row, light);
        row.describe(out, frame, light);
    };
    for (auto row = passRows().begin(); row != passRows().end();) {
        const auto end = std::find_if(row, passRows().end(), [&](const PassRow& other) { return other.perLight != row->perLight; });
        for (std::size_t light = 0; light < (row->perLight ? frame.layersStored.size() : 1); ++light)
            for (auto each = row; each != end; ++each) describe(*each, light);
        row = end;
    }
    return std::move(out.buffers);
}

}  // namespace lrsm
