#include "apps/capture/proxy_buffers.h"

#include "apps/capture/picture_buffers.h"
#include "apps/capture/rerun.h"
#include "conetrace/render.h"
#include "core/settings/settings_table.h"
#include "tests/apps/capture/capture_fixture.h"

#include "catch.h"

#include <map>

using namespace lrsm;
using namespace lrsm::test;

namespace {

Settings smallProxyCapture(const std::string& name)
{
    Settings s = preset(name);
    s.rsm.resolution = 64;
    s.direct.shadows = Shadows::hard;
    s.proxies.count = 2000;
    s.proxies.grid = 6;
    s.proxies.rays = 16;
    s.proxies.gatherDivisor = 1;
    s.ism.lights = 64;
    s.ism.resolution = 16;
    s.ism.points = 500;
    return s;
}

}  // namespace

TEST_CASE("proxy buffers: through files and back every pass has the hash that the frame reports, and runs anew to the same bits", "[capture][proxies]")
{
    Settings settings = smallProxyCapture("proxies");
    const bool other = GENERATE(false, true);
    if (other) {
        settings.proxies.storage = Storage::float32;
        settings.proxies.filterRadius = 0;
        settings.proxies.lobeNorm = ProxyLobeNorm::lobe;
        settings.force.everything = true;
    }
    const Recording r = record(other ? "two-rooms" : "cornell-glossy", settings);
    std::map<std::string, std::string> expected = renderedHashes(r);
    CHECK(hashesOf(r.capture) == expected);

    const ScratchFolder scratch;
    const Capture capture = writtenAndRead(r.capture, scratch);
    CHECK(hashOf(proxiesFromCapture(capture)) == expected["pp place"]);
    CHECK(hashOf(proxyLightFromCapture(capture)) == expected["pp light"]);
    const ProxyCells cells = proxyCellsFromCapture(capture);
    CHECK(hashOf(cells) == expected["pp cells"]);
    CHECK(hashOf(listsFromCapture(capture, kMarched, cells.grid.count())) == expected["pp march"]);
    if (!other) CHECK(hashOf(listsFromCapture(capture, kFilteredLists, cells.grid.count())) == expected["pp filter"]);
    CHECK(hashOf(weighedFromCapture(capture, cells)) == expected["pp weigh"]);
    CHECK(hashOf(gatheredFromCapture(capture)) == expected["pp gather"]);
    checkRunsAnew(capture);
}

TEST_CASE("ism buffers: the same", "[capture][ism]")
{
    Settings settings = smallProxyCapture("ism");
    if (GENERATE(false, true)) settings.ism.storage = Storage::float32;
    const Recording r = record("cornell-glossy", settings);
    std::map<std::string, std::string> expected = renderedHashes(r);
    CHECK(hashesOf(r.capture) == expected);

    const ScratchFolder scratch;
    const Capture capture = writtenAndRead(r.capture, scratch);
    CHECK(hashOf(virtualLightsFromCapture(capture)) == expected["ism lights"]);
    CHECK(hashOf(imperfectMapsFromCapture(capture)) == expected["ism maps"]);
    CHECK(hashOf(gatheredFromCapture(capture)) == expected["ism gather"]);
    checkRunsAnew(capture);
}

TEST_CASE("proxy buffers: lists that point outside are refused in one line", "[capture][proxies]")
{
    const Recording r = record("cornell-box", smallProxyCapture("proxies"));
    const std::string name = GENERATE("pp.first", "pp.lit_end", "pp.filter_first", "pp.filter_cells");
    CAPTURE(name);
    Capture broken = r.capture;
    for (Buffer& buffer : broken.buffers)
        if (buffer.name == name) reinterpret_cast<std::uint32_t*>(buffer.bytes.data())[buffer.elements() / 2] = 0x7fffffff;
    const Rerun gather = rerunPass(broken, "pp gather");
    CHECK(gather.outputs.empty());
    CHECK(gather.why.find(name) != std::string::npos);
}
