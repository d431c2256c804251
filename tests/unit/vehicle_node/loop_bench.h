// A control loop on the bench: a link that a test scripts turn by turn, and a clock that moves only
// when the loop waits. No sockets, no real time.
#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/vehicle_node/vehicle_loop.h"
#include "tests/support/brain_bench.h"

namespace giveway::test {

inline constexpr SessionId kSession{1, 2, 3, 4};

class HandClock final : public Clock {
 public:
  SteadyTime Now() const override { return now_; }
  void SleepUntil(SteadyTime when) override { now_ = std::max(now_, when); }
  Nanoseconds ThreadTime() const override { return Nanoseconds{0}; }

 private:
  SteadyTime now_ = std::chrono::seconds(100);
};

// What is to come with a turn.
struct Arrival {
  std::optional<RangeScan> scan;
  std::vector<Beacon> beacons;
  std::optional<RosterEntry> roster;
};

class ScriptedLink final : public link::DriveLink {
 public:
  using Script = std::function<Arrival(std::uint32_t turn)>;
  ScriptedLink(HandClock* clock, Script script) : clock_(*clock), script_(std::move(script)) {}

  // In the order in which it was sent: "beacon", "leave notice", "join 1", "leave", "status", ...
  const std::vector<std::string>& Calls() const { return calls_; }
  // Without what is sent all the time.
  std::vector<std::string> SaidBesides() const {
    std::vector<std::string> rest;
    std::ranges::remove_copy_if(calls_, std::back_inserter(rest), [](const std::string& word) {
      return word == "beacon" || word == "status";
    });
    return rest;
  }
  const std::vector<Outputs>& Sent() const { return sent_; }
  const std::vector<JoinRequest>& JoinRequests() const { return joins_; }
  const VehicleStatus& LastStatus() const { return last_status_; }
  const std::vector<Nanoseconds>& Waits() const { return waits_; }
  std::uint32_t Turns() const { return turn_; }
  void SayThatWorldSpeaks() { world_speaks_ = true; }
  void SayThatItLacksBody() { lacks_body_ = true; }
  void ChangeInterface(const std::string& change) { interface_change_ = change; }
  void DeleteSharedMemory() { shared_memory_is_gone_ = true; }

  bool WaitForScan(Nanoseconds timeout) override {
    waits_.push_back(timeout);
    next_ = script_(++turn_);
    clock_.SleepUntil(clock_.Now() + (next_.scan ? std::min(timeout, kTick) : timeout));
    return next_.scan.has_value();
  }
  link::Taken Take(SteadyTime now) override {
    received_.clear();
    for (const Beacon& beacon : next_.beacons) received_.push_back(Received(beacon, now));
    link::Taken taken;
    taken.inputs.now = now;
    taken.inputs.scan = next_.scan;
    taken.inputs.beacons = received_;
    taken.inputs.roster = next_.roster;
    return taken;
  }
  std::vector<std::string> TakeUnfit(SteadyTime /*now*/) override { return {}; }
  void Send(const Outputs& outputs) override {
    sent_.push_back(outputs);
    calls_.push_back(outputs.beacon.mode == Mode::kLeaving ? "leave notice" : "beacon");
  }
  void SendStatus(const VehicleStatus& status) override {
    last_status_ = status;
    calls_.push_back(status.final ? "last status" : "status");
  }
  void FlushStatus(Nanoseconds /*timeout*/) override { calls_.push_back("status heard"); }
  void FlushAnswer(Nanoseconds /*timeout*/) override { calls_.push_back("answer heard"); }
  void SendJoin(const JoinRequest& request) override {
    joins_.push_back(request);
    calls_.push_back("join " + std::to_string(Number(request.wanted)));
  }
  void FlushJoin(Nanoseconds /*timeout*/) override { calls_.push_back("join heard"); }
  void SendLeave(const SessionId& session) override {
    calls_.push_back(session == kSession ? "leave" : "leave as another");
  }
  // Entries for TakeRoster, one a call.
  void Answer(const RosterEntry& entry) { entries_.push_back(entry); }
  std::optional<RosterEntry> TakeRoster(const SessionId& /*session*/) override {
    if (entries_.empty()) return std::nullopt;
    const RosterEntry entry = entries_.front();
    entries_.pop_front();
    return entry;
  }
  std::string WhyNoPeerIsFound() const override { return {}; }
  std::string InterfaceChange() const override { return interface_change_; }
  bool SharedMemoryIsGone() override { return shared_memory_is_gone_; }
  bool WorldSpeaks() const override { return world_speaks_; }
  bool LacksBody() const override { return lacks_body_; }
  link::VehicleLinkCounters Counters() const override { return {}; }
  link::EffectiveBeaconQos BeaconQos() const override { return {}; }
  std::optional<SteadyTime> BlackoutsSince() const override { return std::nullopt; }

