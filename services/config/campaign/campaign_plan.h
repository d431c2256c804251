// A campaign as values: which virtual runs there are. idl/campaign.proto documents each field.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace giveway {

// Both ends included.
struct CampaignWholes {
  std::uint32_t low = 0;
  std::uint32_t high = 0;
};
struct CampaignNumbers {
  double low = 0;
  double high = 0;
};

struct CampaignPlan {
  std::string name;
  std::vector<std::string> generators;  // or the scenario alone
  std::string scenario_text;            // what stands in it; empty: there is none
  std::optional<double> duration_s;     // of the scenario; absent: its own
  CampaignWholes seeds;
  std::optional<CampaignWholes> vehicles;  // absent only of a scenario: its own
  CampaignNumbers loss_percent;
  bool burst = false;
  double delay_ms = 0;
  double jitter_ms = 0;
  double reorder_percent = 0;
  double duplicate_percent = 0;
  bool loops_back = false;
  std::uint32_t crashes = 0;
  std::uint32_t pauses = 0;
  std::uint32_t restarts = 0;
  std::string fault_file;  // as named; empty: none
  std::string fault_text;  // what stands in it
  bool skip_unsupported = false;
  std::uint32_t shards = 1;

  std::uint32_t SeedCount() const { return seeds.high - seeds.low + 1; }
  std::uint32_t Runs() const { return SeedCount() * static_cast<std::uint32_t>(generators.size()); }
};

}  // namespace giveway
