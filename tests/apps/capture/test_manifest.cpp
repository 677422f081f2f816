#include "apps/capture/capture_files.h"
#include "apps/capture/manifest_read.h"
#include "apps/capture/manifest_write.h"
#include "core/base/errors.h"
#include "tests/apps/capture/capture_fixture.h"

#include "catch.h"
#include "python.h"
#include "scratch.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

using namespace lrsm;
using namespace lrsm::test;

namespace {

using Json = nlohmann::ordered_json;

const Capture& boxCapture()
{
    static const Capture capture = record("cornell-box", smallSettings()).capture;
    return capture;
}

void write(const ScratchFolder& scratch, const Capture& capture)
{
    OutputFolder folder(scratch.path("capture"));
    writeCapture(folder, capture);
    folder.commit();
}

template <class Read>
std::string messageOf(Read&& read)
{
    try {
        read();
    } catch (const InputError& error) {
        return error.what();
    }
    return "read";
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("manifest: what makes no sense is one line that names the place", "[capture][manifest]")
{
    struct Case {
        std::string pointer;
        Json value;  ///< null: erased
        std::string place, why;
    };
    const std::vector<Case> cases = {
        {"/format", "png", "m: format", "this is no capture"},
        {"/format_version", 2, "m: format_version", "is not 1"},
        {"/size/0", 0, "m: size[0]", "1 .. 16384"},
        {"/size", Json::array({4}), "m: size", "2 entries"},
        {"/scene", nullptr, "m: scene", "is missing"},
        {"/scene/complete", 1, "m: scene: complete", "true or false"},
        {"/settings/cone_count", 0, "m: settings", "cone_count"},
        {"/settings/cone_cuont", 6, "m: settings", "cone_count"},
        {"/camera/position/1", "x", "m: camera: position[1]", "number"},
        {"/camera/vertical_fov", 1e300, "m: camera: vertical_fov", "float32"},
        {"/grid/resolution", 64, "m: grid: resolution", "32 .. 32"},
        {"/grid/voxel_size", -1, "m: grid: voxel_size", "above 0"},
        {"/lights/0/type", "moon", "m: lights[0]: type", "moon"},
        {"/lights/0/projection/depth_far", -1, "m: lights[0]: projection: depth_far", "depth_near"},
        {"/lights/0/projection/resolution", 128, "m: lights[0]: projection: resolution", "64 .. 64"},
        {"/lights/0/partition/0/stored", 1, "m: lights[0]: partition[0]: stored", "0 .. 0"},
        {"/lights/0/partition/0/depth_max", 0, "m: lights[0]: partition[0]: depth_max", "above depth_min"},
        {"/passes/0/inputs", 3, "m: passes[0]: inputs", "list"},
        {"/buffers/0/name", "../x", "m: buffers[0]: name", "letters"},
        {"/buffers/0/file", "../x.npy", "m: buffers[0] (scene.positions): file", "own folder"},
        {"/buffers/0/file", "/etc/passwd", "m: buffers[0] (scene.positions): file", "own folder"},
        {"/buffers/0/dtype", "f16", "m: buffers[0] (scene.positions): dtype", "f16"},
        {"/buffers/0/encoding", "unorm", "m: buffers[0] (scene.positions): encoding", "u1 or u2"},
        {"/buffers/0/shape/0", -1, "m: buffers[0] (scene.positions): shape[0]", "0 .."},
        {"/buffers/0/shape", Json::array({1ull << 62, 1ull << 62}), "m: buffers[0] (scene.positions): shape", "larger than any file"},
        {"/buffers/0/axes", Json::array({"vertex"}), "m: buffers[0] (scene.positions): axes", "each"},
        {"/buffers/0/components", Json::array({"x"}), "m: buffers[0] (scene.positions): components", "last axis"},
        {"/buffers/0/tolerance/kind", "close", "m: buffers[0] (scene.positions): tolerance: kind", "exact, ulp"},
        {"/buffers/0/tolerance/value", -1, "m: buffers[0] (scene.positions): tolerance", "negative"},
        {"/buffers/1/name", "scene.positions", "m: buffers[1]", "twice"},
        {"/history", Json::object(), "m: history", "list"},
    };
    const Json good = manifestJson(boxCapture());
    REQUIRE(messageOf([&] { captureFromManifest(good, "m"); }) == "read");
    for (const Case& c : cases) {
        Json manifest = good;
        const Json::json_pointer pointer(c.pointer);
        if (c.value.is_null())
            manifest.at(pointer.parent_pointer()).erase(pointer.back());
        else
            manifest[pointer] = c.value;
        const std::string message = messageOf([&] { captureFromManifest(manifest, "m"); });
        CAPTURE(c.pointer, message);
        CHECK(message.starts_with(c.place + ":"));
        CHECK(contains(message, c.why));
        CHECK_FALSE(contains(message, "\n"));
    }
}

TEST_CASE("manifest: every number survives the file to the last bit", "[capture][manifest]")
{
    Capture capture = boxCapture();
    capture.lights[0].light.intensity = Vec3(0.1f, 1e-38f, 3.4e38f);
    capture.lights[0].light.range = 1.0f / 3.0f;
    capture.camera.position = Vec3(-0.0f, 16777216.0f, 1e-45f);
    capture.history = {{"a reason", "0.2", {"voxel.bits"}}};
    const Capture back = captureFromManifest(Json::parse(manifestJson(capture).dump()), "m");
    CHECK(manifestJson(back).dump() == manifestJson(capture).dump());
    CHECK(back.lights[0].light.intensity == capture.lights[0].light.intensity);
    CHECK(back.lights[0].light.range == 1.0f / 3.0f);
    CHECK(std::signbit(back.camera.position.x));
    CHECK(back.camera.position == capture.camera.position);
    CHECK(back.lights[0].partition == capture.lights[0].partition);
    CHECK(back.grid == capture.grid);
}

TEST_CASE("capture: missing, changed and damaged files are one line that names the file", "[capture][files]")
{
    namespace fs = std::filesystem;
    const ScratchFolder scratch;
    const auto message = [&] { return messageOf([&] { readCapture(scratch.path("capture")); }); };
    CHECK(contains(message(), "there is no such folder"));
    write(scratch, boxCapture());
    REQUIRE(message() == "read");

    const fs::path file = scratch.path("capture/gbuffer.depth.npy"), aside = scratch.path("aside");
    fs::rename(file, aside);
    CHECK(contains(message(), "gbuffer.depth.npy: there is no such file"));
    fs::copy_file(scratch.path("capture/gbuffer.object_id.npy"), file);
    CHECK(contains(message(), "holds u4 where the manifest says f4"));
    fs::remove(file);
    fs::copy_file(scratch.path("capture/scene.positions.npy"), file);
    CHECK(contains(message(), "another shape"));
    fs::remove(file);
    fs::copy_file(aside, file);
    std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).seekp(500).put('\x55');
    CHECK(contains(message(), "gbuffer.depth.npy: has another SHA-256"));

    fs::rename(scratch.path("capture/manifest.json"), scratch.path("m"));
    CHECK(contains(message(), "has no manifest.json"));
    scratch.write("capture/manifest.json", "{\"format\": ");
    CHECK(contains(message(), "is no JSON: line 1"));
}

TEST_CASE("manifest: follows docs/capture.schema.json", "[capture][schema]")
{
    LRSM_NEED_PYTHON(python, "jsonschema");
    Settings specular = smallSettings();
    specular.force.everything = true;
    specular.cones.gather.gaussian = GaussianMethod::table;
    const ScratchFolder scratch;
    scratch.write("box.json", manifestJson(boxCapture()).dump());
    scratch.write("rooms.json", manifestJson(record("two-rooms", specular).capture).dump());
    Json wrong = manifestJson(boxCapture());
    wrong["buffers"][3]["dtype"] = "c8";
    scratch.write("wrong.json", wrong.dump());
    scratch.write("validate.py",
                  "import json, sys, jsonschema\n"
                  "v = jsonschema.Draft7Validator(json.load(open(sys.argv[1])))\n"
                  "v.check_schema(v.schema)\n"
                  "e = [error.message for error in v.iter_errors(json.load(open(sys.argv[2])))]\n"
                  "print(e); sys.exit(len(e))\n");
    const auto validate = [&](const std::string& manifest) {
        return runCommand(python + " " + scratch.path("validate.py") + " " LRSM_SOURCE_DIR "/docs/capture.schema.json " + scratch.path(manifest));
    };
    for (const std::string manifest : {"box.json", "rooms.json"}) {
        const CommandOutcome outcome = validate(manifest);
        INFO(outcome.text);
        CHECK(outcome.code == 0);
    }
    CHECK(validate("wrong.json").code == 1);
}

TEST_CASE("capture: numpy alone computes passes anew, bit for bit", "[capture][numpy]")
{
    LRSM_NEED_PYTHON(python, "numpy");
    Settings paper = smallSettings();
    paper.voxel.axes = OpacityAxes::isotropic;
    paper.cones.march.estimator = Estimator::paper;
    paper.layers.overlap = 0.2f;
    paper.layers.depthLayers = 3;
    paper.cones.gather.layerSelection = LayerSelection::centre;
    paper.layers.halfRounding = HalfRounding::nearestEven;
    paper.cones.set.setsPerPixel = 2;
    paper.cones.set.filter = false;
    const auto [scene, settings] = GENERATE_COPY(table<std::string, Settings>({{"cornell-box", smallSettings()}, {"two-rooms", paper}}));
    const ScratchFolder scratch;
    write(scratch, record(scene, settings).capture);
    const auto recompute = [&] { return runCommand(python + " " LRSM_SOURCE_DIR "/docs/examples/recompute_pass.py " + scratch.path("capture")); };
    const CommandOutcome outcome = recompute();
    INFO(outcome.text);
    CHECK(outcome.code == 0);
    CHECK(contains(outcome.text, "lrsm0.depth.mip5: identical"));
    CHECK(contains(outcome.text, "lrsm0.normal.mip0: identical"));
    CHECK(contains(outcome.text, "voxel.mip5: identical"));
    CHECK(contains(outcome.text, "cones.irradiance: identical"));
    CHECK(contains(outcome.text, "composite.combined: identical"));

    // A single wrong bit is seen.
    const std::string file = scratch.path("capture/lrsm0.depth.mip2.npy");
    std::fstream damaged(file, std::ios::in | std::ios::out | std::ios::binary);
    damaged.seekg(160);
    const int byte = damaged.get();
    damaged.seekp(160).put(static_cast<char>(byte ^ 1));
    damaged.close();
    const CommandOutcome after = recompute();
    CHECK(after.code == 1);
    CHECK(contains(after.text, "lrsm0.depth.mip2: 1 bytes differ"));
}
