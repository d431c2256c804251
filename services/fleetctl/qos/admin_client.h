// Sends orders to running vehicles and receives their answers: finds the vehicles, sends, waits
// with a deadline. What is ordered and what the answers mean is up to the caller.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "services/fleetctl/qos/settling.h"
#include "services/link/operator_link.h"
#include "services/runtime/refusal_log.h"
#include "services/types/admin.h"

namespace giveway::fleetctl {

// kNoVehicle stands for the world.
class AdminClient {
 public:
  // `key`: seals orders, and only answers sealed with it are accepted; empty: without seals.
  AdminClient(const link::LinkOptions& options, const std::string& key)
      : link_(options, key), has_key_(!key.empty()) {}

  // Waits until each is reached, or `patience` ends; returns those that are not reached.
  std::vector<VehicleId> Seek(const std::vector<VehicleId>& vehicles,
                              const Settling::Patience& patience);
  std::vector<VehicleId> Seek(const std::vector<VehicleId>& vehicles, Nanoseconds limit) {
    return Seek(vehicles, {.quiet = limit, .limit = limit, .at_least = vehicles.size()});
  }
  std::vector<VehicleId> Announced() { return link_.Announced(); }
  // Sends it to a vehicle that is reached, and waits for the answer that it is in effect, or
  // refused. nullopt if none arrives within `patience`. Ctrl-C ends the wait; with `insist` only
  // the second one does.
  std::optional<AdminAnswer> Send(AdminRequest order, std::chrono::milliseconds patience,
                                  bool insist = false);
  // What the process runs with, or its refusal to say so; nullopt as above.
  std::optional<AdminAnswer> AskQos(VehicleId process, std::chrono::milliseconds patience,
                                    bool insist = false);

 private:
  // Reports on stderr the answers that are not accepted, once per writer.
  void ReportRefusals();

  link::OperatorLink link_;
  const bool has_key_;
  std::set<VehicleId> sought_;
  RefusalLog refusal_log_;
};

// Report on stderr why there is no answer of the vehicle: it is not reached or does not answer, or
// the operator did not wait. The exit code.
int ReportNotReached(VehicleId vehicle, std::uint32_t domain);
int ReportNoAnswer(VehicleId vehicle);
// Reports that it refuses even to answer what it runs with, and why: mostly another key.
int ReportRefused(const AdminAnswer& answer);
int ReportNoneReached(std::uint32_t domain);

AdminRequest ApplyRequest(VehicleId vehicle, const QosProfiles& profiles);

}  // namespace giveway::fleetctl
