#include "catch.h"
#include "scratch.h"

#include "apps/capture/capture_files.h"
#include "apps/capture/record.h"
#include "apps/check/check.h"
#include "apps/validate/vectors/judge.h"
#include "apps/validate/vectors/make_vectors.h"
#include "apps/validate/vectors/vector_files.h"
#include "core/scene/builtin_scenes.h"
#include "core/settings/settings_table.h"
#include "tests/twin/compare.h"
#include "tests/twin/passes.h"
#include "tests/twin/vectors.h"

#include <map>
#include <set>

using namespace lrsm;

namespace {

/// The context of all test cases in this program, made on first use; nullptr where there is none.
twin::GlContext* context()
{
    static std::string whyNot;
    static const std::unique_ptr<twin::GlContext> made = twin::GlContext::create(whyNot);
    if (!made) WARN("SKIPPED: " << whyNot);
    return made.get();
}

struct Golden {
    std::string scene, preset;
};

/// A capture small enough for a test, voxelized as a rasterizer can.
std::string capture(const ScratchFolder& scratch, const Golden& golden)
{
    Settings settings = preset(golden.preset);
    settings.voxel.mode = Voxelization::raster;
    settings.voxel.resolution = 32;
    settings.rsm.resolution = 64;
    settings.cones.set.filterPasses = 0;
    // What a shader can compare: a map's texel, or in one scene the mean of several.
    if (settings.direct.shadows == Shadows::exact) settings.direct.shadows = golden.scene == "cornell-glossy" ? Shadows::pcf : Shadows::hard;
    const Scene scene = *makeBuiltinScene(golden.scene);
    const Requirements needs = analyseRequirements(scene, settings.force);
    RecordOptions options;
    options.width = 48;
    options.height = 36;
    options.dds = false;
    const Capture made = recordCapture(scene, scene.cameras.at(0), needs, settings, options, "test");
    const std::string path = scratch.path(golden.scene + "-" + golden.preset);
    OutputFolder folder(path);
    writeCapture(folder, made);
    folder.commit();
    return path;
}

/// "lrsm" of "lrsm 0".
std::string kindOf(const std::string& pass)
{
    const std::size_t digit = pass.find_first_of("0123456789");
    return digit == std::string::npos ? pass : pass.substr(0, digit - 1);
}

std::string describe(const twin::Difference& d)
{
    return d.name + ": " + std::to_string(d.outside) + " of " + std::to_string(d.elements) + " outside, " + std::to_string(d.differing) + " differ, largest " +
           std::to_string(d.largest);
}

/// `lrsm check --from-golden` on what the frame made.
CheckReport check(const Capture& golden, const twin::Frame& frame, const std::string& folder, Candidate& candidate)
{
    frame.write(folder);
    candidate = readCandidate(folder, golden);
    return checkCandidate(golden, candidate, {.fromGolden = true, .passes = {}, .hints = false, .progress = {}});
}

}  // namespace

TEST_CASE("every pass on OpenGL, fed with the golden's inputs, is within the manifest's tolerances", "[twin]")
{
    if (!context()) return;
    const Golden golden =
        GENERATE(Golden{"cornell-box", "literal"}, Golden{"atrium", "balanced"}, Golden{"two-rooms", "literal"}, Golden{"cornell-glossy", "balanced"});
    CAPTURE(golden.scene, golden.preset);
    const ScratchFolder scratch;
    twin::Frame frame(capture(scratch, golden), false);
    twin::Programs programs;
    CHECK(runAll(frame, {programs}).empty());

    // What involves no interpolation and no sampler is the same bits: decisions of coverage and layers, and both mip chains.
    const std::set<std::string> exact = {"voxelize", "voxel mips", "lrsm"};
    std::size_t compared = 0;
    for (const twin::Difference& d : twin::differences(frame)) {
        INFO(describe(d));
        CHECK(d.accepted());
        if (exact.count(kindOf(d.pass))) CHECK(d.differing == 0);
        compared += d.elements > 0;
    }
    CHECK(compared > 30);
}

