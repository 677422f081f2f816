#include "apps/capture/caches_buffers.h"

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

struct CachesVariant {
    std::string scene, name;
    Settings settings;
};

std::vector<CachesVariant> cachesVariants()
{
    const auto small = [](const std::string& name, int tile) {
        Settings s = preset(name);
        s.voxel.resolution = 32;
        s.rsm.resolution = 64;
        s.caches.tile = tile;
        s.caches.resolution = 4;
        s.direct.shadows = Shadows::hard;
        return s;
    };
    Settings wide = small("caches", 4);
    wide.caches.maxCaches = 40;  // tiles double
    wide.caches.mapping = CacheMapping::octahedral;
    wide.caches.storage = Storage::float32;
    wide.cones.set.rotation = Rotation::strata;
    wide.cones.set.filter = true;
    wide.force.everything = true;
    Settings vct = small("caches", 16);
    vct.caches.fill = CacheFill::vct;
    return {{"cornell-glossy", "caches", small("caches", 8)},
            {"cornell-box", "vct", vct},
            {"two-rooms", "caches-paper", small("caches-paper", 16)},
            {"atrium", "wide", wide}};
}

}  // namespace

TEST_CASE("caches buffers: through files and back every pass has the hash that the frame reports, and runs anew to the same bits", "[capture][caches]")
{
    const CachesVariant variant = GENERATE(from_range(cachesVariants()));
    CAPTURE(variant.name);
    const Recording r = record(variant.scene, variant.settings);
    std::map<std::string, std::string> expected = renderedHashes(r);
    CHECK(hashesOf(r.capture) == expected);

    const ScratchFolder scratch;
    const Capture capture = writtenAndRead(r.capture, scratch);
    const PixelClusters clusters = clustersFromCapture(capture);
    CHECK(clusters.tile >= variant.settings.caches.tile);
    CHECK((clusters.tile > variant.settings.caches.tile) == (variant.name == "wide"));
    CHECK(hashOf(clusters) == expected["rc clusters"]);
    CHECK(hashOf(placesFromCapture(capture)) == expected["rc places"]);
    if (expected.contains("rc mips")) {
        IsotropicVolume volume = isotropicFromCapture(capture);
        CHECK(hashOf(volume) == expected["rc mips"]);
        volume.levels.resize(1);
        CHECK(hashOf(volume) == expected["rc light"]);
    }
    CHECK(hashOf(filledFromCapture(capture)) == expected["rc fill"]);
    CHECK(hashOf(atlasFromCapture(capture)) == expected["rc convolve"]);
    CHECK(hashOf(gatheredFromCapture(capture)) == expected["rc gather"]);
    checkRunsAnew(capture);
}

TEST_CASE("caches buffers: lists that point outside are refused in one line", "[capture][caches]")
{
    const Recording r = record("cornell-box", cachesVariants().front().settings);
    const std::string name = GENERATE("rc.pixels", "rc.first", "rc.tile_first", "rc.cluster", "rc.pixel", "rc.rotation");
    CAPTURE(name);
    Capture broken = r.capture;
    for (Buffer& buffer : broken.buffers)
        if (buffer.name == name) reinterpret_cast<std::uint32_t*>(buffer.bytes.data())[buffer.elements() / 2] = 0x7fffffff;
    const Rerun gather = rerunPass(broken, "rc gather");
    CHECK(gather.outputs.empty());
    CHECK(gather.why.find(name) != std::string::npos);
}
