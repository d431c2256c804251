// Participant profiles against the fleet: which participant finds which, for how long one is
// remembered, and whether there are ports for all.
#include <algorithm>

#include "services/qos/qos_rules.h"

namespace giveway::qos {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kLongestLease = 60 * kSecond;
constexpr std::int64_t kShortestPause = 10'000'000;
constexpr std::int64_t kLastDomain = 99;
constexpr std::int64_t kLastPort = 65'535;
// Announcements a second in the whole fleet; 21 760 were half of what two cores can receive.
constexpr std::int64_t kMostAnnouncements = 20'000;

class ParticipantRules {
 public:
  ParticipantRules(const Profile& profile, const Participation& participation,
                   const Deployment& deployment, Findings* findings)
      : profile_(profile),
        participation_(participation),
        participants_(deployment.vehicles + kOtherParticipants),
        on_host_(deployment.vehicles_a_host == 0 ? participants_
                                                 : deployment.vehicles_a_host + kOtherParticipants),
        findings_(*findings) {}

  void CheckLease();
  void CheckPause(Policy policy);
  void CheckDiscovery();
  void CheckIdentity();
  void CheckPorts();
  void CheckReach();
  void CheckOverridden();

 private:
  std::int64_t Number(Policy policy) const { return profile_.Number(policy); }
  void Add(Severity severity, const std::string& rule, Policy at, const std::string& against,
           std::string consequence, std::string remedy) {
    AddAt(PlaceOf(profile_, at), severity, rule,
          std::string(Info(at).name) + " " + StatedValue(profile_, at) + against,
          std::move(consequence), std::move(remedy));
  }
  void AddAt(const Place& place, Severity severity, const std::string& rule, std::string values,
             std::string consequence, std::string remedy) {
    findings_.push_back({severity, rule, place, profile_.name, std::move(values),
                         std::move(consequence), std::move(remedy)});
  }
  std::string There() const { return "; " + std::to_string(participants_) + " participants"; }
  std::string ThereOnHost() const { return "; " + std::to_string(on_host_) + " participants"; }

