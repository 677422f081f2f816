#include "apps/capture/rerun.h"
#include "apps/check/check.h"
#include "core/settings/settings_table.h"
#include "tests/apps/capture/capture_fixture.h"
#include "tests/apps/check/planted.h"

using namespace lrsm;
using namespace lrsm::test;

namespace {

const Capture& cachesGolden()
{
    static const Capture capture = [] {
        Settings s = preset("caches");
        s.voxel.resolution = 32;
        s.rsm.resolution = 64;
        s.caches.tile = 8;
        s.caches.resolution = 4;
        s.direct.shadows = Shadows::hard;
        return record("cornell-glossy", s).capture;
    }();
    return capture;
}

/// The paper's own fill.
const Capture& voxelsGolden()
{
    static const Capture capture = [] {
        Settings s = preset("caches-paper");
        s.voxel.resolution = 16;
        s.rsm.resolution = 64;
        s.caches.tile = 16;
        s.caches.resolution = 4;
        s.direct.shadows = Shadows::hard;
        return record("cornell-box", s).capture;
    }();
    return capture;
}

/// Half as much again of every number; of indices, each the one before it (which none points beyond), of cluster ranges an own edge moved.
void plantIn(Buffer& buffer)
{
    if (buffer.dtype != Dtype::u4) return recompute(buffer, [](const Buffer& before, std::size_t i) { return 1.5 * decodedValue(before, i); });
    auto* values = reinterpret_cast<std::uint32_t*>(buffer.bytes.data());
    const std::size_t count = buffer.elements();
    if (buffer.name == "rc.tile_first") {
        // Ranges stay in order: what one tile has too much the next has too little.
        for (std::size_t i = 1; i + 1 < count; ++i)
            if (values[i] > values[i - 1]) --values[i];
    } else if (buffer.name == "rc.first") {
        for (std::size_t i = 1; i + 1 < count; ++i)
            if (values[i] > values[i - 1] + 1) --values[i];
    } else {
        for (std::size_t i = 0; i < count; ++i)
            if (values[i] > 1) --values[i];
        if (buffer.name == "rc.rotation") std::fill_n(values, count, 3u);
    }
}

std::string hintOf(const std::string& assignment, const std::string& pass)
{
    Capture copy = cachesGolden(), inputs = cachesGolden();
    applySetting(inputs.settings, assignment);
    for (Buffer& made : rerunPass(inputs, pass).outputs)
        for (Buffer& buffer : copy.buffers)
            if (buffer.name == made.name) buffer.bytes = std::move(made.bytes);
    const Candidate candidate = candidateOf(copy);
    const CheckReport report = checkCandidate(cachesGolden(), candidate);
    const CheckedBuffer* wrong = report.firstWrong();
    return wrong && !wrong->hints.empty() ? wrong->hints.front() : "";
}

}  // namespace

TEST_CASE("check of method caches: a defect in any buffer of its passes is found in that buffer, and in what is made from it alone", "[capture][check][caches]")
{
    findsEachDefect(cachesGolden(), "rc", [](Buffer& buffer) { plantIn(buffer); }, {"rc clusters", "rc places", "rc fill", "rc convolve", "rc gather"});
}

TEST_CASE("check of method caches: the same of the voxels that fill them", "[capture][check][caches]")
{
    for (const char* pass : {"rc light", "rc mips", "rc fill"}) findsEachDefect(voxelsGolden(), pass, [](Buffer& buffer) { plantIn(buffer); }, {pass});
}

TEST_CASE("check of method caches: names the setting that a candidate has otherwise", "[capture][check][caches]")
{
    CHECK(textHas(hintOf("rc_radius=2", "rc gather"), "as with rc_radius=2 (the golden has 1)"));
    CHECK(textHas(hintOf("rc_horizon=black", "rc convolve"), "as with rc_horizon=black"));
    CHECK(textHas(hintOf("start_voxels=1", "rc fill"), "as with start_voxels=1"));
}
