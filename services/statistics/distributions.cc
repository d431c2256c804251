#include "services/statistics/distributions.h"

#include <boost/math/distributions/normal.hpp>

namespace giveway::statistics {

double NormalAbove(double z) { return cdf(complement(boost::math::normal(), z)); }

}  // namespace giveway::statistics