TEST_CASE("radiance in voxels on OpenGL, fed with the golden's volumes, is within the manifest's tolerances", "[twin][vct]")
{
    if (!context()) return;
    const Golden golden = GENERATE(Golden{"cornell-glossy", "vct"}, Golden{"atrium", "vct"}, Golden{"two-rooms", "vct-paper"});
    CAPTURE(golden.scene, golden.preset);
    const ScratchFolder scratch;
    twin::Frame frame(capture(scratch, golden), false);
    twin::Programs programs;
    CHECK(runAll(frame, {programs}) == std::vector<std::string>{"vct surface, vct inject: sums over lists of texels"});
    std::size_t mips = 0, cones = 0;
    for (const twin::Difference& d : twin::differences(frame)) {
        INFO(describe(d));
        CHECK(d.accepted());
        if (d.pass == "vct mips") CHECK(d.differing == 0);
        mips += d.pass == "vct mips" && d.elements > 0;
        cones += d.pass == "vct cones" && d.elements > 0;
    }
    CHECK(mips == 30);
    CHECK(cones >= 3);
}

TEST_CASE("UNORM stores and 8-bit filtering as the driver does them are within the tolerances", "[twin]")
{
    if (!context()) return;
    const ScratchFolder scratch;
    twin::Frame frame(capture(scratch, {"atrium", "balanced"}), false);
    twin::Programs programs;
    runAll(frame, {.programs = programs, .driverFormats = true});
    for (const twin::Difference& d : twin::differences(frame)) {
        INFO(describe(d));
        const bool half = frame.description(d.name)["dtype"] == "f2";  // whose rounding a driver chooses, and the tolerance is meant to tell
        CHECK((half || d.accepted()));
    }
}

TEST_CASE("a chain of its own passes is accepted by the check of each pass on its inputs", "[twin][check]")
{
    if (!context()) return;
    const ScratchFolder scratch;
    const std::string folder = capture(scratch, {"two-rooms", "balanced"});
    const Capture golden = readCapture(folder);
    twin::Frame frame(folder, true);
    twin::Programs programs;
    runAll(frame, {programs});
    Candidate candidate;
    const CheckReport report = check(golden, frame, scratch.path("candidate"), candidate);
    INFO(report.summary());
    CHECK(report.holds());
    CHECK(report.count(Verdict::ok) + report.count(Verdict::inherits) > 30);
}

TEST_CASE("an error planted in a shader is named at its pass, and at no other", "[twin][check]")
{
    if (!context()) return;
    const ScratchFolder scratch;
    const bool vct = GENERATE(false, true);
    std::map<std::string, std::string> folders;  // captures by scene
    twin::Programs programs;
    for (const twin::Plant& plant : twin::plants()) {
        if (std::string(plant.pass).starts_with("vct") != vct) continue;
        std::string& folder = folders[plant.scene];
        if (folder.empty()) folder = capture(scratch, {plant.scene, vct ? "vct" : "balanced"});
        const Capture golden = readCapture(folder);
        twin::Frame frame(folder, true);
        runAll(frame, {programs, plant.name});
        Candidate candidate;
        const CheckReport report = check(golden, frame, scratch.path(plant.name), candidate);
        INFO(plant.name << ": " << report.summary());
        REQUIRE_FALSE(report.holds());
        CHECK(kindOf(report.firstWrong()->golden->pass) == plant.pass);
        for (const CheckedBuffer& buffer : report.buffers)
            if (buffer.verdict == Verdict::wrong) CHECK(kindOf(buffer.golden->pass) == plant.pass);
    }
}

TEST_CASE("the equations one by one on OpenGL are within what the vectors allow", "[twin][vectors]")
{
    if (!context()) return;
    const ScratchFolder scratch;
    const std::vector<VectorSet> sets = makeVectors();
    OutputFolder folder(scratch.path("vectors"));
    writeVectors(folder, sets, "test");
    folder.commit();
    twin::Programs programs;
    const std::vector<std::string> leftOut = twin::runVectors(programs, scratch.path("vectors"), scratch.path("results"));
    CHECK(leftOut == std::vector<std::string>{"partition", "opacity_lookup", "six_cones", "specular_aperture", "unorm8", "log2_double", "exp2_double", "sin",
                                              "cos", "arc_tangent", "power"});
    const Judgement judgement = judgeFolder(sets, scratch.path("results"));
    CHECK(judgement.holds());
    CHECK(judgement.count(OutputVerdict::ok) == 34);
    for (const JudgedOutput& o : judgement.outputs) {
        INFO(o.output->exact.name << ": " << o.outside << " outside, at " << caseText(*o.set, o.worstCase()));
        CHECK((o.verdict == OutputVerdict::ok || o.verdict == OutputVerdict::missing));
    }
}
