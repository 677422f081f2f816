#include "synthetic_sweep.h"

#include "apps/sweep/effects.h"
#include "apps/sweep/rivals.h"

#include <catch.h>
#include <algorithm>

using namespace lrsm;
using namespace lrsm::test;

namespace {

std::vector<std::string> labelsOf(const std::vector<const Measurement*>& rows)
{
    std::vector<std::string> labels;
    for (const Measurement* row : rows) labels.push_back(row->label);
    return labels;
}

const Effect& effect(const std::vector<Effect>& effects, const std::string& label)
{
    const auto found = std::find_if(effects.begin(), effects.end(), [&](const Effect& e) { return e.label == label; });
    REQUIRE(found != effects.end());
    return *found;
}

using Labels = std::vector<std::string>;

}  // namespace

TEST_CASE("rows fall into cases by case key, and cases of one scene get names apart", "[sweep]")
{
    std::vector<Measurement> rows = syntheticSweep(2);
    CHECK(casesOf(rows).size() == 2);
    CHECK(casesOf(rows)[1].name == "scene1");
    CHECK(casesOf(rows)[1].pathTracer.size() == 11);
    CHECK(casesOf(rows)[1].settings.size() == 11);
    for (Measurement& row : rows) row.scene = "box";
    const std::vector<CaseRows> cases = casesOf(rows);
    CHECK(cases[0].name == "box 320x180 0000000000000000");
    CHECK(cases[0].name != cases[1].name);
    CHECK(casesOf({}).empty());
}

TEST_CASE("a case's fronts are those read off by eye", "[sweep]")
{
    const std::vector<Measurement> rows = syntheticSweep(1);
    const std::vector<CaseRows> cases = casesOf(rows);
    CHECK(labelsOf(timeFront(cases[0])) == Labels{"fast", "voxel_resolution=256", "step=0.25", "accurate"});
    CHECK(labelsOf(memoryFront(cases[0])) == Labels{"voxel_resolution=256", "step=0.25", "accurate"});
}

TEST_CASE("over all scenes a setting counts relative to balanced, where all scenes have it", "[sweep]")
{
    std::vector<Measurement> rows = syntheticSweep(3);
    // The third scene is still being measured.
    std::erase_if(rows, [](const Measurement& row) { return row.scene == "scene2" && row.label == "cone_count=4"; });
    // One scene answers otherwise: 4 times and 1 time balanced's error have the geometric mean 4^(1/3).
    for (Measurement& row : rows)
        if (row.scene == "scene1" && row.label == "cone_count=9") row.error.rmse = std::hypot(0.8, row.error.noise);
    const std::vector<CaseRows> cases = casesOf(rows);
    const CombinedCases all = combineCases(cases);
    CHECK(all.cases.size() == 3);
    CHECK(all.settings.size() == 10);
    CHECK(all.pathTracer.size() == 11);
    CHECK(all.noise == Approx(kNoise / 0.1));
    for (const CombinedRow& row : all.settings) {
        REQUIRE(row.rows.size() == 3);
        if (row.rows[0]->label == "fast") {
            CHECK(row.error == Approx(2.0));
            CHECK(row.cost == Approx(0.25));
            CHECK(row.bytes == Approx(0.5));
        }
        if (row.rows[0]->label == "cone_count=9") CHECK(row.error == Approx(std::cbrt(0.9 * 4.0 * 0.9)));
    }
    CHECK(all.pathTracer[2].cost == Approx(0.5));
    CHECK(all.pathTracer[2].error == Approx(4.0));

    std::erase_if(rows, [](const Measurement& row) { return row.label == "balanced"; });
    const std::vector<CaseRows> without = casesOf(rows);
    CHECK(combineCases(without).cases.empty());
    CHECK(combineCases({}).settings.empty());
}

