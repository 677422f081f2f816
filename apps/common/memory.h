#pragma once

#include "conetrace/render.h"

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

/// Bytes before and after: what each structure will hold, what it held, and what Table 2 of the paper says.
namespace lrsm {

/// InputError, before anything large is allocated, when the frame needs more than `maxMegabytes` (of 10^6 bytes; 0: no limit). Decides
/// by bounds where they suffice: what is unknown at its most, then at its least; only between the two is it found.
void enforceMemoryLimit(const MemoryQuestion& question, double maxMegabytes);

nlohmann::ordered_json memoryJson(const std::vector<MemoryRow>& rows);
void printMemory(std::ostream& out, const std::vector<MemoryRow>& rows);

/// "19.2 MB", of 10^6 bytes as in the paper.
std::string megabytes(std::size_t bytes);

}  // namespace lrsm
