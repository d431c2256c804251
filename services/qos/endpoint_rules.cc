// One writer or reader, whatever its topic: limits that contradict each other, and what Fast DDS
// does with some values. One set serves the fleet, which may mix 2.9 and 3.1: a hazard of either
// is a finding.
#include "services/qos/qos_rules.h"

namespace giveway::qos {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr char kWithoutService[] =
    "There is no persistence service: Fast DDS 2.9 refuses the endpoint, and nothing starts; 3.1 "
    "keeps nothing beyond the writer's life.";

class EndpointRules {
 public:
  EndpointRules(const Profile& profile, Findings* findings)
      : profile_(profile), findings_(*findings) {}

  void CheckLimits();
  void CheckDurability();
  void CheckLiveliness();
  void CheckTimes();
  void CheckPaths();

 private:
  std::int64_t Number(Policy policy) const { return profile_.Number(policy); }
  void Add(Severity severity, const std::string& rule, Policy at, std::string values,
           std::string consequence, std::string remedy) {
    findings_.push_back({severity, rule, PlaceOf(profile_, at), profile_.name, std::move(values),
                         std::move(consequence), std::move(remedy)});
  }
  std::string Named(Policy policy) const {
    return std::string(Info(policy).name) + " " + StatedValue(profile_, policy);
  }

