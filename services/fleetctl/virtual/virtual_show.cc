#include "services/fleetctl/virtual/virtual_show.h"

#include <fmt/format.h>

#include <functional>
#include <optional>

#include "services/fleetctl/output/decision_trace.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/virtual/virtual_mcap.h"
#include "sim_world/virtual/virtual_run.h"

namespace giveway::fleetctl {
namespace {

void Trace(const sim::VirtualFleet& fleet, std::string* text) {
  std::size_t index = 0;
  for (const Truth& truth : fleet.World().Truths()) {
    AppendLine({.tick = truth.tick,
                .time_s = truth.time_s,
                .vehicle = truth.vehicle,
                .world_from_body = truth.world_from_body,
                .forward_m_s = truth.forward_m_s,
                .arrived = truth.arrived},
               fleet.OutputsOf(index++), text);
  }
}

// Of the picture alone: it grows with the run.
void AppendDrawn(const sim::VirtualFleet& fleet, std::vector<Track>* tracks,
                 std::vector<WorldEvent>* events) {
  tracks->resize(fleet.Size());
  std::size_t index = 0;
  for (const Truth& truth : fleet.World().Truths()) {
    (*tracks)[index].vehicle = truth.vehicle;
    (*tracks)[index++].truths.push_back(truth);
  }
  events->insert(events->end(), fleet.World().Events().begin(), fleet.World().Events().end());
}

// Violations as text after the trace, so that one file has everything.
void AppendVerdict(const sim::VirtualOutcome& outcome, std::string* text) {
  for (const sim::Violation& violation : outcome.first) {
    *text +=
        fmt::format("# {} tick {} vehicle {} other {}\n", sim::Name(violation.invariant),
                    Number(violation.tick), Number(violation.vehicle), Number(violation.other));
  }
}

// One file that cannot be written keeps no other from being written.
class EachFile {
 public:
  void Write(const std::function<void()>& write) {
    try {
      write();
    } catch (const OutputError& error) {
      complaints_ += (complaints_.empty() ? "" : "\n") + std::string(error.what());
    }
  }
  void ThrowIfAnyFailed() const {
    if (!complaints_.empty()) throw OutputError(complaints_);
  }

 private:
  std::string complaints_;
};

}  // namespace

void ShowRun(const VirtualCase& made, const ShownFiles& files, const Headline& headline) {
  std::optional<VirtualRecording> recording;
  EachFile each;
  if (!files.mcap.empty()) each.Write([&] { recording.emplace(files.mcap); });
  const bool is_drawn = !files.picture.empty();
  std::vector<Track> tracks;
  std::vector<WorldEvent> events;
  std::string trace(kTraceHead);
  const sim::VirtualOutcome outcome =
      sim::RunVirtually(made.scenario, made.plan, [&](const sim::VirtualFleet& fleet) {
        if (Interrupts::Count() > 0) throw OutputError("interrupted before the run was drawn");
        if (is_drawn) AppendDrawn(fleet, &tracks, &events);
        if (!files.trace.empty()) Trace(fleet, &trace);
        if (recording) recording->Note(fleet);
      });
  AppendVerdict(outcome, &trace);
  if (!files.trace.empty()) each.Write([&] { WriteFile(files.trace, trace); });
  if (recording) each.Write([&] { recording->Close(); });
  if (is_drawn) {
    each.Write([&] { WriteFile(files.picture, DrawRun(made.scenario, tracks, events, headline)); });
  }
  each.ThrowIfAnyFailed();
}

}  // namespace giveway::fleetctl
