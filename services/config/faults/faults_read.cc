#include "services/config/faults/faults_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "services/config/vehicle_read.h"
#include "services/faults/expand.h"
#include "services/faults/kind_table.h"
#include "services/types/fleet_limits.h"

namespace giveway {
namespace {

using faults::KindRow;
using faults::Parameters;
using faults::Target;
using faults::Targets;

constexpr int kMaxRandomRules = 1024;
constexpr Allowed kTime{0, faults::kLongestRun_s, "s"};
constexpr Allowed kLasting{0.001, faults::kLongestRun_s, "s"};
constexpr Allowed kMeanBetween{faults::kLeastMean_s, faults::kLongestRun_s, "s"};
constexpr int kMaxAtRules = static_cast<int>(faults::kMostFaults);
constexpr Allowed kTimes{1, static_cast<double>(faults::kMostFaults)};
constexpr std::size_t kLongestName = 64;

std::string ReadRuleName(const Section& section) {
  if (!section.Has("name")) {
    section.AddMissingError("name", "write name: \"...\"");
    return "";
  }
  const std::string name = section.Text("name");
  const bool clean = std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  if (!clean || name.empty() || name.size() > kLongestName) {
    section.AddError("name", "must be 1 to 64 of the characters a-z 0-9 _ -",
                     "choose another name");
  }
  return name;
}

// Nothing where it is missing or unknown, which is a problem then.
const KindRow* ReadKindRow(const Section& section) {
  if (!section.Has("kind")) {
    section.AddMissingError("kind", "write kind: with a word that `fleetctl faults list` shows");
    return nullptr;
  }
  const std::string word = section.Text("kind");
  if (const auto kind = faults::KindOf(word)) return &faults::RowOf(*kind);
  section.AddError("kind", "is no kind of fault",
                   fmt::format("write {}, or another that `fleetctl faults list` shows",
                               faults::NearestKind(word)));
  return nullptr;
}

// The names of what a kind takes: "probability, count", "nothing".
std::string TakenBy(const KindRow& row) {
  std::string names;
  const auto add = [&](std::string_view name) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
  };
  for (const faults::QuantityRow& taken : row.numbers) add(faults::FieldOf(taken.quantity));
  if (row.takes_from) add("from");
  if (!row.usual_qos.empty()) add("qos");
  return names.empty() ? "nothing" : names;
}

void AddNotTakenError(const Section& section, const KindRow& row, std::string_view field) {
  section.AddError(field, fmt::format("{} does not take it", row.word),
                   fmt::format("remove it: {} takes {}", row.word, TakenBy(row)));
}

void ReadQuantity(const Section& section, const KindRow& row, faults::Quantity quantity,
                  Parameters* parameters) {
  const std::string_view field = faults::FieldOf(quantity);
  if (!section.Has(field)) return;
  const faults::QuantityRow* taken = faults::RowOf(row.kind, quantity);
  if (taken == nullptr) return AddNotTakenError(section, row, field);
  const double value = section.Number(field, {taken->low, taken->high, faults::UnitOf(quantity)});
  if (!std::isnan(value)) faults::Set(parameters, quantity, value);
}

// Shown on terminals and given to processes as a flag.
std::string ReadQosName(const Section& section) {
  std::string name = section.Text("qos");
  const bool clean = std::ranges::none_of(
      name, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
  if (!clean || name.empty() || name.front() == '-') {
    section.AddError("qos", "is no name of a profile set or file",
                     "write such as lossy_radio, or a path");
  }
  return name;
}

Parameters ReadParameters(const Section& section, const KindRow& row) {
  Parameters parameters;
  for (std::size_t i = 0; i < faults::kQuantities; ++i) {
    ReadQuantity(section, row, static_cast<faults::Quantity>(i), &parameters);
  }
  if (section.Has("from")) {
    if (!row.takes_from) AddNotTakenError(section, row, "from");
    parameters.from = VehicleId{section.Uint("from", kId)};
  }
  if (section.Has("qos")) {
    if (row.usual_qos.empty()) AddNotTakenError(section, row, "qos");
    parameters.qos = ReadQosName(section);
  }
  return parameters;
}

void AddTimeError(const Section& section, const KindRow& row) {
  if (row.takes_time && !section.Has("for_s")) {
    section.AddMissingError("for_s", fmt::format("write for_s: with how long {} lasts", row.word));
  }
  if (!row.takes_time && section.Has("for_s")) {
    section.AddError("for_s", fmt::format("{} takes no time", row.word), "remove it");
  }
}

// A word of `words`, and one the kind allows; nothing otherwise, which is a problem then.
template <typename What, std::size_t N>
std::optional<What> ReadTargetWord(const Section& section,
                                   const std::array<std::pair<std::string_view, What>, N>& words) {
  const std::string word = section.Text("target");
  std::string names;
  for (const auto& [name, what] : words) {
    if (name == word) return what;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
  }
  section.AddError("target", "is none of its words", "write one of " + names);
  return std::nullopt;
}

void CheckAllowed(const Section& section, const KindRow* row, const char* field,
                  Target::What what) {
  if (row == nullptr || row->Allows(what)) return;
  section.AddError(field, fmt::format("{} cannot meet {}", row->word, faults::ToString(what)),
                   fmt::format("name {}", faults::TargetsOf(*row)));
}

Target ReadTarget(const Section& section, const KindRow* row) {
  constexpr std::array<std::pair<std::string_view, Target::What>, 3> kWords = {{
      {"world", Target::What::kWorld},
      {"discovery_server", Target::What::kDiscoveryServer},
      {"all", Target::What::kAll},
  }};
  if (section.Has("vehicle") == section.Has("target")) {
    section.AddError(
        section.Has("target") ? "target" : "",
        section.Has("target") ? "is given together with vehicle" : "has no target",
        section.Has("target") ? "remove one of the two" : "write vehicle: with an id, or target:");
    return {};
  }
  if (section.Has("vehicle")) {
    CheckAllowed(section, row, "vehicle", Target::What::kVehicle);
    return {Target::What::kVehicle, VehicleId{section.Uint("vehicle", kId)}};
  }
  const auto what = ReadTargetWord(section, kWords);
  if (!what) return {};
  CheckAllowed(section, row, "target", *what);
  return {*what};
}

std::vector<VehicleId> ReadNamed(const Section& section) {
  std::set<VehicleId> ids;
  for (const double number : section.Numbers("vehicle", kId, kMaxVehicles)) {
    if (!std::isnan(number)) ids.insert(VehicleId{static_cast<std::uint32_t>(number)});
  }
  return {ids.begin(), ids.end()};
}

Target::What OneOf(Targets::What what) {
  switch (what) {
    case Targets::What::kWorld:
      return Target::What::kWorld;
    case Targets::What::kDiscoveryServer:
      return Target::What::kDiscoveryServer;
    case Targets::What::kAll:
      return Target::What::kAll;
    default:
      return Target::What::kVehicle;
  }
}

Targets ReadTargets(const Section& section, const KindRow* row) {
  constexpr std::array<std::pair<std::string_view, Targets::What>, 5> kWords = {{
      {"any_vehicle", Targets::What::kAnyVehicle},
      {"every_vehicle", Targets::What::kEveryVehicle},
      {"world", Targets::What::kWorld},
      {"discovery_server", Targets::What::kDiscoveryServer},
      {"all", Targets::What::kAll},
  }};
  if (section.Has("vehicle")) {
    if (section.Has("target")) {
      section.AddError("target", "is given together with vehicle", "remove one of the two");
    }
    CheckAllowed(section, row, "vehicle", Target::What::kVehicle);
    return {Targets::What::kNamed, ReadNamed(section)};
  }
  Targets targets;
  if (section.Has("target")) {
    const auto what = ReadTargetWord(section, kWords);
    if (!what) return targets;
    targets.what = *what;
  }
  CheckAllowed(section, row, section.Has("target") ? "target" : "", OneOf(targets.what));
  return targets;
}

faults::AtRule ReadAt(const Section& section) {
  faults::AtRule rule;
  rule.line = section.Line();
  rule.name = ReadRuleName(section);
  rule.nth = section.UintOr(0, "nth", kWholeNumber);
  rule.time_s = section.Number("time_s", kTime);
  const KindRow* row = ReadKindRow(section);
  rule.target = ReadTarget(section, row);
  if (section.Has("for_s")) rule.for_s = section.Number("for_s", kLasting);
  if (row == nullptr) return rule;
  AddTimeError(section, *row);
  rule.kind = row->kind;
  rule.parameters = ReadParameters(section, *row);
  return rule;
}

void ReadLasting(const Section& section, faults::RandomRule* rule) {
  if (!section.Has("for_s")) return;
  const std::vector<double> span = section.Numbers("for_s", kLasting, 2);
  if (span.empty()) return;
  rule->for_low_s = span.front();
  rule->for_high_s = span.back();
  if (rule->for_low_s > rule->for_high_s) {
    section.AddError("for_s", "the lowest is above the highest", "write [lowest, highest]");
  }
}

faults::RandomRule ReadRandom(const Section& section) {
  faults::RandomRule rule;
  rule.line = section.Line();
  rule.name = ReadRuleName(section);
  rule.mean_between_s = section.Number("mean_between_s", kMeanBetween);
  const KindRow* row = ReadKindRow(section);
  rule.targets = ReadTargets(section, row);
  ReadLasting(section, &rule);
  if (section.Has("at_most")) rule.at_most = section.Uint("at_most", kTimes);
  if (row == nullptr) return rule;
  AddTimeError(section, *row);
  rule.kind = row->kind;
  rule.parameters = ReadParameters(section, *row);
  return rule;
}

// The sections of a repeated field, or none where there are too many to look at.
std::vector<Section> RulesOf(const Section& root, const char* field, int most) {
  const int count = root.Count(field);
  if (count <= most) return root.Children(field);
  root.AddError(field, fmt::format("is one of {}; at most {} are allowed", count, most),
                "leave some out", most);
  return {};
}

// Refuses names that stand twice. A name that is bad already is not counted.
class UsedNames {
 public:
  void Take(const Section& section, const std::string& name, std::optional<std::uint32_t> nth) {
    if (name.empty()) return;
    const auto [known, is_new] = lines_.try_emplace({name, nth}, section.Line());
    const auto other = nth ? lines_.find({name, std::nullopt}) : FirstOf(name, known);
    const bool twice = !is_new || (other != lines_.end() && other != known);
    if (!twice) return;
    section.AddError("name", fmt::format("stands in line {} too", (is_new ? other : known)->second),
                     nth ? "give each its own name, or another nth" : "give each its own name");
  }

 private:
  using Lines = std::map<std::pair<std::string, std::optional<std::uint32_t>>, int>;

  // Any entry of `name` but `own`.
  Lines::iterator FirstOf(const std::string& name, Lines::iterator own) {
    const auto next = std::next(own);
    return next != lines_.end() && next->first.first == name ? next : lines_.end();
  }

  Lines lines_;  // no nth: of a random rule
};

}  // namespace

faults::FaultFile ReadFaultFile(const Section& root) {
  faults::FaultFile file;
  file.description = root.Text("description");
  UsedNames names;
  for (const Section& section : RulesOf(root, "at", kMaxAtRules)) {
    file.at.push_back(ReadAt(section));
    names.Take(section, file.at.back().name, file.at.back().nth);
  }
  for (const Section& section : RulesOf(root, "random", kMaxRandomRules)) {
    file.random.push_back(ReadRandom(section));
    names.Take(section, file.random.back().name, std::nullopt);
  }
  return file;
}

}  // namespace giveway
