#include "catch.h"
#include "python.h"
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
                                  "no-such-scene", "--samples 0", "cornell-box --preset none", "--junit j.xml", "--against nowhere", "--against .",
                                  "--vectors v cornell-box", "--vectors v --extremes", "--vectors v --junit j.xml"}) {
        const Outcome run = box.run(std::string("validate ") + arguments + " -o result");
        INFO(arguments);
        CHECK(run.code == 2);
        CHECK(isOneLine(run.err));
        CHECK(box.empty());
    }
}

TEST_CASE("program: the equations in NumPy go through validate --against, and a slip of theirs is named", "[apps][validate][vectors]")
{
    LRSM_NEED_PYTHON(python, "numpy");
    Sandbox box;
    const Outcome written = box.run("validate --vectors v");
    REQUIRE(written.code == 0);
    CHECK(isOneLine(written.out));
    const std::string here = "cd '" + box.here().string() + "' && ";
    const CommandOutcome example = runCommand(here + python + " '" LRSM_SOURCE_DIR "/docs/examples/vectors.py' v");
    INFO(example.text);
    REQUIRE(example.code == 0);
    const Outcome fine = box.run("validate --against v --junit fine.xml");
    CHECK(fine.code == 0);
    CHECK(contains(fine.out, "within what is allowed"));
    CHECK(contains(readText(box.here() / "fine.xml"), "failures=\"0\" errors=\"0\""));
    // A folder of one's own; and one for each equation, in which a factor is lost.
    const std::string folders =
        "import glob, os, shutil\nimport numpy as np\nos.mkdir('mine')\n"
        "for f in glob.glob('v/*.npy'):\n"
        "  if f.count('.') == 2: shutil.copy(f, 'mine')\n"
        "for e in range(1, 16):\n"
        "  shutil.copytree('mine', 'slip%d' % e)\n"
        "  for f in glob.glob('slip%d/eq%d.*.npy' % (e, e)): np.save(f, 0.5 * np.load(f))\n";
    REQUIRE(runCommand(here + python + " -c \"" + folders + "\"").code == 0);
    for (int equation = 1; equation <= 15; ++equation) {
        const Outcome wrong = box.run("validate --against slip" + std::to_string(equation) + " --vectors v --quiet --junit wrong.xml");
        CHECK(wrong.code == 1);
        CHECK(contains(wrong.out, "WRONG: Eq. " + std::to_string(equation) + ";"));
        CHECK(contains(readText(box.here() / "wrong.xml"), "<failure message="));
    }
    const ValidateJson json = ValidateJson::parse(box.run("validate --against mine --vectors v --json -o report").out);
    CHECK(json["held"] == true);
    CHECK(contains(readText(box.here() / "report" / "report.html"), "eq12.visibility"));
    REQUIRE(runCommand(here + "mv mine/eq5.radiance.npy mine/eq5.radiace.npy").code == 0);
    const Outcome misnamed = box.run("validate --against mine --vectors v");
    CHECK(misnamed.code == 2);
    CHECK(contains(misnamed.out, "eq5.radiace.npy is of no output; did you mean eq5.radiance.npy?"));
}