TEST_CASE("effects say what each value buys, in order of what a millisecond buys", "[sweep]")
{
    const std::vector<Measurement> rows = syntheticSweep(2);
    const std::vector<CaseRows> cases = casesOf(rows);
    const std::vector<Effect> effects = effectsOf(cases, kUnit, 0.02);
    Labels order;
    for (const Effect& e : effects) order.push_back(e.label);
    CHECK(order == Labels{"step=0.25", "cone_count=9", "cone_count=12", "voxel_resolution=256", "cone_count=4", "voxel_storage=float32", "mip_filter=max",
                          "density_k=1"});

    CHECK(effect(effects, "step=0.25").kind == EffectKind::winsBoth);
    CHECK(effect(effects, "mip_filter=max").kind == EffectKind::losesBoth);
    CHECK(effect(effects, "voxel_storage=float32").kind == EffectKind::losesBoth);
    CHECK(effect(effects, "voxel_storage=float32").bytes == Approx(1.0));
    CHECK(effect(effects, "density_k=1").kind == EffectKind::changesNothing);
    CHECK(effect(effects, "density_k=1").changed == 0);

    // Costs are 2 and 3 times those of the formula: 1 is 2.5 units of 10 ms.
    const Effect& nine = effect(effects, "cone_count=9");
    CHECK(nine.kind == EffectKind::buys);
    CHECK(nine.cases == 2);
    CHECK(nine.error == Approx(-0.1));
    // The base's cost is the median of 4 and 4.04, which have the same bits.
    CHECK(nine.cost == Approx(5.0 / 4.02 - 1.0));
    CHECK(nine.milliseconds == Approx(2.5 * 9.8));
    CHECK(nine.percentPerMs == Approx(10.0 / (2.5 * 9.8)));
    const Effect& coarse = effect(effects, "voxel_resolution=256");
    CHECK(coarse.kind == EffectKind::saves);
    CHECK(coarse.percentPerMs == Approx(10.0 / (2.5 * 20.2)));
    CHECK(coarse.bytes == Approx(-0.8));

    // What counts as no change of time decides between two verdicts.
    const std::vector<Effect> tolerant = effectsOf(cases, kUnit, 0.3);
    CHECK(effect(tolerant, "cone_count=9").kind == EffectKind::winsBoth);
    CHECK(effect(tolerant, "cone_count=12").kind == EffectKind::buys);
    CHECK(effect(tolerant, "cone_count=4").kind == EffectKind::losesBoth);
    CHECK(effect(tolerant, "voxel_resolution=256").kind == EffectKind::saves);

    CHECK(costNoise(cases) == Approx(0.02 / 4.02));
    CHECK(costNoise(casesOf({})) == 0.0);
}

TEST_CASE("a base that met a busy minute is held to what its bits cost other rows", "[sweep]")
{
    std::vector<Measurement> rows = syntheticSweep(1);
    const std::string bits = rows.front().irradianceSha256;
    rows.front().cost *= 1.5;
    for (const char* same : {"ism_bias=0.005", "pp_count=1000"}) {
        rows.push_back(syntheticAxis(0, same, 0.1, 4.0, 100'000'000));
        rows.back().irradianceSha256 = bits;
    }
    const std::vector<CaseRows> cases = casesOf(rows);
    const std::vector<Effect> effects = effectsOf(cases, kUnit, 0.02);
    // Of 12, 8.08, 8 and 8 the median is 8.04.
    CHECK(effect(effects, "cone_count=9").cost == Approx(10.0 / 8.04 - 1.0));
    CHECK(effect(effects, "cone_count=9").kind == EffectKind::buys);
}

TEST_CASE("a value that needs another beside it is held against the row with that other alone", "[sweep]")
{
    std::vector<Measurement> rows = syntheticSweep(1);
    rows.push_back(syntheticAxis(0, "estimator=paper", 0.4, 2.0, 100'000'000));
    rows.push_back(syntheticAxis(0, "density_k=4", 0.5, 2.0, 100'000'000));
    applySetting(rows.back().settings, "estimator=paper");
    rows.back().label += " estimator=paper";
    const std::vector<CaseRows> cases = casesOf(rows);
    const std::vector<Effect> effects = effectsOf(cases, kUnit, 0.02);
    CHECK(effect(effects, "density_k=4").base == "balanced estimator=paper");
    CHECK(effect(effects, "density_k=4").error == Approx(0.25));
    CHECK(effect(effects, "estimator=paper").base == "balanced");
    CHECK(effect(effects, "estimator=paper").error == Approx(3.0));
}

