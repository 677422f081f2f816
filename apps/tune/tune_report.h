#pragma once

#include "apps/tune/tune.h"
#include "core/base/math.h"

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <ostream>
#include <string>

/// What `lrsm tune` says, to people and as JSON.
namespace lrsm {

struct TuneRecord {
    std::string scene;
    const TuneRequest& request;
    const TuneResult& result;
    IVec2 probeSize{0};
    double probeNoise = 0.0;  ///< of the truth, RMSE / mean
    std::uint64_t probeSamples = 0;
    double verifyNoise = 0.0;
    std::uint64_t verifySamples = 0;  ///< 0: nothing was verified
};

/// {"settings": of `written`, "tune": {...}}: a file for --settings. Without `written` there are no settings in it.
nlohmann::ordered_json tuneJson(const TuneRecord& record, std::optional<std::size_t> written);

/// Budget, points and the choice; `file`: where the settings went, empty: nowhere.
void printTune(std::ostream& out, const TuneRecord& record, const std::string& file);

}  // namespace lrsm
