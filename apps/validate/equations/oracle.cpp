#include "apps/validate/equations/oracle.h"

#include <boost/math/special_functions/erf.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>

namespace lrsm::oracle {
namespace {

using Wide = boost::multiprecision::cpp_bin_float_50;

/// By the lower tail, so that nothing cancels there.
Wide phiWide(const Wide& x)
{
    return boost::math::erfc(Wide(-x / sqrt(Wide(2)))) / 2;
}

double difference(double value, const Wide& exact)
{
    return static_cast<double>(Wide(value) - exact);
}

double ratioError(double value, const Wide& exact)
{
    return static_cast<double>(Wide((Wide(value) - exact) / exact));
}

}  // namespace

long double phi(long double x)
{
    return 0.5L * std::erfc(-x * 0.70710678118654752440084436210484904L);
}

long double visibility(long double mu, long double sigma2, long double zc, long double rc)
{
    const long double distance = std::abs(zc - mu), inner = rc - distance;
    if (!(sigma2 > 0.0L)) return inner > 0.0L ? 1.0L : inner < 0.0L ? 0.0L : 0.5L;
    const long double sigma = std::sqrt(sigma2);
    return phi(inner / sigma) - phi(-(rc + distance) / sigma);
}

double phiError(double x, double value)
{
    return difference(value, phiWide(x));
}

double phiRelativeError(double x, double value)
{
    return ratioError(value, phiWide(x));
}

double visibilityError(double mu, double sigma2, double zc, double rc, double value)
{
    if (!(sigma2 > 0.0)) return value - static_cast<double>(visibility(mu, sigma2, zc, rc));
    const Wide sigma = sqrt(Wide(sigma2)), distance = abs(Wide(zc) - Wide(mu));
    return difference(value, phiWide((Wide(rc) - distance) / sigma) - phiWide((-Wide(rc) - distance) / sigma));
}

double log2Error(double x, double value)
{
    return difference(value, log(Wide(x)) / log(Wide(2)));
}

double exp2RelativeError(double x, double value)
{
    return ratioError(value, pow(Wide(2), Wide(x)));
}

double powerRelativeError(double x, double y, double value)
{
    return ratioError(value, pow(Wide(x), Wide(y)));
}

double sinError(double x, double value)
{
    return difference(value, sin(Wide(x)));
}

double cosError(double x, double value)
{
    return difference(value, cos(Wide(x)));
}

double arcTangent2Error(double y, double x, double value)
{
    return difference(value, atan2(Wide(y), Wide(x)));
}

}  // namespace lrsm::oracle
