#pragma once

#include "apps/validate/equations/check_equations.h"
#include "apps/validate/extremes/extremes.h"
#include "apps/validate/ladder/ladder.h"
#include "apps/validate/vectors/judge.h"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

/// What `lrsm validate` found, for a terminal, for programs and for a page.
namespace lrsm {

struct ValidationPart {
    std::string name;  ///< key in validate.json: "equations"
    bool held = false;
    std::string verdict;                                   ///< one sentence; for ladders a line a scene
    std::string text;                                      ///< tables for a terminal
    std::string html;                                      ///< tables and plots for the page
    std::vector<std::pair<std::string, std::string>> csv;  ///< file name, content
};

/// The part's data go to `json`.
ValidationPart describeEquations(const EquationReport& report, nlohmann::ordered_json& json);
/// Measures and explains; there is no bound to break.
ValidationPart describeLadders(const std::vector<LadderScene>& scenes, nlohmann::ordered_json& json);
ValidationPart describeExtremes(const ExtremesReport& report, nlohmann::ordered_json& json);
ValidationPart describeJudgement(const Judgement& judgement, nlohmann::ordered_json& json);
/// A suite an equation, a case an output.
std::string judgementJUnit(const Judgement& judgement, const std::string& name);

}  // namespace lrsm
