#include "apps/capture/capture_files.h"
#include "apps/capture/manifest_write.h"
#include "apps/capture/map_buffers.h"
#include "apps/capture/picture_buffers.h"
#include "apps/capture/scene_buffers.h"
#include "apps/capture/voxel_buffers.h"
#include "conetrace/frame/composite.h"
#include "conetrace/frame/direct.h"
#include "conetrace/frame/irradiance_filter.h"
#include "conetrace/frame/smooth_irradiance.h"
#include "conetrace/render.h"
#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "core/scene/scene_hash.h"
#include "tests/apps/capture/capture_fixture.h"
#include "voxel/voxelize.h"

#include "catch.h"
#include "scratch.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

using namespace lrsm;
using namespace lrsm::test;

namespace {

namespace fs = std::filesystem;

/// " 0": as in "rsm 0".
std::string spaced(std::size_t light)
{
    std::string text(1, ' ');
    return text.append(std::to_string(light));
}

/// The settings that change what buffers look like.
struct Variant {
    std::string scene, name;
    Settings settings;
};
std::vector<Variant> variants()
{
    Settings plain = smallSettings();
    Settings paper = smallSettings();
    paper.voxel.axes = OpacityAxes::isotropic;
    paper.cones.march.estimator = Estimator::paper;
    paper.cones.gather.gaussian = GaussianMethod::table;
    paper.cones.gather.gaussianTableSize = 64;
    paper.cones.set.rotation = Rotation::none;
    paper.cones.set.filter = false;
    paper.layers.overlap = 0.1f;
    paper.cones.gather.layerSelection = LayerSelection::centre;
    paper.direct.shadows = Shadows::cone;
    paper.force.everything = true;
    Settings wide = smallSettings();
    wide.cones.set.filterPasses = 2;
    wide.voxel.storage = wide.rsm.storage = wide.layers.storage = Storage::float32;
    wide.layers.dropEmpty = false;
    wide.cones.set.setsPerPixel = 2;
    wide.force.everything = true;
    return {{"cornell-box", "plain", plain}, {"two-rooms", "paper", paper}, {"atrium", "float32", wide}};
}

}  // namespace

TEST_CASE("capture: through files and back every pass has the hash that the frame reports", "[capture][roundtrip]")
{
    const Variant variant = GENERATE(from_range(variants()));
    CAPTURE(variant.name);
    const Recording r = record(variant.scene, variant.settings);
    std::map<std::string, std::string> expected = renderedHashes(r);
    CHECK(hashesOf(r.capture) == expected);

    const ScratchFolder scratch;
    const Capture capture = writtenAndRead(r.capture, scratch);
    CHECK(capture.settings == r.settings);
    CHECK(capture.sceneHash == hashScene(r.scene));
    CHECK(hashOf(bitsFromCapture(capture)) == expected["voxelize"]);
    CHECK(hashOf(opacityFromCapture(capture)) == expected["voxel mips"]);
    for (std::size_t light = 0; light < r.scene.lights.size(); ++light) {
        const std::string number = spaced(light);
        CHECK(hashOf(rsmFromCapture(capture, light)) == expected["rsm" + number]);
        CHECK(hashOf(lrsmFromCapture(capture, light)) == expected["lrsm" + number]);
    }
    CHECK(hashOf(gbufferFromCapture(capture)) == expected["gbuffer"]);
    CHECK(hashOf(pictureFromCapture(capture, "direct.radiance")) == expected["direct"]);
    CHECK(hashOf(gatheredFromCapture(capture)) == expected["cones"]);
    if (r.settings.cones.set.filter) CHECK(hashOf(filteredFromCapture(capture)) == expected["filter"]);
    if (r.settings.cones.set.smoothingPasses() > 0) CHECK(hashOf(irradianceFromCapture(capture)) == expected["smooth"]);
    CHECK(hashOf(pictureFromCapture(capture, "composite.combined")) == expected["composite"]);
    CHECK(manifestJson(capture).dump() == manifestJson(r.capture).dump());
}

