#include "catch.h"
#include "sandbox.h"

#include <nlohmann/json.hpp>

// lrsm capture, as a user runs it.

using namespace lrsm::test;
using Json = nlohmann::ordered_json;

namespace {

const std::string kTinyCapture = " --size 32x24 --set voxel_resolution=32 --set rsm_resolution=64 ";

}  // namespace

TEST_CASE("capture program: holds the hashes of the frame that render makes", "[apps][capture]")
{
    const Sandbox box;
    REQUIRE(box.run("render two-rooms -o frame --set shadows=hard --set filter_passes=0" + kTinyCapture).code == 0);
    const Outcome outcome = box.run("capture two-rooms -o golden" + kTinyCapture);
    REQUIRE(outcome.code == 0);
    CHECK(contains(outcome.out, "buffers and textures: "));
    const Json frame = Json::parse(readText(box.here() / "frame" / "frame.json")), manifest = Json::parse(readText(box.here() / "golden" / "manifest.json"));
    CHECK(manifest["scene"]["sha256"] == frame["scene"]["sha256"]);
    CHECK(manifest["settings"] == frame["settings"]);
    REQUIRE(manifest["passes"].size() == frame["passes"].size());
    for (std::size_t i = 0; i < manifest["passes"].size(); ++i) {
        CHECK(manifest["passes"][i]["name"] == frame["passes"][i]["name"]);
        CHECK(manifest["passes"][i]["sha256"] == frame["passes"][i]["sha256"]);
    }
    for (const char* file : {"frame.exr", "rsm0.exr", "contact-sheet.png", "lrsm0.depth.dds", "voxel.dds"}) CHECK(fs::exists(box.here() / "golden" / file));
}

TEST_CASE("capture program: made twice it is the same bytes, whatever the threads", "[apps][capture][threads]")
{
    const Sandbox box;
    REQUIRE(box.run("capture cornell-box -o one --threads 1 --quiet" + kTinyCapture).code == 0);
    const Outcome again = box.run("capture cornell-box -o two --threads 3 --json" + kTinyCapture);
    REQUIRE(again.code == 0);
    std::size_t files = 0, bytes = 0;
    for (const auto& entry : fs::directory_iterator(box.here() / "one")) {
        CAPTURE(entry.path().filename().string());
        CHECK(readText(entry.path()) == readText(box.here() / "two" / entry.path().filename()));
        ++files;
        const std::string kind = entry.path().extension().string();
        if (kind == ".npy" || kind == ".dds") bytes += entry.file_size();
    }
    CHECK(files > 50);
    const Json summary = Json::parse(again.out);
    CHECK(summary["predicted_bytes"] == bytes);
    CHECK(summary["bytes"] == bytes);
}

TEST_CASE("capture program: some passes, no textures, no pictures", "[apps][capture]")
{
    const Sandbox box;
    REQUIRE(box.run("capture cornell-box -o out --only lrsm --only voxel-mips,gbuffer --no-dds --no-pictures --quiet" + kTinyCapture).code == 0);
    CHECK(fs::exists(box.here() / "out" / "gbuffer.normal.npy"));
    CHECK(fs::exists(box.here() / "out" / "lrsm0.radiance.mip5.npy"));
    CHECK_FALSE(fs::exists(box.here() / "out" / "rsm0.depth.npy"));
    for (const auto& entry : fs::directory_iterator(box.here() / "out")) {
        const std::string kind = entry.path().extension().string();
        CHECK((kind == ".npy" || kind == ".json"));
    }
}

TEST_CASE("capture program: bad usage is one line, exit code 2, and nothing left behind", "[apps][capture]")
{
    struct Case {
        std::string arguments, message;
    };
    const auto c = GENERATE(values<Case>({{"capture cornell-box", "needs -o FOLDER"},
                                          {"capture nowhere -o out", "nowhere"},
                                          {"capture cornell-box -o out --only lrsm,cone" + kTinyCapture, "\"cone\" is no pass; they are voxelize, "},
                                          {"capture cornell-box --only -o out", "\"-o\" is no pass; they are voxelize, "},
                                          {"capture cornell-box -o out --size 0x0", "--size 0x0"}}));
    const Sandbox box;
    const Outcome outcome = box.run(c.arguments);
    CAPTURE(c.arguments, outcome.err);
    CHECK(outcome.code == 2);
    CHECK(isOneLine(outcome.err));
    CHECK(contains(outcome.err, c.message));
    CHECK(box.empty());
}

TEST_CASE("capture program: a folder used again holds the last capture alone, and check rests on nothing else", "[apps][capture]")
{
    const Sandbox box;
    REQUIRE(box.run("capture cornell-box -o golden --quiet" + kTinyCapture).code == 0);
    REQUIRE(box.run("capture cornell-box -o used --quiet" + kTinyCapture).code == 0);
    std::ofstream(box.here() / "used" / "mine.txt") << "mine";
    REQUIRE(box.run("capture cornell-box --only gbuffer --set shadows=off -o used --quiet --no-pictures" + kTinyCapture).code == 0);
    CHECK(fs::exists(box.here() / "used" / "mine.txt"));
    CHECK(fs::exists(box.here() / "used" / "gbuffer.normal.npy"));
    for (const char* file : {"direct.npy", "voxel.bits.npy", "frame.exr", "rsm0.exr", "contact-sheet.png", "voxel.dds"})
        CHECK_FALSE(fs::exists(box.here() / "used" / file));

    // A file of another run that came there by other ways.
    fs::copy_file(box.here() / "golden" / "voxel.bits.npy", box.here() / "used" / "voxel.bits.npy");
    const Outcome outcome = box.run("check golden used");
    CAPTURE(outcome.out);
    CHECK(contains(outcome.out, "1 buffer is not in the candidate's manifest, and left out as of another run: voxel.bits.npy"));

    const Outcome render = box.run("render cornell-box -o used" + kTinyCapture);
    CHECK(render.code == 2);
    CHECK(contains(render.err, "holds what `lrsm capture` wrote; give render a folder of its own"));
}
