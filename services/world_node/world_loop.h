// giveway-world's loop: wires Run and Admission to WorldLink, tick by tick on absolute deadlines.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/health/health_service.h"
#include "services/link/world_link.h"
#include "services/node/interface_check.h"
#include "services/node/service_admin.h"
#include "services/runtime/fault_reminder.h"
#include "services/runtime/line_budget.h"
#include "services/runtime/packet_log.h"
#include "services/runtime/process.h"
#include "services/runtime/refusal_log.h"
#include "services/runtime/state_writer.h"
#include "services/types/parallel.h"
#include "sim_world/faults/world_faults.h"
#include "sim_world/run/admission.h"
#include "sim_world/run/reaction.h"
#include "sim_world/run/run.h"

namespace giveway {

struct WorldLoopOptions {
  bool lockstep = false;
  ParallelFor parallel = OnThisThread;
  sim::FaultSchedule schedule;                     // in addition to the scenario's faults
  std::string checkpoint_file;                     // empty: none is kept
  std::uint64_t scenario_mark = 0;                 // see sim::FleetCheckpoint
  std::optional<sim::FleetCheckpoint> checkpoint;  // to resume from
  bool same_epoch = false;        // it restarted itself, and nothing has moved since
  std::function<void()> on_back;  // called once it resumes; may be empty
};

// kInterfaceLost: it ends without a word, and its checkpoint stays: it is to be started again.
enum class WorldEnd : std::uint8_t { kPassed, kFailed, kRestarts, kInterfaceLost };

class WorldLoop {
 public:
  WorldLoop(const Scenario& scenario, link::WorldLink* link, ServiceAdmin* admin,
            HealthService<WorldHealth>* health, const WorldLoopOptions& options);

  // Runs to the end, or until an operator's order takes a restart, its shared memory was deleted or
  // its network interface is another.
  WorldEnd Drive(const StopSignal& stop);
  // All that another process needs to resume from here.
  std::string State() const;

 private:
  struct Fleet {
    Fleet(const Scenario& scenario, WorldEpoch epoch, const WorldLoopOptions& options)
        : run(scenario, epoch, options.parallel, options.schedule),
          admission(scenario, epoch, &run) {}
    sim::Run run;
    sim::Admission admission;
  };
  // What the world last heard of one vehicle.
  struct Reception {
    Tick answered = kNoTick;
    std::uint32_t matched_peers = 0;
    bool waited_for = true;  // in lockstep: until it lets a tick go by unanswered
  };

  struct Newcomer {
    SessionId session{};
    Tick stands_until = kNoTick;
  };

  // False where the checkpoint is not of this scenario: it starts a new run then.
  bool Resume(const sim::FleetCheckpoint& checkpoint);
  void StartCheckpoints(bool resumes);
  void RunTick();
  void Admit();
  void ReportLeftOut();
  void Welcome(const RosterEntry& entry);
  void Close();
  void TakeCommands();
  void CountSpeaking();
  bool IsReady(VehicleId vehicle) const;
  std::string Missing() const;
  void StartIfReady();
  void Publish();
  bool MustStand(VehicleId vehicle) const;
  void SendEvent(const WorldEvent& event);
  void AwaitAnswers(const StopSignal& stop);
  bool Unanswered() const;
  void KeepCheckpoint();
  void NoteLastCheckpoint();
  void NoteCheckpoint(const std::string& complaint);
  bool AnnounceEnd(Nanoseconds patience);
  void ReportHealth(HealthStage stage);
  void ReportIfAlone();
  void PublishHeapIfDue();
  bool HasLostSharedMemory();
  bool MayCommand(const MotorCommand& command);
  void Heed(const MotorCommand& command);
  void LogRefused(const MotorCommand& command, const FieldFault& fault, bool passing);

  const Scenario& scenario_;
  link::WorldLink& link_;
  ServiceAdmin& admin_;
  HealthService<WorldHealth>& health_;
  WorldLoopOptions options_;
  WorldEpoch epoch_;
  std::unique_ptr<Fleet> fleet_;
  std::optional<std::vector<VehicleId>> resumed_with_;  // must be back before it resumes
  sim::ReactionMeter reactions_;
  SteadyTime start_by_;
  SteadyTime report_alone_;  // when it is next said that no discovery server answers
  std::map<VehicleId, Reception> heard_;
  std::map<VehicleId, Newcomer> newcomers_;  // that joined during the run
  InterfaceCheck interface_check_;
  bool interface_lost_ = false;
  RefusalLog refusal_log_;
  PacketLog packet_log_;
  std::size_t speaking_ = 0;  // of those that are in
  std::vector<MotorCommand> commands_;
  LineBudget answer_lines_{8};  // of admission
  LineBudget event_lines_{16};  // of the run
  std::uint32_t overruns_ = 0;
  std::unique_ptr<StateWriter<>> checkpoint_writer_;  // null: none is kept
  SteadyTime next_checkpoint_{0};
  SteadyTime next_heap_{0};         // when its heap is next published
  FaultReminder checkpoint_fault_;  // a full disk is no news at every tick
};

}  // namespace giveway
