#include "catch.h"
#include "sandbox.h"

#include <map>
#include <nlohmann/json.hpp>

// lrsm sweep as a user meets it.

using namespace lrsm::test;
using Json = nlohmann::ordered_json;

namespace {

/// The presets need more memory than this, and are skipped: they take too long here.
const std::string kTinySweep = "sweep cornell-box --size 32x18 --repeat 1 --max-memory 3 --set voxel_resolution=32 --set rsm_resolution=64 ";
const std::string kTinySweepTraced = kTinySweep + "--spp 16 --path-tracer 4 ";

std::map<std::string, Json> sweptRows(const fs::path& folder)
{
    std::map<std::string, Json> rows;
    std::istringstream lines(readText(folder / "rows.jsonl"));
    for (std::string line; std::getline(lines, line);) {
        const Json row = Json::parse(line);
        CHECK(rows.emplace(row["key"], row).second);  // none is doubled
    }
    return rows;
}

}  // namespace

TEST_CASE("program: sweep keeps a row a setting and scene with its picture, and writes all its files", "[apps][sweep]")
{
    const Sandbox box;
    const Outcome made = box.run(kTinySweepTraced + "furnace -o out --axis cone_count=2 --axis estimator=paper,slab");
    INFO(made.err);
    REQUIRE(made.code == 0);
    CHECK(contains(made.err, "furnace: truth of 16 paths a pixel, its own noise"));
    CHECK(contains(made.err, "skipped cornell-box accurate: --max-memory"));
    CHECK(contains(made.out, "on the front"));
    const fs::path folder = box.here() / "out";
    const auto rows = sweptRows(folder);
    CHECK(rows.size() == 2 * (2 + 3));
    int traced = 0;
    for (const auto& [key, row] : rows) {
        CHECK(fs::exists(folder / "thumbnails" / (key + ".png")));
        CHECK(fs::exists(folder / "thumbnails" / (row["case"].get<std::string>() + ".png")));
        CHECK(row["rmse"].get<double>() > 0.0);
        CHECK(row["cost"].get<double>() > 0.0);
        CHECK(row["noise"].get<double>() > 0.0);
        traced += row["kind"] == "path_tracer";
        if (row["kind"] != "path_tracer") CHECK(row["voxel_resolution"] == 32);
    }
    CHECK(traced == 6);
    for (const char* name : {"sweep.csv", "sweep.json", "report.html", "tables.md"}) CHECK(fs::file_size(folder / name) > 0);
    CHECK(Json::parse(readText(folder / "sweep.json")).size() == rows.size());

    // All is there: nothing is measured again, and the files can be made from the rows alone.
    const std::string before = readText(folder / "rows.jsonl"), csv = readText(folder / "sweep.csv");
    fs::remove(folder / "report.html");
    fs::remove(folder / "sweep.csv");
    CHECK(contains(box.run(kTinySweepTraced + "furnace -o out --axis cone_count=2 --axis estimator=paper,slab").out, " 0 rows measured, 10 found"));
    fs::remove(folder / "report.html");
    CHECK(box.run("sweep --report-only -o out").code == 0);
    CHECK(fs::exists(folder / "report.html"));
    CHECK(readText(folder / "rows.jsonl") == before);
    CHECK(readText(folder / "sweep.csv") == csv);
}

TEST_CASE("program: sweep finds the truth by what it is of, whatever its folder is called", "[apps][sweep]")
{
    const Sandbox box;
    REQUIRE(box.run("reference cornell-box --size 32x18 --spp 32 --block 2 -o refs/mine --quiet").code == 0);
    REQUIRE(box.run("reference cornell-box --size 32x18 --spp 64 --seed 3 -o refs/another-seed --quiet").code == 0);
    const Outcome swept = box.run(kTinySweep + "--spp 16 --path-tracer 0 -o out --references refs --axis cone_count=2");
    CHECK(swept.code == 0);
    CHECK(contains(swept.err, "truth of 32 paths"));
    CHECK(std::distance(fs::directory_iterator(box.here() / "refs"), {}) == 2);
    CHECK(box.run(kTinySweep + "-o more --references refs --axis cone_count=2 --spp 33 --path-tracer 0 --quiet").code == 0);
    CHECK(std::distance(fs::directory_iterator(box.here() / "refs"), {}) == 3);
}

