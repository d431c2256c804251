// The verdict of a run as data and as text. JSON is printed through idl/report.proto.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/report/violations.h"
#include "services/types/counters.h"
#include "services/types/ids.h"

namespace giveway {

enum class Verdict : std::uint8_t { kPassed, kFailed, kNotRun };

struct FirstViolation {
  std::string invariant;
  Tick tick = kNoTick;
  VehicleId vehicle = kNoVehicle;
  VehicleId other = kNoVehicle;
};

// The same of one of many virtual runs.
struct SeedViolation {
  std::uint32_t seed = 0;
  double time_s = 0;  // since the start signal
  FirstViolation what;
  std::string rule;  // by which the vehicle drove or stood
};

// Field names, presence and meaning are those of the JSON object; see idl/report.proto.
struct Report {
  std::string scenario;
  Verdict verdict = Verdict::kNotRun;
  std::string reason;  // "expectations_met", or what was not, or why it could not run
  std::uint32_t contacts = 0;
  std::optional<double> min_separation_m;
  std::optional<double> time_to_clear_s;
  std::vector<VehicleId> halted;
  std::vector<VehicleId> arrived;
  std::uint64_t beacons_sent = 0;
  std::uint64_t beacons_received = 0;
  std::uint64_t deadline_missed = 0;
  std::uint64_t liveliness_lost = 0;
  TrustCounters trust;  // of all vehicles
  std::optional<double> reaction_p50_ms;
  std::optional<double> reaction_p99_ms;
  std::optional<double> reaction_max_ms;
  std::uint32_t tick_overruns = 0;
  std::uint32_t seed = 0;
  std::uint32_t domain = 0;
  std::string state_hash;                   // 16 hex digits
  std::vector<BrokenInvariant> violations;  // empty where nothing was judged
  std::vector<FirstViolation> first_violations;
  std::uint32_t ticks_judged = 0;
  std::uint32_t ticks_unseen = 0;
};

// One JSON object on one line, proto field names, defaults printed, absent values left out.
std::string ToJson(const Report& report);
// The verdict table for a terminal of `columns` (taken as at least 24); no line is longer.
std::string ToTable(const Report& report, int columns);
// 0 passed, 1 failed, 2 not run.
int ExitCode(Verdict verdict);

}  // namespace giveway
