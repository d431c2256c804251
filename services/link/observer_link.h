// An observer's side: reads what the world and the vehicles publish, writes nothing.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "services/link/fastdds/link_options.h"
#include "services/types/beacon.h"
#include "services/types/fleet_facts.h"
#include "services/types/motor_command.h"
#include "services/types/range_scan.h"
#include "services/types/refusal.h"
#include "services/types/signal.h"

namespace giveway::link {

struct Observed {
  std::vector<Truth> truths;
  std::vector<WorldEvent> events;
  std::vector<VehicleStatus> statuses;
  std::vector<ReceivedBeacon> beacons;  // without the time of their arrival
  std::vector<RosterEntry> roster;
  std::vector<SignalState> signals;
  std::optional<RunFigures> figures;
  std::vector<RangeScan> ranges;       // only where they are asked for
  std::vector<MotorCommand> commands;  // likewise
  // The participant whose writers are those of a world, by discovery; 0: none is there. A world
  // without bodies publishes nothing.
  std::uint64_t world = 0;
  // Statuses whose id is not the one of their writer's partition, and samples of a participant that
  // may not say that, or of ids too many; and the first few of the latter.
  std::uint32_t refused = 0;
  std::vector<Refusal> refusals;
};

class ObserverLink {
 public:
  // The ranges of all vehicles are what the world sends most of: it sends them to every observer
  // that asks for them.
  enum class Ranges : std::uint8_t { kNo, kYes };
  enum class Commands : std::uint8_t { kNo, kYes };

  // Throws LinkError.
  explicit ObserverLink(const LinkOptions& options, Ranges ranges = Ranges::kNo,
                        Commands commands = Commands::kNo);
  ~ObserverLink();
  ObserverLink(const ObserverLink&) = delete;
  ObserverLink& operator=(const ObserverLink&) = delete;

  // Everything that came since the last call: events in order, the other kinds in order of arrival
  // for each vehicle (roster: session; signals: head). Where its shared memory was deleted it
  // replaces its participant by one over UDP, which takes a tenth of a second; what the world keeps
  // for newcomers comes again then, but for its events. Throws LinkError where it cannot, and must
  // not be used after that.
  Observed Take();
  // What changed of the network interfaces since this link was made, if it can no longer receive
  // for that reason; else empty. Throws LinkError.
  std::string InterfaceChange() const;

 private:
  struct Impl;
  struct EventNumber {
    WorldEpoch epoch = kNoEpoch;
    std::uint32_t seq = 0;
  };
  void RenewIfDeaf();
  void DropGiven(std::vector<WorldEvent>* events);

  std::unique_ptr<Impl> impl_;
  EventNumber last_event_;  // that was returned
  EventNumber given_;       // before the participant was replaced; none: it was not
};

}  // namespace giveway::link
