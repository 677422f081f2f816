#include "apps/capture/vct_buffers.h"

#include "apps/capture/picture_buffers.h"
#include "apps/capture/rerun.h"
#include "apps/capture/voxel_buffers.h"
#include "conetrace/render.h"
#include "core/settings/settings_table.h"
#include "tests/apps/capture/capture_fixture.h"
#include "voxel/radiance/sample_radiance.h"

#include "catch.h"

#include <algorithm>
#include <map>

using namespace lrsm;
using namespace lrsm::test;

namespace {

struct VctVariant {
    std::string scene, name;
    Settings settings;
};

std::vector<VctVariant> vctVariants()
{
    const auto small = [](const std::string& name, int resolution) {
        Settings s = preset(name);
        s.voxel.resolution = resolution;
        s.rsm.resolution = 64;
        s.direct.shadows = Shadows::hard;
        return s;
    };
    Settings area = small("vct", 16);
    area.vct.injection = Injection::rsm;
    area.vct.injectionWeight = InjectionWeight::area;
    area.vct.storage = area.rsm.storage = Storage::float32;
    area.cones.set.setsPerPixel = 2;
    area.force.everything = true;
    return {{"cornell-box", "vct", small("vct", 32)}, {"two-rooms", "vct-paper", small("vct-paper", 8)}, {"atrium", "area", area}};
}

}  // namespace

TEST_CASE("vct buffers: through files and back every pass has the hash that the frame reports, and runs anew to the same bits", "[capture][vct]")
{
    const VctVariant variant = GENERATE(from_range(vctVariants()));
    CAPTURE(variant.name);
    const Recording r = record(variant.scene, variant.settings);
    std::map<std::string, std::string> expected = renderedHashes(r);
    CHECK(hashesOf(r.capture) == expected);

    const ScratchFolder scratch;
    const Capture capture = writtenAndRead(r.capture, scratch);
    const BitGrid bits = bitsFromCapture(capture);
    if (expected.contains("vct surface")) CHECK(hashOf(surfaceFromCapture(capture, bits)) == expected["vct surface"]);
    RadianceVolume volume = radianceFromCapture(capture);
    CHECK(hashOf(volume) == expected["vct mips"]);
    volume.faces.clear();
    CHECK(hashOf(volume) == expected["vct inject"]);
    CHECK(hashOf(gatheredFromCapture(capture)) == expected["vct cones"]);
    checkRunsAnew(capture);
}

TEST_CASE("vct buffers: a dense texel is the volume's, and lies where its voxel lies", "[capture][vct]")
{
    const VctVariant variant = vctVariants().front();
    const Recording r = record(variant.scene, variant.settings);
    const RadianceVolume volume = radianceFromCapture(r.capture);
    const Buffer &bits = r.capture.at("voxel.bits"), &base = r.capture.at("vct.base"), &mip = r.capture.at("vct.ny.mip1");
    const int n = variant.settings.voxel.resolution;
    std::size_t lit = 0, i = 0;
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x, ++i) {
                REQUIRE(decodedValue(base, 4 * i + 3) == decodedValue(bits, i));
                const Vec4& texel = volume.base[volume.maps[0].texel(x, y, z)];
                REQUIRE(decodedValue(base, 4 * i) == double(texel.x));
                lit += texel.x > 0.0f ? 1 : 0;
            }
    CHECK(lit > 1000);
    const std::size_t at = (std::size_t(3) * std::size_t(n / 2) + 0) * std::size_t(n / 2) + 5;
    CHECK(decodedValue(mip, 4 * at + 3) == double(volume.faces[1][3][volume.maps[1].texel(5, 0, 3)].w));
}

TEST_CASE("vct buffers: mips that do not follow from the base are taken as they are", "[capture][vct]")
{
    Recording r = record("cornell-box", vctVariants().front().settings);
    for (Buffer& buffer : r.capture.buffers)
        if (buffer.name == "vct.px.mip2") {
            const std::uint16_t one = 0x3c00;
            auto* codes = reinterpret_cast<std::uint16_t*>(buffer.bytes.data());
            std::fill(codes, codes + buffer.bytes.size() / 2, one);
        }
    const RadianceVolume volume = radianceFromCapture(r.capture);
    const RadianceLookup lookUp(volume, VctSettings{}, FilterFraction::exact, Vec3(1.0f, 0.0f, 0.0f));
    CHECK(lookUp.atLevel(Vec3(16.0f), 2) == Vec4(1.0f));  // the middle of the box is empty, by the base
}
