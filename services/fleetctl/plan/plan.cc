#include "services/fleetctl/plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "services/fleetctl/plan/plan_costs.h"
#include "services/qos/profile_set.h"

namespace giveway::fleetctl {
namespace {

// Above these shares of what is available, the plan warns and refuses. A fleet that took 97 % of
// two cores had beacons four times as old as one that took 25 %.
constexpr double kBusy = 0.5;
constexpr double kFull = 0.9;

std::uint32_t CeilShare(std::uint32_t whole, std::uint32_t parts) {
  return (whole + parts - 1) / parts;
}

double AnnouncementSeconds(const PlanRequest& request) {
  if (request.vehicles > qos::kLargeFleet) return qos::kLargeFleetAnnouncementNs / 1e9;
  const qos::XmlRead read = qos::ReadXml(request.set.bytes, request.set.name);
  if (!read.root) return 1;  // the findings say that it is not a set
  const qos::ProfileSet set = qos::ReadProfiles(*read.root, request.set.name);
  const qos::Profile* profile = set.Find(qos::Owner::kParticipant, "giveway_participant");
  return profile == nullptr
             ? 1
             : static_cast<double>(profile->Number(qos::Policy::kAnnouncement)) / 1e9;
}

// The fleet's numbers, from which rows and findings are made.
class Reckoning {
 public:
  explicit Reckoning(const PlanRequest& request)
      : request_(request),
        costs_(CostsWith(request.library_major)),
        n_(request.vehicles),
        on_host_(CeilShare(request.vehicles, request.hosts)),
        peers_(request.vehicles - 1),
        rate_(1e9 / static_cast<double>(request.tick_ns)),
        pace_(rate_ / costs_.ticks_per_s) {}

  double OnHost() const { return on_host_; }
  double Participants() const { return n_ + qos::kOtherParticipants; }
  double ParticipantsOnHost() const { return OnHost() + qos::kOtherParticipants; }

  double VehicleCpu() const {
    return pace_ * (costs_.vehicle_cpu + costs_.vehicle_cpu_a_peer * peers_) / 1000;
  }
  double OthersCpu() const {
    const double a_vehicle = costs_.world_cpu_a_vehicle + costs_.observer_cpu_a_vehicle;
    return pace_ * (costs_.world_cpu + costs_.observer_cpu + a_vehicle * n_) / 1000;
  }
  double VehicleMib() const { return costs_.vehicle_mib + costs_.vehicle_mib_a_peer * peers_; }
  double OthersMib() const {
    const double a_vehicle = costs_.world_mib_a_vehicle + costs_.observer_mib_a_vehicle;
    return costs_.world_mib + costs_.observer_mib + a_vehicle * n_;
  }
  double SamplesHeard() const { return rate_ * (peers_ + 1); }  // beacons, and its ranges
  double DiscoveryPackets() const { return costs_.discovery_packets_a_pair * n_ * peers_; }
  double VehiclePackets() const { return rate_ * peers_ + pace_ * costs_.packets_a_vehicle; }
  // What one host sends to others: a beacon goes to each peer separately, wherever it is.
  double LinkMbit() const {
    if (request_.hosts < 2) return 0;
    const double elsewhere = n_ - OnHost();
    const double beacons = OnHost() * rate_ * elsewhere;
    const double world = pace_ * costs_.packets_a_vehicle * elsewhere;
    return (beacons + world) * costs_.bytes_a_packet * 8 / 1e6;
  }
  double HostCpu() const { return OnHost() * VehicleCpu() + OthersCpu(); }
  double HostMib() const { return OnHost() * VehicleMib() + OthersMib(); }

  // Of participants that announce themselves once in so many seconds.
  std::vector<PlanRow> Rows(double announcement_s) const;

