#include "services/config/impair.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "services/config/problem.h"
#include "services/config/text_file.h"
#include "services/config/vehicle_read.h"

namespace giveway {

namespace {

constexpr Allowed kProbability{0, 1};
constexpr Allowed kDelay{0, 10000, "ms"};

constexpr std::array kFields = {
    ImpairField{"loss", "loss", &ImpairmentRule::loss, kProbability},
    ImpairField{"burst", "burst", &ImpairmentRule::burst, {0, 0.9}},
    ImpairField{
        "burst_length", "burst_length", &ImpairmentRule::burst_length, {1, 10000, "packets"}},
    ImpairField{"burst_loss", "burst_loss", &ImpairmentRule::burst_loss, kProbability},
    ImpairField{"delay_ms", "delay", &ImpairmentRule::delay_s, kDelay, 1000, true},
    ImpairField{"jitter_ms", "jitter", &ImpairmentRule::jitter_s, kDelay, 1000, true},
    ImpairField{"reorder", "reorder", &ImpairmentRule::reorder, kProbability},
    ImpairField{"reorder_by_ms",
                "reorder_by",
                &ImpairmentRule::reorder_by_s,
                {0, 10000, "ms", true},
                1000,
                true},
    ImpairField{"duplicate", "duplicate", &ImpairmentRule::duplicate, kProbability},
    ImpairField{"corrupt", "corrupt", &ImpairmentRule::corrupt, kProbability},
    ImpairField{"rate_bytes_s", "rate", &ImpairmentRule::rate_bytes_s, {0, 1e9, "bytes/s"}},
    ImpairField{
        "rate_burst_bytes", "rate_burst", &ImpairmentRule::rate_burst_bytes, {1, 1e9, "bytes"}},
};

}  // namespace

std::span<const ImpairField> ImpairFields() { return kFields; }

std::vector<RuleConflict> ConflictsIn(const ImpairmentRule& rule) {
  std::vector<RuleConflict> conflicts;
  if (rule.jitter_s > rule.delay_s) {
    conflicts.push_back({"jitter_ms",
                         fmt::format("a jitter of {} ms is more than the delay of {} ms: packets "
                                     "would come before they are sent",
                                     rule.jitter_s * 1000, rule.delay_s * 1000),
                         "raise the delay or lessen the jitter"});
  }
  if (rule.burst > (1 - rule.burst) * rule.burst_length) {
    conflicts.push_back(
        {"burst",
         fmt::format("with bad times of {} packets at most {:.3g} can be bad", rule.burst_length,
                     rule.burst_length / (1 + rule.burst_length)),
         "lower burst or raise burst_length"});
  }
  return conflicts;
}

namespace {

// kNoVehicle where absent.
VehicleId ReadVehicleId(const Section& section, const char* field, const KnownIds& known) {
  if (!section.Has(field)) return kNoVehicle;
  const VehicleId id{section.Uint(field, kId)};
  if (id != kNoVehicle && !known.vehicles.contains(id) && !known.joining.contains(id)) {
    section.AddError(field, "no vehicle has this id", "name the id of a vehicle of this file");
  }
  return id;
}

ImpairedSender ReadFrom(const Section& section) {
  constexpr std::array kAsNumberedInTheSchema = {ImpairedSender::kAnyone, ImpairedSender::kVehicles,
                                                 ImpairedSender::kWorld};
  if (section.Has("from_vehicle")) {
    if (section.Has("from")) {
      section.AddError("from", "is given together with from_vehicle", "remove one of the two");
    }
    return ImpairedSender::kOneVehicle;
  }
  const int from = section.Enum("from").value_or(0);
  return kAsNumberedInTheSchema[static_cast<std::size_t>(from)];
}

Blackout ReadBlackout(const Section& section) {
  const Blackout blackout{section.Number("from_s", kBlackoutTime),
                          section.Number("to_s", kBlackoutTime)};
  if (blackout.from_s >= blackout.to_s) {
    section.AddError("to_s", "the blackout ends before it starts", "write to_s above from_s");
  }
  return blackout;
}

}  // namespace

namespace {

void ReadDuring(const Section& section, ImpairmentRule* rule) {
  if (section.Has("from_s")) rule->from_s = section.Number("from_s", kBlackoutTime);
  if (section.Has("to_s")) rule->to_s = section.Number("to_s", kBlackoutTime);
  if (rule->to_s && rule->from_s.value_or(0) >= *rule->to_s) {
    section.AddError("to_s", "the rule ends before it starts", "write to_s above from_s");
  }
}

}  // namespace

ImpairmentRule ReadImpairmentRule(const Section& section, const KnownIds& known) {
  ImpairmentRule rule;
  rule.from = ReadFrom(section);
  rule.from_vehicle = ReadVehicleId(section, "from_vehicle", known);
  rule.to_vehicle = ReadVehicleId(section, "to_vehicle", known);
  for (const ImpairField& field : ImpairFields()) {
    double& value = rule.*field.member;
    value = section.NumberOr(value * field.per_si, field.field, field.allowed) / field.per_si;
  }
  for (const RuleConflict& conflict : ConflictsIn(rule)) {
    section.AddError(conflict.field, conflict.message, conflict.remedy);
  }
  ReadDuring(section, &rule);
  if (section.Count("blackout") > kMaxBlackouts) {
    section.AddError("blackout", "is one too many: at most 1024 are allowed", "leave some out",
                     kMaxBlackouts);
    return rule;
  }
  for (const Section& blackout : section.Children("blackout")) {
    rule.blackouts.push_back(ReadBlackout(blackout));
  }
  return rule;
}

namespace {

template <typename T>
std::optional<T> NumberOf(std::string_view text) {
  T value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

std::optional<double> ParseNumber(std::string_view text) {
  const auto value = NumberOf<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

// "0.1", or "10%" of a share.
std::optional<double> ParseShare(std::string_view text) {
  if (!text.ends_with('%')) return ParseNumber(text);
  text.remove_suffix(1);
  const auto percent = ParseNumber(text);
  return percent ? std::optional(*percent / 100) : std::nullopt;
}

// "20ms" in seconds.
std::optional<double> ParseTime_s(std::string_view text) {
  struct Unit {
    std::string_view name;
    double per_second;
  };
  for (const Unit unit : {Unit{"us", 1e6}, Unit{"ms", 1e3}, Unit{"s", 1}}) {
    if (!text.ends_with(unit.name)) continue;
    text.remove_suffix(unit.name.size());
    const auto number = ParseNumber(text);
    return number ? std::optional(*number / unit.per_second) : std::nullopt;
  }
  return std::nullopt;
}

std::optional<double> ParseOf(const ImpairField& field, std::string_view text) {
  if (field.is_time) return ParseTime_s(text);
  return field.IsShare() ? ParseShare(text) : ParseNumber(text);
}

std::vector<std::string_view> Split(std::string_view text, char by) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t at = text.find(by);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

std::string KnownKeys() {
  std::string keys = "from, to, blackout, during, seed";
  for (const ImpairField& field : ImpairFields()) keys += fmt::format(", {}", field.key);
  return keys;
}

// Parses one text; every problem is noted and parsing continues.
class Parser {
 public:
  explicit Parser(int most_rules) : most_rules_(most_rules) {}

  ParsedImpairment Parse(std::string_view text) {
    if (text == "none") return {};
    const auto rules = Split(text, ';');
    if (std::ssize(rules) > most_rules_) {
      AddError("", "", fmt::format("{} rules; at most {} are allowed", rules.size(), most_rules_),
               "leave some out");
      return parsed_;
    }
    for (const std::string_view rule : rules) ParseRule(rule);
    return parsed_;
  }

 private:
  void AddError(std::string_view key, std::string_view value, const std::string& message,
                std::string remedy) {
    const std::string what = key.empty() ? "" : fmt::format("{} = {}: ", key, value);
    parsed_.problems.push_back({what + message, std::move(remedy)});
  }

  void ParseRule(std::string_view text) {
    rule_ = {};
    given_.clear();
    for (const std::string_view item : Split(text, ',')) ParseItem(item);
    for (const RuleConflict& conflict : ConflictsIn(rule_)) {
      AddError("", "", conflict.message, conflict.remedy);
    }
    parsed_.impairment.rules.push_back(rule_);
  }

  void ParseItem(std::string_view item) {
    const std::size_t equals = item.find('=');
    if (equals == std::string_view::npos) {
      return AddError("", "", fmt::format("\"{}\" is no key=value", item),
                      "write such as loss=0.1,delay=20ms, or none");
    }
    const std::string_view key = item.substr(0, equals);
    const std::string_view value = item.substr(equals + 1);
    if (key != "blackout" && !given_.insert(key).second) {
      return AddError(key, value, "is given twice", "write it once a rule");
    }
    if (key == "seed") return ParseSeed(value);
    if (key == "from") return ParseFrom(value);
    if (key == "to") return ParseTo(value);
    if (key == "blackout") return ParseBlackout(value);
    if (key == "during") return ParseDuring(value);
    const auto fields = ImpairFields();
    const auto field = std::ranges::find(fields, key, &ImpairField::key);
    if (field == fields.end()) {
      return AddError(key, value, "is no part of an impairment", "write one of " + KnownKeys());
    }
    ParseField(*field, value);
  }

  void ParseSeed(std::string_view value) {
    const auto seed = NumberOf<std::uint32_t>(value);
    if (!seed) {
      return AddError("seed", value, "must be a whole number between 0 and 4294967295",
                      "write one in that range");
    }
    if (parsed_.impairment.seed) {
      return AddError("seed", value, "is the second seed", "write one for all rules");
    }
    parsed_.impairment.seed = seed;
  }

  static VehicleId ParseId(std::string_view value) {
    return VehicleId{NumberOf<std::uint32_t>(value).value_or(0)};
  }

  void ParseFrom(std::string_view value) {
    if (value == "anyone") return;
    if (value == "vehicles" || value == "world") {
      rule_.from = value == "world" ? ImpairedSender::kWorld : ImpairedSender::kVehicles;
      return;
    }
    rule_.from = ImpairedSender::kOneVehicle;
    rule_.from_vehicle = ParseId(value);
    if (rule_.from_vehicle == kNoVehicle) {
      AddError("from", value, "names no sender", "write anyone, vehicles, world or a vehicle's id");
    }
  }

  void ParseTo(std::string_view value) {
    rule_.to_vehicle = ParseId(value);
    if (rule_.to_vehicle == kNoVehicle) {
      AddError("to", value, "names no vehicle", "write a vehicle's id, or leave it out");
    }
  }

  void ParseBlackout(std::string_view value) {
    const std::size_t dots = value.find("..");
    const auto from_s = ParseTime_s(value.substr(0, dots));
    const auto to_s =
        dots == std::string_view::npos ? std::nullopt : ParseTime_s(value.substr(dots + 2));
    if (!from_s || !to_s) {
      return AddError("blackout", value, "is no span of time", "write such as blackout=5s..7s");
    }
    if (!kBlackoutTime.Contains(*from_s) || !kBlackoutTime.Contains(*to_s) || *from_s >= *to_s) {
      return AddError("blackout", value,
                      "must start before it ends, both " + Describe(kBlackoutTime),
                      "write seconds since the start signal, such as 5s..7s");
    }
    if (std::ssize(rule_.blackouts) >= kMaxBlackouts) {
      return AddError("blackout", value, fmt::format("at most {} are allowed", kMaxBlackouts),
                      "leave some out");
    }
    rule_.blackouts.push_back({*from_s, *to_s});
  }

  // One end may be left open.
  void ParseDuring(std::string_view value) {
    const std::size_t dots = value.find("..");
    const std::string_view from = value.substr(0, dots);
    const std::string_view to = dots == std::string_view::npos ? "" : value.substr(dots + 2);
    rule_.from_s = ParseTime_s(from);
    rule_.to_s = ParseTime_s(to);
    const bool is_span = dots != std::string_view::npos && !(from.empty() && to.empty()) &&
                         (rule_.from_s || from.empty()) && (rule_.to_s || to.empty());
    if (!is_span) {
      return AddError("during", value, "is no span of time",
                      "write such as during=60s..80s or during=60s..");
    }
    const double from_s = rule_.from_s.value_or(0);
    if (!kBlackoutTime.Contains(from_s) || (rule_.to_s && !kBlackoutTime.Contains(*rule_.to_s)) ||
        (rule_.to_s && from_s >= *rule_.to_s)) {
      AddError("during", value, "must start before it ends, both " + Describe(kBlackoutTime),
               "write seconds since the start signal, such as 60s..80s");
    }
  }

  void ParseField(const ImpairField& field, std::string_view value) {
    const auto si = ParseOf(field, value);
    if (si && field.allowed.Contains(*si * field.per_si)) {
      rule_.*field.member = *si;
      return;
    }
    const std::string kind = field.is_time ? "must be a time with its unit, " : "must be a number ";
    const std::string remedy = field.is_time     ? "write such as 20ms or 0.02s"
                               : field.IsShare() ? "write such as 0.1 or 10%"
                                                 : "write one in that range";
    AddError(field.key, value, kind + Describe(field.allowed), remedy);
  }

  const int most_rules_;
  ParsedImpairment parsed_;
  ImpairmentRule rule_;
  std::set<std::string_view> given_;  // keys of the rule
};

}  // namespace

namespace {

// The rules of a soak of weeks: 30 MB for 30 days of `radio_storm` with 8 vehicles.
constexpr std::uintmax_t kMaxRulesBytes = 64U << 20;

ParsedImpairment ParseFile(const std::string& path) {
  try {
    std::string text = ReadTextFile(path, kMaxRulesBytes);
    text.erase(text.find_last_not_of(" \t\r\n") + 1);
    return Parser(kMaxImpairRulesOfFile).Parse(text);
  } catch (const InputError& error) {
    ParsedImpairment parsed;
    for (const Problem& problem : error.Problems()) {
      parsed.problems.push_back({problem.file + ": " + problem.message, problem.remedy});
    }
    return parsed;
  }
}

}  // namespace

ParsedImpairment ParseImpairment(std::string_view text) {
  if (text.starts_with('@')) return ParseFile(std::string(text.substr(1)));
  return Parser(kMaxImpairRules).Parse(text);
}

namespace {

void AppendItem(std::string_view key, const std::string& value, std::string* rule) {
  *rule += fmt::format("{}{}={}", rule->empty() ? "" : ",", key, value);
}

std::string TimeText(const std::optional<double>& time_s) {
  return time_s ? fmt::format("{}s", *time_s) : "";
}

std::string RuleText(const ImpairmentRule& rule) {
  std::string text;
  if (rule.from == ImpairedSender::kOneVehicle) {
    AppendItem("from", std::to_string(Number(rule.from_vehicle)), &text);
  } else if (rule.from != ImpairedSender::kAnyone) {
    AppendItem("from", rule.from == ImpairedSender::kWorld ? "world" : "vehicles", &text);
  }
  if (rule.to_vehicle != kNoVehicle)
    AppendItem("to", std::to_string(Number(rule.to_vehicle)), &text);
  const ImpairmentRule plain;
  for (const ImpairField& field : ImpairFields()) {
    const double value = rule.*field.member;
    if (value == plain.*field.member) continue;
    AppendItem(field.key, fmt::format("{}{}", value, field.is_time ? "s" : ""), &text);
  }
  for (const Blackout& blackout : rule.blackouts) {
    AppendItem("blackout", TimeText(blackout.from_s) + ".." + TimeText(blackout.to_s), &text);
  }
  if (rule.from_s || rule.to_s) {
    AppendItem("during", TimeText(rule.from_s) + ".." + TimeText(rule.to_s), &text);
  }
  return text.empty() ? "from=anyone" : text;
}

}  // namespace

std::string ImpairmentText(const Impairment& impairment) {
  if (impairment.rules.empty()) return "none";
  std::string text;
  for (const ImpairmentRule& rule : impairment.rules) {
    text += (text.empty() ? "" : ";") + RuleText(rule);
  }
  if (impairment.seed) AppendItem("seed", std::to_string(*impairment.seed), &text);
  return text;
}

}  // namespace giveway
