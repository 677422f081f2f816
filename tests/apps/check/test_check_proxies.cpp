#include "core/settings/settings_table.h"
#include "tests/apps/capture/capture_fixture.h"
#include "tests/apps/check/planted.h"

using namespace lrsm;
using namespace lrsm::test;

namespace {

Capture goldenOf(const std::string& name)
{
    Settings s = preset(name);
    s.voxel.resolution = 32;
    s.rsm.resolution = 64;
    s.direct.shadows = Shadows::hard;
    applySetting(s, "pp_count=512");
    applySetting(s, "pp_grid=6");
    applySetting(s, "ism_lights=64");
    applySetting(s, "ism_resolution=16");
    return record("cornell-glossy", s).capture;
}

/// Numbers are half as large again; what counts and points is out of all bounds, which must end no check.
void plantAnywhere(Buffer& buffer)
{
    if (buffer.dtype == Dtype::u4)
        std::fill(buffer.bytes.begin(), buffer.bytes.end(), std::byte{0xff});
    else
        recompute(buffer, [](const Buffer& before, std::size_t i) { return 1.5 * decodedValue(before, i) + 0.25; });
}

}  // namespace

TEST_CASE("check of method proxies: a defect in any buffer of its passes is found in that buffer, and in what is made from it alone",
          "[capture][check][proxies]")
{
    findsEachDefect(goldenOf("proxies"), "pp", plantAnywhere, {"pp place", "pp light", "pp cells", "pp march", "pp filter", "pp weigh", "pp gather"});
}

TEST_CASE("check of method ism: a defect in any buffer of its passes is found in that buffer, and in what is made from it alone", "[capture][check][ism]")
{
    findsEachDefect(goldenOf("ism"), "ism", plantAnywhere, {"ism lights", "ism maps", "ism gather"});
}
