#pragma once

#include "apps/validate/vectors/vector_set.h"
#include "core/base/output_folder.h"

/// A folder of vectors: vectors.json and .npy files (docs/vectors.md).
namespace lrsm {

inline constexpr const char* kVectorsFile = "vectors.json";

// Of a set's input, of an output's exact results and of what is allowed; and what somebody else's results are to be called.
std::string inputFile(const VectorSet& set, const VectorArray& input);
std::string exactFile(const VectorOutput& output);
std::string allowedFile(const VectorOutput& output);
std::string givenFile(const VectorOutput& output);

/// (cases, then the shape of one).
std::vector<std::size_t> wholeShape(const VectorArray& array, std::size_t cases);

/// Equal sets give equal bytes.
void writeVectors(OutputFolder& folder, const std::vector<VectorSet>& sets, const std::string& version);

/// All but `ours`. InputError "FILE: why; what to do" where a file is missing, damaged or not as vectors.json says.
std::vector<VectorSet> readVectors(const std::string& folder);

/// Every element as a number.
std::vector<double> numbersOf(const NpyArray& array);

}  // namespace lrsm
