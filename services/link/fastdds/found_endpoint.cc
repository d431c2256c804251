#include "services/link/fastdds/found_endpoint.h"

#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <string_view>
#include <utility>

namespace giveway::link {
namespace {

// Of a loop that hangs while a large fleet comes: those beyond are not looked at.
constexpr std::size_t kMostQueued = 2048;
constexpr std::string_view kHex = "0123456789abcdef";

struct Vendor {
  std::uint8_t second;  // the first byte is 1
  std::string_view name;
};
// Of the list that the OMG keeps (www.dds-foundation.org/dds-rtps-vendor-and-product-ids).
constexpr std::array kVendors = {Vendor{0x01, "RTI Connext DDS"},
                                 Vendor{0x02, "ADLINK OpenSplice DDS"},
                                 Vendor{0x03, "OCI OpenDDS"},
                                 Vendor{0x06, "CoreDX DDS"},
                                 Vendor{0x0d, "ADLINK Vortex DDS"},
                                 Vendor{0x0f, "eProsima Fast DDS"},
                                 Vendor{0x10, "Eclipse Cyclone DDS"},
                                 Vendor{0x11, "GurumDDS"},
                                 Vendor{0x12, "RustDDS"},
                                 Vendor{0x14, "Dust DDS"}};
constexpr std::uint8_t kOurVendor = 0x0f;

bool IsWildcard(std::string_view name) { return name.find_first_of("*?[") != name.npos; }

bool NamesMatch(const std::string& a, const std::string& b) {
  if (IsWildcard(a) && IsWildcard(b)) return a == b;
  if (IsWildcard(a)) return fnmatch(a.c_str(), b.c_str(), 0) == 0;
  if (IsWildcard(b)) return fnmatch(b.c_str(), a.c_str(), 0) == 0;
  return a == b;
}

std::string Text(std::int64_t duration_ns) {
  if (duration_ns == kEndless) return "endless";
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), double(duration_ns) * 1e-6).ptr;
  return std::string(text.data(), end) + " ms";
}

std::string_view NameOf(int kind, std::span<const std::string_view> names) {
  const auto place = static_cast<std::size_t>(kind);  // of a negative one beyond every name
  return place < names.size() ? names[place] : "unknown";
}
constexpr std::array<std::string_view, 4> kDurabilities = {"VOLATILE", "TRANSIENT_LOCAL",
                                                           "TRANSIENT", "PERSISTENT"};
constexpr std::array<std::string_view, 3> kLivelinesses = {"AUTOMATIC", "MANUAL_BY_PARTICIPANT",
                                                           "MANUAL_BY_TOPIC"};

}  // namespace

bool AreOfOneParticipant(const FoundEndpoint& a, const FoundEndpoint& b) {
  return std::equal(a.guid.begin(), a.guid.begin() + 12, b.guid.begin());
}

bool HasPartition(const FoundEndpoint& endpoint) {
  return std::ranges::any_of(endpoint.partitions,
                             [](const std::string& name) { return !name.empty(); });
}

bool PartitionsMatch(const FoundEndpoint& a, const FoundEndpoint& b) {
  // The library matches no wildcard with the default partition.
  if (!HasPartition(a) || !HasPartition(b)) return !HasPartition(a) && !HasPartition(b);
  return std::ranges::any_of(a.partitions, [&](const std::string& name) {
    return std::ranges::any_of(b.partitions,
                               [&](const std::string& other) { return NamesMatch(name, other); });
  });
}

std::string Misfit(const FoundEndpoint& writer, const FoundEndpoint& reader) {
  std::string text;
  const auto add = [&](bool holds, std::string_view policy, std::string_view offered,
                       std::string_view requested) {
    if (holds) return;
    text += std::string(text.empty() ? "" : "; ") + std::string(policy) + " offered " +
            std::string(offered) + ", requested " + std::string(requested);
  };
  if (writer.type != reader.type)
    text = "type " + writer.type + " written, " + reader.type + " read";
  add(writer.reliable || !reader.reliable, "reliability", "BEST_EFFORT", "RELIABLE");
  add(writer.durability >= reader.durability, "durability",
      NameOf(writer.durability, kDurabilities), NameOf(reader.durability, kDurabilities));
  add(writer.deadline_ns <= reader.deadline_ns, "deadline", Text(writer.deadline_ns),
      Text(reader.deadline_ns));
  add(writer.liveliness >= reader.liveliness, "liveliness",
      NameOf(writer.liveliness, kLivelinesses), NameOf(reader.liveliness, kLivelinesses));
  add(writer.lease_ns <= reader.lease_ns, "lease", Text(writer.lease_ns), Text(reader.lease_ns));
  const auto ownership = [](bool exclusive) { return exclusive ? "EXCLUSIVE" : "SHARED"; };
  add(writer.exclusive == reader.exclusive, "ownership", ownership(writer.exclusive),
      ownership(reader.exclusive));
  return text;
}

std::string VendorOf(const std::array<std::uint8_t, 16>& guid) {
  const auto vendor = std::ranges::find(kVendors, guid[1], &Vendor::second);
  if (guid[0] == 1 && vendor != kVendors.end()) return std::string(vendor->name);
  std::string text = "vendor 0x";
  for (const std::uint8_t byte : {guid[0], guid[1]}) {
    text += kHex[byte >> 4U];
    text += kHex[byte & 15U];
  }
  return text;
}

bool IsOurVendor(const std::array<std::uint8_t, 16>& guid) {
  return guid[0] == 1 && guid[1] == kOurVendor;
}

std::string PartitionText(const FoundEndpoint& endpoint) {
  if (!HasPartition(endpoint)) return "no partition";
  std::string text;
  for (const std::string& name : endpoint.partitions) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string ParticipantText(const std::array<std::uint8_t, 16>& guid) {
  std::string text;
  for (std::size_t i = 0; i < 12; ++i) {
    text += kHex[guid[i] >> 4U];
    text += kHex[guid[i] & 15U];
  }
  return text;
}

void EndpointQueue::Add(FoundEndpoint found) {
  const std::scoped_lock lock(mutex_);
  if (queue_.size() < kMostQueued) queue_.push_back(std::move(found));
}

std::vector<FoundEndpoint> EndpointQueue::Take() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(queue_, {});
}

}  // namespace giveway::link
