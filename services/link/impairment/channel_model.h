// What becomes of each packet a process hears: the channel as a model. Pure: no clock, no thread,
// no Fast DDS; the transport asks it and obeys.
//
// Every sender has a stream of its own, made from the seed, the sender and the hearer, and every
// packet draws the same numbers from it whatever is asked for. So the n-th packet from a vehicle
// meets the same fate in every run, and asking for delay does not change which packets are lost.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>

#include "services/types/impairment.h"
#include "services/types/math/random.h"
#include "services/types/time.h"

namespace giveway::link {

// The sender of a packet, as far as discovery has identified it.
struct Sender {
  enum class Kind : std::uint8_t { kUnknown, kVehicle, kWorld };
  Kind kind = Kind::kUnknown;
  std::uint32_t number = 0;  // id of a vehicle; of the unknown 0, 1, 2 ... as they appeared

  friend constexpr auto operator<=>(const Sender&, const Sender&) = default;
};

struct PacketFate {
  bool dropped = false;
  Nanoseconds delay{0};
  std::optional<Nanoseconds> copy_delay;     // there is a second copy, so late
  std::optional<std::uint32_t> flipped_bit;  // of the packet, counted from its first byte's lowest
};

class ChannelModel {
 public:
  // The seed of `impairment` is set.
  explicit ChannelModel(Impairment impairment);

  // The receiving vehicle, once it is known: rules for one receiver apply from now on.
  void NameHearer(VehicleId hearer);
  // The start signal was heard: blackouts and the times of rules are counted from `now`. Only the
  // first call counts.
  void Start(SteadyTime now);
  const std::optional<SteadyTime>& Started() const { return started_; }
  // `now` never goes back.
  PacketFate Decide(const Sender& sender, std::uint32_t bytes, SteadyTime now);

  ImpairmentCounters Counters() const;
  ImpairmentCounters CountersOf(const Sender& sender) const;

 private:
  struct Channel {
    const ImpairmentRule* rule = nullptr;  // null: none fits
    SteadyTime rule_until{0};              // until then no other rule can fit
    SteadyTime asked_at{0};
    Random dice{0};
    bool bad = false;
    double tokens_bytes = 0;
    SteadyTime tokens_at{0};
    SteadyTime latest_due{0};
    ImpairmentCounters counters;
  };
  struct Draws;

  Channel& ChannelOf(const Sender& sender, SteadyTime now);
  void Begin(const Sender& sender, SteadyTime now, Channel* channel) const;
  const ImpairmentRule* RuleFor(const Sender& sender, SteadyTime now) const;
  SteadyTime NextChange(SteadyTime now) const;
  void Renew(const Sender& sender, SteadyTime now, Channel* channel) const;
  bool IsBlackout(const ImpairmentRule& rule, SteadyTime now) const;
  bool IsDropped(const Draws& draws, std::uint32_t bytes, SteadyTime now, Channel* channel) const;

  const Impairment impairment_;
  VehicleId hearer_ = kNoVehicle;
  std::optional<SteadyTime> started_;
  std::map<Sender, Channel> channels_;
};

}  // namespace giveway::link
