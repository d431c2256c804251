// The two functions that tests of samples stand on, the same bits on every machine. Pure.
#pragma once

namespace giveway::statistics {

// That a standard normal value lies above z (Marsaglia 2004; continued fraction in the tail); to
// 1e-12 of itself up to z = 3, 1e-9 beyond.
double NormalAbove(double z);

// The logarithm of n factorial, n from 0 on (Stirling); to 1e-12 of itself or 1e-12.
double LogFactorial(double n);

}  // namespace giveway::statistics
