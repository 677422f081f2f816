#include "core/imageio/image_io.h"

#include "catch.h"
#include "sandbox.h"

#include <nlohmann/json.hpp>

// lrsm render, reference and capture --frames as a user meets them.

using namespace lrsm;
using namespace lrsm::test;
using Json = nlohmann::ordered_json;

namespace {

const std::string kTinyFrames = " --size 32x24 --set voxel_resolution=32 --set rsm_resolution=64 --quiet ";

/// A spot that moves in the Cornell box.
void writeMovingView(const Sandbox& box, const std::string& second = "[0.5, 0, 0.5]")
{
    std::ofstream(box.here() / "view.json") << R"({"scene": "cornell-box", "lights": [{"type": "spot", "position": [0, 1.9, 0], "intensity": 5,
        "keys": [{"time": 0, "target": [0, 0, 0]}, {"time": 1, "target": )"
                                            << second << "}]}]}";
}

std::string frameBytes(const Sandbox& box, const std::string& name)
{
    return readText(box.here() / name / "image.exr");
}

}  // namespace

TEST_CASE("program: any split of a range of frames gives the same bytes, kept from frame to frame or not, and those of the moment rendered by itself",
          "[apps][sequence]")
{
    const Sandbox box;
    writeMovingView(box);
    REQUIRE(box.run("render view.json --frames 0:4 --fps 4 -o whole --threads 1" + kTinyFrames).code == 0);
    REQUIRE(box.run("render view.json --frames 2:4 --fps 4 -o parts --threads 2 --sequence-reuse off" + kTinyFrames).code == 0);
    REQUIRE(box.run("render view.json --frames 0:2 --fps 4 -o other" + kTinyFrames).code == 0);
    for (const char* name : {"0000", "0001"}) fs::rename(box.here() / "other" / name, box.here() / "parts" / name);
    const Outcome merged = box.run("render view.json --frames 0:4 --fps 4 -o parts --json" + kTinyFrames);
    REQUIRE(merged.code == 0);
    CHECK(merged.out == readText(box.here() / "whole" / "sequence.json"));
    CHECK(readText(box.here() / "parts" / "sequence.json") == merged.out);
    REQUIRE(box.run("render view.json --time 0.75 -o alone" + kTinyFrames).code == 0);
    for (const char* name : {"0000", "0001", "0002", "0003"})
        for (const auto& file : fs::directory_iterator(box.here() / "whole" / name))
            if (const std::string leaf = file.path().filename().string(); leaf != "frame.json")  // it has times
                CHECK(readText(file.path()) == readText(box.here() / "parts" / name / leaf));
    CHECK(frameBytes(box, "whole/0003") == frameBytes(box, "alone"));
    CHECK(frameBytes(box, "whole/0003") != frameBytes(box, "whole/0002"));

    const Json json = Json::parse(merged.out);
    CHECK(json["fps"] == 4.0);
    REQUIRE(json["frames"].size() == 4);
    CHECK(json["frames"][3]["time"] == 0.75);
    CHECK(json["frames"][3]["folder"] == "0003");
    CHECK(json["frames"][3]["scene_sha256"] != json["frames"][2]["scene_sha256"]);
}

TEST_CASE("program: frames that are complete and of the same input are kept, others are made anew", "[apps][sequence]")
{
    const Sandbox box;
    writeMovingView(box);
    const std::string command = "render view.json --frames 0:3 --fps 4 -o out" + kTinyFrames;
    REQUIRE(box.run(command).code == 0);
    std::vector<std::string> before, stamps;
    for (const char* name : {"out/0000", "out/0001", "out/0002"})
        before.push_back(frameBytes(box, name)), stamps.push_back(readText(box.here() / name / "frame.json"));

    // One frame lost, one damaged, one half-written as a kill leaves it.
    fs::remove_all(box.here() / "out" / "0000");
    fs::create_directory(box.here() / "out" / ".0000-partial-abcdef");
    std::ofstream(box.here() / "out" / "0001" / "image.exr", std::ios::app) << "x";
    const Outcome again = box.run(command);
    REQUIRE(again.code == 0);
    CHECK(contains(again.err, "frames of other input or settings, or damaged, that were replaced: 1"));
    CHECK(frameBytes(box, "out/0000") == before[0]);
    CHECK(frameBytes(box, "out/0001") == before[1]);
    CHECK(readText(box.here() / "out" / "0002" / "frame.json") == stamps[2]);  // its times are the first run's
    CHECK(readText(box.here() / "out" / "0001" / "frame.json") != stamps[1]);
    CHECK_FALSE(fs::exists(box.here() / "out" / ".0000-partial-abcdef"));

    // Another light from 0 s on: only what is at 0 s stays the same picture, and even that is of another view.
    writeMovingView(box, "[0.25, 0, 0.5]");
    REQUIRE(box.run("render view.json --frames 1:3 --fps 4 -o out" + kTinyFrames).code == 0);
    CHECK(frameBytes(box, "out/0001") != before[1]);
    CHECK(Json::parse(readText(box.here() / "out" / "sequence.json"))["frames"].size() == 2);
}

TEST_CASE("program: a sequence that was killed goes on to the same bytes, with nothing half-written", "[apps][sequence]")
{
    const Sandbox box;
    writeMovingView(box);
    const std::string command = "reference view.json --frames 0:3 --fps 4 --size 48x32 --spp 64 --checkpoint-seconds 0 --quiet -o ";
    REQUIRE(box.run(command + "whole").code == 0);
    for (const char* signal : {"KILL", "INT"}) {
        const std::string out = signal;
        box.run(command + out, "timeout -s " + std::string(signal) + " 0.9 ");
        for (int i = 0; i < 3; ++i) {
            const fs::path folder = box.here() / out / ("000" + std::to_string(i));
            if (fs::exists(folder / "moment.json")) CHECK(readText(folder / "image.exr") == frameBytes(box, "whole/000" + std::to_string(i)));
        }
        REQUIRE(box.run(command + out).code == 0);
        for (const char* name : {"0000/image.exr", "0001/image.exr", "0002/image.exr", "sequence.json"})
            CHECK(readText(box.here() / out / name) == readText(box.here() / "whole" / name));
        for (const auto& entry : fs::directory_iterator(box.here() / out)) CHECK_FALSE(entry.path().filename().string().starts_with("."));
    }
}

TEST_CASE("program: --sequence-bounds union fits all frames to all moments, whatever the range", "[apps][sequence]")
{
    const Sandbox box;
    std::ofstream(box.here() / "triangle.gltf")
        << R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}], "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
    std::ofstream(box.here() / "view.json") << R"({"scene": "cornell-box", "objects": [{"scene": "triangle.gltf", "keys": [{"time": 0, "position": [0, 0, 0]},
        {"time": 1, "position": [0, 2, 0]}]}]})";
    const auto boundsOf = [&](const std::string& frame) { return Json::parse(readText(box.here() / frame / "frame.json"))["scene"]["bounds"]; };
    REQUIRE(box.run("render view.json --frames 1:3 --fps 4 -o each" + kTinyFrames).code == 0);
    REQUIRE(box.run("render view.json --frames 1:3 --fps 4 --sequence-bounds union -o all" + kTinyFrames).code == 0);
    REQUIRE(box.run("render view.json --frames 2:3 --fps 4 --sequence-bounds union -o part" + kTinyFrames).code == 0);
    CHECK(boundsOf("each/0001") != boundsOf("each/0002"));
    CHECK(boundsOf("all/0001") == boundsOf("all/0002"));
    CHECK(boundsOf("all/0002")["max"][1] == 3.0);
    CHECK(frameBytes(box, "all/0002") == frameBytes(box, "part/0002"));
    CHECK(frameBytes(box, "all/0002") != frameBytes(box, "each/0002"));
}

