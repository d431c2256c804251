// What the link tests share: options in a domain of their own, waiting for a condition, vehicles in
// this process that only send beacons, and vehicles in processes that can be killed.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <memory>
#include <set>
#include <vector>

#include "services/link/vehicle_link.h"
#include "tests/support/domain_lock.h"

namespace giveway::test {

link::LinkOptions OptionsIn(const DomainLock& domain);

// Repeats `step` until it is true; false if it never is within the deadline. How often it is tried
// proves nothing; that it became true does.
bool Eventually(const std::function<bool()>& step,
                std::chrono::milliseconds deadline = std::chrono::seconds(60));

// Repeats `step` for as long as `duration`, every 10 ms.
void Repeat(std::chrono::milliseconds duration, const std::function<void()>& step);

Outputs BeaconFrom(VehicleId id, std::uint32_t seq);

// A vehicle that sends what BeaconFrom says.
class Beaconing {
 public:
  Beaconing(const link::LinkOptions& options, VehicleId id);
  void Send() { link_.Send(BeaconFrom(id_, ++seq_)); }
  std::uint32_t Seq() const { return seq_; }  // of the last one sent
  link::VehicleLink& Link() { return link_; }

 private:
  VehicleId id_;
  std::uint32_t seq_ = 0;
  link::VehicleLink link_;
};

// The same in a process of its own, sending at 20 Hz until it is killed.
class BeaconingProcess {
 public:
  BeaconingProcess(const link::LinkOptions& options, VehicleId id);
  ~BeaconingProcess() { Kill(); }
  BeaconingProcess(const BeaconingProcess&) = delete;
  BeaconingProcess& operator=(const BeaconingProcess&) = delete;
  void Kill();  // SIGKILL: no leave notice

 private:
  pid_t pid_ = -1;
};

// What a vehicle has taken so far, summed up.
class ReceptionMonitor {
 public:
  explicit ReceptionMonitor(link::VehicleLink& link) : link_(link) {}
  void Listen();
  // Vehicles a named, sound beacon came from.
  const std::set<VehicleId>& Heard() const { return heard_; }
  // The vehicles that events of a kind were about, in order.
  std::vector<VehicleId> EventsOf(QosEventKind kind) const;
  const std::vector<ReceivedBeacon>& Beacons() const { return beacons_; }
  void Forget();

 private:
  link::VehicleLink& link_;
  std::set<VehicleId> heard_;
  std::vector<ReceivedBeacon> beacons_;
  std::vector<QosEvent> events_;
};

}  // namespace giveway::test
