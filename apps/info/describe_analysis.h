#pragma once

#include "apps/info/advice.h"

#include <nlohmann/json_fwd.hpp>
#include <ostream>

/// What a scene requires of the settings, for people and as JSON.
namespace lrsm {

nlohmann::ordered_json analysisJson(const SceneAnalysis& analysis);
nlohmann::ordered_json adviceJson(const std::vector<Advice>& advice);

void printAnalysis(std::ostream& out, const SceneAnalysis& analysis);
void printAdvice(std::ostream& out, const std::vector<Advice>& advice);

}  // namespace lrsm
