#include "catch.h"
#include "sandbox.h"

#include <nlohmann/json.hpp>

using namespace lrsm::test;
using BenchJson = nlohmann::json;

TEST_CASE("program: bench measures an axis and writes a line a frame", "[apps][bench]")
{
    Sandbox box;
    const Outcome run = box.run("bench cones sets --quick --size 32x18 --repeat 2 -o result");
    REQUIRE(run.code == 0);
    CHECK(contains(run.out, "cone_steps"));

    const std::string rows = readText(box.here() / "result" / "bench.csv");
    CHECK(std::count(rows.begin(), rows.end(), '\n') == 1 + 2 * 3 * 2);
    CHECK(rows.starts_with("axis,x,label,repeat,width,height,threads,frame_cpu_ms,"));

    const BenchJson json = BenchJson::parse(readText(box.here() / "result" / "bench.json"));
    CHECK_FALSE(json["machine"]["processor"].get<std::string>().empty());
    CHECK_FALSE(json["machine"]["compiler"].get<std::string>().empty());
    REQUIRE(json["axes"].size() == 2);
    CHECK(json["axes"][1]["x"] == BenchJson{1.0, 2.0, 4.0});
    for (const BenchJson& curve : json["axes"][1]["curves"])
        if (curve["series"] == "cone_steps") CHECK(curve["slope"].get<double>() == Approx(1.0).margin(0.02));
    CHECK(contains(readText(box.here() / "result" / "bench.html"), "cone sets a pixel"));
}

TEST_CASE("program: bench refuses what it cannot measure in one line, and leaves nothing behind", "[apps][bench]")
{
    Sandbox box;
    for (const char* arguments : {"pixel -o result", "cones", "cones -o result --size 0x4", "cones -o result --scene none", "cones -o result --repeat 0",
                                  "cones -o result --set cone_counts=3"}) {
        const Outcome run = box.run(std::string("bench --quick ") + arguments);
        INFO(arguments);
        CHECK(run.code == 2);
        CHECK(isOneLine(run.err));
        CHECK(box.empty());
    }
}
