// The numbers of an impairment rule: how a scenario and the flag --impair name them, their ranges,
// and what must hold between them. One table for reading either and for writing.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "services/app/section.h"
#include "services/types/impairment.h"

namespace giveway::app {

struct ImpairField {
  std::string_view field;  // in a scenario: delay_ms
  std::string_view key;    // in --impair: delay
  double ImpairmentRule::*member;
  Allowed allowed;       // in the unit of the scenario
  double per_si = 1;     // of that unit in one of the member's
  bool is_time = false;  // in --impair: with its unit
};

inline constexpr Allowed kBlackoutTime{0, 86400, "s"};
inline constexpr int kMaxImpairRules = 64;
inline constexpr int kMaxBlackouts = 64;

std::span<const ImpairField> ImpairFields();

// A number that is in its range and does not go with another.
struct RuleConflict {
  std::string_view field;  // as in a scenario
  std::string message;
  std::string remedy;
};
// Says nothing about numbers that are not finite: they are problems already.
std::vector<RuleConflict> ConflictsIn(const ImpairmentRule& rule);

}  // namespace giveway::app
