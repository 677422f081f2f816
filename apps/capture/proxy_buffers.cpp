#include "apps/capture/proxy_buffers.h"

#include "apps/capture/fill.h"
#include "apps/capture/scene_buffers.h"
#include "apps/capture/tolerances.h"

namespace lrsm {

namespace {

using Names = Catalogue::Names;

constexpr std::size_t kLanes = 4, kQuadRows = sizeof(ProxyQuad) / sizeof(Float4), kLightFloats = sizeof(CellLight) / sizeof(float);
constexpr std::size_t kVirtualFloats = sizeof(VirtualLight) / sizeof(float);

Blocks marchedBlocks(int width, int height, const ProxySettings& settings)
{
    return {width, height, settings.marchDivisor};
}

std::size_t mostQuads(const ProxySettings& settings)
{
    return std::size_t(settings.count) / kLanes + 1;
}

void addLists(Catalogue& out, const DescribedFrame& frame, const std::string& name, const std::string& which)
{
    const Blocks blocks = marchedBlocks(frame.width, frame.height, frame.settings.proxies);
    const std::size_t count = std::size_t(blocks.columns()) * std::size_t(blocks.rows());
    out.add(name + "_first", Dtype::u4, {count + 1}, {"block"}, {}, {"cells of block b, row by row, are cells[first[b]] .. cells[first[b + 1] - 1]", "", ""},
            tolerances::kLists);
    out.add(name + "_cells", Dtype::u4, {count}, {"entry"}, {}, {"hash (Eq. 1) of a cell that " + which + ", rising", "", ""}, tolerances::kLists);
    out.add(name + "_hits", Dtype::u4, {count}, {"entry"}, {}, {"diffuse rays of the list that met the cell", "", ""}, tolerances::kLists);
    out.add(name + "_opacity", Dtype::f4, {count}, {"block"}, {}, {"part of the pixel's own diffuse rays that met a disc", "", ""}, tolerances::kConeOpacity);
    out.add(name + "_lobe_opacity", Dtype::f4, {count}, {"block"}, {}, {"the same of its rays in the specular lobe; 1 where it has none", "", ""},
            tolerances::kConeOpacity);
    out.add(name + "_rays", Dtype::u4, {count}, {"block"}, {}, {"diffuse rays that the list is of", "", ""}, tolerances::kLists);
}

/// UNORM16, or as it is.
void fitDepths(std::vector<Buffer>& buffers, const std::string& name, const std::vector<float>& depths)
{
    const Buffer* buffer = findBuffer(buffers, name);
    if (!buffer) return;
    if (buffer->dtype == Dtype::f4) return fit(buffers, name, depths);
    std::vector<std::uint16_t> codes;
    codes.reserve(depths.size());
    for (const float depth : depths) codes.push_back(unorm16FromFloat(depth));
    fit(buffers, name, codes);
}

/// Half, in which the values are representable, or as it is.
void fitRadiance(std::vector<Buffer>& buffers, const std::string& name, const std::vector<Vec3>& radiance)
{
    const Buffer* buffer = findBuffer(buffers, name);
    if (!buffer) return;
    if (buffer->dtype == Dtype::f4) return fit(buffers, name, radiance);
    std::vector<std::uint16_t> halves;
    halves.reserve(radiance.size() * 3);
    for (const Vec3& value : radiance)
        for (int c = 0; c < 3; ++c) halves.push_back(halfFromFloat(value[c], HalfRounding::nearestEven));
    fit(buffers, name, halves);
}

std::vector<Vec3> radianceFrom(const Capture& capture, const std::string& name)
{
    const Buffer& buffer = capture.at(name);
    if (buffer.dtype == Dtype::f4) return allOf<Vec3>(capture, name, Dtype::f4);
    const auto halves = valuesOf<std::uint16_t>(capture, name, Dtype::f2, buffer.elements());
    std::vector<Vec3> values(halves.size() / 3);
    for (std::size_t i = 0; i < values.size() * 3; ++i) values[i / 3][int(i % 3)] = floatFromHalf(halves[i]);
    return values;
}

}  // namespace

void describeProxies(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const auto count = std::size_t(frame.settings.proxies.count);
    const auto list = [&](const std::string& name, const Names& components, const Catalogue::Text& text) {
        out.add("pp." + name, Dtype::f4, {count}, {"proxy"}, components, text, tolerances::kPoints);
    };
    out.add("pp.area", Dtype::f4, {1}, {"scene"}, {}, {"surface that each proxy stands for", "", "m^2"}, tolerances::kPoints);
    list("position", kXyz, {"of a proxy", kWorldSpace, "m"});
    list("normal", kXyz, {"geometric normal of the triangle's front", kWorldSpace, ""});
    list("shading_normal", kXyz, {"shading normal", kWorldSpace, ""});
    list("albedo", kRgb, {"diffuse albedo", "", ""});
    out.add("pp.double_sided", Dtype::u1, {count}, {"proxy"}, {}, {"1: reflects on both sides", "", ""}, tolerances::kLists);
}

void describeProxyLight(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const auto count = std::size_t(frame.settings.proxies.count);
    out.add("pp.radiance", frame.settings.proxies.storage == Storage::gpu ? Dtype::f2 : Dtype::f4, {count}, {"proxy"}, kRgb,
            {"radiance times pre_exposure, of the side that reflects most", "", kRadianceUnit}, tolerances::kPoints);
    out.add("pp.lit_normal", Dtype::f4, {count}, {"proxy"}, kXyz, {"geometric normal of that side", kWorldSpace, ""}, tolerances::kPoints);
}

void describeProxyCells(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const std::size_t cells = makeCellGrid(extentOf(frame.scene), frame.settings.proxies.grid).count();
    const std::size_t quads = mostQuads(frame.settings.proxies);
    out.add("pp.first", Dtype::u4, {cells + 1}, {"cell"}, {}, {"quads of cell h are quads[first[h]] .. quads[first[h + 1] - 1]", "", ""}, tolerances::kLists);
    out.add("pp.lit_end", Dtype::u4, {cells}, {"cell"}, {}, {"those before lit_end[h] shine", "", ""}, tolerances::kLists);
    out.add("pp.quads", Dtype::f4, {quads, kQuadRows, kLanes}, {"quad", "row", "lane"}, {},
            {"x, y, z; nx, ny, nz; red, green, blue of four proxies; 0 where there is none", kWorldSpace, ""}, tolerances::kPoints);
    out.add("pp.number", Dtype::u4, {quads, kLanes}, {"quad", "lane"}, {}, {"of the proxy, as placed; 2^32 - 1: none", "", ""}, tolerances::kLists);
    out.add(
        "pp.cell_light", Dtype::f4, {cells, kLightFloats}, {"cell", "number"}, {},
        {"mean, along x, y, z (r, g, b, area each), centroid, lit area, greatest radiance: W/sr times pre_exposure, m^2; m; m^2; W/(m^2 sr) times pre_exposure",
         "", ""},
        tolerances::kCellSums);
    out.add("pp.cell_bounds", Dtype::f4, {cells, 6}, {"cell", "number"}, {}, {"least and greatest corner of the cell's discs", kWorldSpace, "m"},
            tolerances::kCellSums);
}

void describeMarched(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    addLists(out, frame, kMarched, "a ray of the block's pixel met");
    if (frame.settings.proxies.cellWeight == ProxyCellWeight::seen)
        out.add(kProxyHits, Dtype::u4, {mostQuads(frame.settings.proxies), kLanes}, {"quad", "lane"}, {},
                {"rays of all blocks that met the proxy, the nearest of its cell", "", ""}, tolerances::kLists);
}

void describeFiltered(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    addLists(out, frame, kFilteredLists, "is in a list of the window (Eq. 4)");
}

void describeWeighed(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const std::size_t cells = makeCellGrid(extentOf(frame.scene), frame.settings.proxies.grid).count();
    out.add(kSeenLight, Dtype::f4, {cells, kLightFloats}, {"cell", "number"}, {}, {"as pp.cell_light, each proxy as often as rays met it", "", ""},
            tolerances::kCellSums);
}

void describeListed(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const int width = frame.width, height = frame.height;
    out.picture("cones.irradiance", width, height, kRgb, {"sum over the cells or virtual lights that the pixel sees", kPicture, kIrradianceUnit},
                tolerances::kListed);
    out.picture("cones.opacity", width, height, {}, {"part of the marched pixels' rays that met a disc; 0 of method=ism", kPicture, ""},
                tolerances::kConeOpacity);
    if (frame.needs.specular)
        out.picture("cones.specular", width, height, {"r", "g", "b", ""}, {"mean radiance over the specular lobe", kPicture, kRadianceUnit},
                    tolerances::kListed);
}

void describeVirtualLights(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    out.add("ism.lights", Dtype::f4, {std::size_t(frame.settings.ism.lights), kVirtualFloats}, {"light", "number"}, {},
            {"position; tangent, bitangent, normal; intensity times pre_exposure; area: m, W/sr, m^2", kWorldSpace, ""}, tolerances::kPoints);
}

void describeImperfectMaps(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const IsmSettings& settings = frame.settings.ism;
    const auto n = std::size_t(settings.resolution);
    const bool unorm = settings.storage == Storage::gpu;
    Buffer& depth = out.add("ism.depth", unorm ? Dtype::u2 : Dtype::f4, {std::size_t(settings.lights), n, n}, {"light", "row", "column"}, {},
                            {"distance over the diagonal of the reach; 1: nothing there", "paraboloid", ""}, tolerances::kMapDepths);
    if (unorm) depth.encoding = Encoding::unorm;
}

void shapeBuffers(const PointProxies& proxies, std::vector<Buffer>& buffers)
{
    for (const char* name : {"pp.position", "pp.normal", "pp.shading_normal", "pp.albedo", "pp.double_sided"}) shape(buffers, name, {proxies.size()});
}

void shapeBuffers(const ProxyLight& light, std::vector<Buffer>& buffers)
{
    for (const char* name : {"pp.radiance", "pp.lit_normal"}) shape(buffers, name, {light.radiance.size()});
}

void shapeBuffers(const ProxyCells& cells, std::vector<Buffer>& buffers)
{
    for (const char* name : {"pp.quads", "pp.number"}) shape(buffers, name, {cells.quads.size()});
}

void shapeBuffers(const VisibilityLists& lists, const std::string& name, std::vector<Buffer>& buffers)
{
    shape(buffers, name + "_cells", {lists.cells.size()});
    shape(buffers, name + "_hits", {lists.hits.size()});
    shape(buffers, name + "_proxy_hits", {lists.proxyHits.size() / kLanes});
}

void shapeBuffers(const VirtualLights& lights, std::vector<Buffer>& buffers)
{
    shape(buffers, "ism.lights", {lights.lights.size()});
}

void shapeBuffers(const ImperfectMaps& maps, std::vector<Buffer>& buffers)
{
    shape(buffers, "ism.depth", {maps.depth.size() / std::max<std::size_t>(1, maps.texels())});
}

void toBuffers(const PointProxies& proxies, std::vector<Buffer>& buffers)
{
    fit(buffers, "pp.area", std::vector<float>{proxies.area});
    fit(buffers, "pp.position", proxies.positions);
    fit(buffers, "pp.normal", proxies.normals);
    fit(buffers, "pp.shading_normal", proxies.shadingNormals);
    fit(buffers, "pp.albedo", proxies.albedos);
    fit(buffers, "pp.double_sided", proxies.doubleSided);
}

void toBuffers(const ProxyLight& light, std::vector<Buffer>& buffers)
{
    fitRadiance(buffers, "pp.radiance", light.radiance);
    fit(buffers, "pp.lit_normal", light.normals);
}

void toBuffers(const ProxyCells& cells, std::vector<Buffer>& buffers)
{
    fit(buffers, "pp.first", cells.first);
    fit(buffers, "pp.lit_end", cells.litEnd);
    fit(buffers, "pp.quads", cells.quads);
    fit(buffers, "pp.number", cells.numbers);
    fit(buffers, "pp.cell_light", cells.lights);
    fit(buffers, "pp.cell_bounds", cells.bounds);
}

void toBuffers(const VisibilityLists& lists, const std::string& name, std::vector<Buffer>& buffers)
{
    fit(buffers, name + "_first", lists.first);
    fit(buffers, name + "_cells", lists.cells);
    fit(buffers, name + "_hits", lists.hits);
    fit(buffers, name + "_opacity", lists.opacity);
    fit(buffers, name + "_lobe_opacity", lists.lobeOpacity);
    fit(buffers, name + "_rays", lists.rays);
    fit(buffers, name + "_proxy_hits", lists.proxyHits);
}

void toBuffers(const WeighedProxies& seen, std::vector<Buffer>& buffers)
{
    fit(buffers, kSeenLight, seen.lights);
}

void toBuffers(const VirtualLights& lights, std::vector<Buffer>& buffers)
{
    fit(buffers, "ism.lights", lights.lights);
}

void toBuffers(const ImperfectMaps& maps, std::vector<Buffer>& buffers)
{
    fitDepths(buffers, "ism.depth", maps.depth);
}

PointProxies proxiesFromCapture(const Capture& capture)
{
    PointProxies proxies;
    proxies.area = allOf<float>(capture, "pp.area", Dtype::f4).at(0);
    proxies.positions = allOf<Vec3>(capture, "pp.position", Dtype::f4);
    const std::size_t count = proxies.size();
    proxies.normals = copyFrom<Vec3>(capture, "pp.normal", Dtype::f4, count);
    proxies.shadingNormals = copyFrom<Vec3>(capture, "pp.shading_normal", Dtype::f4, count);
    proxies.albedos = copyFrom<Vec3>(capture, "pp.albedo", Dtype::f4, count);
    proxies.doubleSided = copyFrom<std::uint8_t>(capture, "pp.double_sided", Dtype::u1, count);
    return proxies;
}

ProxyLight proxyLightFromCapture(const Capture& capture)
{
    ProxyLight light;
    light.preExposure = capture.preExposure;
    light.half = capture.settings.proxies.storage == Storage::gpu;
    light.radiance = radianceFrom(capture, "pp.radiance");
    light.normals = copyFrom<Vec3>(capture, "pp.lit_normal", Dtype::f4, light.radiance.size());
    return light;
}

ProxyCells proxyCellsFromCapture(const Capture& capture)
{
    const ProxySettings& settings = capture.settings.proxies;
    ProxyCells cells;
    cells.grid = makeCellGrid(extentOf(sceneFromCapture(capture)), settings.grid);
    PointProxies one;
    one.area = allOf<float>(capture, "pp.area", Dtype::f4).at(0);
    cells.area = one.area;
    cells.radius = one.radius();
    cells.discRadius = settings.radius * cells.radius;
    cells.preExposure = capture.preExposure;
    cells.half = settings.storage == Storage::gpu;
    const std::size_t count = cells.grid.count();
    cells.first = copyFrom<std::uint32_t>(capture, "pp.first", Dtype::u4, count + 1);
    cells.litEnd = copyFrom<std::uint32_t>(capture, "pp.lit_end", Dtype::u4, count);
    cells.quads = allOf<ProxyQuad>(capture, "pp.quads", Dtype::f4);
    cells.numbers = copyFrom<std::uint32_t>(capture, "pp.number", Dtype::u4, cells.quads.size() * kLanes);
    cells.lights = copyFrom<CellLight>(capture, "pp.cell_light", Dtype::f4, count);
    cells.bounds = copyFrom<Aabb>(capture, "pp.cell_bounds", Dtype::f4, count);
    refuseUnsorted(cells.first, cells.quads.size(), "pp.first");
    refuseBeyond(cells.litEnd, cells.quads.size(), "pp.lit_end");
    return cells;
}

VisibilityLists listsFromCapture(const Capture& capture, const std::string& name, std::size_t cells)
{
    const Blocks blocks = marchedBlocks(capture.width, capture.height, capture.settings.proxies);
    const std::size_t count = std::size_t(blocks.columns()) * std::size_t(blocks.rows());
    VisibilityLists lists;
    lists.divisor = blocks.divisor;
    lists.first = copyFrom<std::uint32_t>(capture, name + "_first", Dtype::u4, count + 1);
    lists.cells = allOf<std::uint32_t>(capture, name + "_cells", Dtype::u4);
    lists.hits = copyFrom<std::uint32_t>(capture, name + "_hits", Dtype::u4, lists.cells.size());
    lists.opacity = copyFrom<float>(capture, name + "_opacity", Dtype::f4, count);
    lists.lobeOpacity = copyFrom<float>(capture, name + "_lobe_opacity", Dtype::f4, count);
    lists.rays = copyFrom<std::uint32_t>(capture, name + "_rays", Dtype::u4, count);
    if (name == kMarched && capture.settings.proxies.cellWeight == ProxyCellWeight::seen)
        lists.proxyHits = allOf<std::uint32_t>(capture, kProxyHits, Dtype::u4);
    refuseUnsorted(lists.first, lists.cells.size(), name + "_first");
    refuseBeyond(lists.cells, cells - 1, name + "_cells");
    return lists;
}

WeighedProxies weighedFromCapture(const Capture& capture, const ProxyCells& cells)
{
    WeighedProxies seen;
    const auto hits = copyFrom<std::uint32_t>(capture, kProxyHits, Dtype::u4, cells.numbers.size());
    seen.counts = countsOf(hits);
    seen.lights = copyFrom<CellLight>(capture, kSeenLight, Dtype::f4, cells.lights.size());
    return seen;
}

VirtualLights virtualLightsFromCapture(const Capture& capture)
{
    VirtualLights lights;
    lights.preExposure = capture.preExposure;
    lights.lights = allOf<VirtualLight>(capture, "ism.lights", Dtype::f4);
    return lights;
}

ImperfectMaps imperfectMapsFromCapture(const Capture& capture)
{
    const IsmSettings& settings = capture.settings.ism;
    ImperfectMaps maps;
    maps.resolution = settings.resolution;
    maps.range = glm::length(extentOf(sceneFromCapture(capture)).extent());
    maps.unorm = settings.storage == Storage::gpu;
    if (maps.unorm)
        for (const std::uint16_t code : allOf<std::uint16_t>(capture, "ism.depth", Dtype::u2)) maps.depth.push_back(floatFromUnorm16(code));
    else
        maps.depth = allOf<float>(capture, "ism.depth", Dtype::f4);
    return maps;
}

}  // namespace lrsm
