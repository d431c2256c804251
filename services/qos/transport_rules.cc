// Transports: which the services take, what shared memory does to a fleet, and buffers against its
// size.
#include <algorithm>

#include "services/qos/qos_rules.h"

namespace giveway::qos {
namespace {

constexpr std::int64_t kLargestSample = 4096;  // a lidar scan with a margin
constexpr std::int64_t kUdpMessage = 65'500;   // the library's default maxMessageSize
constexpr std::int64_t kLargestBuffer = 0x7fff'ffff;
constexpr char kNoParticipant[] =
    "The library makes no participant, and the service does not start.";
constexpr std::int64_t kShmQueue = 512;           // its default port_queue_capacity
constexpr std::int64_t kShmSegment = 512 * 1024;  // what it takes for a segment_size of 0, or none
constexpr std::int64_t kSamplesATick = 3;         // beacon, ranges and command of a vehicle

class TransportRules {
 public:
  TransportRules(const ProfileSet& set, const Deployment& deployment, Findings* findings)
      : set_(set), vehicles_(deployment.vehicles), findings_(*findings) {}

  void CheckUse(const Participation& participation);
  void CheckOne(const Transport& transport);
  void CheckBuffers(const Transport& transport);
  void CheckSharedMemory(const Transport& transport);
  void CheckTwiceOrUnused();
  void CheckIntraprocess();

 private:
  void Add(Severity severity, const std::string& rule, const Place& place,
           const std::string& subject, std::string values, std::string consequence,
           std::string remedy) {
    findings_.push_back({severity, rule, place, subject, std::move(values), std::move(consequence),
                         std::move(remedy)});
  }
  // A number of a transport below what is needed.
  void AddBelow(const Transport& transport, const std::string& element, std::int64_t otherwise,
                std::int64_t needed, const std::string& rule, std::string consequence);

