// What is wrong with an input file: one problem, many of them in words, and as an exception.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace giveway {

// One thing wrong with an input file, in words an operator can act on.
struct Problem {
  std::string file;
  int line = 0;         // 1-based; 0 where the file as a whole is meant
  std::string field;    // path, e.g. "vehicle[1].cruise_m_s"; empty for the file as a whole
  std::string value;    // as written; empty if missing
  std::string message;  // what is wrong and the allowed range
  std::string remedy;   // what to do
};

// "file:line: field = value: message; remedy", one a line.
std::string Format(const std::vector<Problem>& problems);

// Start-up input is bad. what() lists every problem. Main exits with 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);
  const std::vector<Problem>& Problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

// Gathers the problems of a file up to a number that a person still reads: a file made of nonsense
// has millions.
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

}  // namespace giveway
