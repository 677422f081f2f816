#pragma once

#include "apps/check/check.h"

#include <nlohmann/json_fwd.hpp>
#include <string>

/// What `lrsm check` found, for a terminal, for programs, and for CI servers.
namespace lrsm {

/// One line a buffer; runs of mips that are all right share one.
std::string checkTable(const CheckReport& report);

nlohmann::ordered_json checkJson(const CheckReport& report);

/// A suite a pass, a case a buffer: the format that Jenkins, GitLab and others read.
std::string checkJUnit(const CheckReport& report, const std::string& name);

}  // namespace lrsm
