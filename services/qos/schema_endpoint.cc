// What a data_writer, data_reader or topic profile may hold.
#include "services/qos/schema.h"

namespace giveway::qos {
namespace {

using enum Content;

constexpr ElementRule Group(std::string_view name, std::span<const ElementRule> children,
                            bool must_hold = false) {
  return {name, kElements, children, {}, false, must_hold};
}
constexpr ElementRule Word(std::string_view name, std::string_view words) {
  return {name, kWord, {}, words};
}

constexpr ElementRule kReliability[] = {Word("kind", "BEST_EFFORT RELIABLE"),
                                        {"max_blocking_time", kDuration}};
constexpr ElementRule kDurability[] = {
    Word("kind", "VOLATILE TRANSIENT_LOCAL TRANSIENT PERSISTENT")};
constexpr ElementRule kPeriod[] = {{"period", kDuration}};
constexpr ElementRule kLength[] = {{"duration", kDuration}};
constexpr ElementRule kLiveliness[] = {
    Word("kind", "AUTOMATIC MANUAL_BY_PARTICIPANT MANUAL_BY_TOPIC"),
    {"lease_duration", kDuration},
    {"announcement_period", kDuration}};
constexpr ElementRule kOwnership[] = {Word("kind", "SHARED EXCLUSIVE")};
constexpr ElementRule kStrength[] = {{"value", kUnsigned}};
constexpr ElementRule kPartitionNames[] = {{"name", kText, {}, {}, true}};
constexpr ElementRule kPartition[] = {Group("names", kPartitionNames)};
constexpr ElementRule kPublishMode[] = {Word("kind", "SYNCHRONOUS ASYNCHRONOUS")};
constexpr ElementRule kPositiveAcks[] = {{"enabled", kFlag}, {"duration", kDuration}};
constexpr ElementRule kPiggyback[] = {{"enabled", kFlag}};
constexpr ElementRule kDomainIds[] = {{"domainId", kUnsigned, {}, {}, true}};
constexpr ElementRule kDataSharing[] = {Word("kind", "AUTOMATIC ON OFF"),
                                        {"shared_dir", kDoor},
                                        {"max_domains", kInteger},
                                        Group("domain_ids", kDomainIds)};

constexpr ElementRule kWriterQos[] = {
    Group("reliability", kReliability),
    Group("durability", kDurability, true),
    Group("deadline", kPeriod, true),
    Group("latencyBudget", kLength, true),
    Group("liveliness", kLiveliness),
    Group("lifespan", kLength, true),
    Group("ownership", kOwnership, true),
    Group("ownershipStrength", kStrength, true),
    Group("partition", kPartition, true),
    Group("publishMode", kPublishMode, true),
    Group("disablePositiveAcks", kPositiveAcks),
    Group("data_sharing", kDataSharing, true),
    {"disable_heartbeat_piggyback", kFlag},
    {"durabilityService", kNoEffect},
    {"userData", kNoEffect},
    {"timeBasedFilter", kNoEffect},
    {"destinationOrder", kNoEffect},
    {"presentation", kNoEffect},
    {"topicData", kNoEffect},
    {"groupData", kNoEffect},
};
constexpr ElementRule kReaderQos[] = {
    Group("reliability", kReliability),
    Group("durability", kDurability, true),
    Group("deadline", kPeriod, true),
    Group("latencyBudget", kLength, true),
    Group("liveliness", kLiveliness),
    Group("lifespan", kLength, true),
    Group("ownership", kOwnership, true),
    Group("partition", kPartition, true),
    Group("disablePositiveAcks", kPositiveAcks),
    Group("data_sharing", kDataSharing, true),
    {"durabilityService", kNoEffect},
    {"userData", kNoEffect},
    {"timeBasedFilter", kNoEffect},
    {"destinationOrder", kNoEffect},
    {"presentation", kNoEffect},
    {"topicData", kNoEffect},
    {"groupData", kNoEffect},
};

constexpr ElementRule kHistory[] = {Word("kind", "KEEP_LAST KEEP_ALL"), {"depth", kInteger}};
constexpr ElementRule kLimits[] = {{"max_samples", kInteger},
                                   {"max_instances", kInteger},
                                   {"max_samples_per_instance", kInteger},
                                   {"allocated_samples", kInteger},
                                   {"extra_samples", kInteger}};
constexpr ElementRule kTopic[] = {Word("kind", "NO_KEY WITH_KEY"),
                                  {"name", kText},
                                  {"dataType", kText},
                                  Group("historyQos", kHistory),
                                  Group("resourceLimitsQos", kLimits)};

constexpr ElementRule kWriterTimes[] = {{"initialHeartbeatDelay", kDuration},
                                        {"heartbeatPeriod", kDuration},
                                        {"nackResponseDelay", kDuration},
                                        {"nackSupressionDuration", kDuration}};
constexpr ElementRule kReaderTimes[] = {{"initialAcknackDelay", kDuration},
                                        {"heartbeatResponseDelay", kDuration}};
constexpr ElementRule kThroughput[] = {{"bytesPerPeriod", kUnsigned},
                                       {"periodMillisecs", kUnsigned}};
constexpr ElementRule kMatched[] = {
    {"initial", kUnsigned}, {"maximum", kUnsigned}, {"increment", kUnsigned}};
constexpr std::string_view kMemory =
    "PREALLOCATED PREALLOCATED_WITH_REALLOC DYNAMIC "
    "DYNAMIC_REUSABLE";

constexpr ElementRule kWriter[] = {
    Group("topic", kTopic),
    Group("qos", kWriterQos),
    Group("times", kWriterTimes),
    {"unicastLocatorList", kOpaque},
    {"external_unicast_locators", kOpaque},
    {"multicastLocatorList", kOpaque},
    {"remoteLocatorList", kOpaque},
    {"ignore_non_matching_locators", kFlag},
    {"throughputController", kElements, kThroughput, {}, false, false, true},
    Word("historyMemoryPolicy", kMemory),
    {"propertiesPolicy", kDoor},
    {"userDefinedID", kByte},
    {"entityID", kByte},
    Group("matchedSubscribersAllocation", kMatched),
};
constexpr ElementRule kReader[] = {
    Group("topic", kTopic),
    Group("qos", kReaderQos),
    Group("times", kReaderTimes),
    {"unicastLocatorList", kOpaque},
    {"external_unicast_locators", kOpaque},
    {"multicastLocatorList", kOpaque},
    {"remoteLocatorList", kOpaque},
    {"ignore_non_matching_locators", kFlag},
    {"expectsInlineQos", kFlag},
    Word("historyMemoryPolicy", kMemory),
    {"propertiesPolicy", kDoor},
    {"userDefinedID", kByte},
    {"entityID", kByte},
    Group("matchedPublishersAllocation", kMatched),
};

}  // namespace

std::span<const ElementRule> EndpointElements(bool writer) {
  if (writer) return kWriter;
  return kReader;
}

std::span<const ElementRule> TopicElements() { return kTopic; }

}  // namespace giveway::qos
