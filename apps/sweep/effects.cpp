#include "apps/sweep/effects.h"

#include "core/settings/settings_table.h"

#include <algorithm>
#include <cmath>

namespace lrsm {
namespace {

/// A row beside the row that it departs from, and what to call the two.
struct Step {
    const Measurement *row, *base;
    std::string label, around;
    double baseCost = 0.0;  ///< see costOfBase
};

std::string baseNameOf(const Measurement& row)
{
    if (row.kind == RowKind::axis && !row.base.empty()) return row.base;
    const bool single = row.kind != RowKind::pathTracer && differences(Settings{}, row.settings).size() == 1;
    return single ? "balanced" : "";
}

/// A value that means nothing without another ("density_k=4 estimator=paper") is held against the row that has that other alone: its label's first word is the
/// value. nullptr where it stands alone, or where that row was not measured.
const Measurement* companionRow(const CaseRows& rows, const Measurement& row, const Settings& base)
{
    const std::vector<SettingDifference> changed = differences(base, row.settings);
    const std::string key = row.label.substr(0, row.label.find('='));
    if (changed.size() < 2) return nullptr;
    for (const SettingDifference& d : changed)
        if (d.key == key) {
            Settings without = row.settings;
            applySetting(without, key + "=" + d.a);
            return findSettings(rows, without);
        }
    return nullptr;
}

bool equalBits(const Step& step)
{
    return !step.row->irradianceSha256.empty() && step.row->irradianceSha256 == step.base->irradianceSha256;
}

/// The median of the base's cost and of those of the rows with its bits. A base alone, which is measured first, may have met a busy minute, and every row is
/// held against it.
double costOfBase(const std::vector<Step>& steps, const Measurement& base)
{
    std::vector<double> costs = {base.cost};
    for (const Step& step : steps)
        if (step.base == &base && equalBits(step)) costs.push_back(step.row->cost);
    return summarize(std::move(costs)).median;
}

std::vector<Step> stepsOf(const CaseRows& rows)
{
    const std::vector<std::string> known = presetNames();
    std::vector<Step> steps;
    for (const Measurement* row : rows.settings) {
        const std::string name = baseNameOf(*row);
        if (std::find(known.begin(), known.end(), name) == known.end()) continue;
        const Settings settings = preset(name);
        if (const Measurement* companion = companionRow(rows, *row, settings))
            steps.push_back({row, companion, row->label.substr(0, row->label.find(' ')), name + " " + companion->label});
        else if (const Measurement* base = findSettings(rows, settings); base && base != row)
            steps.push_back({row, base, row->label, name});
    }
    for (Step& step : steps) step.baseCost = costOfBase(steps, *step.base);
    return steps;
}

using Group = std::vector<Step>;

/// The same settings around the same base, over the cases.
std::vector<Group> groupsOf(const std::vector<CaseRows>& cases)
{
    std::vector<Group> groups;
    for (const CaseRows& one : cases)
        for (const Step& step : stepsOf(one)) {
            const auto same = [&](const Group& group) { return group.front().around == step.around && group.front().row->settings == step.row->settings; };
            auto found = std::find_if(groups.begin(), groups.end(), same);
            if (found == groups.end()) found = groups.insert(groups.end(), Group{});
            found->push_back(step);
        }
    return groups;
}

EffectKind kindOf(const Effect& effect, double tolerance)
{
    if (effect.changed == 0) return EffectKind::changesNothing;
    if (effect.error < 0.0) return effect.cost <= tolerance ? EffectKind::winsBoth : EffectKind::buys;
    return effect.cost < -tolerance ? EffectKind::saves : EffectKind::losesBoth;
}

Effect effectOf(const Group& group, double unit, double tolerance)
{
    Effect effect;
    effect.label = group.front().label;
    effect.base = group.front().around;
    effect.cases = group.size();
    std::vector<CostError> ratios;
    std::vector<double> bytes;
    for (const Step& step : group) {
        ratios.push_back(relativeTo(*step.row, *step.base));
        ratios.back().cost = step.row->cost / step.baseCost;
        if (step.row->bytes > 0 && step.base->bytes > 0) bytes.push_back(static_cast<double>(step.row->bytes) / static_cast<double>(step.base->bytes));
        effect.changed += equalBits(step) ? 0 : 1;
        effect.worstError = ratios.size() == 1 ? ratios.back().error - 1.0 : std::max(effect.worstError, ratios.back().error - 1.0);
        effect.milliseconds += (step.row->cost - step.baseCost) * unit / static_cast<double>(group.size());
    }
    const CostError all = combineScenes(ratios);
    effect.error = all.error - 1.0;
    effect.cost = all.cost - 1.0;
    effect.bytes = geometricMean(bytes) - 1.0;
    effect.kind = kindOf(effect, tolerance);
    const bool traded = effect.kind == EffectKind::buys || effect.kind == EffectKind::saves;
    if (traded && effect.milliseconds != 0.0) effect.percentPerMs = 100.0 * std::abs(effect.error) / std::abs(effect.milliseconds);
    return effect;
}

bool comesBefore(const Effect& a, const Effect& b)
{
    if (a.kind != b.kind) return a.kind < b.kind;
    switch (a.kind) {
    case EffectKind::buys: return a.percentPerMs > b.percentPerMs;
    case EffectKind::saves: return a.percentPerMs < b.percentPerMs;
    case EffectKind::changesNothing: return a.cost < b.cost;
    default: return a.error < b.error;
    }
}

}  // namespace

std::vector<Effect> effectsOf(const std::vector<CaseRows>& cases, double unit, double tolerance)
{
    std::vector<Effect> effects;
    for (const Group& group : groupsOf(cases)) effects.push_back(effectOf(group, unit, tolerance));
    std::erase_if(effects, [](const Effect& e) { return !std::isfinite(e.error) || !std::isfinite(e.cost); });
    std::stable_sort(effects.begin(), effects.end(), comesBefore);
    return effects;
}

double costNoise(const std::vector<CaseRows>& cases)
{
    std::vector<double> changes;
    for (const CaseRows& one : cases)
        for (const Step& step : stepsOf(one))
            if (equalBits(step) && step.baseCost > 0.0) changes.push_back(std::abs(step.row->cost / step.baseCost - 1.0));
    return summarize(std::move(changes)).median;
}

CalibrationUnit calibrationUnit(const std::vector<Measurement>& rows)
{
    std::vector<double> times;
    for (const Measurement& row : rows)
        if (row.calibrationCpu > 0.0) times.push_back(row.calibrationCpu);
    if (times.empty()) return {};
    const auto [min, max] = std::minmax_element(times.begin(), times.end());
    const double least = *min, most = *max;
    return {summarize(std::move(times)).median, least, most};
}

}  // namespace lrsm
