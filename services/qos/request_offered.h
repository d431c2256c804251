// Whether a writer and a reader match: the request-offered rules, one function each. What the
// writer offers must be at least what the reader requests.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "services/qos/profile_set.h"

namespace giveway::qos {

// What the writer's number must be against the reader's.
enum class Relation : std::uint8_t {
  kAtLeast,  // of kinds whose words rise from weak to strong
  kAtMost,   // of durations: a promise of at most so long
  kEqual,
};

struct MatchRule {
  std::string_view name;  // of the finding where it is broken
  Policy policy;          // the values of this one are compared
  std::string_view rule;  // in words
  Relation relation;
  // Fast DDS looks at it when endpoints meet. Others do of those it does not.
  bool enforced = true;
};

std::span<const MatchRule> MatchRules();
bool Holds(const MatchRule& rule, const Profile& writer, const Profile& reader);

// The rules between the two that do not hold, whether the library looks at them or not.
std::vector<const MatchRule*> Broken(const Profile& writer, const Profile& reader);

// What Fast DDS will do, 2.9 and 3.1 alike. Partitions apart: a profile of an endpoint does not set
// them.
bool WillMatch(const Profile& writer, const Profile& reader);

}  // namespace giveway::qos
