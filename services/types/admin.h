// What an operator asks of a running vehicle, and what it answers.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "services/types/ids.h"

namespace giveway {

enum class AdminRequestKind : std::uint8_t {
  kReportQos,  // report the QoS profiles in use
  kApply,      // run with these profiles: at once where that is enough, else after a restart
  kKeepRing,   // keep permanently what the recording's ring holds now: recorder.h
};

// A profile set by value: its text, because the file may be on another machine, or another by now.
struct QosProfiles {
  static constexpr std::size_t kMostBytes = 60'000;  // the bound of the wire

  std::string name;  // for people: "lossy_radio.xml"
  std::string text;  // Fast DDS XML

  friend bool operator==(const QosProfiles&, const QosProfiles&) = default;
};

// Of an order or an answer, by the operators' key: services/auth. All 0 without one.
using Seal = std::array<std::uint8_t, 32>;

struct AdminRequest {
  VehicleId vehicle = kNoVehicle;
  std::uint64_t number = 0;  // the operator's; the answer repeats it
  AdminRequestKind kind = AdminRequestKind::kReportQos;
  QosProfiles profiles;  // of kApply
  Seal seal{};
};

enum class AnswerState : std::uint8_t {
  kInEffect,    // the values in the answer are those the vehicle runs with
  kRestarting,  // it halts and comes back with the profiles; the answer to follow is kInEffect
  kRefused,     // nothing was changed; `reason` says why
};

// One value of a live endpoint, as the library has it. Durations in nanoseconds, kinds by number.
struct LiveValue {
  std::string profile;  // "fleet_beacon_writer"
  std::string policy;   // "deadline"
  std::int64_t number = 0;

  friend bool operator==(const LiveValue&, const LiveValue&) = default;
};

struct AdminAnswer {
  VehicleId vehicle = kNoVehicle;
  std::uint64_t order = 0;
  AnswerState state = AnswerState::kInEffect;
  std::string reason;
  std::uint32_t fleet_size = 0;  // some values follow from it
  std::string interface;         // as given by --interface
  QosProfiles profiles;          // what it runs with, or restarts with
  std::vector<LiveValue> live;   // of kInEffect
  Seal seal{};
};

}  // namespace giveway
