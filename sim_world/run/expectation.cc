#include "sim_world/run/expectation.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace giveway::sim {
namespace {

std::string Text(const std::vector<VehicleId>& vehicles) {
  if (vehicles.empty()) return "none";
  std::string text;
  for (const VehicleId vehicle : vehicles) {
    if (!text.empty()) text += ' ';
    text += std::to_string(Number(vehicle));
  }
  return text;
}

std::string Text(const std::vector<Rule>& rules) {
  if (rules.empty()) return "nothing";
  std::string text;
  for (const Rule rule : rules) {
    if (!text.empty()) text += ' ';
    text += Name(rule);
  }
  return text;
}

std::string Text(std::optional<double> value) {
  if (!value) return "none";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", *value);
  return text.data();
}

class Mismatches {
 public:
  void Add(const std::string& name, const std::string& expected, const std::string& got) {
    if (!text_.empty()) text_ += "; ";
    text_ += name + ": expected " + expected + ", got " + got;
  }
  const std::string& AsText() const { return text_; }

 private:
  std::string text_;
};

}  // namespace

std::string Unmet(const Expectation& expect, const Outcome& outcome) {
  Mismatches unmet;
  if (outcome.contacts != expect.contacts) {
    unmet.Add("contacts", std::to_string(expect.contacts), std::to_string(outcome.contacts));
  }
  if (!expect.any_halted && outcome.halted != expect.halted) {
    unmet.Add("halted", Text(expect.halted), Text(outcome.halted));
  }
  if (expect.halted_for && !std::ranges::count(outcome.halted_for, *expect.halted_for)) {
    unmet.Add("halted_for", std::string(Name(*expect.halted_for)), Text(outcome.halted_for));
  }
  if (!expect.any_arrived && outcome.arrived != expect.arrived) {
    unmet.Add("arrived", Text(expect.arrived), Text(outcome.arrived));
  }
  if (expect.parted && !outcome.parted) unmet.Add("parted", "true", "false");
  if (expect.min_separation_m &&
      (!outcome.min_separation_m || *outcome.min_separation_m < *expect.min_separation_m)) {
    unmet.Add("min_separation_m", "at least " + Text(expect.min_separation_m),
              Text(outcome.min_separation_m));
  }
  if (expect.time_to_clear_s &&
      (!outcome.time_to_clear_s || *outcome.time_to_clear_s > *expect.time_to_clear_s)) {
    unmet.Add("time_to_clear_s", "at most " + Text(expect.time_to_clear_s),
              Text(outcome.time_to_clear_s));
  }
  return unmet.AsText();
}

}  // namespace giveway::sim