  const Profile& profile_;
  const Participation& participation_;
  std::int64_t participants_;
  std::int64_t on_host_;  // of them
  Findings& findings_;
};

void ParticipantRules::CheckLease() {
  const std::int64_t lease = Number(Policy::kParticipantLease);
  const std::int64_t announcement = Number(Policy::kAnnouncement);
  if (lease <= announcement) {
    Add(Severity::kError, "participant_lease_too_short", Policy::kParticipantLease,
        " is not above the announcement period of " + StatedValue(profile_, Policy::kAnnouncement),
        "Living participants are forgotten between two announcements, or the library refuses to "
        "start.",
        "a lease of several announcement periods");
  } else if (lease > kLongestLease) {
    Add(Severity::kWarning, "participant_lease_too_long", Policy::kParticipantLease, "",
        "A process that was killed keeps its place, its ports and its samples for that long.",
        "10 s, announced every 1 s");
  }
  CheckPause(Policy::kAnnouncement);
  CheckPause(Policy::kInitialAnnouncementPeriod);
  CheckPause(Policy::kClientAnnouncement);
  const std::int64_t others = std::min(participants_, kLargeFleet);
  if (announcement > 0 && others * others * kSecond / announcement > kMostAnnouncements) {
    Add(Severity::kWarning, "announcement_storm", Policy::kAnnouncement, There(),
        "Every participant announces to every other: " +
            std::to_string(others * others * kSecond / announcement) + " packets a second.",
        "announce every 1 s");
  }
  if (Number(Policy::kInitialAnnouncements) == 0) {
    Add(Severity::kWarning, "no_initial_announcement", Policy::kInitialAnnouncements, "",
        "A new participant is found only by the next periodic announcement.", "5, every 100 ms");
  }
}

// The library takes a pause of nothing for as often as it can: 212 994 datagrams in 4 s.
void ParticipantRules::CheckPause(Policy policy) {
  if (Number(policy) >= kShortestPause) return;
  Add(Severity::kError, "announcement_without_pause", policy, "",
      "Every process announces itself as often as it can, and the network holds nothing else.",
      "at least " + DurationText(kShortestPause));
}

void ParticipantRules::CheckDiscovery() {
  const std::int64_t protocol = Number(Policy::kDiscoveryProtocol);
  if (protocol == kNone) {
    Add(Severity::kError, "discovery_off", Policy::kDiscoveryProtocol, "",
        "No participant is found.", "SIMPLE, or CLIENT with a server");
  } else if (protocol == kServer || protocol == kBackup) {
    Add(Severity::kError, "server_for_all", Policy::kDiscoveryProtocol, "",
        "Every process of the fleet takes this profile, and all would be the same server.",
        "CLIENT here; the server is a process of its own");
  } else if (protocol != kSimple && participation_.servers.empty()) {
    Add(Severity::kError, "discovery_server_missing", Policy::kDiscoveryProtocol,
        " without a discoveryServersList", "A client without a server finds no participant.",
        "name the server's prefix and address");
  }
  if (participation_.static_discovery) {
    AddAt(participation_.static_place, Severity::kError, "static_discovery", "EDP STATIC",
          "Endpoints are found from a list in a file, and vehicles come and go.", "SIMPLE");
  }
  if (Number(Policy::kLivelinessProtocol) == 0) {
    Add(Severity::kWarning, "liveliness_protocol_off", Policy::kLivelinessProtocol, "",
        "Liveliness that is not asserted by samples is never reported to any process.", "true");
  }
}

void ParticipantRules::CheckIdentity() {
  if (!participation_.prefix.empty() && Number(Policy::kDiscoveryProtocol) < kServer) {
    AddAt(
        profile_.place, Severity::kError, "guid_prefix_fixed", "prefix " + participation_.prefix,
        "Every process takes this profile; with one identity they take each other for themselves.",
        "remove it");
  }
  if (Number(Policy::kParticipantId) >= 0) {
    Add(Severity::kError, "participant_id_fixed", Policy::kParticipantId, There(),
        "All ask for the ports of one participant, and all but the first fail or get another's.",
        "remove it");
  }
  const std::string& flags = participation_.ignore_flags;
  if (flags.find("FILTER_") == std::string::npos) return;
  const bool process = flags.find("DIFFERENT_PROCESS") != std::string::npos;
  AddAt(participation_.ignore_place, process ? Severity::kError : Severity::kWarning,
        "participants_ignored", "ignoreParticipantFlags " + flags,
        process ? "Every vehicle is a process of its own, and they ignore each other."
                : "Participants that this flag names are ignored without a sign.",
        "remove it");
}

void ParticipantRules::CheckPorts() {
  const std::int64_t base = Number(Policy::kPortBase);
  const std::int64_t domain = Number(Policy::kDomainGain);
  const std::int64_t each = Number(Policy::kParticipantGain);
  const std::int64_t offset = std::max(Number(Policy::kOffset1), Number(Policy::kOffset3));
  const std::int64_t highest = offset + each * (on_host_ - 1);
  if (Number(Policy::kMutationTries) < on_host_) {
    Add(Severity::kError, "participant_limit", Policy::kMutationTries, ThereOnHost(),
        "On one host the later ones find no free port, and do not start.",
        "at least one for each participant on a host");
  }
  if (each < 2) {
    Add(Severity::kError, "participant_gain", Policy::kParticipantGain, "",
        "Each participant needs two ports; neighbours take each other's.", "2");
  }
  if (base + domain * kLastDomain + highest > kLastPort) {
    Add(Severity::kError, "port_out_of_range", Policy::kDomainGain,
        "; port_base " + StatedValue(profile_, Policy::kPortBase) +
            ", domains up to 99 reach port " +
            std::to_string(base + domain * kLastDomain + highest),
        "Participants of the higher domains have no port, and do not start.",
        "the default: 7400 and 250");
  }
  if (highest >= domain) {
    Add(Severity::kWarning, "port_overlap", Policy::kDomainGain, ThereOnHost(),
        "The ports of the last participants on one host are those of the next domain.",
        "use every second domain, or fewer vehicles on a host");
  }
}

void ParticipantRules::CheckReach() {
  if (participation_.peers_without_port > 0 && on_host_ > 4) {
    AddAt(participation_.peers_place, Severity::kWarning, "initial_peers_range",
          "initial peers without a port" + ThereOnHost(),
          "Only the first four participants of such a host are asked.",
          "maxInitialPeersRange of the transport, or multicast");
  }
  if (Number(Policy::kAvoidBuiltinMulticast) == 0) {
    Add(Severity::kWarning, "multicast_endpoint_discovery", Policy::kAvoidBuiltinMulticast, "",
        "Discovery of endpoints goes to all by multicast, which radio links send slowest.", "true");
  }
}

void ParticipantRules::CheckOverridden() {
  for (const auto& [name, place] : participation_.limits) {
    if (name == "throughputController") {
      AddAt(place, Severity::kWarning, "throughput_limited", name,
            "Samples beyond the limit wait, and arrive older.", "remove it");
    } else {
      AddAt(place, Severity::kWarning, "overridden_by_code", "<" + name + ">",
            "The services set it themselves, and this has no effect.", "remove it");
    }
  }
}

}  // namespace

void CheckParticipants(const ProfileSet& set, const Deployment& deployment, Findings* findings) {
  for (const Participation& participation : set.participations) {
    const Profile* profile = set.Find(Owner::kParticipant, participation.profile);
    if (profile == nullptr) continue;
    ParticipantRules rules(*profile, participation, deployment, findings);
    rules.CheckLease();
    rules.CheckDiscovery();
    rules.CheckIdentity();
    rules.CheckPorts();
    rules.CheckReach();
    rules.CheckOverridden();
  }
}

}  // namespace giveway::qos