TEST_CASE("capture: each pass run anew on the captured output of the ones before gives its captured output", "[capture][rerun]")
{
    const Variant variant = GENERATE(from_range(variants()));
    CAPTURE(variant.name);
    const Recording r = record(variant.scene, variant.settings);
    const Capture& c = r.capture;
    const std::map<std::string, std::string> expected = hashesOf(c);
    const Scene scene = sceneFromCapture(c);
    REQUIRE(c.sceneComplete);

    CHECK(hashOf(voxelize(scene, c.settings.voxel)) == expected.at("voxelize"));
    CHECK(hashOf(buildPyramid(bitsFromCapture(c), c.settings.voxel)) == expected.at("voxel mips"));
    const OpacityPyramid opacity = opacityFromCapture(c);
    std::vector<Rsm> rsms;
    std::vector<Lrsm> lrsms;
    for (std::size_t light = 0; light < c.lights.size(); ++light) {
        const std::string number = spaced(light);
        CHECK(hashOf(renderRsm(scene, scene.lights[light], c.needs, c.settings.rsm)) == expected.at("rsm" + number));
        rsms.push_back(rsmFromCapture(c, light));
        CHECK(hashOf(buildLrsm(rsms.back(), c.settings.layers)) == expected.at("lrsm" + number));
        lrsms.push_back(lrsmFromCapture(c, light));
    }
    CHECK(hashOf(renderGBuffer(scene, c.camera, c.needs, {c.width, c.height})) == expected.at("gbuffer"));
    const GBuffer gbuffer = gbufferFromCapture(c);
    const std::vector<DepthMapView> depths(rsms.begin(), rsms.end());
    CHECK(hashOf(traceDirect(gbuffer, scene, c.camera, depths, &opacity, c.needs, c.settings.direct).radiance) == expected.at("direct"));
    CHECK(hashOf(traceCones(gbuffer, c.camera, opacity, lrsms, c.needs, c.settings.cones)) == expected.at("cones"));
    const Gathered gathered = gatheredFromCapture(c);
    if (c.settings.cones.set.filter) CHECK(hashOf(filterIrradiance(gathered.irradiance, gbuffer)) == expected.at("filter"));
    if (const int passes = c.settings.cones.set.smoothingPasses(); passes > 0)
        CHECK(hashOf(smoothIrradiance(filteredFromCapture(c), gbuffer, passes)) == expected.at("smooth"));
    const IndirectLight indirect = shadeIndirect(gbuffer, c.camera, irradianceFromCapture(c), specularFromCapture(c));
    CHECK(hashOf(composite(pictureFromCapture(c, "direct.radiance"), indirect)) == expected.at("composite"));
}

TEST_CASE("capture: the single cones, weighted and added in their order, are the irradiance and the opacity", "[capture][cones]")
{
    Settings settings = smallSettings();
    settings.cones.set.setsPerPixel = 4;
    settings.cones.set.count = 9;
    const Recording r = record("cornell-box", settings);
    const auto cones = r.capture.at("cones.diffuse").as<Vec4>();
    const auto irradiance = r.capture.at("cones.irradiance").as<Vec3>();
    const auto opacity = r.capture.at("cones.opacity").as<float>();
    const nlohmann::ordered_json rings = manifestJson(r.capture)["cones"]["rings"];
    REQUIRE(cones.size() == 4 * 9 * irradiance.size());
    for (std::size_t pixel = 0; pixel < irradiance.size(); ++pixel) {
        Vec4 sum(0.0f);
        std::size_t cone = 0;
        for (int set = 0; set < 4; ++set)
            for (const auto& ring : rings)
                for (int k = 0; k < ring["count"].get<int>(); ++k) sum += ring["weight"].get<float>() * cones[cone++ * irradiance.size() + pixel];
        REQUIRE(Vec3(sum) * (kPi * 0.25f) == irradiance[pixel]);
        REQUIRE(sum.w * 0.25f == opacity[pixel]);
    }
}

