#include "sweep/advice.h"

#include "core/base/settings_table.h"

namespace lrsm {

Settings applyAdvice(Settings settings, const std::vector<Advice>& advice)
{
    for (const Advice& change : advice) applySetting(settings, change.key + "=" + change.to);
    validate(settings);
    return settings;
}

std::vector<Advice> adviseSettings(const SceneAnalysis&, const Settings&, int, int) { return {}; }

}  // namespace lrsm
