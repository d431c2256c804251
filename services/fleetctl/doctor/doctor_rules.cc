// The rules of `fleetctl doctor` about processes and clocks, and all rules together.
#include "services/fleetctl/doctor/doctor_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "services/qos/qos_rules.h"

namespace giveway::fleetctl {
namespace {

using qos::Severity;

// A slewed clock runs at most 500 ppm off: 0.1 ms in the window of a fifth of a second.
constexpr std::int64_t kStepNs = 1'000'000;
// fleetctl run held 22 descriptors with five processes, and each of those 20.
constexpr std::uint64_t kFilesEach = 2;
constexpr std::uint64_t kFilesAnyway = 64;

// Whether a sample can expire by the clocks of two machines.
bool UsesLifespan(const ProcessSituation& planned) {
  if (!planned.profiles) return false;
  return std::ranges::any_of(planned.profiles->profiles, [](const qos::Profile& profile) {
    return profile.owner == qos::Owner::kWriter && profile[qos::Policy::kLifespan].given &&
           profile.Number(qos::Policy::kLifespan) != qos::kInfinite;
  });
}

void Add(Severity severity, const char* rule, std::string subject, std::string values,
         std::string consequence, std::string remedy, qos::Findings* findings) {
  findings->push_back({severity,
                       rule,
                       {},
                       std::move(subject),
                       std::move(values),
                       std::move(consequence),
                       std::move(remedy)});
}

}  // namespace

void CheckSurroundings(const HostFacts& host, qos::Findings* findings) {
  // The processes of a fleet are mostly started alike: what is true of many is reported once.
  std::set<std::tuple<std::string, std::string, std::string>> said;
  for (const Surroundings& at : host.surroundings) {
    qos::Deployment deployment;
    deployment.environment = at.environment;
    deployment.folder_files = at.folder_files;
    qos::Findings found;
    qos::CheckSurroundings(deployment, &found);
    for (qos::Finding& finding : found) {
      if (!finding.place.file.empty()) finding.place.file = at.folder + "/" + finding.place.file;
      if (!said.insert({finding.rule, finding.subject, finding.place.file}).second) continue;
      finding.values += " of " + at.who;
      findings->push_back(std::move(finding));
    }
  }
}

void CheckClock(const HostFacts& host, qos::Findings* findings) {
  const bool lifespan = UsesLifespan(host.planned);
  const auto& offsets = host.clock.offsets_ns;
  if (!offsets.empty()) {
    const auto [least, most] = std::ranges::minmax(offsets);
    if (most - least > kStepNs) {
      Add(lifespan ? Severity::kError : Severity::kWarning, "clock_step", "",
          fmt::format("the wall clock was set by {:.1f} ms within {:.0f} ms",
                      static_cast<double>(most - least) * 1e-6,
                      static_cast<double>(host.clock.window_ns) * 1e-6),
          lifespan
              ? "LIFESPAN compares wall clocks: samples expire before they arrive, without a "
                "sign, or stay for too long."
              : "Times in logs jump. Vehicles decide by clocks that are never set, and are not "
                "touched; a LIFESPAN would be.",
          "one service alone that slews the clock (chrony without makestep); end date -s and "
          "others",
          findings);
    }
  }
  if (lifespan && host.clock.synchronised == false) {
    Add(Severity::kWarning, "clock_unsynchronised", "",
        "the kernel says that nothing keeps the wall clock",
        "The set has LIFESPAN, which compares the clocks of two machines: by 0.2 s apart a "
        "LIFESPAN "
        "of 0.2 s delivers nothing, without a sign.",
        "chrony or systemd-timesyncd on every host, or no LIFESPAN", findings);
  }
}

void CheckDescriptors(const HostFacts& host, qos::Findings* findings) {
  const std::uint64_t needed = kFilesAnyway + kFilesEach * (host.vehicles + 1ULL);
  if (host.open_files_limit && *host.open_files_limit < needed) {
    Add(Severity::kError, "descriptor_limit", "this shell",
        fmt::format("a process may open {} files; fleetctl run needs {} for {} vehicles",
                    *host.open_files_limit, needed, host.vehicles),
        "fleetctl run cannot start all of them.", fmt::format("ulimit -n {}", needed), findings);
  }
  for (const ProcessSituation& process : host.processes) {
    if (!process.open_files || !process.open_files_limit) continue;
    if (*process.open_files * 10 < *process.open_files_limit * 9) continue;
    Add(Severity::kWarning, "descriptor_limit", NameOf(process),
        fmt::format("{} of {} files are open", *process.open_files, *process.open_files_limit),
        "At the limit it opens no further socket, file or shared memory: it does not meet a "
        "participant that "
        "comes next.",
        "ulimit -n, LimitNOFILE= of systemd, or ulimits of the container", findings);
  }
}

qos::Findings Examine(const HostFacts& host) {
  qos::Findings findings;
  CheckMemoryFiles(host, &findings);
  CheckForeignFiles(host, &findings);
  CheckMemoryRoom(host, &findings);
  CheckMemoryShared(host, &findings);
  CheckHostIds(host, &findings);
  CheckMulticast(host, &findings);
  CheckReceiveBuffer(host, &findings);
  CheckPorts(host, &findings);
  CheckEphemeralPorts(host, &findings);
  CheckSurroundings(host, &findings);
  CheckClock(host, &findings);
  CheckDescriptors(host, &findings);
  std::ranges::stable_sort(findings, std::greater<>{}, &qos::Finding::severity);
  return findings;
}

}  // namespace giveway::fleetctl
