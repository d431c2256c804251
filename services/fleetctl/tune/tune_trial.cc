#include "services/fleetctl/tune/tune_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "services/fleetctl/args/qos_files.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Nanoseconds kStartLimit = seconds(40);
constexpr Nanoseconds kSettle = milliseconds(500);
// Between two kills: longer than any limit that is searched.
constexpr Nanoseconds kBetweenKillings = milliseconds(700);
constexpr Nanoseconds kFirstKilling = milliseconds(20);
constexpr std::size_t kMostKillings = 3;
constexpr Nanoseconds kLeaveGrace = seconds(3);

std::vector<MemberCommand> CommandsOf(const TuneGround& ground, const TrialOrder& order,
                                      const DomainLock& lock) {
  FleetSpec spec = ground.fleet;
  spec.domain = lock.Domain();
  spec.lock_fd = lock.Fd();
  spec.qos_file = order.qos_file;
  spec.options.seed = order.seed;
  spec.options.record_folder = order.folder.string();
  return MakeCommands(spec, *ground.scenario);
}

link::LinkOptions ObserverOptions(const TuneGround& ground, std::uint32_t domain) {
  link::LinkOptions options;
  options.domain = domain;
  options.qos = ReadSoundQos(ground.observer_qos);
  options.area = ground.scenario->area;
  options.fleet_size = static_cast<std::uint32_t>(ground.scenario->vehicles.size());
  return options;
}

// "bytes=1234" in the line in which a vehicle logs its impairments.
std::optional<double> BytesIn(const std::string& line) {
  const std::size_t impairment = line.find("impairment: ");
  if (impairment == std::string::npos) return std::nullopt;
  const std::size_t bytes = line.find(" bytes=", impairment);
  if (bytes == std::string::npos) return std::nullopt;
  return std::strtod(line.c_str() + bytes + 7, nullptr);
}

}  // namespace

TuneTrial::TuneTrial(const TuneGround& ground, const TrialOrder& order)
    : ground_(ground), order_(order), lock_(std::nullopt), random_(order.seed) {
  // What a trial left that was killed: the vehicles would write next to its recordings, which would
  // be read instead.
  std::filesystem::remove_all(order.folder);
  std::filesystem::create_directories(order.folder);
  observer_.emplace(ObserverOptions(ground, lock_.Domain()));
  processes_.emplace(CommandsOf(ground, order, lock_));
  begun_ = SteadyNow();
  Enter(Phase::kStarting, begun_ + kStartLimit);
}

TuneTrial::~TuneTrial() {
  processes_.reset();
  std::error_code ignored;
  std::filesystem::remove_all(order_.folder, ignored);
}

void TuneTrial::Fail(const std::string& why) {
  if (trouble_.empty()) trouble_ = why;
}

void TuneTrial::Hear() {
  for (const VehicleStatus& status : observer_->Take().statuses) {
    const bool all = status.peers_heard + 1 == ground_.scenario->vehicles.size();
    hears_all_[status.vehicle] = hears_all_[status.vehicle] || all;
  }
}

bool TuneTrial::AllHearAll() const {
  return hears_all_.size() == ground_.scenario->vehicles.size() &&
         std::ranges::all_of(hears_all_, [](const auto& entry) { return entry.second; });
}

// Only killed processes may end before they are asked to.
void TuneTrial::CheckAlive() {
  const auto gone = processes_->FirstEndNotAllowed([](const auto& end) { return end.planned; });
  if (!gone) return;
  const auto& said = processes_->LastLines(gone->member);
  Fail(NameOf(gone->member) + " ended: " + Describe(gone->how) +
       (said.empty() ? "" : "; it said: " + said.back()));
}

double TuneTrial::CpuSeconds() const {
  double sum = 0;
  for (const VehicleOptions& vehicle : ground_.scenario->vehicles) {
    const auto resources = processes_->ResourcesOf(MemberOf(vehicle.id));
    if (resources) sum += resources->cpu_s;
  }
  return sum;
}

void TuneTrial::BeginAlive(SteadyTime now) {
  window_.from = now;
  cpu_before_s_ = CpuSeconds();
  Enter(Phase::kAlive, now + FromSeconds(ground_.alive_s));
}

void TuneTrial::EndAlive(SteadyTime now) {
  window_.to = now;
  cpu_used_s_ = CpuSeconds() - cpu_before_s_;
  PlanKillings();
  Enter(Phase::kKilling, now + planned_.front().after);
}

// The seed decides which vehicle is killed, and how long after the last one; the phase in the
// target's own tick is random.
void TuneTrial::PlanKillings() {
  std::vector<VehicleId> vehicles;
  for (const VehicleOptions& vehicle : ground_.scenario->vehicles) vehicles.push_back(vehicle.id);
  for (std::size_t i = vehicles.size(); i > 1; --i) {
    std::swap(vehicles[i - 1], vehicles[random_.Next() % i]);
  }
  const std::size_t killings = std::min(kMostKillings, vehicles.size() - 1);
  for (std::size_t i = 0; i < killings; ++i) {
    const double share = random_.Uniform(0, 1);
    const Nanoseconds in_tick = FromSeconds(share * Seconds(ground_.scenario->tick_period));
    planned_.push_back({vehicles[i], (i == 0 ? kFirstKilling : kBetweenKillings) + in_tick});
  }
}