TEST_CASE("capture: the same bytes for any number of threads", "[capture][threads]")
{
    Settings settings = smallSettings();
    settings.force.everything = true;
    const auto recordWith = [&](int threads) {
        const ThreadLimit limit(threads);
        return record("cornell-box", settings).capture;
    };
    const Capture one = recordWith(1), three = recordWith(3);
    CHECK(manifestJson(one).dump() == manifestJson(three).dump());
    REQUIRE(one.buffers.size() == three.buffers.size());
    for (std::size_t i = 0; i < one.buffers.size(); ++i) CHECK(one.buffers[i].bytes == three.buffers[i].bytes);
}

TEST_CASE("capture: voxel.bits, voxel.bricks and the grid agree", "[capture][voxels]")
{
    Settings settings = smallSettings();
    settings.voxel.resolution = GENERATE(1, 2, 4, 8, 32);
    const Recording r = record("cornell-box", settings);
    const int n = settings.voxel.resolution;
    const BitGrid grid = voxelize(r.scene, settings.voxel);
    const Buffer &bits = r.capture.at("voxel.bits"), &bricks = r.capture.at("voxel.bricks");
    std::uint64_t set = 0;
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const std::size_t byte = (std::size_t(z) * std::size_t(n) + std::size_t(y)) * bits.shape[2] + std::size_t(x / 8);
                const bool occupied = grid.occupied(x, y, z);
                REQUIRE(((bits.as<std::uint8_t>()[byte] >> (x % 8)) & 1) == occupied);
                const std::size_t edge = bricks.shape[0], brick = (std::size_t(z / 4) * edge + std::size_t(y / 4)) * edge + std::size_t(x / 4);
                REQUIRE(((bricks.as<std::uint64_t>()[brick] >> (x % 4 + 4 * (y % 4) + 16 * (z % 4))) & 1) == occupied);
                set += occupied;
            }
    CHECK(set == grid.countOccupied());
    CHECK(bitsFromCapture(r.capture).bricks == grid.bricks);
}

TEST_CASE("capture: mips that do not follow from the bits are taken as they are", "[capture][voxels]")
{
    Recording r = record("cornell-box", smallSettings());
    for (Buffer& buffer : r.capture.buffers)
        if (buffer.name == "voxel.mip1") std::fill(buffer.bytes.begin(), buffer.bytes.end(), std::byte{255});
    const OpacityPyramid opacity = opacityFromCapture(r.capture);
    const Vec3 everywhere = sampleLevel(opacity, Vec3(16.0f), 1, FilterFraction::exact);
    CHECK(everywhere == Vec3(0.5f));  // the sampler must not take the middle of the box for known to be empty
}

/// A buffer as its texture holds it: the first channels of each texel; of voxels a texel each.
static std::vector<std::byte> bytesIn(const DdsTexture& texture, const Buffer& buffer)
{
    std::vector<std::byte> bytes(buffer.bytes.size());
    const bool bits = buffer.encoding == Encoding::bits;
    const std::size_t stride = bytesPerTexel(texture.format), own = sizeOf(buffer.dtype) * std::max<std::size_t>(buffer.components.size(), 1);
    std::size_t i = 0;
    for (std::uint32_t layer = 0; layer < texture.layers; ++layer) {
        const std::span<const std::byte> level = texture.level(layer, buffer.dds->mip);
        for (std::size_t at = 0; at < level.size(); at += stride, ++i)
            if (bits)
                bytes[i / 8] |= std::byte(level[at] == std::byte{255} ? 1u << i % 8 : 0u);
            else
                std::copy_n(level.begin() + std::ptrdiff_t(at), own, bytes.begin() + std::ptrdiff_t(i * own));
    }
    return bytes;
}

TEST_CASE("capture: DDS hold the buffers' very values", "[capture][dds]")
{
    const Variant variant = GENERATE(from_range(variants()));
    CAPTURE(variant.name);
    const Capture capture = record(variant.scene, variant.settings).capture;
    std::size_t compared = 0;
    for (NamedTexture& texture : texturesOf(capture.buffers)) {
        fillTexture(texture, capture.buffers);
        const DdsTexture read = decodeDds(encodeDds(texture.texture), texture.file);
        for (const Buffer& buffer : capture.buffers) {
            if (!buffer.dds || buffer.dds->file != texture.file) continue;
            CHECK(bytesIn(read, buffer) == buffer.bytes);
            ++compared;
        }
    }
    CHECK(compared > 20);
}

