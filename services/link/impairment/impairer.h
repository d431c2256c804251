// The channel model behind the transport of one participant: which process a packet is from, and
// what becomes of it. Safe to use from the library's threads; never calls the library.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "services/link/impairment/channel_model.h"

namespace giveway::link {

// The first twelve bytes of the GUID of every entity of a participant, which are in the header of
// each packet it sends. Ports and addresses do not distinguish participants of one host.
using PrefixBytes = std::array<std::uint8_t, 12>;

class Impairer {
 public:
  // The seed of `impairment` is set.
  explicit Impairer(Impairment impairment) : model_(std::move(impairment)) {}

  // Which packets are the own ones: those, and all before this call, are left alone.
  void NameOwn(const PrefixBytes& own);
  void NameHearer(VehicleId hearer);
  void Start(SteadyTime now);
  std::optional<SteadyTime> Started() const;
  // A discovered writer identifies its process: a vehicle by its beacon writer in `<area>/v<id>`,
  // the world by any in `world`. Once identified it stays so, also when the writer is gone: of a
  // vehicle that is cut off, so that its lease ends, nothing must come through. Only where there
  // are too many does one whose writer is gone give its place to another.
  void OnWriter(const PrefixBytes& process, const std::vector<std::string>& partitions);
  void OnWriterGone(const PrefixBytes& process, const std::vector<std::string>& partitions);

  PacketFate Decide(std::span<const std::uint8_t> packet, SteadyTime now);
  void NoteAbandoned(std::size_t packets);

  ImpairmentCounters Counters() const;
  ImpairmentCounters CountersOf(VehicleId sender) const;
  std::size_t Senders() const;  // distinguished so far

 private:
  struct Named {
    Sender sender;
    std::uint64_t gone = 0;  // 1, 2, 3 ... in the order in which their writers went; 0: it is there
  };
  Sender SenderOf(const PrefixBytes& process);
  bool MakeRoom();

  mutable std::mutex mutex_;  // guards all that follows
  ChannelModel model_;
  std::optional<PrefixBytes> own_;
  std::map<PrefixBytes, Named> named_;
  std::uint64_t gone_ = 0;                        // writers, so far
  std::map<PrefixBytes, std::uint32_t> unknown_;  // heard before they were named: 1, 2, 3 ...
  std::uint32_t numbers_ = 0;                     // given to those
  std::uint64_t abandoned_ = 0;
};

}  // namespace giveway::link