 private:
  const PlanRequest& request_;
  const Costs costs_;
  const double n_;
  const double on_host_;
  const double peers_;
  const double rate_;  // ticks a second
  const double pace_;  // of that at which the costs were measured
};

std::vector<PlanRow> Reckoning::Rows(double announcement_s) const {
  const double announcements = Participants() * Participants() / announcement_s;
  const auto each = [&](std::string name, double one) {
    return PlanRow{std::move(name), one, one * ParticipantsOnHost(), one * Participants(), {}};
  };
  PlanRow link{"sent to other hosts, Mbit/s",
               {},
               LinkMbit(),
               LinkMbit() * request_.hosts,
               request_.link_mbit_s};
  return {
      each("participants", 1),
      each("threads", costs_.threads),
      each("UDP sockets", costs_.sockets),
      each("open descriptors", costs_.descriptors),
      {"instances of fleet/beacon", peers_ + 1, {}, n_, {}},
      {"memory, MiB", VehicleMib(), HostMib(), n_ * VehicleMib() + OthersMib(),
       request_.memory_mib},
      {"processor, cores", VehicleCpu(), HostCpu(), n_ * VehicleCpu() + OthersCpu(),
       request_.cores},
      {"samples received/s", SamplesHeard(), OnHost() * SamplesHeard(), n_ * SamplesHeard(), {}},
      {"packets/s",
       VehiclePackets(),
       OnHost() * VehiclePackets(),
       n_ * VehiclePackets() + announcements,
       {}},
      {"announcements/s", {}, {}, announcements, {}},
      {"discovery, packets", {}, {}, DiscoveryPackets(), {}},
      std::move(link),
  };
}

// A finding if `used` comes near to what is available, or exceeds it.
void Hold(const char* rule, const std::string& values, double used, double there,
          const char* consequence, const char* remedy, qos::Findings* findings) {
  if (there <= 0 || used <= kBusy * there) return;
  const bool full = used > kFull * there;
  findings->push_back({full ? qos::Severity::kError : qos::Severity::kWarning,
                       rule,
                       {},
                       "",
                       values,
                       consequence,
                       remedy});
}

qos::Findings FindingsOf(const PlanRequest& request, const Reckoning& reckoning) {
  qos::Deployment deployment;
  deployment.vehicles = request.vehicles;
  deployment.vehicles_a_host =
      request.containers ? 1 : static_cast<std::int64_t>(reckoning.OnHost());
  deployment.tick_ns = request.tick_ns;
  qos::Findings findings = qos::Check({request.set}, deployment);
  Hold(
      "processor",
      fmt::format("{:.2f} cores of {:.2f} on the busiest host", reckoning.HostCpu(), request.cores),
      reckoning.HostCpu(), request.cores,
      "Loops wait for a core: beacons grow old, deadlines are missed without a fault.",
      "more hosts or cores, or fewer vehicles in a domain", &findings);
  Hold("memory",
       fmt::format("{:.0f} MiB of {:.0f} on the busiest host", reckoning.HostMib(),
                   request.memory_mib),
       reckoning.HostMib(), request.memory_mib, "The kernel kills one of the processes.",
       "more hosts or memory, or fewer vehicles", &findings);
  Hold("link",
       fmt::format("{:.0f} Mbit/s of {:.0f} from the busiest host", reckoning.LinkMbit(),
                   request.link_mbit_s),
       reckoning.LinkMbit(), request.link_mbit_s,
       "Beacons queue in the network card and are dropped.", "fewer vehicles in a domain",
       &findings);
  return findings;
}

bool HasError(const qos::Findings& findings) {
  return std::ranges::any_of(findings, [](const qos::Finding& finding) {
    return finding.severity == qos::Severity::kError;
  });
}

bool WouldFit(const PlanRequest& request) {
  return !HasError(FindingsOf(request, Reckoning(request)));
}

// The first of the numbers from `low` up to but without `end` for which `holds` is false, or `end`;
// it is true for all before and false for all after. Clang 14 does not compile the library's views.
template <typename Holds>
std::uint32_t FirstWithout(std::uint32_t low, std::uint32_t end, const Holds& holds) {
  while (low < end) {
    const std::uint32_t middle = low + (end - low) / 2;
    if (holds(middle)) {
      low = middle + 1;
    } else {
      end = middle;
    }
  }
  return low;
}

// If a number of vehicles does not fit, no larger one does; and from two hosts on, if a number of
// hosts does not suffice, no smaller one does.
void SeekWhatFits(const PlanRequest& request, PlanReport* report) {
  const auto fit = [&](std::uint32_t vehicles) {
    PlanRequest changed = request;
    changed.vehicles = vehicles;
    changed.hosts = std::min(vehicles, request.hosts);
    return WouldFit(changed);
  };
  const auto too_few = [&](std::uint32_t hosts) {
    PlanRequest changed = request;
    changed.hosts = hosts;
    return !WouldFit(changed);
  };
  const std::uint32_t first_too_many = FirstWithout(1, request.vehicles, fit);
  if (first_too_many > 1) report->fewer_vehicles = first_too_many - 1;
  const std::uint32_t enough = FirstWithout(request.hosts + 1, request.vehicles + 1, too_few);
  if (enough <= request.vehicles) report->more_hosts = enough;
}

}  // namespace

bool PlanReport::Fits() const { return !HasError(findings); }

PlanReport Plan(const PlanRequest& request) {
  const Reckoning reckoning(request);
  PlanReport report;
  report.rows = reckoning.Rows(AnnouncementSeconds(request));
  report.findings = FindingsOf(request, reckoning);
  if (!report.Fits()) SeekWhatFits(request, &report);
  return report;
}

}  // namespace giveway::fleetctl
