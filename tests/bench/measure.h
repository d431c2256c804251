// How the benchmarks take and sum up time. Processor time of all threads, not the wall clock:
// another program's turn on the core must not count, and a library's hidden thread must.
#pragma once

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <vector>

namespace giveway::bench {

inline double CpuNow_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <typename Work>
double CpuSecondsOf(Work&& work) {
  const double begin_s = CpuNow_s();
  work();
  return CpuNow_s() - begin_s;
}

inline double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace giveway::bench
