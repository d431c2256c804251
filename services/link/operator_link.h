// An operator's side: gives orders to vehicles, one by one, and hears their answers.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "services/link/fastdds/link_options.h"
#include "services/types/admin.h"
#include "services/types/refusal.h"

namespace giveway::link {

class OperatorLink {
 public:
  // `key`: orders are sealed with it, and only answers sealed with it, and refusals, come out of
  // Take; empty: without. Throws LinkError.
  explicit OperatorLink(const LinkOptions& options, std::string key = {});
  ~OperatorLink();
  OperatorLink(const OperatorLink&) = delete;
  OperatorLink& operator=(const OperatorLink&) = delete;

  // For the next order: the time in nanoseconds since 1970, above all that it gave before.
  static std::uint64_t NextNumber();

  // The vehicles whose beacons are announced in the domain now, in order. Some may take no orders.
  std::vector<VehicleId> Announced();
  // Starts to look for the vehicle; kNoVehicle is the world. Once each. Throws LinkError.
  void Seek(VehicleId vehicle);
  // Whether it would get an order now. It was sought.
  bool Reaches(VehicleId vehicle) const;
  // False if the library refused the order. It was sought, and is reached.
  bool Send(const AdminRequest& order);
  // Everything that came since the last call. Where its shared memory was deleted it replaces its
  // participant, as ObserverLink::Take: orders that are not answered yet are lost. With a key,
  // a refusal may come without a seal: of a service that has another key, or finds the order's
  // number used. Its seal is then 0.
  std::vector<AdminAnswer> Take();
  // Answers that were not believed: of a participant that does not speak for the vehicle, of ids
  // too many, or without the seal of the key; and the first few since the last call.
  std::uint32_t Refused() const;
  std::vector<Refusal> TakeRefusals();

 private:
  struct Impl;
  void RenewIfDeaf();

  std::unique_ptr<Impl> impl_;
};

}  // namespace giveway::link
