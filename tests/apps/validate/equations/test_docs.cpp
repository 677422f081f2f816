// docs/equations.md against the program: constants, bounds and domains cannot drift apart.
#include "core/base/text.h"
#include "core/report/table.h"
#include "core/settings/settings.h"
#include "quick_report.h"

#include "catch.h"

#include <cstdlib>
#include <fstream>
#include <sstream>

using namespace lrsm;

namespace {

/// The lines of the table and the one below it that lists what is exact; a row without its last cell, and that as a number.
struct Row {
    std::string cells;
    double measured = 0.0;
};

std::vector<Row> rowsOf(const std::string& text)
{
    std::vector<Row> rows;
    std::istringstream lines(text);
    bool inTable = false;
    for (std::string line; std::getline(lines, line);) {
        inTable = line.rfind("| equation | function | error |", 0) == 0 || (inTable && line.rfind("|", 0) == 0);
        const std::size_t last = inTable ? line.rfind("| ", line.size() - 3) : line.size();
        if (inTable || line.rfind("Exact: ", 0) == 0) rows.push_back({line.substr(0, last), inTable ? std::atof(line.c_str() + last + 2) : 0.0});
    }
    return rows;
}

bool isExact(const EquationCheck& check)
{
    return check.bound.name == std::string("exact");
}

/// The checks as the page has them: a table, and a line of those that are exact.
std::string equationsMarkdown(const EquationReport& report)
{
    // A | inside a cell must be escaped.
    const auto cell = [](const std::string& text) { return joined(split(text, "|"), std::identity(), "\\|"); };
    std::string table = "| equation | function | error | bound | | measured |\n| --- | --- | --- | --- | --- | --- |\n", exact;
    for (const EquationCheck& check : report.checks)
        if (isExact(check))
            exact += (exact.empty() ? "Exact: " : "; ") + check.function + " (" + check.equation + ")";
        else
            table += "| " + check.equation + " | " + cell(check.function) + " | " + cell(check.errorKind) + " | `" + check.bound.name + "` | " +
                     numberText(2, check.bound.value) + " | " + numberText(2, check.worst) + " |\n";
    return table + "\n" + exact + ".\n";
}

}  // namespace

TEST_CASE("docs/equations.md lists every check with its constant and bound as the program has them", "[equations][docs]")
{
    std::ifstream file(LRSM_SOURCE_DIR "/docs/equations.md");
    std::stringstream page;
    page << file.rdbuf();
    EquationReport report = test::quickReport();
    const std::vector<Row> written = rowsOf(page.str()), expected = rowsOf(equationsMarkdown(report));
    REQUIRE(written.size() == expected.size());
    std::erase_if(report.checks, isExact);
    REQUIRE(written.size() == report.checks.size() + 3);  // two rows of head, and the line of what is exact
    for (std::size_t i = 0; i < written.size(); ++i) CHECK(written[i].cells == expected[i].cells);
    for (std::size_t i = 0; i < report.checks.size(); ++i) {
        CAPTURE(report.checks[i].function);
        // What the page says was measured keeps the bound, and the bound is no idle one.
        CHECK(written[i + 2].measured <= report.checks[i].bound.value * 1.05);
        CHECK(written[i + 2].measured * 3.6 >= report.checks[i].bound.value);
    }
}

TEST_CASE("defaults that are choices: a change of one is a change of every picture", "[equations][settings]")
{
    const Settings s;
    CHECK(s.voxel.resolution == 512);
    CHECK(s.rsm.resolution == 1024);
    CHECK((s.layers.depthLayers == 2 && s.layers.normalLayers == 2 && s.layers.overlap == 0.0f));
    CHECK(s.direct.depthBiasTexels == 0.75f);
    CHECK(s.direct.shadowConeApertureDegrees == 2.0f);
    const ConeSettings& c = s.cones;
    CHECK((c.set.count == 6 && c.set.setsPerPixel == 1 && c.march.maxSteps == 1024 && c.gather.gaussianTableSize == 1024));
    CHECK((c.set.apertureScale == 0.5f && c.march.step == 0.4f && c.march.startVoxels == 3.0f && c.march.normalOffsetVoxels == 1.0f &&
           c.march.minDiameterVoxels == 1.0f && c.march.push == 0.0f));
    CHECK((c.march.transmittanceCutoff == 0.01f && c.march.densityK == 2.0f && c.march.voxelLevelBias == -2.0f));
    CHECK((c.gather.emitterDelayTaps == 3.0f && c.gather.emitterDelayVoxels == 0.75f && c.gather.emitterSlantCap == 0.5f));
    CHECK((c.gather.vRadiusScale == 1.0f && c.gather.rsmLevelBias == 0.0f && c.gather.rsmMinLevel == 0.0f && c.specular.apertureDegrees == 10.0f));
}
