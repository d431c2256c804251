// What the middleware says about a peer. Events only ever make a vehicle more cautious.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

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
  kSampleLost,       // at least one beacon did not arrive, or was overwritten before it was taken
};

constexpr std::string_view Name(QosEventKind kind) {
  constexpr std::array<std::string_view, 7> kNames = {
      "deadline_missed", "liveliness_lost",  "liveliness_back", "matched",
      "unmatched",       "incompatible_qos", "sample_lost"};
  const auto index = static_cast<std::size_t>(kind);
  return index < kNames.size() ? kNames[index] : "unknown";
}

struct QosEvent {
  QosEventKind kind = QosEventKind::kMatched;
  VehicleId vehicle = kNoVehicle;  // that it is about; kNoVehicle if the middleware could not say
  SteadyTime at{0};
};

}  // namespace giveway
