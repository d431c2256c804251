#include "services/fleetctl/replayer.h"

#include <fmt/format.h>

#include "services/app/recording_file.h"

namespace giveway::fleetctl {
namespace {

std::optional<app::FieldDifference> Compare(const app::RecordedStep& recorded,
                                            const Outputs& replayed, std::uint64_t hash) {
  if (auto difference = app::FirstDifference(recorded.outputs, replayed)) return difference;
  if (recorded.hash == hash) return std::nullopt;
  return app::FieldDifference{"hash", fmt::format("{:016x}", recorded.hash),
                              fmt::format("{:016x}", hash)};
}

}  // namespace

app::ReplayedFile Replay(std::istream* recording, const ReplayWatcher& watch) {
  app::RecordingFile file(recording);
  app::ReplayedFile outcome;
  outcome.finding = file.Complaint();
  if (!file.Life()) return outcome;
  outcome.vehicle = file.Life()->options.id;
  Vehicle brain(file.Life()->options, file.Life()->boot_epoch);
  while (const std::optional<app::Record> record = file.Next()) {
    if (const auto* reseat = std::get_if<app::RecordedReseat>(&*record)) {
      brain.Reseat(reseat->options);
      continue;
    }
    const auto& step = std::get<app::RecordedStep>(*record);
    const Outputs replayed = brain.Step(step.AsInputs());
    if (watch) watch(step, brain, replayed);
    if (auto difference = Compare(step, replayed, brain.Hash())) {
      outcome.difference = {outcome.steps + 1, brain.State().tick, std::move(*difference)};
      return outcome;
    }
    ++outcome.steps;
  }
  outcome.finding = file.Complaint();
  outcome.complete = file.End().has_value();
  outcome.lost = file.End() ? file.End()->lost : 0;
  if (outcome.steps == 0 && outcome.finding.empty()) {
    outcome.finding = "holds no step: nothing was compared";
  } else if (file.End() && file.End()->steps != outcome.steps) {
    outcome.finding = fmt::format("says it holds {} steps", file.End()->steps);
  }
  return outcome;
}

}  // namespace giveway::fleetctl
