#include "services/config/campaign/campaign_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace giveway {
namespace {

constexpr std::size_t kLongestCampaignName = 64;
constexpr std::uint64_t kMostRuns = 100'000'000;
constexpr CampaignWholes kUsualFleet{6, 6};
constexpr Allowed kFleetSize{2, 1000};
constexpr Allowed kLoss{0, 99, "%"};
constexpr Allowed kPercent{0, 100, "%"};
constexpr Allowed kMilliseconds{0, 1000, "ms"};
constexpr Allowed kProcessFaults{0, 1000};
constexpr Allowed kCampaignDuration_s{1, 86400, "s"};
constexpr Allowed kShards{1, 100000};

std::string ReadCampaignName(const Section& root) {
  if (!root.Has("name")) {
    root.AddMissingError("name", "write name: \"...\"");
    return "";
  }
  const std::string name = root.Text("name");
  const bool clean = std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  if (!clean || name.empty() || name.size() > kLongestCampaignName || name.front() == '-') {
    root.AddError("name", "must be 1 to 64 of the characters a-z 0-9 _ -, the first not a -",
                  "write such as nightly_1");
  }
  return name;
}

std::vector<std::string> ReadGenerators(const Section& root,
                                        std::span<const std::string_view> known) {
  std::vector<std::string> names = root.Texts("generator");
  if (names.empty()) {
    root.AddMissingError("generator", "write generator: \"crossing\", or scenario: \"four_way\"");
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int index = static_cast<int>(i);
    if (std::ranges::find(known, names[i]) == known.end()) {
      root.AddError("generator", "is no generator",
                    fmt::format("write one of {}", fmt::join(known, ", ")), index);
    } else if (std::find(names.begin(), names.begin() + index, names[i]) != names.begin() + index) {
      root.AddError("generator", "stands there already", "name each once", index);
    }
  }
  return names;
}

// The name of a file, which becomes an argument of a command that is printed on one line. Empty if
// it is absent or none.
std::string ReadFileName(const Section& root, const char* field, const char* remedy) {
  if (!root.Has(field)) return "";
  const std::string name = root.Text(field);
  const bool clean =
      std::ranges::none_of(name, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  if (clean && !name.empty() && name.front() != '-') return name;
  root.AddError(field, "is no name of a file", remedy);
  return "";
}

// What is run: generators, or one scenario.
void ReadSubjects(const Section& root, std::span<const std::string_view> known,
                  CampaignPlan* plan) {
  if (!root.Has("scenario")) {
    plan->generators = ReadGenerators(root, known);
    if (root.Has("duration_s")) {
      root.AddError("duration_s", "stands without a scenario: generators know how long they last",
                    "remove it, or write scenario:");
    }
    return;
  }
  const std::string scenario = ReadFileName(root, "scenario", "write such as four_way, or a path");
  if (std::ranges::find(known, scenario) != known.end()) {
    root.AddError("scenario", "is a generator too, which is what would be run",
                  "write generator:, or the path of the scenario's file");
  }
  if (root.Has("generator")) {
    root.AddError("generator", "is given together with a scenario", "write a campaign for each");
  }
  plan->generators = {scenario};
  const double duration_s = root.NumberOr(1, "duration_s", kCampaignDuration_s);
  if (root.Has("duration_s")) plan->duration_s = duration_s;
}

// [lowest, highest] or one number; nothing where there is none, or none that can be used.
std::optional<CampaignNumbers> ReadRange(const Section& root, const char* field,
                                         const Allowed& allowed) {
  const std::vector<double> ends = root.Numbers(field, allowed, 2);
  if (ends.empty() || std::ranges::any_of(ends, [](double end) { return std::isnan(end); })) {
    return std::nullopt;
  }
  if (ends.front() > ends.back()) {
    root.AddError(field, "the lowest is above the highest", "write [lowest, highest]");
    return std::nullopt;
  }
  return CampaignNumbers{ends.front(), ends.back()};
}

CampaignWholes WholesOfRange(const CampaignNumbers& range) {
  return {static_cast<std::uint32_t>(range.low), static_cast<std::uint32_t>(range.high)};
}

void ReadSeeds(const Section& root, CampaignPlan* plan) {
  if (!root.Has("seeds")) root.AddMissingError("seeds", "write seeds: [1, 1000]");
  const auto seeds = ReadRange(root, "seeds", kWholeNumber);
  if (!seeds) return;
  plan->seeds = WholesOfRange(*seeds);
  const std::uint64_t runs =
      (std::uint64_t{plan->seeds.high} - plan->seeds.low + 1) * plan->generators.size();
  if (runs > kMostRuns) {
    root.AddError(
        "seeds",
        fmt::format("are {} runs with all generators; at most {} are allowed", runs, kMostRuns),
        "write another campaign for the others");
  }
}

void ReadRadio(const Section& root, CampaignPlan* plan) {
  plan->loss_percent = ReadRange(root, "loss_percent", kLoss).value_or(CampaignNumbers{});
  plan->burst = root.FlagOr(false, "burst");
  plan->delay_ms = root.NumberOr(0, "delay_ms", kMilliseconds);
  plan->jitter_ms = root.NumberOr(0, "jitter_ms", kMilliseconds);
  plan->reorder_percent = root.NumberOr(0, "reorder_percent", kPercent);
  plan->duplicate_percent = root.NumberOr(0, "duplicate_percent", kPercent);
  plan->loops_back = root.FlagOr(false, "loopback");
}

void ReadFaultsOfRuns(const Section& root, CampaignPlan* plan) {
  plan->crashes = root.UintOr(0, "crashes", kProcessFaults);
  plan->pauses = root.UintOr(0, "pauses", kProcessFaults);
  plan->restarts = root.UintOr(0, "restarts", kProcessFaults);
  plan->skip_unsupported = root.FlagOr(false, "skip_unsupported");
  if (!root.Has("faults")) {
    if (plan->skip_unsupported) {
      root.AddError("skip_unsupported", "stands without faults", "remove it, or write faults:");
    }
    return;
  }
  plan->fault_file = ReadFileName(root, "faults", "write such as calm, or a path");
}

}  // namespace

CampaignPlan ReadCampaign(const Section& root, std::span<const std::string_view> generators) {
  CampaignPlan plan;
  plan.name = ReadCampaignName(root);
  ReadSubjects(root, generators, &plan);
  ReadSeeds(root, &plan);
  if (const auto vehicles = ReadRange(root, "vehicles", kFleetSize)) {
    plan.vehicles = WholesOfRange(*vehicles);
  } else if (!root.Has("scenario")) {
    plan.vehicles = kUsualFleet;
  }
  ReadRadio(root, &plan);
  ReadFaultsOfRuns(root, &plan);
  plan.shards = root.UintOr(1, "shards", kShards);
  return plan;
}

}  // namespace giveway
