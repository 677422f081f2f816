#include "core/imageio/image_io.h"

#include "catch.h"
#include "sandbox.h"

#include <limits>
#include <nlohmann/json.hpp>

// lrsm reference, merge and compare as a user meets them.

using namespace lrsm;
using namespace lrsm::test;
using Json = nlohmann::ordered_json;

namespace {

const std::string kTinyReference = " cornell-box --size 24x16 ";

void writePicture(const fs::path& path, const LayeredImage& image)
{
    const std::vector<std::byte> bytes = encodeExr(image);
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

/// The reference of the sandbox with a defect planted into its irradiance.
template <class Defect>
void plant(const Sandbox& sandbox, const std::string& name, const Defect& defect)
{
    const std::string source = (sandbox.here() / "truth" / "image.exr").string();
    Image<Vec3> picture = rgbLayer(readImage(source), "irradiance", source);
    defect(picture);
    LayeredImage image;
    addLayer(image, "irradiance", picture);
    writePicture(sandbox.here() / name, image);
}

}  // namespace

TEST_CASE("program: reference ranges merge and resume to the same bytes, for 1 and 2 threads", "[apps][reference]")
{
    const Sandbox box;
    REQUIRE(box.run("reference" + kTinyReference + "--spp 50 -o whole --threads 1 --quiet").code == 0);
    REQUIRE(box.run("reference" + kTinyReference + "--samples 0:21 -o a --threads 2 --quiet").code == 0);
    REQUIRE(box.run("reference" + kTinyReference + "--samples 21:50 -o b --quiet").code == 0);
    REQUIRE(box.run("merge b a -o joined --quiet").code == 0);
    REQUIRE(box.run("reference" + kTinyReference + "--spp 50 --resume -o a --quiet").code == 0);
    for (const char* name : {"image.exr", "samples.bin"})
        for (const char* folder : {"joined", "a"}) CHECK(readText(box.here() / "whole" / name) == readText(box.here() / folder / name));

    // What must not be joined.
    const Outcome overlap = box.run("merge a b -o x");
    CHECK(overlap.code == 2);
    CHECK(isOneLine(overlap.err));
    CHECK(contains(overlap.err, "overlap"));
    REQUIRE(box.run("reference" + kTinyReference + "--samples 60:70 -o far --quiet").code == 0);
    CHECK(contains(box.run("merge a far -o x").err, "gaps"));
    CHECK(box.run("merge a far -o gapped --allow-gaps --quiet").code == 0);
    REQUIRE(box.run("reference" + kTinyReference + "--samples 50:60 --seed 1 -o seed --quiet").code == 0);
    CHECK(contains(box.run("merge a seed -o x").err, "seed"));
    REQUIRE(box.run("reference two-rooms --size 24x16 --samples 50:60 -o scene --quiet").code == 0);
    CHECK(contains(box.run("merge a scene -o x").err, "scene_sha256"));
    CHECK_FALSE(fs::exists(box.here() / "x"));
}

TEST_CASE("program: reference killed or interrupted goes on to the same bytes, and is not thrown away by mistake", "[apps][reference]")
{
    const Sandbox box;
    const std::string arguments = "reference cornell-box --size 64x48 --spp 400 --checkpoint-seconds 0 --quiet -o ";
    REQUIRE(box.run(arguments + "whole").code == 0);
    int struck = 0;
    for (const std::string& signal : {std::string("INT"), std::string("KILL")}) {
        // Waits for the first checkpoint, then strikes. Whether the run has ended by then or not, the bytes must be the same.
        std::ostringstream strike;
        strike << "& pid=$!; while [ ! -e " << box.here() / "part" / "samples.bin"
               << " ] && kill -0 $pid; do sleep 0.01; done; kill -" << signal << " $pid; wait $pid";
        box.run(arguments + "part --threads 1", "exec", strike.str());
        REQUIRE(fs::exists(box.here() / "part" / "samples.bin"));
        if (!fs::exists(box.here() / "part" / "image.exr")) {
            const Outcome again = box.run(arguments + "part");
            CHECK(again.code == 2);
            CHECK(contains(again.err, "--resume"));
            CHECK(contains(box.run("merge part -o x").err, "unfinished"));
        }
        struck += !fs::exists(box.here() / "part" / "image.exr");
        REQUIRE(box.run(arguments + "part --resume").code == 0);
        for (const char* name : {"image.exr", "samples.bin"}) CHECK(readText(box.here() / "whole" / name) == readText(box.here() / "part" / name));
        fs::remove_all(box.here() / "part");
    }
    if (struck == 0) WARN("the runs ended before they could be struck: nothing was resumed");
}

TEST_CASE("program: reference refuses what makes no sense in one line", "[apps][reference]")
{
    const Sandbox box;
    for (const std::string& arguments : {std::string("--spp 0 -o x"), std::string("--samples 5:5 -o x"), std::string("--model half -o x"),
                                         std::string("--block 12 -o x"), std::string("--spp 4")}) {
        CAPTURE(arguments);
        const Outcome outcome = box.run("reference" + kTinyReference + arguments);
        CHECK(outcome.code == 2);
        CHECK(isOneLine(outcome.err));
        CHECK(box.empty());
    }
}

TEST_CASE("program: compare finds each planted defect and fails by it", "[apps][compare]")
{
    const Sandbox box;
    REQUIRE(box.run("reference" + kTinyReference + "--spp 128 -o truth --quiet").code == 0);
    plant(box, "same.exr", [](Image<Vec3>&) {});
    plant(box, "shift.exr", [](Image<Vec3>& p) { std::rotate(p.texels.begin(), p.texels.end() - 1, p.texels.end()); });
    plant(box, "gain.exr", [](Image<Vec3>& p) {
        for (Vec3& v : p.texels) v *= 1.02f;
    });
    plant(box, "swap.exr", [](Image<Vec3>& p) {
        for (Vec3& v : p.texels) std::swap(v.r, v.g);
    });
    plant(box, "nan.exr", [](Image<Vec3>& p) { p.at(3, 4).r = std::numeric_limits<float>::quiet_NaN(); });
    plant(box, "strip.exr", [](Image<Vec3>& p) {
        for (int y = 0; y < p.height; ++y)
            for (int x = 10; x < 12; ++x) p.at(x, y) = Vec3(0.0f);
    });

    CHECK(box.run("compare same.exr truth --fail-above rmse=0 --fail-above flip=0 --fail-above energy=0 --fail-below ssim=0.999999 --quiet").code == 0);
    const auto fails = [&](const std::string& arguments, const std::string& word) {
        const Outcome outcome = box.run("compare " + arguments + " --quiet");
        CAPTURE(arguments, outcome.err);
        CHECK(outcome.code == 1);
        CHECK(contains(outcome.err, word));
    };
    fails("shift.exr truth --fail-above rmse=0.1 --fail-above flip=0.02", "rmse");
    fails("gain.exr truth --fail-above energy=0.015", "energy");
    CHECK(box.run("compare gain.exr truth --fail-above energy=0.025 --quiet").code == 0);
    fails("swap.exr truth --fail-above channel_energy=0.01", "channel_energy");
    fails("nan.exr truth", "NaN");
    CHECK(box.run("compare nan.exr truth --allow-nan --fail-above rmse=0 --quiet").code == 0);
    fails("strip.exr truth --fail-above region_energy=0.1 --fail-above zmax=20", "zmax");
}

TEST_CASE("program: compare writes one HTML file that needs nothing else, and JSON", "[apps][compare]")
{
    const Sandbox box;
    REQUIRE(box.run("reference" + kTinyReference + "--spp 32 -o a --quiet").code == 0);
    REQUIRE(box.run("reference" + kTinyReference + "--spp 32 --seed 1 -o b --quiet").code == 0);
    const Outcome outcome = box.run("compare a b -o result --layer all --regions 3x2 --json --fail-above rmse=1e-9");
    CHECK(outcome.code == 1);
    const Json json = Json::parse(outcome.out);
    CHECK(json["layers"].size() >= 5);
    CHECK(json["layers"][1]["layer"] == "irradiance");
    CHECK(json["layers"][1]["regions"].size() == 6);
    CHECK(json["layers"][1].contains("z_pixels"));
    CHECK_FALSE(json["failures"].empty());

    const std::string html = readText(box.here() / "result" / "report.html");
    CHECK(contains(html, "data:image/png;base64,"));
    CHECK_FALSE(contains(html, "http:"));
    CHECK_FALSE(contains(html, "https:"));
    CHECK_FALSE(contains(html, "src=\"/"));
    CHECK(contains(html, "flicker"));
    CHECK(contains(html, "seed: 1"));
    CHECK(fs::exists(box.here() / "result" / "compare.json"));
    CHECK(fs::exists(box.here() / "result" / "irradiance.flip.png"));
}

TEST_CASE("program: compare says in one line what does not fit", "[apps][compare]")
{
    const Sandbox box;
    REQUIRE(box.run("reference" + kTinyReference + "--spp 2 -o a --quiet").code == 0);
    REQUIRE(box.run("reference cornell-box --size 16x16 --spp 2 -o b --quiet").code == 0);
    struct Case {
        std::string arguments, word;
    };
    for (const Case& c : {Case{"a b", "24x16"}, Case{"a a --layer shadow", "shadow"}, Case{"a missing", "missing"}, Case{"a a --fail-above beauty=1", "beauty"},
                          Case{"a a --fail-above psnr=30", "--fail-below psnr=30"}, Case{"a a --fail-above ssim=0.9", "--fail-below"},
                          Case{"a a --fail-above rmse", "metric=value"}, Case{"a a --regions 0x4", "--regions"}, Case{"a a --fail-above zrms=1", "zrms"},
                          Case{"a a --flip-exposures 3", "--flip-exposures"}}) {
        const Outcome outcome = box.run("compare " + c.arguments + " --quiet");
        CAPTURE(c.arguments, outcome.err);
        CHECK(outcome.code == 2);
        CHECK(isOneLine(outcome.err));
        CHECK(contains(outcome.err, c.word));
    }
    // PNG against PNG works, too.
    CHECK(box.run("compare a/image.png a/image.png --fail-above flip=0").code == 0);
}
