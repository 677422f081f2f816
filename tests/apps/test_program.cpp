#include "core/imageio/image_io.h"

#include "catch.h"
#include "sandbox.h"

#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

// Drives the real binary: arguments in; exit code, both streams and files out.

using namespace lrsm;
using namespace lrsm::test;
using Json = nlohmann::ordered_json;

namespace {

/// Small enough that the start of the program is what takes the time.
const std::string kTiny = " --size 32x24 --set voxel_resolution=32 --set rsm_resolution=64 ";

fs::path sharedScenes()
{
    const char* given = std::getenv("LRSM_SCENES");
    return given ? fs::path(given) : fs::path(LRSM_SOURCE_DIR) / ".." / "shared" / "scenes";
}

}  // namespace

TEST_CASE("program: bad usage and bad input are one clear line and exit code 2, with nothing left behind", "[apps]")
{
    struct Case {
        std::string arguments, message;
    };
    const auto c = GENERATE(values<Case>({
        {"rendr cornell-box", "there is no command \"rendr\""},
        {"render", "needs -o FOLDER"},
        {"render -o out", "scene"},
        {"render '' -o out", "scene \"\""},
        {"render no-such-scene -o out", "no-such-scene"},
        {"render . -o out", "."},
        {"render cornell-box -o ''", "needs -o FOLDER"},
        {"render cornell-box -o out --size 0x0", "--size 0x0"},
        {"render cornell-box -o out --size 100", "--size 100"},
        {"render cornell-box -o out --size -5x5", "--size -5x5"},
        {"render cornell-box -o out --size 99999x10", "16384"},
        {"render cornell-box -o out --animation 4", "animation 4: the built-in scene cornell-box has none"},
        {"render cornell-box -o out --voxel-resolution=64", "--set voxel_resolution=64"},
        {"render cornell-box -o out voxel_resolution=64", "--set voxel_resolution=64"},
        {"compare a b --shadows hard", "`lrsm compare` takes no settings"},
        {"render cornell-box -o out --quite", "did you mean --quiet?"},
        {"help rendr", "there is no command \"rendr\""},
        {"render cornell-box -o /", "is the root of the file system"},
        {"sweep cornell-box -o /", "is the root of the file system"},
        {"render cornell-box -o out --preset best", "literal, paper, fast, balanced, fine, accurate"},
        {"render cornell-box -o out --set push=nan", "push=nan: must be [0, 16]"},
        {"render cornell-box -o out --set cone_cuont=7", "did you mean cone_count?"},
        {"render cornell-box -o out --set layer_overlap=0.1", "count light twice"},
        {"render cornell-box -o out --settings none.json", "none.json: there is no such file"},
        {"render cornell-box -o out --settings .", "is a folder"},
        {"render cornell-box -o out --camera nowhere", "nowhere"},
        {"render cornell-box -o out --time nan", "--time"},
        {"render cornell-box -o out --threads -1", "--threads"},
        {"render cornell-box -o out --max-memory 1", "--max-memory 1: this frame needs"},
        {"render cornell-box -o out --max-memory nan", "--max-memory"},
        {"render cornell-box -o out --exposure bright", "--exposure bright"},
        {"render cornell-box -o out --set visibility=mirrors", "visibility"},
        {"capture cornell-box -o out --set visibility=rays", "take visibility=cones"},
        {"render cornell-box -o out --radiance exact", "take visibility=rays or voxel-rays"},
        {"render cornell-box -o out --radiance rsm", "--radiance rsm: must be lrsm or exact"},
        {"render cornell-box --pixel 1,1 --set visibility=rays", "--pixel"},
        {"render cornell-box --pixel 1280,0", "--pixel 1280,0"},
        {"render cornell-box --pixel 1", "--pixel 1"},
        {"render cornell-box extra -o out", "extra"},
        {"render cornell-box --view v.json -o out", "v.json"},
        {"capture cornell-box -o out --preset rays", "take visibility=cones"},
        {"capture cornell-box -o out --set voxel_cascades=2", "take voxel_cascades=1"},
        {"settings --preset best", "literal, paper, fast, balanced, fine, accurate"},
    }));
    CAPTURE(c.arguments);
    const Sandbox sandbox;
    const Outcome outcome = sandbox.run(c.arguments);
    CAPTURE(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(contains(outcome.err, c.message));
    CHECK(outcome.err.starts_with("lrsm: "));
    CHECK(isOneLine(outcome.err));
    CHECK(sandbox.empty());
}

TEST_CASE("program: what the machine refuses is exit code 3, with nothing left behind", "[apps]")
{
    struct Case {
        std::string name, before, arguments, after;
    };
    const auto c = GENERATE(values<Case>({
        {"a device for a folder", "", "render cornell-box -o /dev/full" + kTiny, ""},
        {"a place where no folder can be made", "", "render cornell-box -o /proc/lrsm/out" + kTiny, ""},
        {"a disk that is full before the pictures are written", "ulimit -f 4;", "render cornell-box -o deep/out" + kTiny, ""},
        {"a disk that is full, into an existing folder", "ulimit -f 4;", "render cornell-box -o . " + kTiny, ""},
        {"standard output on a full disk", "", "settings", ">/dev/full"},
    }));
    CAPTURE(c.name);
    const Sandbox sandbox;
    const Outcome outcome = sandbox.run(c.arguments, c.before, c.after);
    CAPTURE(outcome.err);
    CHECK(outcome.code == 3);
    CHECK(isOneLine(outcome.err));
    CHECK(sandbox.empty());
}

TEST_CASE("program: help, version and the lists are answered with exit code 0", "[apps]")
{
    const Sandbox sandbox;
    CHECK(contains(sandbox.run("--help").out, "render"));
    CHECK(contains(sandbox.run("render --help").out, "--preset"));
    CHECK(sandbox.run("help").out == sandbox.run("--help").out);
    CHECK(sandbox.run("help render").out == sandbox.run("render --help").out);
    CHECK(sandbox.run("--version").code == 0);
    CHECK(sandbox.run("-v").out == sandbox.run("--version").out);
    const Outcome bare = sandbox.run("");
    CHECK(bare.code == 2);
    CHECK(contains(bare.err, "render"));
    const Outcome list = sandbox.run("info --list");
    CHECK(list.code == 0);
    for (const char* name : {"cornell-box", "two-rooms", "atrium", "furnace"}) CHECK(contains(list.out, name));
    CHECK(contains(sandbox.run("settings --preset literal").out, "estimator = paper"));
    CHECK(Json::parse(sandbox.run("settings --json --preset accurate").out).contains("cone_count"));
    CHECK(sandbox.empty());
}

TEST_CASE("render: every file and layer is there, frame.json repeats the frame, neither threads nor the frame's analysis change a bit", "[apps][determinism]")
{
    const Sandbox sandbox;
    const Outcome first = sandbox.run("render cornell-box -o a/deep --quiet" + kTiny);
    REQUIRE(first.code == 0);
    CHECK(first.out.empty());
    CHECK(first.err.empty());
    for (const char* name : {"image.exr", "image.png", "direct.png", "irradiance.png", "indirect.diffuse.png", "indirect.specular.png", "albedo.png",
                             "normal.png", "depth.png", "opacity.png", "frame.json"})
        CHECK(fs::file_size(sandbox.here() / "a/deep" / name) > 0);

    const LayeredImage image = readImage((sandbox.here() / "a/deep/image.exr").string());
    CHECK(image.width == 32);
    CHECK(image.height == 24);
    for (const char* name :
         {"", "direct", "irradiance", "indirect.diffuse", "indirect.specular", "combined", "albedo", "normal", "position", "depth", "opacity"})
        CHECK(image.find(name) != nullptr);

    const Json frame = Json::parse(readText(sandbox.here() / "a/deep/frame.json"));
    CHECK(frame["settings"]["voxel_resolution"] == 32);
    CHECK(frame["scene"]["sha256"].get<std::string>().size() == 64);
    for (const Json& pass : frame["passes"]) CHECK(pass["sha256"].get<std::string>().size() == 64);

    REQUIRE(sandbox.run("render cornell-box -o b --threads 1 --quiet --size 32x24 --settings a/deep/frame.json").code == 0);
    CHECK(readText(sandbox.here() / "a/deep/image.exr") == readText(sandbox.here() / "b/image.exr"));
    const Json again = Json::parse(readText(sandbox.here() / "b/frame.json"));
    REQUIRE(again["passes"].size() == frame["passes"].size());
    for (std::size_t i = 0; i < frame["passes"].size(); ++i) CHECK(again["passes"][i]["sha256"] == frame["passes"][i]["sha256"]);

    REQUIRE(sandbox.run("render cornell-box -o c --set force_everything=true --quiet" + kTiny).code == 0);
    const LayeredImage forced = readImage((sandbox.here() / "c/image.exr").string());
    for (const ImageLayer& layer : image.layers) {
        CAPTURE(layer.name);
        REQUIRE(forced.find(layer.name));
        CHECK((forced.find(layer.name)->values == layer.values));
    }
}

TEST_CASE("render --radiance: named in frame.json, rays build no voxels", "[apps][split]")
{
    const Sandbox box;
    REQUIRE(box.run("render cornell-box -o rays --set visibility=rays" + kTiny).code == 0);
    REQUIRE(box.run("render cornell-box -o same --set visibility=rays --radiance lrsm" + kTiny).code == 0);
    REQUIRE(box.run("render cornell-box -o exact --set visibility=rays --radiance exact" + kTiny).code == 0);
    CHECK(readText(box.here() / "rays/image.exr") == readText(box.here() / "same/image.exr"));
    CHECK(readText(box.here() / "rays/image.exr") != readText(box.here() / "exact/image.exr"));
    const Json rays = Json::parse(readText(box.here() / "rays/frame.json")), exact = Json::parse(readText(box.here() / "exact/frame.json"));
    CHECK(rays["settings"]["visibility"] == "rays");
    CHECK(rays["radiance"] == "lrsm");
    CHECK(exact["radiance"] == "exact");
    std::set<std::string> passes;
    for (const Json& pass : rays["passes"]) passes.insert(pass["name"]);
    CHECK(passes.count("bvh") == 1);
    CHECK(passes.count("voxelize") == 0);
}

TEST_CASE("memory: what info predicts is what render measures", "[apps][memory]")
{
    const auto settings = GENERATE(as<std::string>(), "--set voxel_resolution=256 --set rsm_resolution=256",
                                   "--set voxel_resolution=64 --set opacity_axes=isotropic --set storage=float32 --set rsm_resolution=128 --set depth_layers=8",
                                   "--preset literal --set voxel_resolution=32 --set rsm_resolution=64 --set drop_empty=false");
    const auto scene = GENERATE(as<std::string>(), "cornell-box", "atrium");
    CAPTURE(scene, settings);
    const Sandbox sandbox;
    const std::string arguments = scene + " --size 40x30 " + settings;
    const Outcome info = sandbox.run("info --json " + arguments);
    REQUIRE(info.code == 0);
    REQUIRE(sandbox.run("render --quiet -o out " + arguments).code == 0);
    const Json predicted = Json::parse(info.out)["memory"], measured = Json::parse(readText(sandbox.here() / "out/frame.json"))["memory"];
    REQUIRE(predicted.size() == measured.size());
    for (std::size_t i = 0; i < predicted.size(); ++i) {
        CAPTURE(predicted[i].dump(), measured[i].dump());
        CHECK(predicted[i]["structure"] == measured[i]["structure"]);
        CHECK(predicted[i]["predicted_bytes"] == measured[i]["measured_bytes"]);
    }
}

TEST_CASE("render --pixel: explains one pixel on standard output and writes no file", "[apps]")
{
    const Sandbox sandbox;
    const Outcome outcome = sandbox.run("render cornell-box --pixel 16,20" + kTiny);
    CHECK(outcome.code == 0);
    CHECK(outcome.out.size() > 200);
    CHECK(sandbox.empty());
}

TEST_CASE("program: every malformed file ends in one clear line or a picture, never in a crash", "[apps][malformed]")
{
    const fs::path folder = sharedScenes() / "malformed";
    if (!fs::is_directory(folder)) {
        WARN("skipped: no " << folder.string() << " (set LRSM_SCENES)");
        return;
    }
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    REQUIRE(files.size() > 10);

    const Sandbox sandbox;
    for (const fs::path& file : files) {
        CAPTURE(file.string());
        const Outcome outcome = sandbox.run("render '" + file.string() + "' -o out --quiet --size 8x8 --set voxel_resolution=8 --set rsm_resolution=16");
        CAPTURE(outcome.err);
        CHECK((outcome.code == 0 || outcome.code == 2));
        if (outcome.code == 2) {
            CHECK(isOneLine(outcome.err));
            CHECK(contains(outcome.err, file.filename().string()));
            CHECK(sandbox.empty());
        }
        fs::remove_all(sandbox.here() / "out");
    }
}

TEST_CASE("program: man and bash are told every command, option and setting", "[apps]")
{
    const Sandbox sandbox;
    const std::string page = sandbox.run("man").out, script = sandbox.run("completion bash").out;
    const Json settings = Json::parse(sandbox.run("settings --json").out);
    for (const std::string command : {"info", "render", "reference", "check", "tune"}) {
        CHECK(contains(page, ".SS lrsm \\&" + command + "\n"));
        CHECK(contains(script, "    " + command + ")\n"));
    }
    for (const auto& [key, value] : settings.items()) {
        CHECK(contains(page, "\\&" + key + " = "));
        CHECK(contains(script, key + "="));
    }
    CHECK(contains(page, "\\-\\-max\\-memory"));
    std::ofstream(sandbox.here() / "lrsm.bash") << script;
    const auto completed = [&](const std::string& words) {
        const std::string bash = "bash -c 'source lrsm.bash; COMP_WORDS=(lrsm " + words +
                                 "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _lrsm 2>/dev/null; echo ${COMPREPLY[*]} >completed';";
        sandbox.run("--version", bash);
        return readText(sandbox.here() / "completed");
    };
    CHECK(completed("rend") == "render\n");
    CHECK(completed("help capt") == "capture\n");
    CHECK(completed("render cornell-b") == "cornell-box\n");
    CHECK(completed("render x --pres") == "--preset\n");
    CHECK(completed("render x --preset vct-") == "vct-paper\n");
    CHECK(completed("render x --set voxel_res") == "voxel_resolution=\n");
}

TEST_CASE("program: a reference's folder is not rendered into", "[apps]")
{
    const Sandbox sandbox;
    REQUIRE(sandbox.run("reference cornell-box -o truth --size 16x9 --spp 1 --quiet").code == 0);
    const std::string before = readText(sandbox.here() / "truth" / "frame.json");
    for (const char* arguments : {"render cornell-box -o truth", "render cornell-box --frames 0:2 -o truth", "capture cornell-box -o truth"}) {
        const Outcome outcome = sandbox.run(arguments + kTiny);
        CHECK(outcome.code == 2);
        CHECK(contains(outcome.err, "truth: holds what `lrsm reference` wrote; give"));
    }
    CHECK(readText(sandbox.here() / "truth" / "frame.json") == before);
    REQUIRE(sandbox.run("render cornell-box --frames 0:1 -o frames --quiet" + kTiny).code == 0);
    CHECK(contains(sandbox.run("reference cornell-box --frames 0:1 -o frames --size 16x9 --spp 1").err, "frames: holds what `lrsm render` wrote"));
}

TEST_CASE("program: threads that the system refuses are done without, or are one line and exit code 3", "[apps][threads]")
{
    const Sandbox sandbox;
    REQUIRE(sandbox.run("render cornell-box -o all --quiet" + kTiny).code == 0);
    if (::getuid() == 0) {  // root knows no limit: nobody renders, where nobody may
        const std::string nobody = "setpriv --reuid=65534 --regid=65534 --clear-groups ";
        if (std::system((nobody + "'" LRSM_PROGRAM "' --version >/dev/null 2>&1").c_str()) != 0) {
            WARN("SKIPPED: nobody may not start the program");
            return;
        }
        fs::permissions(sandbox.here(), fs::perms::all);
        fs::permissions(sandbox.here().parent_path(), fs::perms(0755));
        for (const int limit : {2, 5, 6}) {
            const std::string folder = "limit" + std::to_string(limit), run = nobody + "prlimit --nproc=" + std::to_string(limit);
            const Outcome outcome = sandbox.run("render cornell-box -o " + folder + " --quiet" + kTiny, run);
            CAPTURE(limit, outcome.err);
            CHECK((outcome.code == 0 || outcome.code == 3));
            CHECK((outcome.err.empty() || isOneLine(outcome.err)));
            if (outcome.code == 0) CHECK(readText(sandbox.here() / folder / "image.exr") == readText(sandbox.here() / "all" / "image.exr"));
        }
    }
}