  const Profile& profile_;
  Findings& findings_;
};

void EndpointRules::CheckLimits() {
  const std::int64_t samples = Number(Policy::kMaxSamples);
  const std::int64_t instances = Number(Policy::kMaxInstances);
  const std::int64_t each = Number(Policy::kMaxSamplesPerInstance);
  const std::string all = Named(Policy::kMaxSamples) + ", " + Named(Policy::kMaxInstances) + ", " +
                          Named(Policy::kMaxSamplesPerInstance);
  if (samples > 0 && (instances <= 0 || each <= 0 || samples < instances * each)) {
    Add(Severity::kError, "inconsistent_limits", Policy::kMaxSamples, all,
        "The library refuses the endpoint, and the service does not start.",
        "max_samples must be at least max_instances times max_samples_per_instance, and 0, "
        "unlimited, where one of them is");
  }
  if (instances < 0 && profile_.owner == Owner::kWriter) {
    Add(Severity::kError, "negative_limit", Policy::kMaxInstances, Named(Policy::kMaxInstances),
        "Fast DDS 2.9.1 then delivers nothing, without a sign.", "write 0 for unlimited");
  }
  const std::int64_t depth = Number(Policy::kDepth);
  if (Number(Policy::kHistory) == kKeepAll) {
    Add(Severity::kWarning, "keep_all", Policy::kHistory,
        Named(Policy::kHistory) + " with " + Named(Policy::kMaxSamples),
        "One slow reader lets the history grow without end, or blocks the writer at its limit.",
        "KEEP_LAST with the depth that is needed");
  } else if (depth <= 0) {
    Add(Severity::kError, "depth_zero", Policy::kDepth, Named(Policy::kDepth),
        "Keeping the last none keeps nothing.", "write a depth of at least 1");
  } else if (each > 0 && depth > each) {
    Add(Severity::kError, "depth_above_limit", Policy::kDepth,
        Named(Policy::kDepth) + " against " + Named(Policy::kMaxSamplesPerInstance),
        "The history never holds as many samples as its depth says.",
        "raise max_samples_per_instance, or write 0");
  }
}

void EndpointRules::CheckDurability() {
  const std::int64_t kind = Number(Policy::kDurability);
  if (kind == kPersistent || kind == kTransient) {
    Add(Severity::kError, "durability_unsupported", Policy::kDurability, Named(Policy::kDurability),
        kWithoutService, "TRANSIENT_LOCAL keeps samples as long as their writer lives");
  } else if (kind == kTransientLocal && Number(Policy::kReliability) == kBestEffort) {
    Add(Severity::kWarning, "late_joiner_best_effort", Policy::kDurability,
        Named(Policy::kDurability) + " with " + Named(Policy::kReliability),
        "Kept samples reach late readers by resending, which best effort does not do.",
        "RELIABLE, or VOLATILE if late readers need nothing");
  }
}

void EndpointRules::CheckLiveliness() {
  const std::int64_t lease = Number(Policy::kLease);
  if (lease == kInfinite || Number(Policy::kLiveliness) == kManualByTopic) return;
  Add(Severity::kError, "liveliness_masked", Policy::kLiveliness,
      Named(Policy::kLiveliness) + " with a lease of " + StatedValue(profile_, Policy::kLease),
      "In Fast DDS 2.9.1 any living participant refreshes it, so a dead vehicle counts as alive "
      "until its participant lease ends.",
      "MANUAL_BY_TOPIC, in the writer and in the reader");
  if (profile_.owner == Owner::kWriter && Number(Policy::kLivelinessAnnouncement) >= lease) {
    Add(Severity::kError, "announcement_above_lease", Policy::kLivelinessAnnouncement,
        Named(Policy::kLivelinessAnnouncement) + " is not below the lease of " +
            StatedValue(profile_, Policy::kLease),
        "The library refuses the writer, and the service does not start.",
        "an announcement_period of a third of the lease");
  }
}

void EndpointRules::CheckTimes() {
  if (Number(Policy::kLifespan) != kInfinite) {
    Add(Severity::kWarning, "finite_lifespan", Policy::kLifespan, Named(Policy::kLifespan),
        "It compares the clocks of two machines: where they differ by more, every sample is "
        "dropped "
        "without a sign.",
        "leave it out; age is judged by the receiver's own clock");
  }
  for (const Policy policy : {Policy::kDeadline, Policy::kLease, Policy::kLifespan}) {
    if (Number(policy) >= kMillisecond) continue;
    Add(Severity::kError, "period_below_timer", policy, Named(policy),
        "Timers of Fast DDS 2.9.1 are cut to whole milliseconds: this one is zero, and fires "
        "without "
        "end or not at all.",
        "write at least two periods of what it guards");
  }
  if (profile_.owner == Owner::kWriter && profile_[Policy::kHeartbeatPeriod].given) {
    Add(Severity::kWarning, "overridden_by_code", Policy::kHeartbeatPeriod,
        Named(Policy::kHeartbeatPeriod), "The services set 100 ms on every writer.", "remove it");
  }
  if (!profile_.partitions.empty()) {
    findings_.push_back({Severity::kWarning, "overridden_by_code", profile_.partition_place,
                         profile_.name, "partition \"" + profile_.partitions.front() + "\"",
                         "A partition belongs to the publisher; the services set it by area and "
                         "vehicle id, and this one has no effect.",
                         "remove it"});
  }
}

void EndpointRules::CheckPaths() {
  if (Number(Policy::kDataSharing) != kSharingOff) {
    Add(Severity::kWarning, "data_sharing", Policy::kDataSharing, Named(Policy::kDataSharing),
        "In Fast DDS 2.9.1 it stalls readers after a peer crashes, and passes by the transport "
        "that "
        "tests shape.",
        "OFF");
  }
  if (Number(Policy::kDisablePositiveAcks) != 0) {
    Add(Severity::kError, "positive_acks_disabled", Policy::kDisablePositiveAcks,
        Named(Policy::kDisablePositiveAcks),
        "Fast DDS 2.9.1 crashes when a best-effort reader matches such a writer.", "remove it");
  }
  if (Number(Policy::kOwnership) == kExclusive) {
    Add(Severity::kWarning, "exclusive_ownership", Policy::kOwnership, Named(Policy::kOwnership),
        "Of two vehicles with one id the reader hears only one, and the doubled id stays unseen.",
        "SHARED; the peer table names doubled ids");
  }
  // Where nothing is due, nothing is decided by the age of a sample.
  if (profile_.owner == Owner::kWriter && Number(Policy::kPublishMode) == kAsynchronous &&
      Number(Policy::kDeadline) != kInfinite) {
    Add(Severity::kWarning, "asynchronous_writer", Policy::kPublishMode,
        Named(Policy::kPublishMode),
        "Another thread sends each sample later, and its age at the reader grows by that.",
        "SYNCHRONOUS");
  }
}

}  // namespace

void CheckEndpoint(const Profile& profile, Findings* findings) {
  EndpointRules rules(profile, findings);
  rules.CheckLimits();
  rules.CheckDurability();
  rules.CheckLiveliness();
  rules.CheckTimes();
  rules.CheckPaths();
}

}  // namespace giveway::qos
