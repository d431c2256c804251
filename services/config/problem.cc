#include "services/config/problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "services/runtime/utf8.h"

namespace giveway {
namespace {

std::string FormatOne(const Problem& problem) {
  std::string line = problem.file;
  if (problem.line > 0) line += fmt::format(":{}", problem.line);
  if (!problem.field.empty()) line += ": " + problem.field;
  if (!problem.value.empty()) line += (problem.field.empty() ? ": " : " = ") + problem.value;
  // What a file holds must not command the terminal it is shown on.
  return Printable(fmt::format("{}: {}; {}", line, problem.message, problem.remedy));
}

}  // namespace

std::string Format(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) text += (text.empty() ? "" : "\n") + FormatOne(problem);
  return text;
}

InputError::InputError(std::vector<Problem> problems)
    : std::runtime_error(Format(problems)), problems_(std::move(problems)) {}

void ProblemList::Add(Problem problem) {
  if (Full()) {
    more_ = true;
  } else {
    problems_.push_back(std::move(problem));
  }
}

std::vector<Problem> ProblemList::Sorted() const {
  std::vector<Problem> sorted = problems_;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Problem& a, const Problem& b) { return a.line < b.line; });
  if (more_) {
    sorted.push_back({sorted.front().file, 0, "", "", fmt::format("more than {} problems", kMax),
                      "correct these first"});
  }
  return sorted;
}

}  // namespace giveway
