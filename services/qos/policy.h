// Every QoS policy this module knows, as one table: its name, where the XML says it, how a value is
// written, and what the library takes where nothing is said. Values are plain numbers, so that
// reading, showing, comparing and predicting are loops over the table.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

namespace giveway::qos {

enum class Owner : std::uint8_t { kParticipant, kWriter, kReader };

enum class Policy : std::uint8_t {
  // Of writers and readers.
  kReliability,
  kMaxBlockingTime,
  kDurability,
  kDeadline,
  kLiveliness,
  kLease,
  kLivelinessAnnouncement,
  kLifespan,
  kOwnership,
  kLatencyBudget,
  kDestinationOrder,
  kPresentation,
  kDisablePositiveAcks,
  kDataSharing,
  kHistory,
  kDepth,
  kMaxSamples,
  kMaxInstances,
  kMaxSamplesPerInstance,
  kMemoryPolicy,
  kPublishMode,        // writer
  kOwnershipStrength,  // writer
  kHeartbeatPeriod,    // writer
  // Of participants.
  kParticipantLease,
  kAnnouncement,
  kInitialAnnouncements,
  kInitialAnnouncementPeriod,
  kDiscoveryProtocol,
  kClientAnnouncement,
  kAvoidBuiltinMulticast,
  kLivelinessProtocol,
  kBuiltinTransports,
  kMutationTries,
  kParticipantId,
  kPortBase,
  kDomainGain,
  kParticipantGain,
  kOffset0,
  kOffset1,
  kOffset2,
  kOffset3,
  kCount,
};
inline constexpr auto kPolicyCount = static_cast<std::size_t>(Policy::kCount);

constexpr std::size_t Index(Policy policy) { return static_cast<std::size_t>(policy); }

enum class Shape : std::uint8_t {
  kWord,      // a number into PolicyInfo::words
  kDuration,  // nanoseconds, or kInfinite
  kCount,     // a number
  kFlag,      // 0 or 1
};

inline constexpr std::int64_t kInfinite = std::numeric_limits<std::int64_t>::max();

// Values of the kinds the rules ask for, in the order of their words.
enum Reliability : std::int64_t { kBestEffort, kReliable };
enum Durability : std::int64_t { kVolatile, kTransientLocal, kTransient, kPersistent };
enum Liveliness : std::int64_t { kAutomatic, kManualByParticipant, kManualByTopic };
enum Ownership : std::int64_t { kShared, kExclusive };
enum History : std::int64_t { kKeepLast, kKeepAll };
enum DataSharing : std::int64_t { kSharingAutomatic, kSharingOn, kSharingOff };
enum PublishMode : std::int64_t { kSynchronous, kAsynchronous };
enum Discovery : std::int64_t { kNone, kSimple, kClient, kServer, kBackup, kSuperClient };

struct PolicyInfo {
  Policy policy;
  std::string_view name;
  std::string_view path;  // of the XML element, below the profile's
  Shape shape;
  std::string_view words;  // of kWord, separated by blanks
  std::int64_t writer_default = 0;
  std::int64_t reader_default = 0;
  std::int64_t participant_default = 0;
  bool writer = true;
  bool reader = true;
  bool is_unsigned = false;  // the library reads -1 as its largest number
};

// In the order of Policy.
std::span<const PolicyInfo> Policies();
const PolicyInfo& Info(Policy policy);

bool Has(Owner owner, const PolicyInfo& info);
std::int64_t Default(Owner owner, const PolicyInfo& info);

// "RELIABLE", "100 ms", "infinite", "4", "true".
std::string Text(Policy policy, std::int64_t value);
std::string DurationText(std::int64_t nanoseconds);

// The number of `word` among `words`; -1 if it is none of them.
std::int64_t WordIndex(std::string_view words, std::string_view word);

}  // namespace giveway::qos
