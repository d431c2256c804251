// What discovery says of a writer or reader, of any vendor, and whether two of them match. Knows
// no DDS: the discovery data is copied here (fastdds_version.h).
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <mutex>
#include <string>
#include <vector>

namespace giveway::link {

inline constexpr std::int64_t kEndless = std::numeric_limits<std::int64_t>::max();

struct FoundEndpoint {
  std::array<std::uint8_t, 16> guid{};  // the first twelve bytes are the participant's
  bool writes = false;                  // else it reads
  std::string topic;
  std::string type;
  std::vector<std::string> partitions;  // empty: the default one
  bool reliable = false;                // offered or requested, here and below
  int durability = 0;                   // volatile, transient local, transient, persistent
  int liveliness = 0;                   // automatic, manual by participant, by topic
  std::int64_t deadline_ns = kEndless;
  std::int64_t lease_ns = kEndless;
  bool exclusive = false;  // its ownership; else shared
};

// Whether both are of one participant.
bool AreOfOneParticipant(const FoundEndpoint& a, const FoundEndpoint& b);
bool HasPartition(const FoundEndpoint& endpoint);
// As DDS has it: names or wildcards of one against names of the other; of two wildcards none.
bool PartitionsMatch(const FoundEndpoint& a, const FoundEndpoint& b);
// Every policy of which the writer offers less than the reader requests, or an other type, in
// words; empty if there is none. Partitions apart, and positive acknowledgements, which no profile
// of a fleet turns off.
std::string Misfit(const FoundEndpoint& writer, const FoundEndpoint& reader);

// Whose DDS it is, by the first bytes of a GUID; "vendor 0x0107" if it is none of the known.
std::string VendorOf(const std::array<std::uint8_t, 16>& guid);
// Whether it is the library that this program is built with.
bool IsOurVendor(const std::array<std::uint8_t, 16>& guid);
// "v5" or "main/v5, north/v5"; "no partition".
std::string PartitionText(const FoundEndpoint& endpoint);
// "010f45d2a3b1000001000000", of the participant.
std::string ParticipantText(const std::array<std::uint8_t, 16>& guid);

// Between the library's threads, which add, and the loop's, which takes. Bounded.
class EndpointQueue {
 public:
  void Add(FoundEndpoint found);
  std::vector<FoundEndpoint> Take();

 private:
  std::mutex mutex_;
  std::vector<FoundEndpoint> queue_;  // guarded by mutex_
};

}  // namespace giveway::link
