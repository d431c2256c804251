// What the middleware says about a peer. Events only ever make a vehicle more cautious.
#pragma once

#include <cstdint>

#include "services/types/ids.h"
#include "services/types/time.h"

namespace giveway {

enum class QosEventKind : std::uint8_t {
  kDeadlineMissed,  // edge: once a vehicle until its next accepted beacon
  kLivelinessLost,  // the peer's writer stopped asserting itself
  kLivelinessBack,
  kMatched,          // discovered and compatible
  kUnmatched,        // left, dropped, or no longer compatible
  kIncompatibleQos,  // discovered, and refused
};

struct QosEvent {
  QosEventKind kind = QosEventKind::kMatched;
  VehicleId vehicle = kNobody;  // whom it is about; kNobody if the middleware could not say
  SteadyTime at{0};
};

}  // namespace giveway
