#include "core/base/errors.h"
#include "core/settings/settings_table.h"

#include "catch.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <set>
#include <sstream>

using namespace lrsm;
using Json = nlohmann::ordered_json;

namespace {

std::string readSource(const std::string& path)
{
    std::ifstream file(std::string(LRSM_SOURCE_DIR) + "/" + path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// The message of the InputError that `body` throws; empty if it throws none.
template <class Body>
std::string refusal(const Body& body)
{
    try {
        body();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

std::string refusalOf(const std::string& assignment)
{
    Settings settings;
    return refusal([&] { applySetting(settings, assignment); });
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// A choice of one has no other value.
bool single(const SettingInfo& info)
{
    return info.allowed == info.defaultValue;
}

/// A value other than the current one, in range.
std::string otherValue(const SettingInfo& info, const std::string& current)
{
    if (info.allowed == "true | false") return current == "true" ? "false" : "true";
    if (const auto bar = info.allowed.find(" | "); bar != std::string::npos) {
        const std::string first = info.allowed.substr(0, bar), last = info.allowed.substr(info.allowed.rfind(" | ") + 3);
        return current == first ? last : first;
    }
    if (contains(info.allowed, "power of two")) {
        const int least = std::max(2, std::stoi(info.allowed));
        return std::to_string(current == std::to_string(least) ? 2 * least : least);
    }
    if (contains(info.allowed, "0 .. 3") || contains(info.allowed, "1 .. 4")) return current == "1" ? "2" : "1";
    if (contains(info.allowed, " .. ")) return current == "7" ? "5" : "7";
    return current == "0.3" ? "0.4" : "0.3";
}

}  // namespace

TEST_CASE("settings: every field of settings.h has a row, so that none can be forgotten", "[settings]")
{
    const std::string header = readSource("core/settings/settings.h");
    // A field is an indented line "Type name = default;".
    const std::regex field(R"(\n    [A-Za-z:]+ [A-Za-z]+ = [^;]+;)");
    const auto fields = std::distance(std::sregex_iterator(header.begin(), header.end(), field), std::sregex_iterator());
    CHECK(static_cast<std::size_t>(fields) == settingsToJson(Settings()).size());
}

TEST_CASE("settings: each row reads and writes a field of its own", "[settings]")
{
    std::set<std::string> keys;
    for (const SettingInfo& info : describeSettings()) {
        CAPTURE(info.key);
        CHECK(keys.insert(info.key).second);
        CHECK_FALSE(info.meaning.empty());
        CHECK_FALSE(info.source.empty());
        if (info.shorthand || single(info)) continue;

        const Settings before = preset("balanced");
        Settings after = before;
        const std::string value = otherValue(info, info.defaultValue);
        applySetting(after, info.key + "=" + value);
        const auto changes = differences(before, after);
        REQUIRE(changes.size() == 1);
        CHECK(changes[0].key == info.key);
        CHECK(changes[0].b == value);
        CHECK_FALSE(before == after);
    }
}

TEST_CASE("settings: choices follow the order of their enumeration", "[settings]")
{
    Settings s;
    for (const char* text : {"mip_filter=max", "voxelization=raster", "opacity_axes=isotropic", "shadows=off", "estimator=paper", "backface=cosine",
                             "gaussian=exact", "rotation=azimuth", "specular_aperture=fixed", "transmittance=exponential", "opacity=none",
                             "layer_selection=centre", "filter_fraction=8bit", "rsm_storage=float32", "layer_half_rounding=nearest_even"})
        applySetting(s, text);
    CHECK(s.voxel.mipFilter == MipFilter::max);
    CHECK(s.voxel.mode == Voxelization::raster);
    CHECK(s.voxel.axes == OpacityAxes::isotropic);
    CHECK(s.direct.shadows == Shadows::off);
    CHECK(s.cones.march.estimator == Estimator::paper);
    CHECK(s.cones.gather.backface == Backface::cosine);
    CHECK(s.cones.gather.gaussian == GaussianMethod::exact);
    CHECK(s.cones.set.rotation == Rotation::azimuth);
    CHECK(s.cones.specular.aperture == SpecularAperture::fixed);
    CHECK(s.cones.march.transmittance == TransmittanceModel::exponential);
    CHECK(s.cones.march.opacity == OpacityModel::none);
    CHECK(s.cones.gather.layerSelection == LayerSelection::centre);
    CHECK(s.cones.march.filterFraction == FilterFraction::fixed8);
    CHECK(s.rsm.storage == Storage::float32);
    CHECK(s.voxel.storage == Storage::gpu);
    CHECK(s.layers.halfRounding == HalfRounding::nearestEven);
    CHECK(s.rsm.halfRounding == HalfRounding::d3d);
}

TEST_CASE("settings: a shorthand sets each of its stages", "[settings]")
{
    Settings s;
    applySetting(s, "storage=float32");
    applySetting(s, "half_rounding=nearest_even");
    CHECK(s.voxel.storage == Storage::float32);
    CHECK(s.rsm.storage == Storage::float32);
    CHECK(s.layers.storage == Storage::float32);
    CHECK(s.rsm.halfRounding == HalfRounding::nearestEven);
    CHECK(s.layers.halfRounding == HalfRounding::nearestEven);
}

TEST_CASE("settings: a refusal names key, value and what is allowed", "[settings]")
{
    CHECK(refusalOf("cone_count=0") == "setting cone_count=0: must be 1 .. 256");
    CHECK(refusalOf("step=0") == "setting step=0: must be (0, 2]");
    CHECK(refusalOf("step=nan") == "setting step=nan: must be (0, 2]");
    CHECK(refusalOf("transmittance_cutoff=1") == "setting transmittance_cutoff=1: must be [0, 1)");
    CHECK(refusalOf("mip_filter=median") == "setting mip_filter=median: must be mean | coverage | max");
    CHECK(refusalOf("fit_ranges=yes") == "setting fit_ranges=yes: must be true | false");
    CHECK(refusalOf("voxel_resolution=100") == "setting voxel_resolution=100: must be 1 .. 2048, power of two");
    for (const char* text : {"cone_count=", "cone_count=6x", "cone_count=6.5", "cone_count=99999999999", "push=inf", "push=-inf", "push= 1", "push=1e99",
                             "push=0x1p3", "cone_count", "=6", "", "="})
        CHECK_FALSE(refusalOf(text).empty());
}

TEST_CASE("settings: a misspelt key is answered with the nearest", "[settings]")
{
    CHECK(contains(refusalOf("cone_cuont=6"), "did you mean cone_count?"));
    CHECK(contains(refusalOf("voxelresolution=6"), "did you mean voxel_resolution?"));
    CHECK(contains(refusalOf("filter=true"), "_filter?"));
    CHECK_FALSE(contains(refusalOf("zzzzzzzzzzzzzzzz=6"), "did you mean"));
}

TEST_CASE("settings: JSON carries every value there and back to the bit", "[settings]")
{
    std::mt19937 random(7);
    std::uniform_real_distribution<float> real(0.05f, 0.45f);
    for (int round = 0; round < 200; ++round) {
        Settings s;
        s.cones.march.step = real(random);
        s.cones.march.push = real(random);
        s.cones.march.voxelLevelBias = -real(random) * 1e-7f;
        s.layers.overlap = real(random);
        s.cones.set.count = 1 + round;
        s.layers.fitRanges = round % 2;
        Settings back = preset("accurate");
        applySettingsJson(back, Json::parse(settingsToJson(s).dump()), "test");
        REQUIRE(back == s);
    }
    CHECK(settingsToJson(Settings())["transmittance_cutoff"].dump() == "0.01");  // not 0.009999999776482582
}

TEST_CASE("settings: a file with an unknown key, a wrong type or a bad value is refused, and says where", "[settings]")
{
    const auto refuse = [](const std::string& text) {
        Settings s;
        return refusal([&] { applySettingsJson(s, Json::parse(text), "file.json"); });
    };
    CHECK(contains(refuse(R"({"cone_cuont": 6})"), "file.json: there is no setting \"cone_cuont\"; did you mean cone_count?"));
    CHECK(contains(refuse(R"({"cone_count": "6"})"), "file.json: cone_count: must be a number"));
    CHECK(contains(refuse(R"({"fit_ranges": 1})"), "must be true or false"));
    CHECK(contains(refuse(R"({"mip_filter": 1})"), "must be a string"));
    CHECK(contains(refuse(R"({"cone_count": 6.5})"), "file.json: setting cone_count=6.5: must be 1 .. 256"));
    CHECK(contains(refuse(R"({"step": null})"), "must be a number"));
    CHECK(contains(refuse("[1]"), "must be a JSON object"));
    CHECK(refuse(R"({"cone_count": 9, "push": 1, "storage": "float32"})").empty());
    CHECK(refuse(R"({"version": "1", "settings": {"cone_count": 9}})").empty());  // frame.json serves as a settings file
}

TEST_CASE("settings: a file that is not there, not JSON, empty or a folder is one clear line", "[settings]")
{
    const auto folder = std::filesystem::temp_directory_path() / "lrsm_test_settings";
    std::filesystem::create_directories(folder);
    const std::string file = (folder / "s.json").string();
    const auto refuse = [&](const std::string& text) {
        std::ofstream(file) << text;
        Settings s;
        return refusal([&] { applySettingsFile(s, file); });
    };
    CHECK(refuse(R"({"cone_count": 9})").empty());
    for (const char* text : {"", "{", "{\"cone_count\": 9", "nonsense", "\xff\xfe", "{\"cone_count\": NaN}", "[[[[[[[[", "{\"push\": 1e400}"}) {
        const std::string message = refuse(text);
        CHECK(message.starts_with(file + ": "));
        CHECK_FALSE(contains(message, "\n"));
    }
    Settings s;
    CHECK(contains(refusal([&] { applySettingsFile(s, folder.string()); }), "is a folder"));
    CHECK(contains(refusal([&] { applySettingsFile(s, (folder / "none.json").string()); }), "no such file"));
    std::filesystem::remove_all(folder);
}

TEST_CASE("settings: validate refuses what no assignment could have let in", "[settings]")
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (float MarchSettings::*field : {&MarchSettings::step, &MarchSettings::push, &MarchSettings::densityK, &MarchSettings::voxelLevelBias}) {
        Settings s;
        s.cones.march.*field = nan;
        CHECK(contains(refusal([&] { validate(s); }), "=nan: must be"));
        s.cones.march.*field = std::numeric_limits<float>::infinity();
        CHECK(contains(refusal([&] { validate(s); }), "=inf: must be"));
    }
    Settings s;
    s.voxel.resolution = 96;
    CHECK(contains(refusal([&] { validate(s); }), "voxel_resolution=96"));
    s = {};
    s.layers.overlap = 0.1f;
    CHECK(contains(refusal([&] { validate(s); }), "count light twice"));
    s.cones.gather.layerSelection = LayerSelection::centre;
    CHECK(contains(refusal([&] { validate(s); }), "estimator=slab"));
    s.cones.march.estimator = Estimator::paper;
    CHECK(refusal([&] { validate(s); }).empty());
    s.cones.gather.backface = static_cast<Backface>(7);
    CHECK(contains(refusal([&] { validate(s); }), "backface"));
}

TEST_CASE("settings: every preset is valid, the literal one is the paper's reading", "[settings]")
{
    for (const std::string& name : presetNames()) {
        CAPTURE(name);
        CHECK(refusal([&] { validate(preset(name)); }).empty());
    }
    const Settings paper = preset("literal");
    CHECK(paper.cones.march.estimator == Estimator::paper);
    CHECK(paper.cones.march.opacity == OpacityModel::none);
    CHECK(paper.cones.gather.backface == Backface::cosine);
    CHECK(paper.cones.set.count == 6);
    CHECK(paper.layers.depthLayers * paper.layers.normalLayers == 4);
    CHECK(paper.layers.outermostDecay);

    // The preset `paper` differs from it in what the paper leaves open alone.
    const std::set<std::string> open{"voxel_resolution",
                                     "fit_ranges",
                                     "outermost_decay",
                                     "layer_overlap",
                                     "aperture_scale",
                                     "rotation",
                                     "irradiance_filter",
                                     "min_diameter_voxels",
                                     "push",
                                     "opacity",
                                     "density_k",
                                     "voxel_level_bias",
                                     "layer_selection",
                                     "backface",
                                     "v_radius_scale",
                                     "shadow_cone_aperture_degrees"};
    for (const SettingDifference& change : differences(paper, preset("paper"))) {
        CAPTURE(change.key);
        CHECK(open.count(change.key) == 1);
    }
    CHECK(contains(refusal([] { preset("best"); }), "literal, paper, fast, balanced, fine, accurate"));
}

TEST_CASE("settings: docs/settings.md is what `lrsm settings --markdown` prints", "[settings][docs]")
{
    CHECK(readSource("docs/settings.md") == settingsMarkdown());
}
