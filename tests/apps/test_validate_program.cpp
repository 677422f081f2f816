#include "catch.h"
#include "sandbox.h"

#include <nlohmann/json.hpp>

using namespace lrsm::test;
using ValidateJson = nlohmann::json;

TEST_CASE("program: validate holds one equation, and says which bounds", "[apps][validate]")
{
    Sandbox box;
    const Outcome run = box.run("validate --equation 15 --no-speed --json");
    REQUIRE(run.code == 0);
    const ValidateJson json = ValidateJson::parse(run.out);
    CHECK(json["held"] == true);
    CHECK_FALSE(json.contains("ladder"));
    REQUIRE(json["equations"]["checks"].size() >= 1);
    for (const ValidateJson& check : json["equations"]["checks"]) {
        CHECK(check["equation"] == "15");
        CHECK(check["worst"].get<double>() <= check["bound"].get<double>());
        CHECK(check["evaluations"].get<std::uint64_t>() > 0);
        CHECK_FALSE(check["worstInput"].get<std::string>().empty());
    }
}

TEST_CASE("program: validate climbs the ladder of a scene and writes a page, JSON and CSV", "[apps][validate]")
{
    Sandbox box;
    const std::string ladder = "validate cornell-box --size 48x27 --samples 60 --set voxel_resolution=32 --set rsm_resolution=64";
    const Outcome run = box.run(ladder + " -o result");
    REQUIRE(run.code == 0);
    CHECK(contains(run.out, "Eq. 10-12"));

    const ValidateJson json = ValidateJson::parse(readText(box.here() / "result" / "validate.json"));
    REQUIRE(json["ladder"].size() == 1);
    CHECK(json["ladder"][0]["samples"] == 60);
    CHECK(json["ladder"][0]["radiance"]["rungs"].size() == 9);
    CHECK(contains(readText(box.here() / "result" / "report.html"), "Where error enters"));
    const std::string samples = readText(box.here() / "result" / "samples-cornell-box.csv");
    CHECK(std::count(samples.begin(), samples.end(), '\n') == 61);

    // The worst cases point at pixels that --pixel can explain.
    const ValidateJson worst = json["ladder"][0]["radiance"]["worst"][0];
    const std::string pixel = std::to_string(worst["pixel"][0].get<int>()) + "," + std::to_string(worst["pixel"][1].get<int>());
    CHECK(box.run("render cornell-box --size 48x27 --set voxel_resolution=32 --set rsm_resolution=64 --pixel " + pixel).code == 0);

    // The same figures for any number of threads.
    const Outcome one = box.run(ladder + " --json --threads 1"), many = box.run(ladder + " --json --threads 7");
    CHECK(one.out == many.out);
}

TEST_CASE("program: validate --extremes runs what is asked for", "[apps][validate]")
{
    Sandbox box;
    const Outcome run = box.run("validate --extremes --only moments --json");
    REQUIRE(run.code == 0);
    const ValidateJson json = ValidateJson::parse(run.out);
    REQUIRE(json["extremes"]["results"].size() >= 1);
    for (const ValidateJson& result : json["extremes"]["results"]) CHECK(result["outcome"] != "broken");
}

TEST_CASE("program: validate refuses what has no meaning in one line", "[apps][validate]")
{
    Sandbox box;
    for (const char* arguments : {"--equation 99", "--equation 12 cornell-box", "--only moments", "--extremes --equation 12", "--extremes --only no-such-case",
                                  "no-such-scene", "--samples 0", "cornell-box --preset none"}) {
        const Outcome run = box.run(std::string("validate ") + arguments + " -o result");
        INFO(arguments);
        CHECK(run.code == 2);
        CHECK(isOneLine(run.err));
        CHECK(box.empty());
    }
}
