#include "catch.h"
#include "sandbox.h"

#include <nlohmann/json.hpp>

using namespace lrsm::test;
using TuneJson = nlohmann::json;

namespace {

// Small pictures, few samples, small maps: each point takes milliseconds.
const std::string kTinyTune = "tune cornell-box --size 32x18 --probe 32x18 --spp 128 --set voxel_resolution=32 --set rsm_resolution=32 ";

}  // namespace

TEST_CASE("program: tune writes settings that meet the budget, and that render takes", "[apps][tune]")
{
    Sandbox box;
    const Outcome run = box.run(kTinyTune + "--max-error 1 --max-memory 100 -o found.json");
    REQUIRE(run.code == 0);
    CHECK(contains(run.out, "chosen:"));
    const TuneJson json = TuneJson::parse(readText(box.here() / "found.json"));
    CHECK(json["settings"]["voxel_resolution"] == 32);
    CHECK(json["tune"]["met"] == true);
    bool verified = false;
    for (const TuneJson& point : json["tune"]["points"])
        if (point["name"] == json["tune"]["chosen"]) {
            verified = true;
            CHECK(point["verified"]["error"].get<double>() <= 1.0);
            CHECK(point["verified"]["megabytes"].get<double>() <= 100.0);
        }
    CHECK(verified);

    const Outcome render = box.run("render cornell-box --preset literal --settings found.json --size 32x18 --max-memory 100 -o frame");
    REQUIRE(render.code == 0);
    const TuneJson frame = TuneJson::parse(readText(box.here() / "frame" / "frame.json"));
    CHECK(frame["settings"] == json["settings"]);
}

TEST_CASE("program: tune says that nothing meets a budget, and writes the nearest only when asked to", "[apps][tune]")
{
    Sandbox box;
    const Outcome none = box.run(kTinyTune + "--max-memory 0.001 -o found.json");
    CHECK(none.code == 1);
    CHECK(contains(none.out, "no settings meet this budget"));
    CHECK(contains(none.out, "nearest:"));
    CHECK(box.empty());

    // Among the points of another method.
    const Outcome nearest = box.run(kTinyTune + "--max-memory 0.001 --nearest --set method=vct -o found.json");
    CHECK(nearest.code == 1);
    const TuneJson found = TuneJson::parse(readText(box.here() / "found.json"));
    CHECK(found["tune"]["met"] == false);
    CHECK(found["settings"]["method"] == "vct");
    CHECK(found["tune"]["points"].size() > 4);
}

TEST_CASE("program: tune refuses what it cannot promise, in one line", "[apps][tune]")
{
    Sandbox box;
    for (const char* arguments :
         {"-o found.json", "--max-error 0.1", "--max-error 0 -o found.json", "--max-time soon -o found.json", "--max-time nan -o found.json",
          "--max-error 0.1 --metric psnr -o found.json", "--max-error 1e-6 -o found.json", "--max-error 1 --spp 1 -o found.json"}) {
        const Outcome run = box.run(kTinyTune + arguments);
        CAPTURE(arguments, run.err);
        CHECK(run.code == 2);
        CHECK(isOneLine(run.err));
        CHECK(box.empty());
    }
    CHECK(contains(box.run(kTinyTune + "--max-error 0.001 -o found.json").err, "--spp"));
}
