// What tests of samples stand on, by Boost.Math. Pure.
#pragma once

namespace giveway::statistics {

// That a standard normal value lies above z.
double NormalAbove(double z);

}  // namespace giveway::statistics
