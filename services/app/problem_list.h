// Gathers the problems of a file up to a number that a person still reads: a file made of nonsense
// has millions.
#pragma once

#include <cstddef>
#include <vector>

#include "services/app/scenario_file.h"

namespace giveway::app {

class ProblemList {
 public:
  static constexpr std::size_t kMax = 100;

  // True once no more is kept; Add then only notes that there were more.
  bool Full() const { return problems_.size() >= kMax; }
  bool Empty() const { return problems_.empty(); }
  void Add(Problem problem);
  // In order of lines; says so at the end if some were left out.
  std::vector<Problem> Sorted() const;

 private:
  std::vector<Problem> problems_;
  bool more_ = false;
};

}  // namespace giveway::app
