// What a vehicle's own doubt about where it is asks for. Others keep two standard deviations from
// where it says it is: beyond its limit it promises no place any more, stands, and says so.
#include "services/vehicle/decision/decision_rules.h"

namespace giveway {

std::optional<Proposal> Lost(const Situation& s) {
  if (!s.own.lost) return std::nullopt;
  return Proposal{.max_speed_m_s = 0, .may_turn = false, .rule = Rule::kLost};
}

std::optional<Proposal> Unsure(const Situation& s) {
  if (s.own.known_share >= 1) return std::nullopt;
  return Proposal{.max_speed_m_s = s.own.known_share * s.own.options.cruise_m_s,
                  .may_turn = true,
                  .rule = Rule::kUnsure};
}

}  // namespace giveway
