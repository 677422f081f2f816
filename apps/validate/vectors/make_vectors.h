#pragma once

#include "apps/validate/vectors/vector_set.h"

/// The sets, in the order of the paper. Oracles, domains and bounds are those of apps/validate/equations.
///
/// What is allowed is the error of a plain float32 implementation: the bound of our own function, and where a formula subtracts what nearly cancels, what half
/// an ULP of its inputs moves the exact result by. Functions of double (`base`) are held to double's.
namespace lrsm {

/// Of one equation (equationNames()) or of all. The same on every run of one machine; libraries that round otherwise may pick other cases elsewhere.
std::vector<VectorSet> makeVectors(const std::string& equation = "");

/// Leaves what is of this equation. InputError for a name that is none of equationNames().
void keepEquation(std::vector<VectorSet>& sets, const std::string& equation);

// The groups, each in a file of its own.
void addMarchVectors(std::vector<VectorSet>& sets);       // "1"
void addSurfaceVectors(std::vector<VectorSet>& sets);     // "2", "3", "4", "7"
void addLayerVectors(std::vector<VectorSet>& sets);       // "6", "8", "10", "11", "13", "14", "15"
void addSampleVectors(std::vector<VectorSet>& sets);      // "5", "8", "9", "10", "11", "12", "sec5"
void addVoxelVectors(std::vector<VectorSet>& sets);       // "sec3", "fig7"
void addFormatVectors(std::vector<VectorSet>& sets);      // "table1"
void addElementaryVectors(std::vector<VectorSet>& sets);  // "base"

}  // namespace lrsm