TEST_CASE("program: sweep killed or interrupted goes on to the rows of an uninterrupted one", "[apps][sweep]")
{
    const Sandbox box;
    const std::string arguments = kTinySweepTraced + "--quiet --axis cone_count=1,2,3,4,5,6 -o ";
    REQUIRE(box.run(arguments + "whole").code == 0);
    const auto whole = sweptRows(box.here() / "whole");
    CHECK(whole.size() == 3 + 6);
    for (const char* signal : {"INT", "KILL"}) {
        std::ostringstream strike;
        const fs::path rows = box.here() / "part" / "rows.jsonl";
        strike << "& pid=$!; while [ \"$(cat " << rows << " 2>/dev/null | wc -l)\" -lt 5 ] && kill -0 $pid; do sleep 0.005; done; kill -" << signal
               << " $pid; wait $pid; exit $?";
        box.run(arguments + "part", "exec", strike.str());
        REQUIRE(box.run(arguments + "part").code == 0);
        const auto part = sweptRows(box.here() / "part");
        CHECK(part.size() == whole.size());
        for (const auto& [key, row] : whole) {
            REQUIRE(part.count(key) == 1);
            for (const char* same : {"label", "irradiance_sha256", "rmse", "flip", "counters", "rays", "bytes"}) CHECK(part.at(key)[same] == row[same]);
        }
        fs::remove_all(box.here() / "part");
    }
}

TEST_CASE("program: sweep in parts has the rows of a whole one, each once, and they join by their files", "[apps][sweep]")
{
    const Sandbox box;
    const std::string axes = "--axis cone_count=2,4,6 --quiet --references references ";
    REQUIRE(box.run(kTinySweepTraced + axes + "-o whole").code == 0);
    for (const char* part : {"0/3", "1/3", "2/3"}) REQUIRE(box.run(kTinySweepTraced + axes + "--part " + part + " -o part" + part[0]).code == 0);
    const auto whole = sweptRows(box.here() / "whole");
    std::size_t parts = 0;
    std::string lines;
    for (const char* part : {"part0", "part1", "part2"}) {
        const auto rows = sweptRows(box.here() / part);
        CHECK(rows.size() < whole.size());
        parts += rows.size();
        lines += readText(box.here() / part / "rows.jsonl");
        for (const auto& [key, row] : rows) {
            REQUIRE(whole.count(key) == 1);
            CHECK(whole.at(key)["rmse"] == row["rmse"]);
        }
    }
    CHECK(parts == whole.size());
    fs::create_directory(box.here() / "joined");
    std::ofstream(box.here() / "joined" / "rows.jsonl", std::ios::binary) << lines;
    REQUIRE(box.run("sweep --report-only --quiet -o joined").code == 0);
    CHECK(Json::parse(readText(box.here() / "joined" / "sweep.json")).size() == whole.size());
}

TEST_CASE("program: sweep searches for the front and can be continued", "[apps][sweep]")
{
    const Sandbox box;
    const std::string arguments = "sweep cornell-box --size 16x9 --spp 16 --path-tracer 0 --repeat 1 --max-memory 3 -o out --axes search --budget 2";
    // Its baseline is the preset balanced.
    const Outcome refused = box.run(arguments);
    CHECK(refused.code == 2);
    CHECK(contains(refused.err, "balanced"));
}

TEST_CASE("program: sweep refuses what makes no sense in one line, and leaves nothing", "[apps][sweep]")
{
    const Sandbox box;
    for (const char* arguments :
         {"cornell-box", "-o out", "no-such-scene -o out", "cornell-box -o out --axis cone_count=", "cornell-box -o out --axes no-such-file",
          "cornell-box -o out --axes search --axis cone_count=1", "cornell-box -o out --axes search --part 0/2", "cornell-box -o out --part 2/2",
          "cornell-box -o out --part 1", "cornell-box -o out --size 0x1", "cornell-box -o out --max-memory -1", "--report-only -o out"}) {
        const Outcome refused = box.run(std::string("sweep ") + arguments);
        INFO(arguments << ": " << refused.err);
        CHECK(refused.code == 2);
        CHECK(isOneLine(refused.err));
        CHECK(box.empty());
    }
    REQUIRE(box.run(kTinySweep + "-o out --axis cone_count=2 --spp 16 --path-tracer 0 --quiet").code == 0);
    const std::string rows = readText(box.here() / "out" / "rows.jsonl");
    std::ofstream(box.here() / "out" / "rows.jsonl") << "{]\n" << rows;
    const Outcome damaged = box.run(kTinySweep + "-o out --axis cone_count=2 --spp 16 --path-tracer 0 --quiet");
    CHECK(damaged.code == 2);
    CHECK(contains(damaged.err, "rows.jsonl:1"));
}
