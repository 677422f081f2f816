#include "apps/capture/passes.h"
#include "tests/apps/capture/capture_fixture.h"

#include "catch.h"

#include <algorithm>

using namespace lrsm;
using namespace lrsm::test;

TEST_CASE("passes: every pass of a frame has a row, which records what it describes, and runs anew what it records", "[capture][passes]")
{
    Settings settings = smallSettings();
    settings.method = GENERATE(Method::lrsm, Method::vct, Method::caches, Method::proxies, Method::ism);
    settings.vct.injection = Injection::voxel;
    settings.proxies = {.count = 2000, .grid = 6, .rays = 16, .gatherDivisor = 1};
    settings.ism = {.lights = 64, .resolution = 16, .points = 500};
    settings.force.everything = true;
    settings.direct.shadows = GENERATE(Shadows::exact, Shadows::hard, Shadows::cone);
    settings.direct.shadowResolution = 2;
    settings.cones.set.filterPasses = 1;
    const Recording r = record("two-rooms", settings);
    std::vector<std::string> families;
    for (const CapturedPass& pass : r.capture.passes) {
        CAPTURE(pass.name);
        const PassRow* row = findPassRow(pass.name);
        REQUIRE(row);
        families.push_back(row->family);
        CHECK_FALSE(row->given);
        CHECK(row->perLight == (row->family != pass.name));
        CHECK_FALSE(pass.inputs.empty());
        const auto own = [&](const Buffer& buffer) { return buffer.pass == pass.name; };
        CHECK(std::any_of(r.capture.buffers.begin(), r.capture.buffers.end(), own));
        CHECK_FALSE(rerunPass(r.capture, pass.name).outputs.empty());
    }
    for (const PassRow& row : passRows()) {
        CAPTURE(row.family);
        const bool ran = std::find(families.begin(), families.end(), row.family) != families.end();
        CHECK(ran == (!row.given && existsIn(row, settings, r.capture.needs)));
    }
    for (const Buffer& buffer : r.capture.buffers) {
        CAPTURE(buffer.name);
        CHECK(findPassRow(buffer.pass));
        CHECK(buffer.bytes.size() == buffer.elements() * sizeOf(buffer.dtype));
        CHECK_FALSE(buffer.bytes.empty());
    }
}

TEST_CASE("passes: one without a row is captured by its hash alone", "[capture][passes]")
{
    CHECK_FALSE(findPassRow("invented 0"));
    CHECK(inputsOf("invented 0", smallSettings(), {}, 1).empty());
    CHECK(rerunPass(sharedGolden(), "invented 0").outputs.empty());
}

TEST_CASE("passes: are asked for by family, by light, and as a command line spells them", "[capture][passes]")
{
    CHECK(isAskedFor({}, "gbuffer"));
    CHECK(isAskedFor({"rsm"}, "rsm 1"));
    CHECK_FALSE(isAskedFor({"rsm"}, "lrsm 1"));
    CHECK(isAskedFor({"direct", "lrsm1"}, "lrsm 1"));
    CHECK_FALSE(isAskedFor({"lrsm1"}, "lrsm 10"));
    CHECK(isAskedFor({"voxel-mips"}, "voxel mips"));
    CHECK_FALSE(isAskedFor({"voxel"}, "voxel mips"));
    CHECK(passNames("!") ==
          "voxelize, voxel-mips, rsm, shadow, lrsm!, vct-surface, vct-inject, vct-mips, rc-light, rc-mips, gbuffer, direct, cones, vct-cones, rc-clusters, "
          "rc-places, rc-fill, "
          "rc-convolve, rc-gather, pp-place, pp-light, pp-cells, pp-march, pp-filter, pp-weigh, pp-gather, ism-lights, ism-maps, ism-gather, filter, "
          "specular-filter, "
          "smooth, composite");
}