 private:
  static constexpr Nanoseconds kTick = std::chrono::milliseconds(50);

  HandClock& clock_;
  const Script script_;
  std::uint32_t turn_ = 0;
  Arrival next_;
  std::vector<ReceivedBeacon> received_;
  std::vector<std::string> calls_;
  std::vector<Outputs> sent_;
  std::vector<JoinRequest> joins_;
  std::deque<RosterEntry> entries_;
  std::vector<Nanoseconds> waits_;
  VehicleStatus last_status_;
  std::string interface_change_;
  bool shared_memory_is_gone_ = false;
  bool world_speaks_ = false;
  bool lacks_body_ = false;
};

// The world's entry for vehicle 1, to which it gave its place.
inline RosterEntry Entry(RunState state, WorldEpoch epoch = kEpoch) {
  return {.session = kSession,
          .vehicle = VehicleId{1},
          .accepted = true,
          .waiting = false,
          .reason = "",
          .epoch = epoch,
          .run_state = state};
}

inline RangeScan Scan(std::uint32_t tick, WorldEpoch epoch = kEpoch) {
  RangeScan scan = ClearScan(tick);
  scan.epoch = epoch;
  return scan;
}

// One loop, driven to its end.
class LoopBench {
 public:
  static constexpr double kSpawnCruise_m_s = 0.2;  // at the scenario's spawn place

  explicit LoopBench(ScriptedLink::Script script, VehicleLoopOptions options = {})
      : link_(&clock_, std::move(script)), options_(std::move(options)) {
    scenario_.vehicles = {DefaultOptions()};
    scenario_.spawns = {DefaultOptions()};
    scenario_.spawns.front().cruise_m_s = kSpawnCruise_m_s;
  }

  // Never longer than `most` turns.
  DriveEnd Drive(std::uint32_t most = 1000) {
    loop_.emplace(
        VehicleLoopParts{.link = &link_,
                         .clock = &clock_,
                         .health = &health_,
                         .recorder = nullptr,
                         .serve_orders = [this] { return link_.Turns() == order_at_; },
                         .on_first_scan = [this] { answered_.push_back(link_.Sent().size()); }},
        scenario_, Entry(RunState::kRunning), options_);
    return loop_->Drive([this, most] {
      return link_.Turns() >= std::min(stop_at_, most) || (stops_as_it_asks_ && HasAsked());
    });
  }
  // After that many turns it is asked to stop.
  void StopAt(std::uint32_t turn) { stop_at_ = turn; }
  void FitRadarAtSpawn() { scenario_.spawns.front().profile.radar = true; }
  void StopAsItAsksForTime() { stops_as_it_asks_ = true; }
  // At the end of that turn an administrative request asks for a restart.
  void OrderRestartAt(std::uint32_t turn) { order_at_ = turn; }

  ScriptedLink& Link() { return link_; }
  const VehicleLoop& Loop() const { return *loop_; }
  SteadyTime Now() const { return clock_.Now(); }
  // How much it had sent each time it reported that its first scan is answered.
  const std::vector<std::size_t>& FirstScans() const { return answered_; }

 private:
  bool HasAsked() const { return !link_.JoinRequests().empty(); }

  HandClock clock_;
  ScriptedLink link_;
  VehicleLoopOptions options_;
  Scenario scenario_;
  VehicleHealthReporter health_{ServiceFlags{}};
  std::optional<VehicleLoop> loop_;
  std::uint32_t stop_at_ = 1'000'000;
  std::uint32_t order_at_ = 0;
  bool stops_as_it_asks_ = false;
  std::vector<std::size_t> answered_;
};

}  // namespace giveway::test
