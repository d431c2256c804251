#include "services/qos/policy.h"

namespace giveway::qos {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kSecond = 1000 * kMillisecond;

constexpr PolicyInfo Both(Policy policy, std::string_view name, std::string_view path, Shape shape,
                          std::string_view words, std::int64_t writer, std::int64_t reader) {
  return {policy, name, path, shape, words, writer, reader};
}

constexpr PolicyInfo Writers(Policy policy, std::string_view name, std::string_view path,
                             Shape shape, std::string_view words, std::int64_t value) {
  return {policy, name, path, shape, words, value, 0, 0, true, false};
}

constexpr PolicyInfo Participants(Policy policy, std::string_view name, std::string_view path,
                                  Shape shape, std::string_view words, std::int64_t value) {
  const bool is_unsigned = shape == Shape::kCount && policy != Policy::kParticipantId;
  return {policy, name, path, shape, words, 0, 0, value, false, false, is_unsigned};
}

// Defaults are those of Fast DDS 2.9 and 3.1; tests/link/qos_resolved_test.cc holds them against
// it.
constexpr std::array<PolicyInfo, kPolicyCount> kPolicies = {
    Both(Policy::kReliability, "reliability", "qos/reliability/kind", Shape::kWord,
         "BEST_EFFORT RELIABLE", kReliable, kBestEffort),
    Both(Policy::kMaxBlockingTime, "max_blocking_time", "qos/reliability/max_blocking_time",
         Shape::kDuration, "", 100 * kMillisecond, 100 * kMillisecond),
    Both(Policy::kDurability, "durability", "qos/durability/kind", Shape::kWord,
         "VOLATILE TRANSIENT_LOCAL TRANSIENT PERSISTENT", kTransientLocal, kVolatile),
    Both(Policy::kDeadline, "deadline", "qos/deadline/period", Shape::kDuration, "", kInfinite,
         kInfinite),
    Both(Policy::kLiveliness, "liveliness", "qos/liveliness/kind", Shape::kWord,
         "AUTOMATIC MANUAL_BY_PARTICIPANT MANUAL_BY_TOPIC", kAutomatic, kAutomatic),
    Both(Policy::kLease, "liveliness_lease", "qos/liveliness/lease_duration", Shape::kDuration, "",
         kInfinite, kInfinite),
    Both(Policy::kLivelinessAnnouncement, "liveliness_announcement",
         "qos/liveliness/announcement_period", Shape::kDuration, "", kInfinite, kInfinite),
    Both(Policy::kLifespan, "lifespan", "qos/lifespan/duration", Shape::kDuration, "", kInfinite,
         kInfinite),
    Both(Policy::kOwnership, "ownership", "qos/ownership/kind", Shape::kWord, "SHARED EXCLUSIVE",
         kShared, kShared),
    Both(Policy::kLatencyBudget, "latency_budget", "qos/latencyBudget/duration", Shape::kDuration,
         "", 0, 0),
    Both(Policy::kDestinationOrder, "destination_order", "qos/destinationOrder/kind", Shape::kWord,
         "BY_RECEPTION_TIMESTAMP BY_SOURCE_TIMESTAMP", 0, 0),
    Both(Policy::kPresentation, "presentation", "qos/presentation/access_scope", Shape::kWord,
         "INSTANCE TOPIC GROUP", 0, 0),
    Both(Policy::kDisablePositiveAcks, "disable_positive_acks", "qos/disablePositiveAcks/enabled",
         Shape::kFlag, "", 0, 0),
    Both(Policy::kDataSharing, "data_sharing", "qos/data_sharing/kind", Shape::kWord,
         "AUTOMATIC ON OFF", kSharingAutomatic, kSharingAutomatic),
    Both(Policy::kHistory, "history", "topic/historyQos/kind", Shape::kWord, "KEEP_LAST KEEP_ALL",
         kKeepLast, kKeepLast),
    Both(Policy::kDepth, "depth", "topic/historyQos/depth", Shape::kCount, "", 1, 1),
    Both(Policy::kMaxSamples, "max_samples", "topic/resourceLimitsQos/max_samples", Shape::kCount,
         "", 5000, 5000),
    Both(Policy::kMaxInstances, "max_instances", "topic/resourceLimitsQos/max_instances",
         Shape::kCount, "", 10, 10),
    Both(Policy::kMaxSamplesPerInstance, "max_samples_per_instance",
         "topic/resourceLimitsQos/max_samples_per_instance", Shape::kCount, "", 400, 400),
    Both(Policy::kMemoryPolicy, "memory_policy", "historyMemoryPolicy", Shape::kWord,
         "PREALLOCATED PREALLOCATED_WITH_REALLOC DYNAMIC DYNAMIC_REUSABLE", 1, 1),
    Writers(Policy::kPublishMode, "publish_mode", "qos/publishMode/kind", Shape::kWord,
            "SYNCHRONOUS ASYNCHRONOUS", kSynchronous),
    Writers(Policy::kOwnershipStrength, "ownership_strength", "qos/ownershipStrength/value",
            Shape::kCount, "", 0),
    Writers(Policy::kHeartbeatPeriod, "heartbeat_period", "times/heartbeatPeriod", Shape::kDuration,
            "", 3 * kSecond),
    Participants(Policy::kParticipantLease, "participant_lease",
                 "rtps/builtin/discovery_config/leaseDuration", Shape::kDuration, "", 20 * kSecond),
    Participants(Policy::kAnnouncement, "announcement",
                 "rtps/builtin/discovery_config/leaseAnnouncement", Shape::kDuration, "",
                 3 * kSecond),
    Participants(Policy::kInitialAnnouncements, "initial_announcements",
                 "rtps/builtin/discovery_config/initialAnnouncements/count", Shape::kCount, "", 5),
    Participants(Policy::kInitialAnnouncementPeriod, "initial_announcement_period",
                 "rtps/builtin/discovery_config/initialAnnouncements/period", Shape::kDuration, "",
                 100 * kMillisecond),
    Participants(Policy::kDiscoveryProtocol, "discovery_protocol",
                 "rtps/builtin/discovery_config/discoveryProtocol", Shape::kWord,
                 "NONE SIMPLE CLIENT SERVER BACKUP SUPER_CLIENT", kSimple),
    Participants(Policy::kClientAnnouncement, "client_announcement",
                 "rtps/builtin/discovery_config/clientAnnouncementPeriod", Shape::kDuration, "",
                 450 * kMillisecond),
    Participants(Policy::kAvoidBuiltinMulticast, "avoid_builtin_multicast",
                 "rtps/builtin/avoid_builtin_multicast", Shape::kFlag, "", 1),
    Participants(Policy::kLivelinessProtocol, "liveliness_protocol",
                 "rtps/builtin/use_WriterLivelinessProtocol", Shape::kFlag, "", 1),
    Participants(Policy::kBuiltinTransports, "builtin_transports", "rtps/useBuiltinTransports",
                 Shape::kFlag, "", 1),
    Participants(Policy::kMutationTries, "mutation_tries", "rtps/builtin/mutation_tries",
                 Shape::kCount, "", 100),
    Participants(Policy::kParticipantId, "participant_id", "rtps/participantID", Shape::kCount, "",
                 -1),
    Participants(Policy::kPortBase, "port_base", "rtps/port/portBase", Shape::kCount, "", 7400),
    Participants(Policy::kDomainGain, "domain_gain", "rtps/port/domainIDGain", Shape::kCount, "",
                 250),
    Participants(Policy::kParticipantGain, "participant_gain", "rtps/port/participantIDGain",
                 Shape::kCount, "", 2),
    Participants(Policy::kOffset0, "port_offset_0", "rtps/port/offsetd0", Shape::kCount, "", 0),
    Participants(Policy::kOffset1, "port_offset_1", "rtps/port/offsetd1", Shape::kCount, "", 10),
    Participants(Policy::kOffset2, "port_offset_2", "rtps/port/offsetd2", Shape::kCount, "", 1),
    Participants(Policy::kOffset3, "port_offset_3", "rtps/port/offsetd3", Shape::kCount, "", 11),
};

// All digits that say something: 250 ms, not 250.000000 ms, and 1.0005 s, not 1 s.
std::string Decimal(std::int64_t number, std::int64_t unit) {
  std::string text = std::to_string(number / unit);
  if (number % unit == 0) return text;
  std::string digits = std::to_string(unit + number % unit).substr(1);
  digits.erase(digits.find_last_not_of('0') + 1);
  return text + "." + digits;
}

std::string_view Word(std::string_view words, std::int64_t index) {
  for (; index > 0; --index) {
    const std::size_t blank = words.find(' ');
    if (blank == std::string_view::npos) return {};
    words.remove_prefix(blank + 1);
  }
  return words.substr(0, words.find(' '));
}

}  // namespace

