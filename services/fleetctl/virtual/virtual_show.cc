#include "services/fleetctl/virtual/virtual_show.h"

#include <fmt/format.h>

#include <optional>

#include "services/fleetctl/output/decision_trace.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/virtual/virtual_mcap.h"
#include "services/report/picture.h"
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

void AppendTruths(const sim::VirtualFleet& fleet, std::vector<Track>* tracks) {
  tracks->resize(fleet.Size());
  std::size_t index = 0;
  for (const Truth& truth : fleet.World().Truths()) {
    (*tracks)[index].vehicle = truth.vehicle;
    (*tracks)[index++].truths.push_back(truth);
  }
}

// Violations as text after the trace, so that one file has everything.
void AppendVerdict(const sim::VirtualOutcome& outcome, std::string* text) {
  for (const sim::Violation& violation : outcome.first) {
    *text +=
        fmt::format("# {} tick {} vehicle {} other {}\n", sim::Name(violation.invariant),
                    Number(violation.tick), Number(violation.vehicle), Number(violation.other));
  }
}

// The headline of the picture is the verdict of the invariants.
void JudgeByInvariants(const sim::VirtualOutcome& outcome, std::vector<WorldEvent>* events) {
  for (WorldEvent& event : *events) {
    if (event.kind != EventKind::kVerdict) continue;
    event.value = outcome.held ? 1 : 0;
    event.text = outcome.held ? "every invariant held" : "broken:";
    for (std::size_t i = 0; i < sim::kInvariantCount; ++i) {
      if (outcome.violations[i] == 0) continue;
      event.text += fmt::format(" {}", sim::Name(static_cast<sim::Invariant>(i)));
    }
  }
}

}  // namespace

void ShowRun(const VirtualCase& made, const ShownFiles& files) {
  std::optional<VirtualRecording> recording;
  if (!files.mcap.empty()) recording.emplace(files.mcap);
  std::vector<Track> tracks;
  std::vector<WorldEvent> events;
  std::string trace(kTraceHead);
  const sim::VirtualOutcome outcome =
      sim::RunVirtually(made.scenario, made.plan, [&](const sim::VirtualFleet& fleet) {
        AppendTruths(fleet, &tracks);
        events.insert(events.end(), fleet.World().Events().begin(), fleet.World().Events().end());
        if (!files.trace.empty()) Trace(fleet, &trace);
        if (recording) recording->Note(fleet);
      });
  AppendVerdict(outcome, &trace);
  JudgeByInvariants(outcome, &events);
  if (!files.trace.empty()) WriteFile(files.trace, trace);
  if (recording) recording->Close();
  if (!files.picture.empty()) {
    WriteFile(files.picture, DrawRun(made.scenario, tracks, events));
  }
}

}  // namespace giveway::fleetctl
