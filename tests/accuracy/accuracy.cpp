// Holds the presets against the path tracer on the built-in scenes; README.md beside it says how limits and truths are made anew.
#include "conetrace/render.h"
#include "core/base/errors.h"
#include "core/scene/builtin_scenes.h"
#include "core/scene/scene_hash.h"
#include "core/settings/settings_table.h"
#include "tests/accuracy/limits.h"
#include "tests/accuracy/planted.h"
#include "tests/accuracy/truth.h"

#include <cstdio>
#include <functional>
#include <iostream>
#include <set>

namespace lrsm::accuracy {
namespace {

const std::string kFolder = LRSM_SOURCE_DIR "/tests/accuracy/";
const std::string kLimits = kFolder + "limits.json";
constexpr char kPlantedIn[] = "fast";  // its frames are cheap, and whatever is lost shows in them

/// Every way to make a frame, by name. What is new here fails the test by its name until it is given limits.
std::vector<std::pair<std::string, Settings>> variants()
{
    std::vector<std::pair<std::string, Settings>> all;
    for (const std::string& name : presetNames()) all.emplace_back(name, preset(name));
    // Tiles and blocks are in pixels, and the presets' are for pictures a dozen times as wide as these.
    constexpr int kSmallTile = 4;
    for (auto& [name, settings] : all) {
        settings.caches.tile = kSmallTile;
        settings.proxies.marchDivisor = settings.proxies.gatherDivisor = 1;
    }
    return all;
}

struct Case {
    std::string name;
    Scene scene;
    StoredTruth truth;
    const Camera& camera() const { return scene.cameras.at(0); }
};

Case loadCase(const std::string& name)
{
    const std::string path = kFolder + "truth/" + name + ".exr";
    Case one{name, makeBuiltinScene(name).value(), readTruth(path)};
    if (one.truth.sceneSha256 != hashScene(one.scene)) throw InputError(path, "is of another scene than the built-in is now; make_truth.sh makes it anew");
    return one;
}

/// The case of each built-in scene, one after the other; `only`: of this one, empty: of all.
void forEachCase(const std::string& only, const std::function<void(const Case&)>& visit)
{
    bool found = false;
    for (const BuiltinSceneInfo& info : builtinScenes()) {
        if (!only.empty() && info.name != only) continue;
        found = true;
        visit(loadCase(info.name));
    }
    if (!found) throw InputError("--only " + only, "names no built-in scene");
}

Frame render(const Case& one, const Settings& settings)
{
    RenderOptions options;
    options.width = one.truth.width;
    options.height = one.truth.height;
    options.watch.hashPasses = false;
    return renderFrame(one.scene, one.camera(), settings, options);
}

using Row = std::pair<RowName, PictureError>;

std::vector<Row> rowsOf(const Case& one, const std::string& variant, const Frame& frame)
{
    const std::vector<PictureError> errors = errorsOf(one.truth, frame);
    std::vector<Row> rows;
    for (std::size_t i = 0; i < errors.size(); ++i) rows.push_back({{one.name, variant, kLayers[i].name}, errors[i]});
    return rows;
}

std::string title(const RowName& row)
{
    return row.scene + ", " + row.preset + ", " + row.layer;
}

/// Prints a line for each limit that does not hold, and counts them.
std::size_t judge(const LimitTable& table, const std::vector<Row>& rows)
{
    std::size_t lines = 0;
    for (const auto& [name, error] : rows) {
        const auto limits = table.find(name);
        const std::vector<std::string> wrong = limits == table.end() ? std::vector<std::string>{"has no limits"} : complaints(error, limits->second);
        for (const std::string& line : wrong) std::cout << title(name) << ": " << line << "\n";
        lines += wrong.size();
    }
    return lines;
}

int hold(const std::string& only)
{
    const LimitTable table = readLimits(kLimits);
    std::set<RowName> held;
    std::size_t failures = 0;
    forEachCase(only, [&](const Case& one) {
        for (const auto& [name, settings] : variants()) {
            const std::vector<Row> rows = rowsOf(one, name, render(one, settings));
            for (const Row& row : rows) held.insert(row.first);
            failures += judge(table, rows);
        }
    });
    for (const auto& [name, limits] : table)
        if ((only.empty() || name.scene == only) && !held.contains(name)) {
            std::cout << title(name) << ": has limits, but is not made\n";
            ++failures;
        }
    std::cout << held.size() << " pictures held, " << failures << " failures\n";
    return failures == 0 ? 0 : 1;
}

/// limits.json on standard output, the figures that it is made from on the other.
int measureAll()
{
    std::vector<std::pair<RowName, Limits>> limits;
    forEachCase("", [&](const Case& one) {
        for (const auto& [variant, settings] : variants())
            for (const auto& [name, error] : rowsOf(one, variant, render(one, settings))) {
                std::fprintf(stderr, "%-50s energy %.4f  net RMSE / mean %.4f  noise of the truth %.4f  FLIP %.4f\n", title(name).c_str(), error.energy,
                             error.net(), error.noise, error.flip);
                limits.emplace_back(name, limitsFor(error));
            }
    });
    std::cout << tableText(limits);
    return 0;
}

/// 0 where all limits hold without the loss, and some scene's break with it.
int plant(Loss loss)
{
    const LimitTable table = readLimits(kLimits);
    std::size_t without = 0;
    std::string caught;
    forEachCase("", [&](const Case& one) {
        const auto broken = [&](Loss planted) {
            return judge(table,
                         rowsOf(one, kPlantedIn, renderWithLoss(one.scene, one.camera(), preset(kPlantedIn), one.truth.width, one.truth.height, planted)));
        };
        without += broken(Loss::none);
        if (broken(loss) > 0) caught += " " + one.name;
    });
    std::cout << "with the loss, limits break in:" << (caught.empty() ? " no scene" : caught) << "; without it " << without << " break\n";
    return !caught.empty() && without == 0 ? 0 : 1;
}

int run(const std::vector<std::string>& arguments)
{
    static const std::map<std::string, Loss> losses{{"layer", Loss::layer}, {"transmittance", Loss::transmittance}, {"albedo", Loss::albedo}};
    const std::string option = arguments.empty() ? "" : arguments[0];
    if (arguments.empty()) return hold("");
    if (option == "--only" && arguments.size() == 2) return hold(arguments[1]);
    if (option == "--measure" && arguments.size() == 1) return measureAll();
    if (option == "--plant" && arguments.size() == 2 && losses.contains(arguments[1])) return plant(losses.at(arguments[1]));
    if (option == "--store" && arguments.size() == 3) {
        storeTruth(arguments[1], arguments[2]);
        return 0;
    }
    std::fprintf(stderr, "usage: lrsm_accuracy [--only SCENE | --measure | --plant layer|transmittance|albedo | --store IMAGE.exr TRUTH.exr]\n");
    return 2;
}

}  // namespace
}  // namespace lrsm::accuracy

int main(int argc, char** argv)
{
    try {
        return lrsm::accuracy::run({argv + 1, argv + argc});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lrsm_accuracy: %s\n", error.what());
        return 2;
    }
}
