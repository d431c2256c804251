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
constexpr Allowed kFleetSize{2, 1000};
constexpr Allowed kLoss{0, 99, "%"};
constexpr Allowed kPercent{0, 100, "%"};
constexpr Allowed kMilliseconds{0, 1000, "ms"};
constexpr Allowed kProcessFaults{0, 1000};
constexpr Allowed kShards{1, 100000};

std::string ReadCampaignName(const Section& root) {
  if (!root.Has("name")) {
    root.ComplainMissing("name", "write name: \"...\"");
    return "";
  }
  const std::string name = root.Text("name");
  const bool clean = std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  if (!clean || name.empty() || name.size() > kLongestCampaignName || name.front() == '-') {
    root.Complain("name", "must be 1 to 64 of the characters a-z 0-9 _ -, none a - at its begin",
                  "write such as nightly_1");
  }
  return name;
}

std::vector<std::string> ReadGenerators(const Section& root,
                                        std::span<const std::string_view> known) {
  std::vector<std::string> names = root.Texts("generator");
  if (names.empty()) root.ComplainMissing("generator", "write generator: \"crossing\"");
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int index = static_cast<int>(i);
    if (std::ranges::find(known, names[i]) == known.end()) {
      root.Complain("generator", "is no generator",
                    fmt::format("write one of {}", fmt::join(known, ", ")), index);
    } else if (std::find(names.begin(), names.begin() + index, names[i]) != names.begin() + index) {
      root.Complain("generator", "stands there already", "name each once", index);
    }
  }
  return names;
}

// [lowest, highest] or one number; nothing where there is none, or none that can be used.
std::optional<CampaignNumbers> ReadRange(const Section& root, const char* field,
                                         const Allowed& allowed) {
  const std::vector<double> ends = root.Numbers(field, allowed, 2);
  if (ends.empty() || std::ranges::any_of(ends, [](double end) { return std::isnan(end); })) {
    return std::nullopt;
  }
  if (ends.front() > ends.back()) {
    root.Complain(field, "the lowest is above the highest", "write [lowest, highest]");
    return std::nullopt;
  }
  return CampaignNumbers{ends.front(), ends.back()};
}

CampaignWholes WholesOfRange(const CampaignNumbers& range) {
  return {static_cast<std::uint32_t>(range.low), static_cast<std::uint32_t>(range.high)};
}

void ReadSeeds(const Section& root, CampaignPlan* plan) {
  if (!root.Has("seeds")) root.ComplainMissing("seeds", "write seeds: [1, 1000]");
  const auto seeds = ReadRange(root, "seeds", kWholeNumber);
  if (!seeds) return;
  plan->seeds = WholesOfRange(*seeds);
  const std::uint64_t runs =
      (std::uint64_t{plan->seeds.high} - plan->seeds.low + 1) * plan->generators.size();
  if (runs > kMostRuns) {
    root.Complain(
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
  plan->crashes = root.WholeOr(0, "crashes", kProcessFaults);
  plan->pauses = root.WholeOr(0, "pauses", kProcessFaults);
  plan->restarts = root.WholeOr(0, "restarts", kProcessFaults);
  plan->skip_unsupported = root.FlagOr(false, "skip_unsupported");
  if (!root.Has("faults")) {
    if (plan->skip_unsupported) {
      root.Complain("skip_unsupported", "stands without faults", "remove it, or write faults:");
    }
    return;
  }
  plan->fault_file = root.Text("faults");
  // It becomes an argument of a command that is printed on one line.
  const bool clean =
      std::ranges::none_of(plan->fault_file, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  if (!clean || plan->fault_file.empty() || plan->fault_file.front() == '-') {
    root.Complain("faults", "is no name of a fault file", "write such as calm, or a path");
    plan->fault_file.clear();
  }
}

}  // namespace

CampaignPlan ReadCampaign(const Section& root, std::span<const std::string_view> generators) {
  CampaignPlan plan;
  plan.name = ReadCampaignName(root);
  plan.generators = ReadGenerators(root, generators);
  ReadSeeds(root, &plan);
  if (const auto vehicles = ReadRange(root, "vehicles", kFleetSize)) {
    plan.vehicles = WholesOfRange(*vehicles);
  }
  ReadRadio(root, &plan);
  ReadFaultsOfRuns(root, &plan);
  plan.shards = root.WholeOr(1, "shards", kShards);
  return plan;
}

}  // namespace giveway
