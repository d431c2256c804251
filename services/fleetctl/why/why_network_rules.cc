// Domains, networks, shared memory and discovery: whether the two meet at all.
#include <fmt/format.h>

#include <algorithm>

#include "services/fleetctl/why/why_rules.h"

namespace giveway::fleetctl {
namespace {

constexpr std::int64_t kPeersRange = 4;  // the library's default of maxInitialPeersRange

void Add(Weight weight, std::string rule, std::string values, std::string consequence,
         std::string remedy, Causes* causes) {
  const auto severity =
      weight == Weight::kPrevents ? qos::Severity::kError : qos::Severity::kWarning;
  causes->push_back({{severity,
                      std::move(rule),
                      {},
                      "",
                      std::move(values),
                      std::move(consequence),
                      std::move(remedy)},
                     weight});
}

// "vehicle 1 (pid 7) has X, vehicle 2 (pid 8) has Y".
std::string Both(const ProcessSituation& a, std::string_view a_has, const ProcessSituation& b,
                 std::string_view b_has) {
  return fmt::format("{} {}, {} {}", NameOf(a), a_has, NameOf(b), b_has);
}

std::int64_t NumberOr(std::int64_t otherwise, const ProcessSituation& process, qos::Policy policy) {
  return ParticipantNumber(process, policy).value_or(otherwise);
}

// The target of the first announcement: a multicast port that depends on the domain.
std::int64_t DiscoveryPort(const ProcessSituation& process) {
  return NumberOr(7400, process, qos::Policy::kPortBase) +
         NumberOr(250, process, qos::Policy::kDomainGain) * process.launch.domain +
         NumberOr(0, process, qos::Policy::kOffset0);
}

bool IsLoopback(const NetworkAddress& one) { return one.address >> 24U == 127; }

std::string Listed(const std::vector<NetworkAddress>& addresses) {
  std::string text;
  for (const NetworkAddress& one : addresses) {
    text += (text.empty() ? "" : ", ") + AddressText(one.address) + " on " +
            (one.interface.empty() ? "?" : one.interface);
  }
  return text.empty() ? "no address" : text;
}

std::string Where(const ProcessSituation& process) {
  return fmt::format("is in network namespace {} with {}", process.network_namespace.value_or(0),
                     Listed(AllowedAddresses(process)));
}

// Whether two in one network namespace receive each other's first announcements. As measured with
// Fast DDS 2.9.1: two whitelists need a common address, a common interface is not enough; and a
// participant with a whitelist never finds one without if there is more than the loopback.
bool MeetInside(const ProcessSituation& a, const ProcessSituation& b) {
  const auto allowed_a = AllowedAddresses(a);
  const auto allowed_b = AllowedAddresses(b);
  const bool any_a = a.launch.interface == "any";
  const bool any_b = b.launch.interface == "any";
  if (any_a != any_b && !std::ranges::all_of(*a.addresses, IsLoopback)) return false;
  return std::ranges::any_of(allowed_a, [&](const NetworkAddress& one) {
    return std::ranges::find(allowed_b, one) != allowed_b.end();
  });
}

// Networks that two namespaces may have in common.
bool ShareNetwork(const ProcessSituation& a, const ProcessSituation& b) {
  for (const NetworkAddress& one : AllowedAddresses(a)) {
    for (const NetworkAddress& other : AllowedAddresses(b)) {
      if (IsLoopback(one) || IsLoopback(other)) continue;
      if (one.mask == other.mask && (one.address & one.mask) == (other.address & other.mask)) {
        return true;
      }
    }
  }
  return false;
}

const qos::Participation* ParticipationOf(const ProcessSituation& process) {
  return process.profiles ? process.profiles->OurParticipation() : nullptr;
}

bool IsClient(std::int64_t protocol) {
  return protocol == qos::kClient || protocol == qos::kSuperClient;
}

std::int64_t PeersRange(const ProcessSituation& process) {
  std::int64_t range = kPeersRange;
  for (const qos::Transport& transport : process.profiles->transports) {
    const auto said = transport.numbers.find("maxInitialPeersRange");
    if (transport.type == "UDPv4" && said != transport.numbers.end()) range = said->second.number;
  }
  return range;
}

// True if the first announcements of `from` do not reach `to`: it contacts a list of hosts, only
// the first few participants of each, and `to` is not one of them.
bool AsksInVain(const ProcessSituation& from, const ProcessSituation& to) {
  const qos::Participation* const participation = ParticipationOf(from);
  if (participation == nullptr || participation->peers_without_port == 0) return false;
  const auto ids = ParticipantIds(to);
  return !ids.empty() &&
         std::ranges::all_of(ids, [&](std::uint32_t id) { return id >= PeersRange(from); });
}

}  // namespace

void CheckDomains(const ProcessSituation& hearer, const ProcessSituation& speaker, Causes* causes) {
  if (hearer.launch.domain == 0 || speaker.launch.domain == 0) return;
  if (hearer.launch.domain != speaker.launch.domain) {
    Add(Weight::kPrevents, "domain_apart",
        Both(hearer, fmt::format("is in domain {}", hearer.launch.domain), speaker,
             fmt::format("in domain {}", speaker.launch.domain)),
        "Domains use other ports, and participants of one never hear of the other's.",
        "start both with the same --domain", causes);
    return;
  }
  const std::int64_t a = DiscoveryPort(hearer);
  const std::int64_t b = DiscoveryPort(speaker);
  if (a == b) return;
  Add(Weight::kPrevents, "ports_apart",
      Both(hearer, fmt::format("announces itself at port {}", a), speaker,
           fmt::format("at port {}", b)),
      "The first announcement of each goes where the other does not listen.",
      "the same <port> elements in both profile sets", causes);
}

void CheckNetworks(const ProcessSituation& hearer, const ProcessSituation& speaker,
                   Causes* causes) {
  const bool known = hearer.network_namespace && speaker.network_namespace && hearer.addresses &&
                     speaker.addresses;
  if (!known) return;
  const std::string values = Both(hearer, Where(hearer), speaker, Where(speaker));
  if (hearer.network_namespace == speaker.network_namespace) {
    if (MeetInside(hearer, speaker)) return;
    Add(Weight::kPrevents, "whitelist_apart",
        Both(hearer,
             fmt::format("allows --interface {} ({})", hearer.launch.interface,
                         Listed(AllowedAddresses(hearer))),
             speaker,
             fmt::format("--interface {} ({})", speaker.launch.interface,
                         Listed(AllowedAddresses(speaker)))),
        "Each announces itself where the other does not listen.",
        "start both with the same --interface", causes);
    return;
  }
  if (ShareNetwork(hearer, speaker)) {
    Add(Weight::kMayPrevent, "network_between", values,
        "The addresses belong to one network; whether it joins the two namespaces is not known.",
        "none if the probe hears; else a bridge or veth pair between the two", causes);
    return;
  }
  Add(Weight::kPrevents, "network_apart", values,
      "No interface of one leads to the other, and a loopback ends in its own namespace.",
      "start both in one network namespace, or join the two by a veth pair or bridge and name its "
      "addresses with --interface",
      causes);
}

void CheckSharedMemory(const ProcessSituation& hearer, const ProcessSituation& speaker,
                       Causes* causes) {
  if (!UsesSharedMemory(hearer) || !UsesSharedMemory(speaker)) return;
  const auto a = HostId(hearer);
  const auto b = HostId(speaker);
  if (!a || !b || *a != *b || !hearer.shared_memory || !speaker.shared_memory) return;
  if (*hearer.shared_memory == *speaker.shared_memory) return;
  const auto file = [](const ProcessSituation& process) {
    return fmt::format("has /dev/shm {}:{}", process.shared_memory->device,
                       process.shared_memory->inode);
  };
  Add(Weight::kPrevents, "shared_memory_apart",
      fmt::format("{}; both have host id {:#06x}",
                  Both(hearer, file(hearer), speaker, file(speaker)), *a),
      "One host id makes Fast DDS send samples through shared memory alone, and the two have none "
      "in common.",
      "--ipc=host for both containers, or a profile set without SHM", causes);
}

void CheckDiscovery(const ProcessSituation& hearer, const ProcessSituation& speaker,
                    Causes* causes) {
  const auto a = DiscoveryProtocol(hearer);
  const auto b = DiscoveryProtocol(speaker);
  if (!a || !b) return;
  const auto text = [](std::int64_t protocol) {
    return "finds others by " + qos::Text(qos::Policy::kDiscoveryProtocol, protocol);
  };
  const std::string values = Both(hearer, text(*a), speaker, text(*b));
  if (*a == qos::kNone || *b == qos::kNone) {
    Add(Weight::kPrevents, "discovery_off", values,
        "A participant without discovery finds no peers.",
        "discoveryProtocol SIMPLE or CLIENT in both profile sets", causes);
  } else if (IsClient(*a) != IsClient(*b)) {
    Add(Weight::kPrevents, "discovery_apart", values,
        "A client asks its server alone, and does not answer multicast.",
        "the same discoveryProtocol in both profile sets, and --discovery-server for both or "
        "neither",
        causes);
  } else if (IsClient(*a)) {
    Add(Weight::kMayPrevent, "discovery_by_server", values,
        "They meet if both name one server and it runs, which is not known.",
        "none if the probe hears; else start fast-discovery-server", causes);
  } else if (AsksInVain(hearer, speaker) && AsksInVain(speaker, hearer)) {
    Add(Weight::kPrevents, "initial_peers_range",
        Both(hearer, fmt::format("is participant {}", ParticipantIds(hearer).front()), speaker,
             fmt::format("is {}; without a port initial peers reach only the first {}",
                         ParticipantIds(speaker).front(), PeersRange(hearer))),
        "Neither asks at the ports of the other.",
        "ports in <initialPeersList>, maxInitialPeersRange, or multicast", causes);
  }
}

}  // namespace giveway::fleetctl
