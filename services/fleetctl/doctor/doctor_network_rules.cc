// The rules of `fleetctl doctor` about interfaces, buffers and ports.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "services/fleetctl/doctor/doctor_rules.h"
#include "services/fleetctl/output/finding_text.h"
#include "services/qos/deployment.h"

namespace giveway::fleetctl {
namespace {

using qos::Severity;

constexpr std::int64_t kLastPort = 65'535;
constexpr std::size_t kPortsShown = 8;

std::int64_t Planned(const HostFacts& host, qos::Policy policy, std::int64_t otherwise) {
  return ParticipantNumber(host.planned, policy).value_or(otherwise);
}

// The ports of one domain, by the formula of RTPS 9.6.2 and the planned set.
struct DomainPorts {
  DomainPorts(const HostFacts& host, std::uint32_t domain)
      : gain(Planned(host, qos::Policy::kDomainGain, 250)),
        first(Planned(host, qos::Policy::kPortBase, 7400) + gain * domain),
        each(std::max<std::int64_t>(Planned(host, qos::Policy::kParticipantGain, 2), 1)),
        discovery(Planned(host, qos::Policy::kOffset1, 10)),
        data(Planned(host, qos::Policy::kOffset3, 11)) {}

  bool Contains(std::int64_t port) const { return port >= first && port < first + gain; }
  std::int64_t DiscoveryOf(std::int64_t participant) const {
    return first + discovery + each * participant;
  }
  std::int64_t DataOf(std::int64_t participant) const { return first + data + each * participant; }
  std::int64_t Last() const { return std::min(first + gain - 1, kLastPort); }

