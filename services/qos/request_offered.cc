#include "services/qos/request_offered.h"

#include <algorithm>
#include <array>

namespace giveway::qos {
namespace {

// Of kinds whose words rise from weak to strong.
template <Policy policy>
bool AtLeast(const Profile& writer, const Profile& reader) {
  return writer.Number(policy) >= reader.Number(policy);
}

// Of durations: a promise of at most so long.
template <Policy policy>
bool AtMost(const Profile& writer, const Profile& reader) {
  return writer.Number(policy) <= reader.Number(policy);
}

template <Policy policy>
bool Equal(const Profile& writer, const Profile& reader) {
  return writer.Number(policy) == reader.Number(policy);
}

constexpr std::array kRules = {
    MatchRule{"reliability_mismatch", Policy::kReliability,
              "a best-effort writer cannot serve a reliable reader", AtLeast<Policy::kReliability>},
    MatchRule{"durability_mismatch", Policy::kDurability,
              "the writer must keep samples at least as long as the reader asks",
              AtLeast<Policy::kDurability>},
    MatchRule{"deadline_mismatch", Policy::kDeadline,
              "the deadline offered must be no longer than the one requested",
              AtMost<Policy::kDeadline>},
    MatchRule{"liveliness_kind_mismatch", Policy::kLiveliness,
              "the kind offered must be no weaker than the one requested",
              AtLeast<Policy::kLiveliness>},
    MatchRule{"liveliness_lease_mismatch", Policy::kLease,
              "the lease offered must be no longer than the one requested", AtMost<Policy::kLease>},
    MatchRule{"ownership_mismatch", Policy::kOwnership, "both must name the same kind",
              Equal<Policy::kOwnership>},
    MatchRule{"positive_acks_mismatch", Policy::kDisablePositiveAcks,
              "a reader without positive acknowledgements needs a writer without them",
              AtLeast<Policy::kDisablePositiveAcks>},
    MatchRule{"latency_budget_mismatch", Policy::kLatencyBudget,
              "the budget offered must be no longer than the one requested",
              AtMost<Policy::kLatencyBudget>, false},
    MatchRule{"destination_order_mismatch", Policy::kDestinationOrder,
              "the order offered must be no weaker than the one requested",
              AtLeast<Policy::kDestinationOrder>, false},
    MatchRule{"presentation_mismatch", Policy::kPresentation,
              "the scope offered must be no narrower than the one requested",
              AtLeast<Policy::kPresentation>, false},
};

}  // namespace

std::span<const MatchRule> MatchRules() { return kRules; }

std::vector<const MatchRule*> Broken(const Profile& writer, const Profile& reader) {
  std::vector<const MatchRule*> broken;
  for (const MatchRule& rule : kRules) {
    if (!rule.holds(writer, reader)) broken.push_back(&rule);
  }
  return broken;
}

bool WillMatch(const Profile& writer, const Profile& reader) {
  return std::ranges::none_of(Broken(writer, reader),
                              [](const MatchRule* rule) { return rule->enforced; });
}

}  // namespace giveway::qos