TEST_CASE("program: a capture of many moments is a capture a folder", "[apps][sequence]")
{
    const Sandbox box;
    writeMovingView(box);
    REQUIRE(box.run("capture view.json --frames 1:3 --fps 4 --no-dds --no-pictures --only cones -o out" + kTinyFrames).code == 0);
    REQUIRE(box.run("capture view.json --time 0.5 --no-dds --no-pictures --only cones -o alone" + kTinyFrames).code == 0);
    CHECK(readText(box.here() / "out" / "0002" / "manifest.json") == readText(box.here() / "alone" / "manifest.json"));
    CHECK(readText(box.here() / "out" / "0002" / "cones.irradiance.npy") == readText(box.here() / "alone" / "cones.irradiance.npy"));
    CHECK_FALSE(fs::exists(box.here() / "out" / "0000"));
}

TEST_CASE("program: what is wrong with --frames is one line", "[apps][sequence]")
{
    const Sandbox box;
    writeMovingView(box, "[0, 3.8, 0]");  // half-way the spot's target is where it stands
    for (const auto& [arguments, message] : {std::pair{"--frames 4:4", "must be A:B with 0 <= A < B"},
                                             {"--frames -1:4", "must be A:B"},
                                             {"--frames 0:4x", "must be A:B"},
                                             {"--frames 0:4 --fps 0", "--fps"},
                                             {"--frames 0:4 --fps nan", "--fps"},
                                             {"--fps 4", "--frames"},
                                             {"--frames 0:4 --time 1", "--frames"},
                                             {"--frames 0:4 --pixel 1,1", "--pixel"},
                                             {"--frames 0:4 --fps 4", "lights[0] at 0.5 s: target: gives no direction"}}) {
        const Outcome outcome = box.run("render view.json " + std::string(arguments) + " -o out" + kTinyFrames);
        CAPTURE(arguments, outcome.err);
        CHECK(outcome.code == 2);
        CHECK(isOneLine(outcome.err));
        CHECK(contains(outcome.err, message));
        CHECK_FALSE(fs::exists(box.here() / "out"));
    }
}

