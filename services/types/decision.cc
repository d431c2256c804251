#include "services/types/decision.h"

namespace giveway {

std::string_view Name(Behaviour behaviour) {
  switch (behaviour) {
    case Behaviour::kCooperative:
      return "cooperative";
    case Behaviour::kLectureAvoid:
      return "lecture_avoid";
    case Behaviour::kStockAvoid:
      return "stock_avoid";
    case Behaviour::kLectureYield:
      return "lecture_yield";
    case Behaviour::kLecturePrinted:
      return "lecture_printed";
  }
  return "unknown";
}

std::string_view Name(Mode mode) {
  switch (mode) {
    case Mode::kCooperative:
      return "cooperative";
    case Mode::kSensorOnly:
      return "sensor_only";
    case Mode::kHalt:
      return "halt";
    case Mode::kLeaving:
      return "leaving";
  }
  return "unknown";
}

std::string_view Name(Rule rule) {
  switch (rule) {
    case Rule::kCruise:
      return "cruise";
    case Rule::kNotRunning:
      return "not_running";
    case Rule::kArrived:
      return "arrived";
    case Rule::kRangesStale:
      return "ranges_stale";
    case Rule::kGiveWay:
      return "give_way";
    case Rule::kNotGranted:
      return "not_granted";
    case Rule::kPeerLost:
      return "peer_lost";
    case Rule::kUnidentifiedMotion:
      return "deaf";
    case Rule::kObstacle:
      return "obstacle";
    case Rule::kSteerRound:
      return "steer_round";
    case Rule::kAvoid:
      return "avoid";
    case Rule::kSignal:
      return "signal";
    case Rule::kKeepClear:
      return "keep_clear";
    case Rule::kMakeRoom:
      return "make_room";
    case Rule::kObject:
      return "object";
    case Rule::kLeaving:
      return "leaving";
    case Rule::kUnsure:
      return "unsure";
    case Rule::kLost:
      return "lost";
  }
  return "unknown";
}

}  // namespace giveway
