#pragma once

#include "apps/info/analyse_scene.h"

#include <string>
#include <vector>

/// Settings that what was measured of a scene allows.
namespace lrsm {

/// One change of one setting that the scene allows.
struct Advice {
    std::string key, from, to;                                    ///< as in --set
    std::string why;                                              ///< one sentence with the numbers that it rests on
    bool bitsEqual = false;                                       ///< the picture keeps every bit; otherwise docs/requirements.md says what the rule has cost
    double predictedTimeRatio = 1.0, predictedMemoryRatio = 1.0;  ///< of the whole frame, after over before, this change alone; 1: none expected
};

/// What may be changed in `settings` for this scene, all together; empty when nothing is. Rules that did not predict are not here: see docs/requirements.md.
std::vector<Advice> adviseSettings(const Scene& scene, const SceneAnalysis& analysis, const Settings& settings, int width, int height);

/// `settings` with all advice laid over it.
Settings applyAdvice(Settings settings, const std::vector<Advice>& advice);

}  // namespace lrsm
