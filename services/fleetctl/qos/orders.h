// Orders to running vehicles, and their answers: finds the vehicles, sends, waits with a deadline.
// What is ordered and what the answers mean, is the caller's.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "services/link/operator_link.h"
#include "services/runtime/refusal_log.h"
#include "services/types/admin.h"

namespace giveway::fleetctl {

// kNobody stands for the world.
class Orders {
 public:
  // `key`: orders are sealed with it, and only answers sealed with it believed; empty: without.
  Orders(const link::LinkOptions& options, const std::string& key)
      : link_(options, key), has_key_(!key.empty()) {}

  // Waits until each is reached; those that are not within `patience` come back.
  std::vector<VehicleId> Seek(const std::vector<VehicleId>& vehicles,
                              std::chrono::milliseconds patience);
  std::vector<VehicleId> Announced() { return link_.Announced(); }
  // Sends it to a vehicle that is reached, and waits for the answer in which it says that it is in
  // effect, or refused. Nothing if it does not come within `patience`.
  // Ctrl-C ends the waiting; `insist`: only the second one does.
  std::optional<AdminAnswer> Give(AdminOrder order, std::chrono::milliseconds patience,
                                  bool insist = false);

 private:
  // On stderr, answers that are not believed, each writer's once.
  void SayRefusals();

  link::OperatorLink link_;
  const bool has_key_;
  std::set<VehicleId> sought_;
  RefusalLog refusal_log_;
};

// Say on stderr why there is no answer of the vehicle: it is not reached or does not speak, or the
// operator did not wait. The exit code.
int SayNotReached(VehicleId vehicle, std::uint32_t domain);
int SayNoAnswer(VehicleId vehicle);
// That it does not even say what it runs with, and why: most often the key is another.
int SayRefused(const AdminAnswer& answer);
int SayNobodyReached(std::uint32_t domain);

// An order that asks what the vehicle runs with.
AdminOrder TellOrder(VehicleId vehicle);
AdminOrder ApplyOrder(VehicleId vehicle, const QosProfiles& profiles);

}  // namespace giveway::fleetctl