TEST_CASE("capture: isotropic voxels are one R8 volume with all mips, bits as 0 and 255", "[capture][dds]")
{
    Settings settings = smallSettings();
    settings.voxel.axes = OpacityAxes::isotropic;
    const Capture capture = record("cornell-box", settings).capture;
    std::vector<NamedTexture> textures = texturesOf(capture.buffers);
    const auto voxels = std::find_if(textures.begin(), textures.end(), [](const NamedTexture& t) { return t.file == "voxel.dds"; });
    REQUIRE(voxels != textures.end());
    fillTexture(*voxels, capture.buffers);
    CHECK((voxels->texture.volume && voxels->texture.mips == 6 && voxels->texture.format == DxgiFormat::R8_UNORM));
    const auto base = voxels->texture.level(0, 0);
    for (const std::byte value : base) REQUIRE((value == std::byte{0} || value == std::byte{255}));
    const BitGrid grid = bitsFromCapture(capture);
    CHECK(std::uint64_t(std::count(base.begin(), base.end(), std::byte{255})) == grid.countOccupied());
}

TEST_CASE("capture: predicted bytes are those written", "[capture][memory]")
{
    const Variant variant = GENERATE(from_range(variants()));
    RecordOptions options;
    options.dds = GENERATE(true, false);
    const Recording r = record(variant.scene, variant.settings, options);
    std::vector<int> layers;
    for (const CapturedLight& light : r.capture.lights) layers.push_back(static_cast<int>(light.storedRanges().size()));
    const ScratchFolder scratch;
    writtenAndRead(r.capture, scratch);
    std::uintmax_t written = 0;
    bool anyDds = false;
    for (const auto& entry : fs::directory_iterator(scratch.path("capture"))) {
        if (entry.path().filename() != kManifestFile) written += entry.file_size();
        anyDds = anyDds || entry.path().extension() == ".dds";
    }
    CHECK(predictCaptureBytes(chosenBuffers(r.scene, r.needs, r.settings, r.options, layers)) == written);
    CHECK(anyDds == options.dds);
}

TEST_CASE("capture: only the passes asked for", "[capture][only]")
{
    RecordOptions options;
    options.only = {"lrsm", "voxel-mips"};
    const Capture capture = record("cornell-box", smallSettings(), options).capture;
    for (const Buffer& buffer : capture.buffers) {
        CAPTURE(buffer.name);
        CHECK((buffer.pass == "scene" || buffer.pass == "tables" || buffer.pass == "lrsm 0" || buffer.pass == "voxel mips"));
        CHECK(buffer.bytes.size() == buffer.elements() * sizeOf(buffer.dtype));
    }
    CHECK(capture.find("lrsm0.depth.mip0"));
    CHECK(capture.passes.size() == 9);
    options.only = {"lrsn"};
    CHECK_THROWS_AS(record("cornell-box", smallSettings(), options), InputError);
}

TEST_CASE("capture: inputs of a pass come before it, and every buffer belongs to a pass", "[capture][manifest]")
{
    const Capture capture = record("two-rooms", smallSettings()).capture;
    std::vector<std::string> known = {"scene", "tables"};
    for (const CapturedPass& pass : capture.passes) {
        for (const std::string& input : pass.inputs) {
            CAPTURE(pass.name, input);
            CHECK(std::find(known.begin(), known.end(), input) != known.end());
        }
        known.push_back(pass.name);
    }
    for (const Buffer& buffer : capture.buffers) {
        CAPTURE(buffer.name);
        CHECK(std::find(known.begin(), known.end(), buffer.pass) != known.end());
        CHECK_FALSE(buffer.meaning.empty());
        CHECK_FALSE(buffer.tolerance.reason.empty());
        CHECK(buffer.axes.size() == buffer.shape.size());
    }
}
