#pragma once
#include <cstdlib>
namespace lrsm { inline double tune(const char* n, double d) { const char* s = std::getenv(n); return s ? std::atof(s) : d; } }
