#include "catch.h"
#include "python.h"
#include "sandbox.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

// `lrsm check` as a user runs it, on captures that the program itself made.

using namespace lrsm::test;
using CheckJson = nlohmann::ordered_json;

namespace {

const std::string kSmallFrame = " --size 24x16 --set voxel_resolution=16 --set rsm_resolution=32 --quiet ";

/// A golden, and a candidate of one buffer in which one value is changed.
void makeGoldenAndCandidate(const Sandbox& box)
{
    REQUIRE(box.run("capture cornell-box -o golden" + kSmallFrame).code == 0);
    std::string file = readText(box.here() / "golden" / "lrsm0.depth.mip1.npy");
    // The last code of the file is unused; the one before it is an alpha.
    file[file.size() - 4] = static_cast<char>(file[file.size() - 4] ^ 0x7f);
    fs::create_directory(box.here() / "mine");
    std::ofstream(box.here() / "mine" / "lrsm0.depth.mip1.npy", std::ios::binary) << file;
}

}  // namespace

TEST_CASE("check program: a capture against itself is 0, bytes that differ are 1, with every report", "[apps][check]")
{
    const Sandbox box;
    makeGoldenAndCandidate(box);
    const Outcome same = box.run("check golden golden --from-golden --exact");
    CHECK(same.code == 0);
    CHECK(contains(same.out, "are within their tolerances"));

    const Outcome wrong = box.run("check golden mine -o report --junit junit.xml");
    CHECK(wrong.code == 1);
    CHECK(wrong.out.starts_with("first difference: pass \"lrsm 0\", lrsm0.depth.mip1, layer "));
    CHECK(contains(wrong.out, "component 'alpha'"));
    for (const char* name : {"report.html", "check.json", "lrsm0.depth.mip1.expected.npy", "lrsm0.depth.mip1.actual.npy", "lrsm0.depth.mip1.difference.npy",
                             "lrsm0.depth.mip1.expected.png", "lrsm0.depth.mip1.actual.png", "lrsm0.depth.mip1.difference.png"}) {
        CAPTURE(name);
        CHECK(fs::exists(box.here() / "report" / name));
    }
    CHECK(readText(box.here() / "report" / "lrsm0.depth.mip1.actual.npy") == readText(box.here() / "mine" / "lrsm0.depth.mip1.npy"));
    const CheckJson json = CheckJson::parse(readText(box.here() / "report" / "check.json"));
    CHECK(json["holds"] == false);
    for (const auto& buffer : json["buffers"])
        if (buffer["name"] == "lrsm0.depth.mip1") {
            CHECK(buffer["verdict"] == "wrong");
            CHECK(buffer["against_golden"]["outside"] == 1);
            CHECK(buffer["first_inputs"].size() == 4);
        }
    // An XML parser that knows nothing of us.
    const std::optional<std::string> python = pythonWith("xml.etree.ElementTree");
    const std::string parse = "cd '" + box.here().string() + "' && " + python.value_or("python3") +
                              " -c 'import xml.etree.ElementTree as t; r = t.parse(\"junit.xml\").getroot(); "
                              "f = [c for c in r.iter(\"testcase\") if c.find(\"failure\") is not None]; "
                              "assert r.tag == \"testsuites\" and int(r.get(\"failures\")) == 1 and [c.get(\"name\") for c in f] == [\"lrsm0.depth.mip1\"]; "
                              "assert all(s.get(\"tests\") == str(len(s.findall(\"testcase\"))) for s in r)'";
    if (!python) WARN("SKIPPED: no python3 that reads XML (Debian: python3)");
    if (python) CHECK(std::system(parse.c_str()) == 0);
    CHECK(CheckJson::parse(box.run("check golden mine --json").out)["holds"] == false);
    CHECK(box.run("check golden mine --only composite").code == 2);
}

TEST_CASE("check program: bad usage and bad input are one line and exit code 2", "[apps][check]")
{
    const Sandbox box;
    makeGoldenAndCandidate(box);
    fs::create_directory(box.here() / "empty");
    std::ofstream(box.here() / "bad.json") << "{";
    struct Case {
        std::string arguments, message;
    };
    for (const Case& c :
         {Case{"check golden", "CANDIDATE"}, Case{"check none mine", "none"}, Case{"check golden none", "none"}, Case{"check mine golden", "manifest.json"},
          Case{"check golden empty", "no buffer in common"}, Case{"check golden mine --map bad.json", "bad.json: is no JSON"},
          Case{"check golden mine --only nonsense", "\"nonsense\" is no pass"}, Case{"check golden golden --bless", "--reason"},
          Case{"check golden golden --bless --reason ' '", "--reason"}, Case{"check golden golden --reason x", "without --bless"},
          Case{"check golden mine --bless --reason x", "manifest.json"}, Case{"check golden golden --bless --reason x --from-golden", "leave out"}}) {
        CAPTURE(c.arguments);
        const Outcome outcome = box.run(c.arguments);
        CHECK(outcome.code == 2);
        CHECK(isOneLine(outcome.err));
        CHECK(contains(outcome.err, c.message));
    }
}

TEST_CASE("check program: --bless makes the candidate the golden and says why in it, without a change nothing is written", "[apps][check]")
{
    const Sandbox box;
    makeGoldenAndCandidate(box);
    const auto stamp = fs::last_write_time(box.here() / "golden" / "manifest.json");
    const Outcome nothing = box.run("check golden golden --bless --reason 'just so'");
    CHECK(nothing.code == 0);
    CHECK(contains(nothing.out, "nothing changed"));
    CHECK(fs::last_write_time(box.here() / "golden" / "manifest.json") == stamp);

    REQUIRE(box.run("capture cornell-box -o other --set depth_bias_texels=8" + kSmallFrame).code == 0);
    const Outcome refused = box.run("check golden other --bless --reason 'new bias'");
    CHECK(refused.code == 2);
    CHECK(contains(refused.err, "depth_bias_texels=8"));

    // The other capture as if the same settings had made it: its manifest with the golden's.
    CheckJson manifest = CheckJson::parse(readText(box.here() / "other" / "manifest.json"));
    manifest["settings"] = CheckJson::parse(readText(box.here() / "golden" / "manifest.json"))["settings"];
    std::ofstream(box.here() / "other" / "manifest.json") << manifest.dump(1);
    CHECK(box.run("check golden other --bless --reason 'a larger bias'").code == 0);
    const CheckJson history = CheckJson::parse(readText(box.here() / "golden" / "manifest.json"))["history"];
    REQUIRE(history.size() == 1);
    CHECK(history[0]["reason"] == "a larger bias");
    CHECK(contains(history[0].dump(), "direct.radiance"));
    CHECK(box.run("check golden other --exact").code == 0);
}
