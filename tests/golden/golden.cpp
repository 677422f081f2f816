// Holds the frames of goldens.json against this build, pass by pass; README.md beside it says how to change them.
#include "conetrace/render.h"
#include "core/base/errors.h"
#include "core/base/file.h"
#include "core/base/output_folder.h"
#include "core/base/parallel.h"
#include "core/scene/load_scene.h"
#include "core/scene/scene_hash.h"
#include "core/settings/settings_table.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace {

using Json = nlohmann::ordered_json;
using namespace lrsm;

enum class Verdict { same, differs, skipped };

/// A built-in, or a file below $LRSM_SCENES (else ../shared/scenes beside the source tree).
std::string scenePath(const std::string& scene)
{
    if (scene.find('/') == std::string::npos) return scene;
    const char* folder = std::getenv("LRSM_SCENES");
    return ((folder ? std::filesystem::path(folder) : std::filesystem::path(LRSM_SOURCE_DIR) / ".." / "shared" / "scenes") / scene).string();
}

Settings settingsOf(const Json& golden)
{
    Settings settings = preset(golden.at("preset"));
    for (const std::string assignment : golden.at("set")) applySetting(settings, assignment);
    validate(settings);
    return settings;
}

/// Scene hash and pass hashes of this build.
Json hashesOf(const Json& golden, int lanes)
{
    const Scene scene = loadScene(scenePath(golden.at("scene")), {});
    const Settings settings = settingsOf(golden);
    RenderOptions options;
    options.width = golden.at("size").at(0);
    options.height = golden.at("size").at(1);
    options.lanes = lanes;
    const Frame frame = renderFrame(scene, findCamera(scene, "0"), settings, options);
    Json passes = Json::object();
    for (const PassReport& pass : frame.passes) passes[pass.name] = pass.sha256;
    return {{"scene_sha256", hashScene(scene)}, {"passes", std::move(passes)}};
}

/// The first pass in the order of the data flow is the one to look at: what follows reads it.
std::string firstDifference(const Json& golden, const Json& made)
{
    if (golden.value("scene_sha256", "") != made["scene_sha256"].get<std::string>()) return "the scene as loaded";
    const Json expected = golden.value("passes", Json::object());
    for (const auto& [name, hash] : made["passes"].items())
        if (!expected.contains(name) || expected[name].get<std::string>() != hash.get<std::string>()) return "pass \"" + name + "\"";
    return expected.size() == made["passes"].size() ? "" : "the list of passes";
}

Verdict hold(Json& golden, int lanes, bool bless)
{
    const std::string name = golden.at("name"), scene = golden.at("scene");
    if (scene.find('/') != std::string::npos && !std::filesystem::exists(scenePath(scene))) {
        std::printf("  %-24s SKIPPED: no %s\n", name.c_str(), scenePath(scene).c_str());
        return Verdict::skipped;
    }
    const auto begin = std::chrono::steady_clock::now();
    const Json made = hashesOf(golden, lanes);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const std::string difference = firstDifference(golden, made);
    std::printf("  %-24s %5.2f s  %s\n", name.c_str(), seconds, difference.empty() ? "same bits" : ("DIFFERS first in " + difference).c_str());
    if (bless) golden.update(made);
    return difference.empty() ? Verdict::same : Verdict::differs;
}

int run(const std::string& path, int threads, int lanes, const std::string& only, const std::string& reason)
{
    Json file = Json::parse(readFile(path));
    const ThreadLimit limit(threads);
    Json changed = Json::array();
    int skipped = 0;
    int held = 0;
    for (Json& golden : file.at("frames")) {
        if (!only.empty() && golden.at("name") != only) continue;
        ++held;
        const Verdict verdict = hold(golden, lanes, !reason.empty());
        if (verdict == Verdict::differs) changed.push_back(golden.at("name"));
        if (verdict == Verdict::skipped) ++skipped;
    }
    std::printf("%d frames, %zu differ, %d skipped\n", held, changed.size(), skipped);
    if (held == 0) throw InputError("--only " + only, "names no frame");
    if (changed.empty() || reason.empty()) return changed.empty() ? 0 : 1;

    file["history"].push_back({{"reason", reason}, {"frames", changed}});
    const std::string text = file.dump(1, ' ') + "\n";
    writeFileWhole(path, std::as_bytes(std::span(text)));
    std::printf("%s: updated\n", path.c_str());
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    const std::string option = argc == 5 ? argv[3] : "", value = argc == 5 ? argv[4] : "";
    if (argc != 3 && (value.empty() || (option != "--only" && option != "--bless" && option != "--lanes"))) {
        std::fprintf(stderr, "usage: lrsm_golden GOLDENS.json THREADS [--only NAME | --lanes N | --bless REASON]\n");
        return 2;
    }
    try {
        return run(argv[1], std::atoi(argv[2]), option == "--lanes" ? std::stoi(value) : 0, option == "--only" ? value : "", option == "--bless" ? value : "");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lrsm_golden: %s\n", error.what());
        return 2;
    }
}
