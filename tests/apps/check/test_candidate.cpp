#include "apps/capture/capture_files.h"
#include "apps/capture/pictures.h"
#include "apps/check/candidate.h"
#include "apps/check/check.h"
#include "apps/check/check_report.h"
#include "core/base/errors.h"
#include "core/imageio/image_io.h"
#include "tests/apps/capture/capture_fixture.h"

#include "catch.h"
#include "scratch.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

using namespace lrsm;
using namespace lrsm::test;

namespace {

std::string_view viewOf(const std::vector<std::byte>& bytes)
{
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void writeNpy(const ScratchFolder& scratch, const std::string& file, Dtype dtype, const std::vector<std::size_t>& shape, const std::vector<std::byte>& bytes)
{
    scratch.write("c/" + file, viewOf(encodeNpy(dtype, shape, bytes)));
}
void writeNpy(const ScratchFolder& scratch, const Buffer& buffer)
{
    writeNpy(scratch, buffer.name + ".npy", buffer.dtype, buffer.shape, buffer.bytes);
}

template <class T>
std::vector<std::byte> bytesOf(const std::vector<T>& values)
{
    std::vector<std::byte> bytes(values.size() * sizeof(T));
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

std::vector<float> floatsFrom(const Buffer& buffer)
{
    std::vector<float> values;
    for (std::size_t i = 0; i < valueCount(buffer); ++i) values.push_back(static_cast<float>(decodedValue(buffer, i)));
    return values;
}

std::string refusal(const std::function<void()>& action)
{
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

bool mentions(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// All that was found in the folder has the golden's bytes.
void requireSame(const ScratchFolder& scratch, const std::vector<std::string>& names, const CandidateOptions& options = {})
{
    const Candidate candidate = readCandidate(scratch.path("c"), sharedGolden(), options);
    REQUIRE(candidate.buffers.size() == names.size());
    for (const std::string& name : names) {
        CAPTURE(name);
        const CandidateBuffer* found = candidate.find(name);
        REQUIRE(found);
        CHECK(found->buffer.bytes == sharedGolden().at(name).bytes);
    }
    CHECK(checkCandidate(sharedGolden(), candidate).holds());
}

}  // namespace

TEST_CASE("candidate: a whole capture's folder, and the same as DDS alone", "[capture][candidate]")
{
    const ScratchFolder scratch;
    OutputFolder folder(scratch.path("c"));
    writeCapture(folder, sharedGolden());
    folder.commit();
    const Candidate whole = readCandidate(scratch.path("c"), sharedGolden());
    CHECK(whole.buffers.size() == sharedGolden().buffers.size());
    CHECK(whole.notes.empty());

    for (const auto& entry : std::filesystem::directory_iterator(scratch.path("c")))
        if (entry.path().extension() != ".dds") std::filesystem::remove(entry.path());
    const Candidate textures = readCandidate(scratch.path("c"), sharedGolden());
    std::size_t expected = 0;
    for (const Buffer& buffer : sharedGolden().buffers) expected += buffer.dds ? 1 : 0;
    CHECK(textures.buffers.size() == expected);
    for (const CandidateBuffer& found : textures.buffers) {
        CAPTURE(found.buffer.name);
        CHECK(found.buffer.bytes == sharedGolden().at(found.buffer.name).bytes);
    }
    CHECK(checkCandidate(sharedGolden(), textures).holds());
}

TEST_CASE("candidate: npy, raw bytes, EXR layers and DDS side by side", "[capture][candidate]")
{
    const ScratchFolder scratch;
    writeNpy(scratch, sharedGolden().at("lrsm0.depth.mip2"));
    scratch.write("c/lrsm0.normal.mip1.bin", viewOf(sharedGolden().at("lrsm0.normal.mip1").bytes));
    LayeredImage image;
    const auto picture = [&](const std::string& name) {
        const Buffer& b = sharedGolden().at(name);
        Image<Vec3> vectors(int(b.shape[1]), int(b.shape[0]));
        std::memcpy(vectors.texels.data(), b.bytes.data(), b.bytes.size());
        return vectors;
    };
    addLayer(image, "direct.radiance", picture("direct.radiance"));
    addLayer(image, "composite.combined", picture("composite.combined"));
    scratch.write("c/anything.exr", viewOf(encodeExr(image)));
    LayeredImage unnamed;
    addLayer(unnamed, "", picture("gbuffer.albedo"));
    scratch.write("c/gbuffer.albedo.exr", viewOf(encodeExr(unnamed)));
    requireSame(scratch, {"lrsm0.depth.mip2", "lrsm0.normal.mip1", "direct.radiance", "composite.combined", "gbuffer.albedo"});
}

TEST_CASE("candidate: other element types, more channels, one number a voxel", "[capture][candidate]")
{
    const ScratchFolder scratch;
    const Buffer& half = sharedGolden().at("lrsm0.radiance.mip0");
    writeNpy(scratch, half.name + ".npy", Dtype::f4, half.shape, bytesOf(floatsFrom(half)));
    const Buffer& unorm = sharedGolden().at("lrsm0.depth.mip0");
    writeNpy(scratch, unorm.name + ".npy", Dtype::f4, unorm.shape, bytesOf(floatsFrom(unorm)));
    const Buffer& bits = sharedGolden().at("voxel.bits");
    std::vector<std::uint8_t> voxels;
    for (const float v : floatsFrom(bits)) voxels.push_back(v != 0.0f ? 1 : 0);
    const std::size_t n = bits.shape[0];
    writeNpy(scratch, "voxel.bits.npy", Dtype::u1, {n, n, n}, bytesOf(voxels));
    // RGBA where the golden has three components; an extra axis of one; signed ids.
    const Buffer& albedo = sharedGolden().at("gbuffer.albedo");
    std::vector<float> rgba;
    const std::vector<float> rgb = floatsFrom(albedo);
    for (std::size_t i = 0; i < rgb.size(); i += 3) rgba.insert(rgba.end(), {rgb[i], rgb[i + 1], rgb[i + 2], 9.0f});
    writeNpy(scratch, "gbuffer.albedo.npy", Dtype::f4, {1, albedo.shape[0], albedo.shape[1], 4}, bytesOf(rgba));
    std::vector<std::int32_t> ids;
    for (const float v : floatsFrom(sharedGolden().at("gbuffer.object_id"))) ids.push_back(std::int32_t(v));
    writeNpy(scratch, "gbuffer.object_id.npy", Dtype::i4, {albedo.shape[0], albedo.shape[1], 1}, bytesOf(ids));
    requireSame(scratch, {half.name, unorm.name, "voxel.bits", "gbuffer.albedo", "gbuffer.object_id"});
}

TEST_CASE("candidate: NaN and what is out of range is not lost in the conversion to UNORM", "[capture][candidate]")
{
    const ScratchFolder scratch;
    const Buffer& unorm = sharedGolden().at("lrsm0.depth.mip0");
    std::vector<float> values = floatsFrom(unorm);
    const auto zero = static_cast<std::size_t>(std::find(values.begin(), values.end(), 0.0f) - values.begin());
    values[zero] = GENERATE(NAN, -2.0f);
    if (zero % 4 == 3) return;
    writeNpy(scratch, unorm.name + ".npy", Dtype::f4, unorm.shape, bytesOf(values));
    const Candidate candidate = readCandidate(scratch.path("c"), sharedGolden());
    const CheckReport report = checkCandidate(sharedGolden(), candidate);
    CHECK_FALSE(report.holds());
    CHECK(report.firstWrong()->comparison().first->element == zero);
}

TEST_CASE("candidate: the map renames, reorders, flips and rescales", "[capture][candidate]")
{
    const ScratchFolder scratch;
    // Normals as a planar, bottom-up UNORM-like array of 0 .. 1 with channels z, y, x.
    const Buffer& normal = sharedGolden().at("gbuffer.normal");
    const std::size_t h = normal.shape[0], w = normal.shape[1];
    std::vector<float> planar(h * w * 3);
    for (std::size_t y = 0; y < h; ++y)
        for (std::size_t x = 0; x < w; ++x)
            for (std::size_t c = 0; c < 3; ++c) planar[((2 - c) * h + (h - 1 - y)) * w + x] = 0.5f + 0.5f * normal.as<float>()[(y * w + x) * 3 + c];
    writeNpy(scratch, "N.npy", Dtype::f4, {3, h, w}, bytesOf(planar));
    // Layers backwards, one file a mip.
    for (int mip = 0; mip < 3; ++mip) {
        const Buffer& b = sharedGolden().at("lrsm0.radiance.mip" + std::to_string(mip));
        std::vector<std::byte> reversed;
        const std::size_t layer = b.bytes.size() / b.shape[0];
        for (std::size_t l = b.shape[0]; l-- > 0;)
            reversed.insert(reversed.end(), b.bytes.begin() + std::ptrdiff_t(l * layer), b.bytes.begin() + std::ptrdiff_t((l + 1) * layer));
        writeNpy(scratch, "rad_" + std::to_string(mip) + ".npy", b.dtype, b.shape, reversed);
    }
    std::string order;
    for (std::size_t l = sharedGolden().at("lrsm0.radiance.mip0").shape[0]; l-- > 0;) order += (order.empty() ? "" : ", ") + std::to_string(l);
    const std::string map = scratch.write("map.json", R"({
        "gbuffer.normal": {"file": "N.npy", "axes": ["component", "row", "column"], "flip": ["row"], "channels": "bgr", "scale": 2, "offset": -1},
        "lrsm0.radiance.mip*": {"file": "rad_*.npy", "layers": [)" +
                                                          order + R"(]}})");
    CandidateOptions options;
    options.map = map;
    options.passes = {"gbuffer", "lrsm 0"};
    // Mips 3 and higher have no file: the map promised one.
    const Candidate incomplete = readCandidate(scratch.path("c"), sharedGolden(), options);
    REQUIRE(incomplete.findUnreadable("lrsm0.radiance.mip3"));
    CHECK(mentions(incomplete.findUnreadable("lrsm0.radiance.mip3")->why, "rad_3.npy"));
    CHECK(incomplete.find("lrsm0.radiance.mip2"));
    for (std::size_t mip = 3; sharedGolden().find("lrsm0.radiance.mip" + std::to_string(mip)); ++mip) {
        const Buffer& b = sharedGolden().at("lrsm0.radiance.mip" + std::to_string(mip));
        std::vector<std::byte> reversed;
        const std::size_t layer = b.bytes.size() / b.shape[0];
        for (std::size_t l = b.shape[0]; l-- > 0;)
            reversed.insert(reversed.end(), b.bytes.begin() + std::ptrdiff_t(l * layer), b.bytes.begin() + std::ptrdiff_t((l + 1) * layer));
        writeNpy(scratch, "rad_" + std::to_string(mip) + ".npy", b.dtype, b.shape, reversed);
    }
    const Candidate candidate = readCandidate(scratch.path("c"), sharedGolden(), options);
    CHECK(checkCandidate(sharedGolden(), candidate).holds());
    CHECK(candidate.find("lrsm0.radiance.mip2")->buffer.bytes == sharedGolden().at("lrsm0.radiance.mip2").bytes);
}

TEST_CASE("candidate: malformed files and maps are one line that names them", "[capture][candidate]")
{
    const ScratchFolder scratch;
    const Buffer& depth = sharedGolden().at("gbuffer.depth");
    std::filesystem::create_directories(scratch.path("c"));
    const auto refused = [&](const std::string& map = {}) {
        CandidateOptions options;
        options.map = map;
        return refusal([&] {
            const Candidate candidate = readCandidate(scratch.path("c"), sharedGolden(), options);
            if (!candidate.unreadable.empty()) throw InputError(candidate.unreadable.front().why);
        });
    };
    const std::vector<std::byte> good = encodeNpy(depth.dtype, depth.shape, depth.bytes);
    SECTION("no folder")
    {
        CHECK(mentions(refusal([&] { (void)readCandidate(scratch.path("none"), sharedGolden()); }), "none: is no candidate"));
    }
    SECTION("cut off")
    {
        scratch.write("c/gbuffer.depth.npy", viewOf(good).substr(0, good.size() - 3));
        CHECK(mentions(refused(), "gbuffer.depth.npy"));
    }
    SECTION("no npy at all")
    {
        scratch.write("c/gbuffer.depth.npy", "hello");
        CHECK(mentions(refused(), "gbuffer.depth.npy"));
    }
    SECTION("another size")
    {
        writeNpy(scratch, "gbuffer.depth.npy", Dtype::f4, {2, 2}, bytesOf(std::vector<float>(4)));
        CHECK(mentions(refused(), "is (2, 2) where gbuffer.depth is (30, 40)"));
    }
    SECTION("rows and columns exchanged")
    {
        writeNpy(scratch, "gbuffer.depth.npy", Dtype::f4, {depth.shape[1], depth.shape[0]}, depth.bytes);
        CHECK(mentions(refused(), R"(it looks like {"axes": ["column", "row"]})"));
    }
    SECTION("codes of another width")
    {
        const Buffer& b = sharedGolden().at("lrsm0.depth.mip3");
        writeNpy(scratch, "lrsm0.depth.mip3.npy", Dtype::u1, b.shape, std::vector<std::byte>(b.elements()));
        CHECK(mentions(refused(), "holds u1 where lrsm0.depth.mip3 is u2 (unorm)"));
    }
    SECTION("ids that are no whole numbers")
    {
        std::vector<float> ids(depth.elements(), 0.5f);
        writeNpy(scratch, "gbuffer.object_id.npy", Dtype::f4, depth.shape, bytesOf(ids));
        CHECK(mentions(refused(), "whole numbers"));
    }
    SECTION("raw bytes of another length")
    {
        scratch.write("c/gbuffer.depth.bin", "1234");
        CHECK(mentions(refused(), "holds 4 bytes where gbuffer.depth has 4800"));
    }
    SECTION("bad DDS, EXR, manifest")
    {
        const auto file = GENERATE(values<std::string>({"lrsm0.depth.dds", "gbuffer.depth.exr", "manifest.json"}));
        scratch.write("c/" + file, "DDS nonsense");
        CHECK(mentions(refused(), file));
    }
    SECTION("maps")
    {
        writeNpy(scratch, depth);
        struct Case {
            std::string map, message;
        };
        const auto c = GENERATE(values<Case>({
            {"{", "is no JSON"},
            {"[]", "must be an object"},
            {R"({"gbuffer.depth": 3})", "gbuffer.depth: must be a file's name"},
            {R"({"gbuffer.depth": {}})", "has no \"file\""},
            {R"({"gbuffer.depth": {"file": "none.npy"}})", "none.npy"},
            {R"({"gbuffer.depth": {"file": "gbuffer.depth.npy", "flop": []}})", "flop: is no key"},
            {R"({"gbuffer.depth": {"file": "gbuffer.depth.npy", "flip": ["rows"]}})", "has no axis \"rows\""},
            {R"({"gbuffer.depth": {"file": "gbuffer.depth.npy", "flip": 1}})", "must be a list"},
            {R"({"gbuffer.depth": {"file": "gbuffer.depth.npy", "axes": ["row"]}})", "each axis"},
            {R"({"gbuffer.depth": {"file": "gbuffer.depth.npy", "axes": ["row", "row"]}})", "twice"},
            {R"({"gbuffer.depth": {"file": "gbuffer.depth.npy", "channels": "q"}})", "none of r g b a"},
            {R"({"gbuffer.depth": {"file": "gbuffer.depth.npy", "channels": [4]}})", "channels"},
            {R"({"gbuffer.depth": {"file": "gbuffer.depth.npy", "layers": [1, 2]}})", "layers"},
            {R"({"gbuffer.depth": {"file": "gbuffer.depth.npy", "scale": "x"}})", "must be a number"},
            {R"({"gbuffer.depth": {"file": "gbuffer.depth.npy", "encoding": "snorm"}})", "snorm"},
            {R"({"gbuffer.depth": {"file": "gbuffer.depth.npy", "transfer": "gamma"}})", "\"linear\" or \"srgb\""},
        }));
        CAPTURE(c.map);
        CHECK(mentions(refused(scratch.write("map.json", c.map)), c.message));
    }
}

TEST_CASE("candidate: files that are of no buffer are mentioned, with what they may have meant", "[capture][candidate]")
{
    const ScratchFolder scratch;
    writeNpy(scratch, sharedGolden().at("gbuffer.depth"));
    const Buffer& normal = sharedGolden().at("gbuffer.normal");
    writeNpy(scratch, "gbuffer.normals.npy", normal.dtype, normal.shape, normal.bytes);
    const Candidate candidate = readCandidate(scratch.path("c"), sharedGolden());
    REQUIRE(candidate.notes.size() == 1);
    CHECK(mentions(candidate.notes[0], "did you mean gbuffer.normal?"));
}

TEST_CASE("candidate: one that has nothing in common is told what it nearly has", "[capture][candidate]")
{
    const ScratchFolder scratch;
    const Buffer& depth = sharedGolden().at("gbuffer.depth");
    const auto told = [&](const CandidateOptions& options = {}) {
        const Candidate candidate = readCandidate(scratch.path("c"), sharedGolden(), options);
        return refusal([&] { (void)checkCandidate(sharedGolden(), candidate); });
    };
    SECTION("case")
    {
        writeNpy(scratch, "GBuffer.Depth.npy", depth.dtype, depth.shape, depth.bytes);
        CHECK(mentions(told(), "GBuffer.Depth.npy is of no buffer of the golden; did you mean gbuffer.depth? (names are told apart by case)"));
    }
    SECTION("an underscore, as a layer")
    {
        LayeredImage image;
        addLayer(image, "gbuffer_depth", Image<float>(int(depth.shape[1]), int(depth.shape[0])));
        scratch.write("c/all.exr", viewOf(encodeExr(image)));
        CHECK(mentions(told(), "all.exr, layer gbuffer_depth is of no buffer of the golden; did you mean gbuffer.depth?"));
    }
    SECTION("a key of the map")
    {
        writeNpy(scratch, "d.npy", depth.dtype, depth.shape, depth.bytes);
        CandidateOptions options;
        options.map = scratch.write("map.json", R"({"gbuffer.Depth": "d.npy"})");
        CHECK(mentions(told(options), "the map's key \"gbuffer.Depth\" is of no buffer of the golden; did you mean gbuffer.depth?"));
    }
    SECTION("components first")
    {
        const Buffer& normal = sharedGolden().at("gbuffer.normal");
        writeNpy(scratch, "gbuffer.normal.npy", normal.dtype, {3, normal.shape[0], normal.shape[1]}, normal.bytes);
        CHECK(mentions(told(), R"(it looks like {"axes": ["component", "row", "column"]})"));
    }
}

TEST_CASE("candidate: what cannot be read is listed, and the rest is judged", "[capture][candidate]")
{
    const ScratchFolder scratch;
    writeNpy(scratch, sharedGolden().at("gbuffer.depth"));
    scratch.write("c/gbuffer.albedo.npy", "hello");
    scratch.write("c/lrsm0.depth.dds", "hello");
    const Candidate candidate = readCandidate(scratch.path("c"), sharedGolden());
    const CheckReport report = checkCandidate(sharedGolden(), candidate);
    const std::size_t mips = candidate.unreadable.size() - 1;
    CHECK(report.count(Verdict::ok) == 1);
    CHECK(report.count(Verdict::unreadable) == 1 + mips);
    CHECK_FALSE(report.holds());
    CHECK(report.firstWrong() == nullptr);
    CHECK(report.summary().starts_with("1 buffer is within its tolerance; "));
    CHECK(mentions(report.summary(), "; " + std::to_string(1 + mips) + " cannot be read: "));
    const std::string xml = checkJUnit(report, "t");
    CHECK(mentions(xml, "errors=\"" + std::to_string(1 + mips) + "\""));
    // Every count is of the same buffers.
    std::size_t all = 0;
    for (const Verdict v : {Verdict::ok, Verdict::wrong, Verdict::inherits, Verdict::missing, Verdict::unreadable}) all += report.count(v);
    CHECK(all == report.buffers.size());
    CHECK(mentions(xml, "tests=\"" + std::to_string(all) + "\""));
}

TEST_CASE("candidate: booleans, integers of any width, typeless and packed textures, pictures", "[capture][candidate]")
{
    const ScratchFolder scratch;
    const Buffer& bits = sharedGolden().at("voxel.bits");
    std::vector<std::uint8_t> voxels;
    for (const float v : floatsFrom(bits)) voxels.push_back(v != 0.0f ? 1 : 0);
    const std::size_t n = bits.shape[0];
    writeNpy(scratch, "voxel.bits.npy", Dtype::b1, {n, n, n}, bytesOf(voxels));
    const Buffer& bricks = sharedGolden().at("voxel.bricks");
    writeNpy(scratch, "voxel.bricks.npy", Dtype::i8, bricks.shape, bricks.bytes);
    std::vector<std::int64_t> ids, codes;
    for (const float v : floatsFrom(sharedGolden().at("gbuffer.object_id"))) ids.push_back(std::int64_t(v));
    writeNpy(scratch, "gbuffer.object_id.npy", Dtype::i8, sharedGolden().at("gbuffer.object_id").shape, bytesOf(ids));
    // Codes of a UNORM16 as torch has them.
    const Buffer& depth = sharedGolden().at("lrsm0.depth.mip0");
    for (const std::uint16_t code : depth.as<std::uint16_t>()) codes.push_back(code);
    writeNpy(scratch, depth.name + ".npy", Dtype::i8, depth.shape, bytesOf(codes));
    const auto dds = [&](const Buffer& b, std::uint32_t format, std::uint32_t layers) {
        DdsTexture texture{
            DxgiFormat::R32_FLOAT, std::uint32_t(b.shape[b.shape.size() - 2]), std::uint32_t(b.shape[b.shape.size() - 3]), 1, 1, layers, false, {}};
        texture.layout = layoutOfDxgi(format, "test");
        texture.texels = b.bytes;
        std::vector<std::byte> file = encodeDds([&] {
            DdsTexture same = texture;
            same.layout = layoutOfDxgi(format, "test");
            return same;
        }());
        std::memcpy(file.data() + 4 * 32, &format, 4);
        scratch.write("c/" + b.name + ".dds", viewOf(file));
    };
    dds(sharedGolden().at("gbuffer.normal"), 6, 1);    // R32G32B32_FLOAT
    dds(sharedGolden().at("gbuffer.position"), 5, 1);  // R32G32B32_TYPELESS
    const Buffer& radiance = sharedGolden().at("lrsm0.radiance.mip1");
    dds(radiance, 9, std::uint32_t(radiance.shape[0]));  // R16G16B16A16_TYPELESS: halves, as the golden
    const Buffer& normal = sharedGolden().at("lrsm0.depth.mip1");
    dds(normal, 12, std::uint32_t(normal.shape[0]));  // R16G16B16A16_UINT: codes, as the golden's
    requireSame(scratch, {"voxel.bits", "voxel.bricks", "gbuffer.object_id", depth.name, "gbuffer.normal", "gbuffer.position", radiance.name, normal.name});
}

TEST_CASE("candidate: a capture's own pictures, and a PNG of numbers", "[capture][candidate]")
{
    const ScratchFolder scratch;
    OutputFolder folder(scratch.path("c"));
    writePictures(folder, sharedGolden());
    folder.commit();
    const Candidate candidate = readCandidate(scratch.path("c"), sharedGolden());
    CHECK(candidate.unreadable.empty());
    CHECK(candidate.find("composite.combined"));
    CHECK(candidate.find("rsm0.depth"));
    CHECK(checkCandidate(sharedGolden(), candidate).holds());

    const Buffer& normal = sharedGolden().at("gbuffer.normal");
    Image<Rgb8> picture(int(normal.shape[1]), int(normal.shape[0]), {0, 51, 255});
    scratch.write("p/n.png", viewOf(encodePng(picture)));
    CandidateOptions options;
    options.map = scratch.write("map.json", R"({"gbuffer.normal": {"file": "n.png", "scale": 2, "offset": -1}})");
    CHECK(readCandidate(scratch.path("p"), sharedGolden(), options).find("gbuffer.normal")->given[1] == Approx(-0.6));
    options.map = scratch.write("map.json", R"({"gbuffer.normal": {"file": "n.png", "transfer": "srgb"}})");
    CHECK(readCandidate(scratch.path("p"), sharedGolden(), options).find("gbuffer.normal")->buffer.as<float>()[1] == Approx(0.0331048f));
    // Colours are sRGB unless the map says otherwise.
    options.map = scratch.write("map.json", R"({"gbuffer.albedo": {"file": "n.png", "transfer": "linear"}})");
    CHECK(readCandidate(scratch.path("p"), sharedGolden(), options).find("gbuffer.albedo")->buffer.as<float>()[1] == Approx(0.2f));
}

TEST_CASE("candidate: voxels in one packing are laid over both", "[capture][candidate]")
{
    const ScratchFolder scratch;
    Buffer bricks = sharedGolden().at("voxel.bricks");
    bricks.bytes[3] ^= std::byte(0x10);  // z 1, y 3, x 0 of the first brick: bit 28
    writeNpy(scratch, bricks);
    const Candidate candidate = readCandidate(scratch.path("c"), sharedGolden());
    const Capture mixed = layOver(sharedGolden(), candidate);
    const Buffer& rows = mixed.at("voxel.bits");
    const std::size_t at[] = {1, 3, 0};
    CHECK(decodedValue(rows, elementAt(rows, at)) != decodedValue(sharedGolden().at("voxel.bits"), elementAt(rows, at)));
    std::size_t changed = 0;
    for (std::size_t i = 0; i < rows.bytes.size(); ++i) changed += rows.bytes[i] != sharedGolden().at("voxel.bits").bytes[i] ? 1 : 0;
    CHECK(changed == 1);
}
