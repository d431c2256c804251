#include "services/qos/request_offered.h"

#include <algorithm>
#include <array>

namespace giveway::qos {
namespace {

constexpr std::array kRules = {
    MatchRule{"reliability_mismatch", Policy::kReliability,
              "a best-effort writer cannot serve a reliable reader", Relation::kAtLeast},
    MatchRule{"durability_mismatch", Policy::kDurability,
              "the writer must keep samples at least as long as the reader asks",
              Relation::kAtLeast},
    MatchRule{"deadline_mismatch", Policy::kDeadline,
              "the deadline offered must be no longer than the one requested", Relation::kAtMost},
    MatchRule{"liveliness_kind_mismatch", Policy::kLiveliness,
              "the kind offered must be no weaker than the one requested", Relation::kAtLeast},
    MatchRule{"liveliness_lease_mismatch", Policy::kLease,
              "the lease offered must be no longer than the one requested", Relation::kAtMost},
    MatchRule{"ownership_mismatch", Policy::kOwnership, "both must name the same kind",
              Relation::kEqual},
    MatchRule{"positive_acks_mismatch", Policy::kDisablePositiveAcks,
              "a reader without positive acknowledgements needs a writer without them",
              Relation::kAtLeast},
    MatchRule{"latency_budget_mismatch", Policy::kLatencyBudget,
              "the budget offered must be no longer than the one requested", Relation::kAtMost,
              false},
    MatchRule{"destination_order_mismatch", Policy::kDestinationOrder,
              "the order offered must be no weaker than the one requested", Relation::kAtLeast,
              false},
    MatchRule{"presentation_mismatch", Policy::kPresentation,
              "the scope offered must be no narrower than the one requested", Relation::kAtLeast,
              false},
};

}  // namespace

std::span<const MatchRule> MatchRules() { return kRules; }

bool Holds(const MatchRule& rule, const Profile& writer, const Profile& reader) {
  const std::int64_t offered = writer.Number(rule.policy);
  const std::int64_t requested = reader.Number(rule.policy);
  if (rule.relation == Relation::kAtLeast) return offered >= requested;
  if (rule.relation == Relation::kAtMost) return offered <= requested;
  return offered == requested;
}

std::vector<const MatchRule*> Broken(const Profile& writer, const Profile& reader) {
  std::vector<const MatchRule*> broken;
  for (const MatchRule& rule : kRules) {
    if (!Holds(rule, writer, reader)) broken.push_back(&rule);
  }
  return broken;
}

bool WillMatch(const Profile& writer, const Profile& reader) {
  return std::ranges::none_of(Broken(writer, reader),
                              [](const MatchRule* rule) { return rule->enforced; });
}

}  // namespace giveway::qos
