#include "apps/capture/rerun.h"
#include "apps/check/check.h"
#include "apps/check/texel_inputs.h"
#include "core/settings/settings_table.h"
#include "tests/apps/capture/capture_fixture.h"
#include "tests/apps/check/planted.h"

using namespace lrsm;
using namespace lrsm::test;

namespace {

const Capture& vctGolden()
{
    static const Capture capture = [] {
        Settings s = preset("vct");
        s.voxel.resolution = 16;
        s.rsm.resolution = 64;
        s.direct.shadows = Shadows::hard;
        return record("cornell-glossy", s).capture;
    }();
    return capture;
}

/// Half as much again of every element.
void tooMuch(Buffer& buffer)
{
    recompute(buffer, [](const Buffer& before, std::size_t i) { return 1.5 * decodedValue(before, i); });
}

/// The candidate is what the golden's passes make with these settings, pass by pass.
Capture madeWith(const std::string& assignment, const std::string& pass)
{
    Capture copy = vctGolden();
    Capture inputs = vctGolden();
    applySetting(inputs.settings, assignment);
    for (Buffer& made : rerunPass(inputs, pass).outputs)
        for (Buffer& buffer : copy.buffers)
            if (buffer.name == made.name) buffer.bytes = std::move(made.bytes);
    return copy;
}

std::string hintOf(const Capture& capture)
{
    const Candidate candidate = candidateOf(capture);
    const CheckReport report = checkCandidate(vctGolden(), candidate);
    const CheckedBuffer* wrong = report.firstWrong();
    return wrong && !wrong->hints.empty() ? wrong->hints.front() : "";
}

}  // namespace

TEST_CASE("check of method vct: a defect in any buffer of its passes is found in that buffer, and in no other", "[capture][check][vct]")
{
    findsEachDefect(vctGolden(), "vct", tooMuch, {"vct surface", "vct inject", "vct mips", "vct cones"});
}

TEST_CASE("check of method vct: names the setting that a candidate has otherwise, and volumes that are exchanged", "[capture][check][vct]")
{
    CHECK(textHas(hintOf(madeWith("vct_facing=2", "vct mips")), "as with vct_facing=2 (the golden has 0.1)"));
    CHECK(textHas(hintOf(madeWith("vct_weights=squared", "vct cones")), "as with vct_weights=squared (the golden has absolute)"));
    CHECK(textHas(hintOf(madeWith("start_voxels=1", "vct cones")), "as with start_voxels=1"));
    Capture exchanged = vctGolden();
    for (Buffer& buffer : exchanged.buffers)
        if (buffer.pass == "vct mips") {
            std::string name = buffer.name;
            name[4] = name[4] == 'p' ? 'n' : 'p';
            buffer.bytes = vctGolden().at(name).bytes;
        }
    Capture cones = vctGolden();
    for (Buffer& made : rerunPass(exchanged, "vct cones").outputs)
        for (Buffer& buffer : cones.buffers)
            if (buffer.name == made.name) buffer.bytes = made.bytes;
    CHECK(textHas(hintOf(cones), "the volumes of opposite directions are exchanged"));
}

TEST_CASE("check of method vct: a texel of a mip is shown with the eight that it is made from", "[capture][check][vct]")
{
    const auto shown = [](const std::string& name) {
        std::vector<std::string> names;
        for (const TexelInput& input : inputsOf(vctGolden(), vctGolden().at(name), 0)) names.push_back(input.what);
        return names;
    };
    const std::vector<std::string> above = shown("vct.nz.mip2"), first = shown("vct.nz.mip1");
    REQUIRE(above.size() == 8);
    CHECK(above.back() == "vct.nz.mip1, z 1, y 1, x 1");
    REQUIRE(first.size() == 16);
    CHECK(first.front() == "vct.base, z 0, y 0, x 0");
    CHECK(first.back() == "vct.normal, z 1, y 1, x 1");
}