  const ProfileSet& set_;
  std::int64_t vehicles_;
  Findings& findings_;
};

void TransportRules::CheckUse(const Participation& participation) {
  const Profile& profile = *set_.Find(Owner::kParticipant, participation.profile);
  if (profile.Number(Policy::kBuiltinTransports) != 0) {
    Add(Severity::kError, "builtin_transports", PlaceOf(profile, Policy::kBuiltinTransports),
        profile.name, "useBuiltinTransports " + StatedValue(profile, Policy::kBuiltinTransports),
        "The services do not start: the builtin ones listen on every interface, and add shared "
        "memory unasked.",
        "false, and name the transports in <userTransports>");
  }
  std::size_t udp = 0;
  for (const auto& [id, place] : participation.transports) {
    const Transport* transport = set_.FindTransport(id);
    if (transport == nullptr) {
      Add(Severity::kError, "unknown_transport", place, profile.name,
          "no transport_descriptor has the id \"" + id + "\"",
          "The library refuses the whole file, and no process starts.",
          "correct the id, or add the descriptor");
    } else if (transport->type == "UDPv4") {
      ++udp;
    } else if (transport->type != "SHM") {
      Add(Severity::kError, "transport_unsupported", transport->place, id,
          "type " + transport->type, "The services take UDPv4 and SHM, and do not start.", "UDPv4");
    }
  }
  if (udp != 1 && profile.Number(Policy::kBuiltinTransports) == 0) {
    Add(Severity::kError, "not_one_udp_transport", profile.place, profile.name,
        std::to_string(participation.transports.size()) + " user transports, of them " +
            std::to_string(udp) + " UDPv4",
        "The services do not start: one UDPv4 transport finds the others, and besides it only "
        "shared memory is allowed.",
        "name one transport of type UDPv4");
  }
}

void TransportRules::AddBelow(const Transport& transport, const std::string& element,
                              std::int64_t otherwise, std::int64_t needed, const std::string& rule,
                              std::string consequence) {
  const auto said = transport.numbers.find(element);
  const std::int64_t number = said == transport.numbers.end() ? otherwise : said->second.number;
  if (number >= needed) return;
  Add(Severity::kWarning, rule,
      said == transport.numbers.end() ? transport.place : said->second.place, transport.id,
      element + " " + std::to_string(number) + "; " + std::to_string(vehicles_) +
          " vehicles need " + std::to_string(needed),
      std::move(consequence), "at least " + std::to_string(needed));
}

void TransportRules::CheckOne(const Transport& transport) {
  const auto said = [&](const char* element) -> const Value* {
    const auto found = transport.numbers.find(element);
    return found == transport.numbers.end() ? nullptr : &found->second;
  };
  if (const Value* list = said("interfaceWhiteList")) {
    Add(Severity::kWarning, "overridden_by_code", list->place, transport.id, "interfaceWhiteList",
        "The services set it from the flag --interface, and this has no effect.", "remove it");
  }
  if (const Value* ttl = said("TTL"); ttl != nullptr && ttl->number > 1) {
    Add(Severity::kWarning, "multicast_beyond_network", ttl->place, transport.id,
        "TTL " + std::to_string(ttl->number),
        "Multicast discovery leaves the network, and reaches fleets that are none of ours.", "1");
  }
  if (const Value* size = said("receiveBufferSize"); size != nullptr && size->number > 0) {
    AddBelow(transport, "receiveBufferSize", 0, vehicles_ * kDatagramBytes, "receive_buffer_small",
             "The fleet speaks on common ticks: what comes beyond the buffer is dropped unseen.");
  }
  AddBelow(
      transport, "maxMessageSize", kUdpMessage, kLargestSample, "message_too_small",
      "A lidar scan no longer fits one message, and a best-effort one is lost with any piece.");
  if (transport.type == "SHM") {
    CheckSharedMemory(transport);
  } else {
    CheckBuffers(transport);
  }
}

// What the library holds these numbers against when it makes the transport. A buffer of 0 is left
// to the system.
void TransportRules::CheckBuffers(const Transport& transport) {
  const auto message = transport.numbers.find("maxMessageSize");
  const std::int64_t most =
      message == transport.numbers.end() ? kUdpMessage : message->second.number;
  if (most > kUdpMessage) {
    Add(Severity::kError, "message_too_large", message->second.place, transport.id,
        "maxMessageSize " + std::to_string(most), kNoParticipant,
        "at most " + std::to_string(kUdpMessage));
  }
  for (const char* name : {"sendBufferSize", "receiveBufferSize"}) {
    const auto buffer = transport.numbers.find(name);
    if (buffer == transport.numbers.end() || buffer->second.number == 0) continue;
    const std::int64_t size = buffer->second.number;
    const std::string said = std::string(name) + " " + std::to_string(size);
    if (size < most) {
      Add(Severity::kError, "buffer_below_message", buffer->second.place, transport.id,
          said + " against maxMessageSize " + std::to_string(most), kNoParticipant,
          "space for several messages, or 0 for what the system gives");
    } else if (size > kLargestBuffer) {
      Add(Severity::kWarning, "buffer_above_limit", buffer->second.place, transport.id, said,
          "Fast DDS 2.9 takes it for as much as the system grants; 3.1 makes no participant.",
          "at most " + std::to_string(kLargestBuffer) +
              ", of which the system grants what it does");
    }
  }
}

void TransportRules::CheckSharedMemory(const Transport& transport) {
  const auto segment = transport.numbers.find("segment_size");
  const auto message = transport.numbers.find("maxMessageSize");
  const std::int64_t most =
      message == transport.numbers.end() ? kUdpMessage : message->second.number;
  const bool said = segment != transport.numbers.end() && segment->second.number != 0;
  const std::int64_t size = said ? segment->second.number : kShmSegment;
  if (size < most) {
    Add(Severity::kError, "segment_too_small", said ? segment->second.place : message->second.place,
        transport.id,
        "segment_size " + std::to_string(size) + (said ? "" : " (library default)") +
            " against maxMessageSize " + std::to_string(most),
        "The library refuses the transport, and the service does not start.",
        "a segment of several messages");
  }
  AddBelow(transport, "port_queue_capacity", kShmQueue, kSamplesATick * vehicles_,
           "shm_queue_short",
           "A tick of the fleet does not fit the queue, and what comes beyond it is dropped.");
}

void TransportRules::CheckTwiceOrUnused() {
  for (const Transport& transport : set_.transports) {
    if (set_.FindTransport(transport.id) != &transport) {
      Add(Severity::kError, "duplicate_transport", transport.place, transport.id,
          "is described already at line " +
              std::to_string(set_.FindTransport(transport.id)->place.line),
          "The library refuses the file, or keeps the first and drops this one.",
          "remove one of them");
    }
    const bool used = std::ranges::any_of(set_.participations, [&](const Participation& one) {
      return std::ranges::any_of(one.transports,
                                 [&](const auto& named) { return named.first == transport.id; });
    });
    if (used) continue;
    Add(Severity::kWarning, "unused_transport", transport.place, transport.id,
        "no participant names it in <userTransports>", "What it says has no effect.",
        "name it, or remove it");
  }
}

void TransportRules::CheckIntraprocess() {
  if (set_.intraprocess == "OFF") return;
  Add(Severity::kWarning, "intraprocess", {set_.file, set_.intraprocess_place.line},
      "library_settings", "intraprocess_delivery " + set_.intraprocess,
      "With many participants in one process discovery never ends in Fast DDS 2.9.1, and samples "
      "pass by the transport that tests shape.",
      "<library_settings><intraprocess_delivery>OFF");
}

}  // namespace

void CheckTransports(const ProfileSet& set, const Deployment& deployment, Findings* findings) {
  TransportRules rules(set, deployment, findings);
  for (const Participation& participation : set.participations) {
    if (set.Find(Owner::kParticipant, participation.profile) != nullptr) {
      rules.CheckUse(participation);
    }
  }
  for (const Transport& transport : set.transports) rules.CheckOne(transport);
  rules.CheckTwiceOrUnused();
  if (deployment.complete || !set.intraprocess_place.file.empty()) rules.CheckIntraprocess();
}

}  // namespace giveway::qos
