// What is to go wrong with the packets vehicles hear, as configuration: the numbers of a rule, how
// a scenario and the flag --impair name them, their ranges, and what must hold between them. One
// table serves reading either and writing. As one word of a command line:
//
//   loss=0.1,delay=20ms,jitter=5ms,seed=7
//   loss=0.05;from=3,to=2,blackout=5s..7s;from=world
//   from=vehicles,loss=0.3,during=60s..80s
//
// Rules are separated by ';', the last that fits a packet counts. Keys are those of the scenario
// without their units; times carry one of us, ms, s. `from` is anyone, vehicles, world or an id,
// `to` an id; `blackout` may be repeated. A rule holds `during` a span of time, which may be open
// at one end (`60s..`), or always. "none" is no impairment, and "@FILE" is what that file says: a
// soak of days has more rules than a command line takes.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "services/config/plan_read.h"
#include "services/config/section.h"
#include "services/types/impairment.h"

namespace giveway {

struct ImpairField {
  std::string_view field;  // in a scenario: delay_ms
  std::string_view key;    // in --impair: delay
  double ImpairmentRule::*member;
  Allowed allowed;       // in the unit of the scenario
  double per_si = 1;     // of that unit in one of the member's
  bool is_time = false;  // in --impair: with its unit

  // In --impair a share may be given in percent.
  bool IsShare() const { return allowed.high <= 1; }
};

inline constexpr Allowed kBlackoutTime{0, 2592000, "s"};  // and of from_s, to_s of a rule
inline constexpr int kMaxImpairRules = 1024;              // in a scenario or a word
inline constexpr int kMaxImpairRulesOfFile = 1000000;     // in a file that a word names
inline constexpr int kMaxBlackouts = 1024;

std::span<const ImpairField> ImpairFields();

// A number that is in its range and does not go with another.
struct RuleConflict {
  std::string_view field;  // as in a scenario
  std::string message;
  std::string remedy;
};
// Says nothing about numbers that are not finite: they are problems already.
std::vector<RuleConflict> ConflictsIn(const ImpairmentRule& rule);

ImpairmentRule ReadImpairmentRule(const Section& section, const KnownIds& known);

// One thing wrong with the text: names key and value.
struct ImpairTextProblem {
  std::string message;
  std::string remedy;
};

struct ParsedImpairment {
  Impairment impairment;
  std::vector<ImpairTextProblem> problems;  // empty: the impairment is good
};

// Reads the file that `text` may name.
ParsedImpairment ParseImpairment(std::string_view text);

// The text that is parsed as the same impairment; without a rule, "none", there is no seed either.
std::string ImpairmentText(const Impairment& impairment);

}  // namespace giveway
