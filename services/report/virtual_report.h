// What a batch of virtual runs came to, as data and as text. JSON is printed through
// idl/report.proto.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/report/report.h"

namespace giveway {

// Means over all vehicles, until they arrived.
struct TrafficReport {
  std::vector<std::pair<std::string, double>> by_rule_s;  // by its name; no rule without time
  double stops = 0;
  double taken_back = 0;
};

// Field names, presence and meaning are those of the JSON object; see idl/report.proto.
struct VirtualReport {
  std::string scenario;
  Verdict verdict = Verdict::kNotRun;
  std::string reason;
  std::uint32_t runs = 0;
  std::uint32_t failed_runs = 0;
  std::uint32_t contacts = 0;
  std::vector<BrokenInvariant> violations;  // by their names in the schema
  std::string unmet;
  std::vector<SeedViolation> first_violations;
  std::uint32_t vehicles = 0;
  std::uint32_t arrived = 0;
  double vehicle_hours = 0;
  double vehicle_hours_per_minute = 0;
  std::optional<double> delay_p50_s;
  std::optional<double> delay_p99_s;
  std::optional<double> delay_mean_s;
  std::optional<double> min_separation_m;
  TrafficReport traffic;
  TrustCounters trust;
  std::string hash;
  std::vector<std::uint32_t> failing_seeds;
  std::uint32_t jobs = 0;
};

// One JSON object on one line, proto field names, defaults printed, absent values left out.
std::string ToJson(const VirtualReport& report);
// For people: a few short lines.
std::string ToText(const VirtualReport& report);

}  // namespace giveway
