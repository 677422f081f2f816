#include "apps/sweep/axes.h"

#include "core/base/errors.h"
#include "core/settings/settings_table.h"

#include "catch.h"

#include <unistd.h>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

using namespace lrsm;

namespace {

std::string refusal(const std::string& axis)
{
    try {
        parseAxis(axis);
        return "";
    } catch (const InputError& error) {
        return error.what();
    }
}

const NamedSettings* labelled(const std::vector<NamedSettings>& all, const std::string& label)
{
    for (const NamedSettings& named : all)
        if (named.label == label) return &named;
    return nullptr;
}

}  // namespace

TEST_CASE("an axis is a key and its values, what --set would refuse is refused", "[sweep][axes]")
{
    const Axis axis = parseAxis("cone_count=4,6,12");
    CHECK(axis.key == "cone_count");
    CHECK(axis.values == std::vector<std::string>{"4", "6", "12"});
    CHECK(parseAxis("storage=float32").values.size() == 1);
    CHECK(refusal("cone_counts=4").find("cone_count") != std::string::npos);
    for (const char* text : {"cone_count", "cone_count=", "=4", "cone_count=4,,6", "cone_count=4,", "cone_count=0", "voxel_resolution=100", "rotation=fast"})
        CHECK_FALSE(refusal(text).empty());
}

TEST_CASE("axes in a file are the same as on the command line", "[sweep][axes]")
{
    const std::string path = (std::filesystem::temp_directory_path() / ("lrsm_axes_" + std::to_string(::getpid()) + ".json")).string();
    const auto read = [&](const std::string& text) {
        std::ofstream(path) << text;
        return readAxes(path);
    };
    const std::vector<Axis> axes = read(R"({"step": [0.5, 1.0], "rotation": ["none"], "fit_ranges": [true, false]})");
    REQUIRE(axes.size() == 3);
    CHECK(axes[0].values == parseAxis("step=0.5,1").values);
    CHECK(axes[2].values == parseAxis("fit_ranges=true,false").values);
    for (const char* text : {"{", "[]", "{}", R"({"step": 1})", R"({"step": []})", R"({"step": [3]})", R"({"stepp": [1]})", R"({"step": [null]})"})
        CHECK_THROWS_AS(read(text), InputError);
    std::filesystem::remove(path);
}

TEST_CASE("a product of axes has every combination that has a meaning, and names the others", "[sweep][axes]")
{
    std::vector<std::string> refused;
    const auto all =
        combine(preset("balanced"), {parseAxis("cone_count=4,6"), parseAxis("estimator=paper,slab"), parseAxis("layer_selection=centre,touched")}, &refused);
    CHECK(all.size() == 6);
    CHECK(refused.size() == 2);
    CHECK(refused.at(0).find("cone_count=4 estimator=slab layer_selection=centre: ") == 0);
    const NamedSettings* one = labelled(all, "cone_count=4 estimator=paper layer_selection=centre");
    REQUIRE(one);
    CHECK(one->settings.cones.set.count == 4);
    CHECK(one->settings.cones.march.estimator == Estimator::paper);
    CHECK(combine(preset("fast"), {}).size() == 1);
}

TEST_CASE("one at a time visits every setting of the program, around every preset", "[sweep][axes]")
{
    for (const std::string& name : presetNames()) {
        const Settings base = preset(name);
        std::vector<std::string> refused;
        const std::vector<NamedSettings> all = oneAtATime(base, &refused);
        // Methods whose cones march through one grid say so.
        const auto ofOneGrid = [](const std::string& line) { return line.find("voxel_cascades=") != std::string::npos; };
        CHECK(std::all_of(refused.begin(), refused.end(), ofOneGrid));
        for (const SettingInfo& info : describeSettings()) {
            if (info.shorthand) continue;
            INFO(name << " " << info.key);
            int visits = 0, differing = 0;
            for (const NamedSettings& named : all) {
                if (named.label.rfind(info.key + "=", 0) != 0) continue;
                ++visits;
                for (const SettingDifference& change : differences(base, named.settings)) differing += change.key == info.key;
            }
            const bool only = info.allowed == info.defaultValue || (info.key == "voxel_cascades" && !refused.empty());  // a choice of one has no other value
            CHECK(visits >= (only ? 0 : 1));
            CHECK(visits <= 14);
            CHECK(differing == visits);
        }
        std::set<std::string> labels;
        for (std::size_t i = 0; i < all.size(); ++i) {
            CHECK_NOTHROW(validate(all[i].settings));
            CHECK(labels.insert(all[i].label).second);
            CHECK_FALSE(all[i].settings == base);
            for (std::size_t j = 0; j < i; ++j) CHECK_FALSE(all[i].settings == all[j].settings);

            // The label says all that differs: applied to the base it gives the setting back.
            Settings said = base;
            for (std::size_t begin = 0; begin < all[i].label.size();) {
                const std::size_t end = std::min(all[i].label.find(' ', begin), all[i].label.size());
                applySetting(said, all[i].label.substr(begin, end - begin));
                begin = end + 1;
            }
            CHECK(said == all[i].settings);
        }
    }
}

TEST_CASE("settings that only matter together are changed together", "[sweep][axes]")
{
    const std::vector<NamedSettings> all = oneAtATime(preset("balanced"));
    CHECK(labelled(all, "gaussian_table_size=256 gaussian=table"));
    CHECK(labelled(all, "gaussian_table_size=64"));         // alone: the same bits as the base
    CHECK_FALSE(labelled(all, "gaussian_table_size=256"));  // and one such value is enough
    CHECK(labelled(all, "density_k=1 estimator=paper"));
    CHECK(labelled(all, "layer_selection=centre estimator=paper"));
    CHECK(labelled(all, "layer_overlap=0.1 estimator=paper layer_selection=centre"));
    CHECK(labelled(all, "shadow_cone_aperture_degrees=5 shadows=cone"));
    CHECK(labelled(all, "rotation=none irradiance_filter=false"));
    CHECK(labelled(oneAtATime(preset("literal")), "emitter_slant_cap=1 layer_overlap=0 layer_selection=touched estimator=slab"));
}

TEST_CASE("the search's axes hold what the presets of `slab` choose", "[sweep][axes]")
{
    for (const Axis& axis : searchAxes()) {
        CHECK(axis.values.size() >= 2);
        for (const char* name : {"fast", "balanced", "fine"}) {
            INFO(name << " " << axis.key);
            int matches = 0;
            for (const std::string& value : axis.values) {
                Settings settings = preset(name);
                applySetting(settings, axis.key + "=" + value);
                matches += settings == preset(name);
            }
            CHECK(matches == 1);
        }
    }
}