namespace {

/// Frames whose irradiance is picture * gain(frame), as another engine might write them: nothing but the layer.
template <class Gain>
void writeFrames(const Sandbox& box, const std::string& name, int frames, const Gain& gain)
{
    for (int t = 0; t < frames; ++t) {
        Image<Vec3> picture(40, 30);
        for (std::size_t i = 0; i < picture.texels.size(); ++i) picture.texels[i] = Vec3(float(1 + i % 7), float(1 + i % 3), 2.0f) * float(gain(t));
        LayeredImage image;
        addLayer(image, "irradiance", picture);
        const fs::path folder = box.here() / name / ("000" + std::to_string(t));
        fs::create_directories(folder);
        const std::vector<std::byte> bytes = encodeExr(image);
        std::ofstream(folder / "image.exr", std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    }
}

}  // namespace

TEST_CASE("program: compare --sequence finds a planted pop with its frame, and nothing where nothing flickers", "[apps][sequence]")
{
    const Sandbox box;
    writeFrames(box, "still", 6, [](int) { return 1.0; });
    writeFrames(box, "wrong", 6, [](int) { return 1.5; });
    writeFrames(box, "pop", 6, [](int t) { return t == 3 ? 1.02 : 1.0; });
    writeFrames(box, "fade", 7, [](int t) { return 1.0 - t / 16.0; });

    const Json wrong = Json::parse(box.run("compare --sequence wrong still --json").out)["layers"][0];
    for (const char* metric : {"f", "fe", "v", "j"}) CHECK(wrong[metric] == 0.0);
    CHECK(wrong["layer"] == "irradiance");
    CHECK(wrong["frames"][4]["rmse_over_mean"] > 0.5);

    const Json fade = Json::parse(box.run("compare --sequence fade still --json").out);
    CHECK(fade["layers"][0]["f"] == 0.0);
    CHECK(fade["layers"][0]["fe"] == 0.0);
    CHECK(fade["layers"][0]["j"] > 0.0);
    CHECK(contains(fade["notes"][0].get<std::string>(), "1 frames of fade have no counterpart"));

    const Outcome pop = box.run("compare --sequence pop still -o out --fail-above fe=0.001 --fail-above v=1");
    CHECK(pop.code == 1);
    CHECK(contains(pop.err, "irradiance: fe = "));
    CHECK(isOneLine(pop.err));
    CHECK(contains(pop.out, "worst: frame 3"));
    const Json json = Json::parse(readText(box.here() / "out" / "compare.json"))["layers"][0];
    CHECK(json["worst_frame"] == 3);
    CHECK(json["worst_jump_into"] == 3);
    CHECK(json["f_reference"] == 0.0);
    CHECK(json["fe"].get<double>() == Approx(0.02 * 4 / 4));
    const std::string page = readText(box.here() / "out" / "report.html");
    CHECK(contains(page, "frame 5 at "));
    CHECK_FALSE(contains(page, "src=\"http"));
    for (const char* picture : {"worst.test", "worst.reference", "worst.signed", "flicker", "dance"})
        CHECK(fs::exists(box.here() / "out" / ("irradiance." + std::string(picture) + ".png")));
}

TEST_CASE("program: what two sequences cannot be compared for is one line", "[apps][sequence]")
{
    const Sandbox box;
    const auto steady = [](int) { return 1.0; };
    writeFrames(box, "long", 5, steady);
    writeFrames(box, "short", 2, steady);
    writeFrames(box, "gap", 5, steady);
    fs::remove_all(box.here() / "gap" / "0002");
    writeFrames(box, "early", 5, steady);
    writeFrames(box, "late", 5, steady);
    std::ofstream(box.here() / "early" / "0001" / "moment.json") << R"({"time": 0.25})";
    std::ofstream(box.here() / "late" / "0001" / "moment.json") << R"({"time": 0.5})";
    fs::create_directory(box.here() / "empty");
    for (const auto& [arguments, message] : {std::pair{"no-such long", "no-such: is no folder of frames"},
                                             {"empty long", "empty: has no frame, as 0000/image.exr"},
                                             {"short long", "has 2 frames in common with long; three are needed"},
                                             {"gap long", "gap: has no frame 2"},
                                             {"early late", "frame 1 at 0.25 s, late at 0.5 s"},
                                             {"long long --layer direct", "has no layer direct"},
                                             {"long long --fail-above rmse=1", "must be metric=value of a sequence"},
                                             {"long long --fail-below psnr=1", "--fail-below"}}) {
        const Outcome outcome = box.run("compare --sequence " + std::string(arguments) + " -o out");
        CAPTURE(arguments, outcome.err);
        CHECK(outcome.code == 2);
        CHECK(isOneLine(outcome.err));
        CHECK(contains(outcome.err, message));
        CHECK_FALSE(fs::exists(box.here() / "out"));
    }
}

TEST_CASE("program: a camera that moves past a still scene is followed from frame to frame", "[apps][sequence]")
{
    const Sandbox box;
    std::ofstream(box.here() / "view.json") << R"({"scene": "cornell-box", "camera": {"target": [0, 1, 0], "keys": [{"time": 0, "eye": [0, 1, 3.4]},
        {"time": 1, "eye": [0.4, 1.2, 3.4]}]}})";
    REQUIRE(box.run("render view.json --frames 0:3 --fps 2 -o out" + kTinyFrames).code == 0);
    const Json layer = Json::parse(box.run("compare --sequence out out --json").out)["layers"][0];
    CHECK(layer["fe"] == 0.0);
    CHECK(layer["v"].is_null());
    CHECK(layer["followed_share"] > 0.8);
    CHECK(layer["followed_share"] < 1.0);
}