std::span<const PolicyInfo> Policies() { return kPolicies; }
const PolicyInfo& Info(Policy policy) { return kPolicies[Index(policy)]; }

bool Has(Owner owner, const PolicyInfo& info) {
  if (owner == Owner::kParticipant) return !info.writer && !info.reader;
  return owner == Owner::kWriter ? info.writer : info.reader;
}

std::int64_t Default(Owner owner, const PolicyInfo& info) {
  if (owner == Owner::kParticipant) return info.participant_default;
  return owner == Owner::kWriter ? info.writer_default : info.reader_default;
}

std::string DurationText(std::int64_t nanoseconds) {
  if (nanoseconds == kInfinite) return "infinite";
  return nanoseconds >= kSecond ? Decimal(nanoseconds, kSecond) + " s"
                                : Decimal(nanoseconds, kMillisecond) + " ms";
}

std::string Text(Policy policy, std::int64_t value) {
  const PolicyInfo& info = Info(policy);
  switch (info.shape) {
    case Shape::kWord:
      return std::string(Word(info.words, value));
    case Shape::kDuration:
      return DurationText(value);
    case Shape::kFlag:
      return value != 0 ? "true" : "false";
    case Shape::kCount:
      break;
  }
  return std::to_string(value);
}

std::int64_t WordIndex(std::string_view words, std::string_view word) {
  if (word.empty()) return -1;
  for (std::int64_t index = 0; !words.empty(); ++index) {
    const std::size_t blank = words.find(' ');
    if (words.substr(0, blank) == word) return index;
    words.remove_prefix(blank == std::string_view::npos ? words.size() : blank + 1);
  }
  return -1;
}

}  // namespace giveway::qos