TEST_CASE("an effect changes something when one scene of several shows it", "[sweep]")
{
    std::vector<Measurement> rows = syntheticSweep(2);
    for (Measurement& row : rows)
        if (row.scene == "scene1" && row.label == "density_k=1") {
            row.irradianceSha256 = "other";
            row.error.rmse = std::hypot(0.3, row.error.noise);
        }
    const std::vector<CaseRows> cases = casesOf(rows);
    const std::vector<Effect> effects = effectsOf(cases, kUnit, 0.02);
    const Effect& density = effect(effects, "density_k=1");
    CHECK(density.kind == EffectKind::losesBoth);
    CHECK(density.changed == 1);
    CHECK(density.error == Approx(std::sqrt(1.5) - 1.0));
    CHECK(density.worstError == Approx(0.5));
}

TEST_CASE("presets and path tracer are compared at equal time and at equal error", "[sweep]")
{
    const std::vector<Measurement> rows = syntheticSweep(2);
    const std::vector<EqualRow> equal = presetsAgainstPathTracer(casesOf(rows));
    REQUIRE(equal.size() == 6);
    const EqualRow& balanced = equal[3];
    CHECK(balanced.name == "scene1");
    CHECK(balanced.row->label == "balanced");
    CHECK(balanced.row == balanced.balanced);
    // 0.5 spp = 4: 8 spp, an exact power of the curve; 0.8 / sqrt(spp) = 0.1: 64 spp, cost 32.
    REQUIRE(balanced.errorRatio);
    CHECK(balanced.tracerError.value == Approx(2.0 * 0.8 / std::sqrt(8.0)));
    CHECK(*balanced.errorRatio == Approx(0.8 / std::sqrt(8.0) / 0.1));
    REQUIRE(balanced.costRatio);
    CHECK(balanced.tracerCost.value == Approx(3.0 * 32.0));
    CHECK(*balanced.costRatio == Approx(8.0));

    std::vector<EqualRow> some = equal;
    some[0].costRatio.reset();
    *some[3].costRatio = 2.0;
    some[0].errorRatio = 9.0;
    some[3].errorRatio = 4.0;
    const std::vector<EqualSummary> summary = summarizeEqual(some);
    REQUIRE(summary.size() == 3);
    CHECK(summary[0].preset == "balanced");
    CHECK(summary[0].cases == 2);
    CHECK(summary[0].costRatios == 1);
    CHECK(summary[0].costRatio == Approx(2.0));
    CHECK(summary[0].errorRatio == Approx(6.0));
}

TEST_CASE("nothing is compared below the noise floor or beyond what was measured", "[sweep]")
{
    const std::vector<CostError> curve = {{1.0, 0.8}, {4.0, 0.4}, {16.0, 0.2}};
    CHECK(errorAt(curve, 0.5, 0.01).reach == Reach::before);
    CHECK(errorAt(curve, 2.0, 0.01).reach == Reach::measured);
    CHECK(errorAt(curve, 2.0, 0.01).value == Approx(0.8 / std::sqrt(2.0)));
    CHECK(errorAt(curve, 17.0, 0.01).reach == Reach::beyond);
    CHECK(errorAt(curve, 12.0, 0.3).reach == Reach::belowFloor);
    CHECK(errorAt(curve, 17.0, 0.3).reach == Reach::belowFloor);
    CHECK(errorAt({}, 1.0, 0.3).reach == Reach::beyond);

    CHECK(costAt(curve, 0.9, 0.01).reach == Reach::before);
    CHECK(costAt(curve, 0.4, 0.01).value == Approx(4.0));
    CHECK(costAt(curve, 0.1, 0.01).reach == Reach::beyond);
    CHECK(costAt(curve, 0.3, 0.3).reach == Reach::belowFloor);
    CHECK(costAt({}, 0.3, 0.1).reach == Reach::beyond);

    std::vector<Measurement> rows = syntheticSweep(1);
    for (Measurement& row : rows)
        if (row.label == "accurate") row.error.rmse = row.error.noise;
    for (const EqualRow& row : presetsAgainstPathTracer(casesOf(rows)))
        if (row.row->label == "accurate") {
            CHECK(row.atFloor);
            CHECK(!row.errorRatio);
            CHECK(!row.costRatio);
        }
}
