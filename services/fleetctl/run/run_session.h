// One run from the first process to the last: supervises the fleet, carries out planned faults,
// ends the run when it is over, when a process dies or on the operator's request, and reports.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/output/live_screen.h"
#include "services/fleetctl/process/fleet_processes.h"
#include "services/fleetctl/process/fleet_restarts.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/run/fleet_watch.h"
#include "services/fleetctl/run/invariant_watch.h"
#include "services/fleetctl/run/run_options.h"
#include "services/fleetctl/run/topic_recorder.h"
#include "services/link/observer_link.h"
#include "services/observer/capture/run_frames.h"
#include "services/observer/fleet/fleet_view.h"
#include "services/report/report.h"
#include "services/types/scenario.h"

namespace giveway::fleetctl {

class RunSession {
 public:
  // Starts everything. `scenario` outlives the session. Throws LinkError, StartError.
  RunSession(const RunOptions& options, const Scenario& scenario, const FleetSpec& spec);

  // Returns when the last process is gone.
  Report Run();
  std::string DrawPicture(const Report& report) const { return watch_.DrawPicture(report); }
  // With the observations of the run embedded, see RunOptions::html_file.
  std::string DrawPage() const;
  // Ends the recording of samples, if there is one. False if it is incomplete.
  bool FinishTopics(const std::vector<std::string>& attachments);

 private:
  // Waits for the run's end. A value if the verdict is not the world's.
  std::optional<Overruled> Supervise();
  // Restarts processes that died, if the operator asked for it. One that cannot be started does not
  // end the others: it is started again later.
  void BringBack();
  // A process ended unexpectedly, unless the event of the run's end is still in transit.
  std::optional<Overruled> JudgeEnd(const MemberEnd& gone);
  std::optional<MemberEnd> FirstEarlyEnd() const;
  std::optional<MemberEnd> FirstBadEnd() const;
  // Takes the samples still in transit after the last process is gone.
  void DrainLast();
  // Exit statuses show what the world cannot know.
  std::optional<Overruled> JudgeExits();
  // Takes the samples that have arrived.
  void Drain();
  // One cycle of the loop: sleep, drain, carry out faults, poll, show.
  void Turn();
  // Reports errors that a child survives, such as a full disk: the operator would not see them
  // otherwise.
  void ShowErrors();
  void ShowTrouble(const MemberEnd& gone, const std::string& what);

  const Scenario& scenario_;
  bool open_;
  bool restarts_;
  std::uint32_t domain_;
  Nanoseconds time_limit_;
  Interrupts interrupts_;
  FleetWatch watch_;
  InvariantWatch invariants_;
  const bool has_page_;
  FleetView view_;  // kept only for the page, like the frames
  RunFrames frames_;
  link::ObserverLink observer_;
  std::optional<TopicRecorder> topics_;
  FleetProcesses processes_;
  FleetRestarts comebacks_;
  LiveScreen screen_;
  bool stopping_ = false;
  std::size_t errors_shown_ = 0;
  std::map<MemberId, unsigned> brought_back_;
};

}  // namespace giveway::fleetctl
