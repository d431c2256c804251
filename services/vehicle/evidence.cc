#include "services/vehicle/evidence.h"

#include <algorithm>

#include "services/vehicle/situation/blocked.h"
#include "services/vehicle/situation/echoes.h"
#include "services/vehicle/situation/heard_places.h"
#include "services/vehicle/situation/objects_ahead.h"

namespace giveway {
namespace {

std::optional<double> FreeOf(const Situation& s, const Decision& decision) {
  switch (decision.rule) {
    case Rule::kGiveWay:
    case Rule::kNotGranted:
    case Rule::kPeerLost:
    case Rule::kKeepClear:
      if (const PeerView* view = ViewOf(decision.peer, s.near.peers)) return view->gap_m;
      return std::nullopt;
    case Rule::kObstacle:
    case Rule::kUnidentifiedMotion:
    case Rule::kAvoid:
      if (decision.sensor < 0) return FreeOfPlaces({1, 0}, s);
      return FreeAhead(static_cast<std::size_t>(decision.sensor), s);
    case Rule::kObject:
      if (const auto object = NearestObstacle(s.own.objects, s)) return object->free_m;
      return std::nullopt;
    case Rule::kSignal:
      return s.own.stop_line ? std::optional(s.own.stop_line->free_m) : std::nullopt;
    default:
      return std::nullopt;
  }
}

}  // namespace

DecisionEvidence EvidenceOf(const Situation& s, const Decision& decision, bool is_new) {
  DecisionEvidence evidence;
  for (const PeerView& view : s.near.peers) {
    if (!view.fresh) continue;
    const Nanoseconds age = Age(*view.peer, s.own.now, s.own.tick, s.own.options.tick_period);
    evidence.oldest_beacon = std::max(evidence.oldest_beacon.value_or(age), age);
  }
  if (!is_new) return evidence;
  evidence.free_m = FreeOf(s, decision);
  if (evidence.free_m) evidence.free_m = std::max(0.0, *evidence.free_m);
  return evidence;
}

}  // namespace giveway
