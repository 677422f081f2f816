#pragma once

/// Special functions to 50 digits, and cheaper ones in long double to search with. None of our own code is in them.
namespace lrsm::oracle {

/// Standard normal distribution function in long double, by the C library's erfc.
long double phi(long double x);
/// Eq. 12 in long double. sigma2 <= 0: the step.
long double visibility(long double mu, long double sigma2, long double zc, long double rc);

/// value - f(x), f to 50 digits (Boost.Multiprecision). The difference is rounded once, to double.
double phiError(double x, double value);
double phiRelativeError(double x, double value);
double visibilityError(double mu, double sigma2, double zc, double rc, double value);
double log2Error(double x, double value);
double exp2RelativeError(double x, double value);
double powerRelativeError(double x, double y, double value);
double sinError(double x, double value);
double cosError(double x, double value);
double arcTangent2Error(double y, double x, double value);

}  // namespace lrsm::oracle