// Counted from the actual time of the last kill, not from the planned one: after a pause of this
// process two would follow each other at once.
void TuneTrial::KillIfDue(SteadyTime now) {
  if (killed_.size() == planned_.size() || now < until_) return;
  const VehicleId target = planned_[killed_.size()].target;
  killed_.push_back({target, SteadyNow()});
  processes_->Kill(MemberOf(target));
  const bool last = killed_.size() == planned_.size();
  until_ = killed_.back().at + (last ? kBetweenKillings : planned_[killed_.size()].after);
}

void TuneTrial::Stop(SteadyTime now) {
  stopped_ = now;
  // All by SIGTERM: a vehicle that stops gracefully logs its impairments.
  processes_->AskToStop();
  Enter(Phase::kStopping, now + kLeaveGrace);
}

void TuneTrial::StopFurther(SteadyTime now) {
  if (!processes_->AllEnded() && now < until_) return;
  processes_->ForceEnd();
  observer_.reset();
  Enter(Phase::kOver, now);
}

void TuneTrial::Turn(SteadyTime now) {
  if (phase_ == Phase::kKilling) KillIfDue(now);
  processes_->Poll();
  if (observer_) Hear();
  if (phase_ < Phase::kStopping) CheckAlive();
  if (phase_ < Phase::kStopping && !trouble_.empty()) return Stop(now);
  switch (phase_) {
    case Phase::kStarting:
      if (AllHearAll()) Enter(Phase::kSettling, now + kSettle);
      if (phase_ == Phase::kStarting && now > until_) Fail("not all vehicles received each other");
      return;
    case Phase::kSettling:
      if (now >= until_) BeginAlive(now);
      return;
    case Phase::kAlive:
      if (now >= until_) EndAlive(now);
      return;
    case Phase::kKilling:
      if (now >= until_) Stop(now);
      return;
    case Phase::kStopping:
      return StopFurther(now);
    case Phase::kOver:
      return;
  }
}

// From those that were not killed: only they log it. Over their whole life, discovery included.
std::optional<double> TuneTrial::HeardBytesPerSecond() const {
  double sum = 0;
  int count = 0;
  for (const VehicleOptions& vehicle : ground_.scenario->vehicles) {
    for (const std::string& line : processes_->LastLines(MemberOf(vehicle.id))) {
      const std::optional<double> bytes = BytesIn(line);
      if (!bytes) continue;
      sum += *bytes;
      ++count;
    }
  }
  const double life_s = Seconds(stopped_ - begun_);
  if (count == 0 || life_s <= 0) return std::nullopt;
  return sum / count / life_s;
}

TrialEvidence TuneTrial::TakeEvidence() {
  const auto& vehicles = ground_.scenario->vehicles;
  TrialEvidence evidence;
  evidence.candidate = order_.candidate;
  evidence.verification = order_.verification;
  evidence.trial = order_.trial;
  evidence.seed = order_.seed;
  evidence.vehicles = static_cast<std::uint32_t>(vehicles.size());
  evidence.trouble = trouble_;
  if (!trouble_.empty()) return evidence;
  evidence.alive_s = Seconds(window_.to - window_.from);
  evidence.cpu_share = cpu_used_s_ / evidence.alive_s / evidence.vehicles;
  evidence.heard_bytes_s = HeardBytesPerSecond();
  std::vector<VehicleReading> readings;
  for (const VehicleOptions& vehicle : vehicles) {
    std::ifstream stream(order_.folder / fmt::format("vehicle-{}.recording", Number(vehicle.id)),
                         std::ios::binary);
    readings.push_back(ReadVehicle(&stream, window_));
  }
  FoldReadings(readings, killed_, ground_.scenario->tick_period, &evidence);
  return evidence;
}

std::string TuneScenarioText(std::uint32_t vehicles) {
  std::string text =
      "name: \"qos_tune\"\n"
      "description: \"Parallel lanes at low speed: all vehicles receive each other, none "
      "conflicts.\"\n"
      "duration_s: 3600\nstart_timeout_s: 60\nemission_radius_m: 1000\n";
  for (std::uint32_t i = 1; i <= vehicles; ++i) {
    text += fmt::format(
        "vehicle {{ id: {0} start {{ x_m: 0 y_m: {1} heading_deg: 0 }} cruise_m_s: 0.05 "
        "goal {{ x_m: 1000 y_m: {1} }} }}\n",
        i, 3 * (i - 1));
  }
  // A place for a newcomer that never joins: in an open fleet a death does not end the run.
  text += "spawn { start { x_m: 0 y_m: -30 heading_deg: 0 } cruise_m_s: 0.05 }\n";
  return text + "expect { any_halted: true any_arrived: true }\n";
}

}  // namespace giveway::fleetctl
