// Puts samples together that come in fragments, so that the library is given each as one DATA when
// it is whole, and never a part. Of a sample of which it has a part it takes memory for the whole,
// and keeps it; it copies further fragments by the sizes that the first one stated, beyond what
// came if these state others (CVE-2026-22590); and it ends the process when the sample's number is
// passed by a GAP, or by a DATA of that number, for then it hands on what has no instance.
//
// What is not whole takes memory for what came, and gives way to what comes later, that of unknown
// participants first: its writer is asked for all of it again. Fast DDS sends all again; Cyclone
// the first fragment alone, and the others when it is asked for them one by one, which nothing does
// here: of its samples one that lost another fragment does not come. Bounded; pure: no clock.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <optional>
#include <vector>

#include "services/link/packet_filter/packet_context.h"
#include "services/link/packet_filter/participant_table.h"
#include "services/link/packet_filter/rtps_bytes.h"

namespace giveway::link {

using OwnedPacket = std::vector<std::uint8_t>;

// A sound packet without its fragments; empty if nothing else is in it that the library would read.
OwnedPacket WithoutFragments(Bytes packet);

class FragmentStore {
 public:
  // In all so many bytes, with what it takes to keep them.
  explicit FragmentStore(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  // The samples that a sound packet makes whole, each a packet of its own with one DATA, which may
  // be longer than a datagram.
  std::vector<OwnedPacket> Take(Bytes packet, const ParticipantTable& participants);

  std::size_t KeptBytes() const { return kept_bytes_; }

 private:
  // Writer, number, sizes of sample and fragments, as they stand in a DATA_FRAG.
  using Key = std::array<std::uint8_t, 32>;
  struct Sample {
    std::vector<std::vector<std::uint8_t>> pieces;  // by fragment; empty: it did not come
    std::size_t missing = 0;                        // fragments
    std::size_t kept_bytes = 0;
    PrefixBytes destination{};  // all 0: none, or more than one
    std::array<std::uint8_t, 4> reader{};
    // Of the fragment whose inline QoS it is: Cyclone states it, and the time, with the first one
    // alone.
    std::uint8_t flags = 0;
    std::array<std::uint8_t, 12> writer_and_number{};
    OwnedPacket inline_qos;
    OwnedPacket time;  // an INFO_TS
    std::list<Key>* turns = nullptr;
    std::list<Key>::iterator turn;
  };
  static OwnedPacket WholeOf(const Sample& sample, const PrefixBytes& source, Bytes packet);
  std::optional<OwnedPacket> Add(const Submessage& frag, const PacketContext& context, Bytes packet,
                                 bool is_known);
  std::map<Key, Sample>::iterator Find(const Submessage& frag, const PacketContext& context,
                                       bool is_known);
  void KeepHead(const Submessage& frag, const PacketContext& context, Sample* sample);
  void Keep(const Submessage& frag, Sample* sample);
  void MakeRoom();

  std::size_t most_bytes_;
  std::size_t kept_bytes_ = 0;
  std::map<Key, Sample> samples_;
  // The one that nothing came of for longest first.
  std::list<Key> turns_;
  std::list<Key> turns_of_unknown_;
};

}  // namespace giveway::link