  std::int64_t gain, first, each, discovery, data;
};

// Participants that will run but do not yet: the vehicles, the world and an observer.
std::int64_t ToCome(const HostFacts& host, std::uint32_t domain) {
  const auto running =
      std::ranges::count(host.processes, domain,
                         [](const ProcessSituation& process) { return process.launch.domain; });
  return std::max<std::int64_t>(host.vehicles + qos::kOtherParticipants - running, 0);
}

std::string Listed(const std::set<std::uint16_t>& ports) {
  std::string text;
  std::size_t shown = 0;
  for (const std::uint16_t port : ports) {
    if (shown++ == kPortsShown) return text + ", ...";
    text += (text.empty() ? "" : ", ") + std::to_string(port);
  }
  return text;
}

void Add(Severity severity, const char* rule, std::string values, std::string consequence,
         std::string remedy, qos::Findings* findings) {
  findings->push_back(
      {severity, rule, {}, "", std::move(values), std::move(consequence), std::move(remedy)});
}

void CheckTaken(const HostFacts& host, const DomainPorts& ports, std::uint32_t domain,
                qos::Findings* findings) {
  if (!host.tool_ports) return;  // they may be theirs
  std::set<std::uint16_t> strange;
  for (const std::uint16_t port : *host.ports) {
    if (ports.Contains(port)) strange.insert(port);
  }
  for (const ProcessSituation& process : host.processes) {
    if (process.launch.domain == domain && !process.ports) return;  // they may be its
    for (const std::uint16_t port : process.ports.value_or(std::vector<std::uint16_t>{})) {
      strange.erase(port);
    }
  }
  for (const std::uint16_t port : *host.tool_ports) strange.erase(port);
  if (strange.empty()) return;
  Add(Severity::kWarning, "ports_taken",
      fmt::format("domain {}: no process of a fleet holds {} of it: {}", domain,
                  Counted(strange.size(), "UDP port"), Listed(strange)),
      "Another DDS program in the domain hears the fleet and is heard; any other takes the place "
      "of "
      "a participant, and who is asked by a list of hosts may stand too far back.",
      "another --domain, or end that program (ss -ulpn names it)", findings);
}

void CheckIds(const HostFacts& host, const DomainPorts& ports, std::uint32_t domain,
              qos::Findings* findings) {
  const std::set<std::int64_t> taken(host.ports->begin(), host.ports->end());
  const std::int64_t attempts = Planned(host, qos::Policy::kMutationTries, 100);
  std::int64_t free = 0;
  std::int64_t free_inside = 0;
  for (std::int64_t id = 0; id < attempts && ports.DataOf(id) <= kLastPort; ++id) {
    if (taken.contains(ports.DiscoveryOf(id)) || taken.contains(ports.DataOf(id))) continue;
    ++free;
    if (ports.DataOf(id) <= ports.Last()) ++free_inside;
  }
  const std::int64_t needed = ToCome(host, domain);
  const std::string values = fmt::format(
      "domain {}: of {} participant ids that are tried {} are free, {} of them with ports of the "
      "domain; {} to come",
      domain, attempts, free, free_inside,
      Counted(static_cast<std::size_t>(needed), "participant"));
  if (free < needed) {
    Add(Severity::kError, "participant_ids_short", values,
        fmt::format("The last {} find no free port, and do not start.", needed - free),
        "end what holds the ports, an unused domain, a higher mutation_tries, or fewer "
        "vehicles on this host",
        findings);
  } else if (free_inside < needed) {
    Add(Severity::kWarning, "ports_of_next_domain", values,
        "The last ones take ports of the next domain, and a fleet there takes theirs.",
        "leave the next domain unused, or fewer vehicles on this host", findings);
  }
}

bool IsReserved(const HostFacts& host, std::int64_t port) {
  return std::ranges::any_of(host.reserved, [port](const PortRange& range) {
    return port >= range.first && port <= range.last;
  });
}

std::string Shown(const HostInterface& one) { return one.name + " (" + one.address + ")"; }

// What is wrong with discovery by multicast on one of the selected interfaces.
void CheckCarries(const HostFacts& host, const HostInterface& one, qos::Findings* findings) {
  const bool refuses = one.echoes_multicast == false;
  if (!refuses && (one.says_multicast || one.loopback)) return;
  Add(refuses ? Severity::kError : Severity::kWarning, "multicast_missing",
      fmt::format("--interface {}: {} {}", host.planned.launch.interface, Shown(one),
                  refuses ? "gives back nothing that is sent to 239.255.0.1, not even on this host"
                          : "says that it carries no multicast"),
      refuses
          ? "No participant receives the first announcements of others, and no two vehicles meet."
          : "Vehicles of this host may meet; whether any on other hosts do, the network decides.",
      refuses ? "let UDP to 239.255.0.1 pass the firewall, or --qos wan_discovery_server"
              : "ip link set " + one.name + " multicast on, or --qos wan_discovery_server",
      findings);
}

}  // namespace

void CheckMulticast(const HostFacts& host, qos::Findings* findings) {
  const std::string& wanted = host.planned.launch.interface;
  std::vector<HostInterface> meant;
  std::string there;
  for (const HostInterface& one : host.interfaces) {
    if (wanted == "any" || wanted == one.name || wanted == one.address) meant.push_back(one);
    there += (there.empty() ? "" : ", ") + Shown(one);
  }
  const bool any_up = std::ranges::any_of(meant, &HostInterface::up);
  if (!any_up) {
    Add(Severity::kError, "interface_missing",
        fmt::format("--interface {}: {}", wanted,
                    meant.empty() ? "there is " + (there.empty() ? "none" : "only " + there)
                                  : Shown(meant.front()) + " is down"),
        "No service starts, or none hears another.",
        "name one that is there with --interface; ip link set lo up brings up the loopback",
        findings);
    return;
  }
  if (DiscoveryProtocol(host.planned).value_or(qos::kSimple) != qos::kSimple) return;
  for (const HostInterface& one : meant) {
    if (one.up) CheckCarries(host, one, findings);
  }
}

void CheckReceiveBuffer(const HostFacts& host, qos::Findings* findings) {
  if (!host.receive_buffer_max || !host.planned.profiles) return;
  for (const qos::Transport& transport : host.planned.profiles->transports) {
    const auto wanted = transport.numbers.find("receiveBufferSize");
    if (transport.type != "UDPv4" || wanted == transport.numbers.end()) continue;
    const std::int64_t granted = std::min(wanted->second.number, *host.receive_buffer_max);
    const std::int64_t needed = host.vehicles * qos::kDatagramBytes;
    if (granted >= needed || granted == wanted->second.number)
      continue;  // else `qos check` reports it
    Add(Severity::kWarning, "receive_buffer_small",
        fmt::format("the set asks for {} bytes, net.core.rmem_max grants {}; {} vehicles need {}",
                    wanted->second.number, granted, host.vehicles, needed),
        "The fleet speaks on common ticks: what comes beyond the buffer is dropped unseen.",
        fmt::format("sysctl -w net.core.rmem_max={}", wanted->second.number), findings);
  }
}

void CheckPorts(const HostFacts& host, qos::Findings* findings) {
  if (!host.ports) return;
  for (const std::uint32_t domain : host.domains) {
    const DomainPorts ports(host, domain);
    CheckTaken(host, ports, domain, findings);
    CheckIds(host, ports, domain, findings);
  }
}

void CheckEphemeralPorts(const HostFacts& host, qos::Findings* findings) {
  if (!host.ephemeral) return;
  for (const std::uint32_t domain : host.domains) {
    const DomainPorts ports(host, domain);
    const std::int64_t from = std::max<std::int64_t>(ports.first, host.ephemeral->first);
    const std::int64_t to = std::min<std::int64_t>(ports.Last(), host.ephemeral->last);
    std::int64_t open = 0;
    for (std::int64_t port = from; port <= to; ++port) open += IsReserved(host, port) ? 0 : 1;
    if (open == 0) continue;
    Add(Severity::kWarning, "ephemeral_ports",
        fmt::format(
            "domain {} has ports {} to {}; the system gives any program those from {} to {}",
            domain, ports.first, ports.Last(), host.ephemeral->first, host.ephemeral->last),
        "Any program may hold a port of a vehicle by chance: now and then one does not start, or "
        "stands too far back to be asked.",
        fmt::format("a lower domain, or sysctl -w net.ipv4.ip_local_reserved_ports={}-{}",
                    ports.first, ports.Last()),
        findings);
  }
}

}  // namespace giveway::fleetctl
