#include "services/qos/order_check.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>

#include "services/qos/xml_value.h"

namespace giveway::qos {
namespace {

// `most` bounds what the library reserves for it at once.
struct Allowed {
  std::string_view name;
  std::span<const Allowed> children{};
  std::int64_t most = std::numeric_limits<std::int64_t>::max();
};

constexpr std::int64_t kMostSamples = 10'000;
constexpr std::int64_t kMostBytes = 64 << 20;

constexpr Allowed kDuration[] = {{"sec"}, {"nanosec"}};
constexpr Allowed kKind[] = {{"kind"}};
constexpr Allowed kPeriod[] = {{"period", kDuration}};
constexpr Allowed kLength[] = {{"duration", kDuration}};
constexpr Allowed kReliability[] = {{"kind"}, {"max_blocking_time", kDuration}};
constexpr Allowed kLiveliness[] = {
    {"kind"}, {"lease_duration", kDuration}, {"announcement_period", kDuration}};
constexpr Allowed kStrength[] = {{"value"}};
constexpr Allowed kPositiveAcks[] = {{"enabled"}, {"duration", kDuration}};
constexpr Allowed kQos[] = {{"reliability", kReliability}, {"durability", kKind},
                            {"deadline", kPeriod},         {"latencyBudget", kLength},
                            {"liveliness", kLiveliness},   {"lifespan", kLength},
                            {"ownership", kKind},          {"ownershipStrength", kStrength},
                            {"publishMode", kKind},        {"disablePositiveAcks", kPositiveAcks},
                            {"data_sharing", kKind},       {"disable_heartbeat_piggyback"}};
constexpr Allowed kHistory[] = {{"kind"}, {"depth", {}, kMostSamples}};
constexpr Allowed kLimits[] = {{"max_samples"},
                               {"max_instances"},
                               {"max_samples_per_instance"},
                               {"allocated_samples", {}, kMostSamples},
                               {"extra_samples", {}, kMostSamples}};
constexpr Allowed kTopic[] = {{"kind"}, {"historyQos", kHistory}, {"resourceLimitsQos", kLimits}};
constexpr Allowed kTimes[] = {
    {"initialHeartbeatDelay", kDuration}, {"heartbeatPeriod", kDuration},
    {"nackResponseDelay", kDuration},     {"nackSupressionDuration", kDuration},
    {"initialAcknackDelay", kDuration},   {"heartbeatResponseDelay", kDuration}};
constexpr Allowed kEndpoint[] = {
    {"topic", kTopic}, {"qos", kQos}, {"times", kTimes}, {"historyMemoryPolicy"}};

constexpr Allowed kInitial[] = {{"count", {}, 1000}, {"period", kDuration}};
constexpr Allowed kDiscovery[] = {{"discoveryProtocol"},
                                  {"leaseDuration", kDuration},
                                  {"leaseAnnouncement", kDuration},
                                  {"initialAnnouncements", kInitial},
                                  {"clientAnnouncementPeriod", kDuration}};
constexpr Allowed kBuiltin[] = {{"discovery_config", kDiscovery},
                                {"avoid_builtin_multicast"},
                                {"use_WriterLivelinessProtocol"},
                                {"mutation_tries"}};
constexpr Allowed kUserTransports[] = {{"transport_id"}};
constexpr Allowed kRtps[] = {
    {"builtin", kBuiltin}, {"userTransports", kUserTransports}, {"useBuiltinTransports"}};
constexpr Allowed kParticipant[] = {{"rtps", kRtps}};

constexpr Allowed kTransport[] = {{"transport_id"},
                                  {"type"},
                                  {"sendBufferSize", {}, kMostBytes},
                                  {"receiveBufferSize", {}, kMostBytes},
                                  {"TTL"},
                                  {"non_blocking_send"},
                                  {"maxMessageSize"},
                                  {"maxInitialPeersRange", {}, 1000},
                                  {"segment_size", {}, kMostBytes},
                                  {"port_queue_capacity", {}, kMostSamples},
                                  {"healthy_check_timeout_ms"}};
constexpr Allowed kTransports[] = {{"transport_descriptor", kTransport}};

constexpr Allowed kProfiles[] = {{"transport_descriptors", kTransports},
                                 {"participant", kParticipant},
                                 {"data_writer", kEndpoint},
                                 {"publisher", kEndpoint},
                                 {"data_reader", kEndpoint},
                                 {"subscriber", kEndpoint}};
constexpr Allowed kLibrary[] = {{"intraprocess_delivery"}};
constexpr Allowed kRoot[] = {{"profiles", kProfiles}, {"library_settings", kLibrary}};

bool Same(const XmlElement& a, const XmlElement& b) {
  const auto same_attribute = [](const XmlAttribute& x, const XmlAttribute& y) {
    return x.name == y.name && x.value == y.value;
  };
  return a.name == b.name && a.text == b.text &&
         std::ranges::equal(a.attributes, b.attributes, same_attribute) &&
         std::ranges::equal(a.children, b.children, Same);
}

// Profiles and transports are distinguished by their names, all else by the element.
std::string NameOf(const XmlElement& element) {
  const XmlElement* const id = element.Child("transport_id");
  return id != nullptr ? id->text : element.Attribute("profile_name");
}

// The child of `running` that has the place of `wanted`; null if there is none.
const XmlElement* Counterpart(const XmlElement& wanted, const XmlElement* running) {
  if (running == nullptr) return nullptr;
  const auto found = std::ranges::find_if(running->children, [&](const XmlElement& child) {
    return child.name == wanted.name && NameOf(child) == NameOf(wanted);
  });
  return found == running->children.end() ? nullptr : &*found;
}

class OrderChecker {
 public:
  explicit OrderChecker(const std::string& file) : file_(file) {}

  void Check(const XmlElement& wanted, const XmlElement* running,
             std::span<const Allowed> allowed) {
    for (const XmlElement& child : wanted.children) {
      const XmlElement* const before = Counterpart(child, running);
      const auto rule = std::ranges::find(allowed, child.name, &Allowed::name);
      if (rule != allowed.end()) {
        CheckNumber(child, rule->most);
        Check(child, before, rule->children);
      } else if (before == nullptr || !Same(child, *before)) {
        Add("not_by_order", child, "is not what the vehicle runs with",
            "give it by file: --qos where the process is started");
      }
    }
  }
  Findings Take() { return std::move(findings_); }

 private:
  void CheckNumber(const XmlElement& element, std::int64_t most) {
    const auto number = ReadNumber(element.text, NumberKind::kUnsigned);
    if (!number || number->value <= most) return;
    Add("too_large_for_order", element, std::to_string(number->value),
        "at most " + std::to_string(most) + "; more by file");
  }
  void Add(const std::string& rule, const XmlElement& element, std::string values,
           std::string remedy) {
    findings_.push_back({Severity::kError,
                         rule,
                         {file_, element.line},
                         "<" + element.name + ">",
                         std::move(values),
                         "An order may come from anyone in the domain: it changes QoS, and neither "
                         "files, addresses nor the memory that is reserved.",
                         std::move(remedy)});
  }

  const std::string& file_;
  Findings findings_;
};

}  // namespace

Findings CheckOrder(const XmlElement& wanted, const XmlElement& running, const std::string& file) {
  OrderChecker checker(file);
  const bool bare = wanted.name == "profiles";
  const XmlElement* const before = bare ? running.FirstChild("profiles") : &running;
  checker.Check(wanted, before, bare ? std::span<const Allowed>(kProfiles) : kRoot);
  return checker.Take();
}

}  // namespace giveway::qos
