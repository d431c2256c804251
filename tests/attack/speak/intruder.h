// A process that joins the domain of a fleet and needs no credentials for it: it receives what the
// world sends to all, and writes whatever it likes.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "services/link/convert/convert.h"
#include "services/link/participant.h"

namespace giveway::attack {

using std::chrono::milliseconds;

// What it was asked to do, and where.
struct Orders {
  std::uint32_t domain = 0;
  std::string qos_file;
  VehicleId target{1};
  milliseconds duration{1500};
};

class Unnamed final : public link::DiscoveryListener {
 public:
  void OnWriter(Change, const link::rtps::GUID_t&, const std::vector<std::string>&) override {}
};

link::LinkOptions OptionsOf(const Orders& orders);

class Intruder {
 public:
  explicit Intruder(const Orders& orders);

  // Waits until the truth and the roster entry of the target were received. Throws.
  void LookRound();
  link::Participant& Participant() { return participant_; }
  const Orders& Asked() const { return orders_; }
  // The target's truth, as the world published it last.
  const Truth& TargetNow();
  const RosterEntry& Entry() const { return entries_.at(orders_.target); }
  const std::map<VehicleId, RosterEntry>& Entries() const { return entries_; }

  // Waits for a reader of `writer`. Throws where there is none within seconds.
  template <typename Wire>
  void AwaitReader(const link::Writer<Wire>& writer) {
    Await([&] { return writer.HasReader(); }, "it has no reader");
  }
  // Calls say(i) every `period`, for as long as it was asked to; afterwards what it wrote has time
  // to arrive.
  void Repeat(milliseconds period, const std::function<void(std::uint32_t i)>& say) const;

 private:
  void Await(const std::function<bool()>& done, const char* why_not);
  void Take();

  Orders orders_;
  Unnamed listener_;
  link::Participant participant_;
  link::Reader<wire::Roster> roster_;
  link::Reader<wire::Truth> truth_;
  std::map<VehicleId, RosterEntry> entries_;
  std::map<VehicleId, Truth> truths_;
};

}  // namespace giveway::attack
