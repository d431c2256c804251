#include "services/fleetctl/survey/why_situation.h"

#include <fmt/format.h>

#include <boost/uuid/detail/md5.hpp>
#include <set>

namespace giveway::fleetctl {
namespace {

constexpr std::uint32_t kLoopback = 127;  // first number of its addresses

bool IsLoopback(std::uint32_t address) { return address >> 24U == kLoopback; }

}  // namespace

std::string NameOf(const ProcessSituation& process) {
  if (process.launch.is_world) return fmt::format("the world (pid {})", process.pid);
  if (process.launch.id == kNoVehicle) return fmt::format("pid {}", process.pid);
  return fmt::format("vehicle {} (pid {})", Number(process.launch.id), process.pid);
}

std::string AddressText(std::uint32_t address) {
  return fmt::format("{}.{}.{}.{}", address >> 24U, address >> 16U & 0xffU, address >> 8U & 0xffU,
                     address & 0xffU);
}

std::vector<NetworkAddress> AllowedAddresses(const ProcessSituation& process) {
  std::vector<NetworkAddress> allowed;
  const std::string& wanted = process.launch.interface;
  for (const NetworkAddress& one : process.addresses.value_or(std::vector<NetworkAddress>{})) {
    if (wanted == "any" || wanted == one.interface || wanted == AddressText(one.address)) {
      allowed.push_back(one);
    }
  }
  return allowed;
}

std::optional<std::uint16_t> HostId(const ProcessSituation& process) {
  if (!process.addresses) return std::nullopt;
  boost::uuids::detail::md5 sum;
  bool any = false;
  for (const NetworkAddress& one : *process.addresses) {
    if (IsLoopback(one.address)) continue;
    any = true;
    std::array<std::uint8_t, 16> locator{};  // an IPv4 address stands in its last four bytes
    for (std::size_t i = 0; i < 4; ++i) {
      locator[12 + i] = static_cast<std::uint8_t>(one.address >> (24U - 8U * i));
    }
    sum.process_bytes(locator.data(), locator.size());
  }
  if (!any) return std::uint16_t{0x017f};
  boost::uuids::detail::md5::digest_type digest;
  sum.get_digest(digest);
  static_assert(sizeof(digest[0]) == 4, "four words, the first byte of each the highest");
  std::uint32_t id = 0;
  for (const std::uint32_t word : digest) id ^= word ^ word >> 16U;
  return static_cast<std::uint16_t>(id);
}

std::optional<std::int64_t> ParticipantNumber(const ProcessSituation& process, qos::Policy policy) {
  if (!process.profiles) return std::nullopt;
  const auto* profile = process.profiles->Find(qos::Owner::kParticipant, qos::kParticipantProfile);
  if (profile == nullptr) return std::nullopt;
  return profile->Number(policy);
}

std::optional<std::int64_t> DiscoveryProtocol(const ProcessSituation& process) {
  if (!process.launch.discovery_servers.empty()) return qos::kClient;
  return ParticipantNumber(process, qos::Policy::kDiscoveryProtocol);
}

bool UsesSharedMemory(const ProcessSituation& process) {
  return process.profiles && !process.launch.leaves_out_shared_memory &&
         qos::UsesSharedMemory(*process.profiles);
}

std::vector<std::uint32_t> ParticipantIds(const ProcessSituation& process) {
  const auto number = [&](qos::Policy policy, std::int64_t otherwise) {
    return ParticipantNumber(process, policy).value_or(otherwise);
  };
  const std::int64_t gain = number(qos::Policy::kDomainGain, 250);
  const std::int64_t each = std::max<std::int64_t>(number(qos::Policy::kParticipantGain, 2), 1);
  const std::int64_t first = number(qos::Policy::kPortBase, 7400) + gain * process.launch.domain +
                             number(qos::Policy::kOffset1, 10);
  std::set<std::uint32_t> ids;
  for (const std::uint16_t port : process.ports.value_or(std::vector<std::uint16_t>{})) {
    const std::int64_t beyond = port - first;
    if (beyond < 0 || beyond >= gain || beyond % each != 0) continue;
    ids.insert(static_cast<std::uint32_t>(beyond / each));
  }
  return {ids.begin(), ids.end()};
}

}  // namespace giveway::fleetctl
