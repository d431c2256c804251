#include "tests/link/fleet.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <thread>

#include "services/link/fastdds/profile_file.h"

namespace giveway::test {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

link::LinkOptions OptionsIn(const DomainLock& domain) {
  link::LinkOptions options;
  options.domain = domain.Domain();
  options.qos = link::ReadProfileFile(GIVEWAY_QOS_FILE);
  return options;
}

bool Eventually(const std::function<bool()>& step, milliseconds deadline) {
  const auto end = steady_clock::now() + deadline;
  while (!step()) {
    if (steady_clock::now() > end) return false;
    std::this_thread::sleep_for(milliseconds(10));
  }
  return true;
}

void Repeat(milliseconds duration, const std::function<void()>& step) {
  const auto end = steady_clock::now() + duration;
  while (steady_clock::now() < end) {
    step();
    std::this_thread::sleep_for(milliseconds(10));
  }
}

Outputs BeaconFrom(VehicleId id, std::uint32_t seq) {
  Outputs outputs;
  outputs.command.vehicle = id;
  outputs.command.tick = Tick{seq};
  outputs.beacon.vehicle = id;
  outputs.beacon.boot_epoch = 1;
  outputs.beacon.seq = seq;
  outputs.beacon.tick = Tick{seq};
  return outputs;
}

Beaconing::Beaconing(const link::LinkOptions& options, VehicleId id) : id_(id), link_(options) {
  link_.Open(id);
}

BeaconingProcess::BeaconingProcess(const link::LinkOptions& options, VehicleId id) {
  const std::string domain = std::to_string(options.domain);
  const std::string number = std::to_string(Number(id));
  pid_ = fork();
  if (pid_ == 0) {
    execl(GIVEWAY_BEACONING_VEHICLE, GIVEWAY_BEACONING_VEHICLE, domain.c_str(), number.c_str(),
          options.qos.name.c_str(), nullptr);
    _exit(127);
  }
}

void BeaconingProcess::Kill() {
  if (pid_ <= 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

void ReceptionMonitor::Listen() {
  const link::Taken taken = link_.Take(SteadyTime{1});
  for (const ReceivedBeacon& received : taken.inputs.beacons) {
    beacons_.push_back(received);
    if (received.crc_valid && received.name_valid) heard_.insert(received.beacon.vehicle);
  }
  events_.insert(events_.end(), taken.inputs.events.begin(), taken.inputs.events.end());
}

std::vector<VehicleId> ReceptionMonitor::EventsOf(QosEventKind kind) const {
  std::vector<VehicleId> vehicles;
  for (const QosEvent& event : events_) {
    if (event.kind == kind) vehicles.push_back(event.vehicle);
  }
  return vehicles;
}

void ReceptionMonitor::Forget() {
  heard_.clear();
  beacons_.clear();
  events_.clear();
}

}  // namespace giveway::test
