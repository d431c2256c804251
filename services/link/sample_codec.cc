#include "services/link/sample_codec.h"

#include <algorithm>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/topics.h"

namespace giveway::link {
namespace {

template <typename Wire>
std::string Serialized(Wire sample) {
  typename TopicOf<Wire>::Type type;
  rtps::SerializedPayload_t payload(SerializedSize(type, &sample));
  if (!Serialize(type, &sample, payload)) return {};
  return {reinterpret_cast<const char*>(payload.data), payload.length};
}

template <typename Wire>
std::optional<Wire> Deserialized(std::string_view bytes) {
  constexpr std::size_t kHeader = 4;
  if (bytes.size() < kHeader) return std::nullopt;
  typename TopicOf<Wire>::Type type;
  rtps::SerializedPayload_t payload(static_cast<std::uint32_t>(bytes.size()));
  std::ranges::copy(bytes, reinterpret_cast<char*>(payload.data));
  payload.length = static_cast<std::uint32_t>(bytes.size());
  Wire sample;
  if (!Deserialize(type, payload, &sample)) return std::nullopt;
  return sample;
}

template <typename Wire, typename Ours>
Decoded Append(std::string_view bytes, std::vector<Ours>* list) {
  const auto sample = Deserialized<Wire>(bytes);
  Ours value;
  if (!sample || !FromWire(*sample, value)) return Decoded::kUnreadable;
  list->push_back(std::move(value));
  return Decoded::kYes;
}

Decoded AppendBeacon(std::string_view bytes, std::vector<ReceivedBeacon>* list) {
  const auto sample = Deserialized<wire::Beacon>(bytes);
  if (!sample) return Decoded::kUnreadable;
  ReceivedBeacon received;
  received.name_valid = true;
  const Arrival arrival = FromWire(*sample, received.beacon);
  if (!arrival.readable) return Decoded::kUnreadable;
  received.crc_valid = arrival.crc_valid;
  list->push_back(received);
  return Decoded::kYes;
}

Decoded SetFigures(std::string_view bytes, std::optional<RunFigures>* figures) {
  std::vector<RunFigures> list;
  const Decoded decoded = Append<wire::Figures>(bytes, &list);
  if (!list.empty()) *figures = list.back();
  return decoded;
}

}  // namespace

std::string Encode(const Beacon& beacon) { return Serialized(ToWire(beacon)); }
std::string Encode(const VehicleStatus& status) { return Serialized(ToWire(status)); }
std::string Encode(const Truth& truth) { return Serialized(ToWire(truth)); }
std::string Encode(const WorldEvent& event) { return Serialized(ToWire(event)); }
std::string Encode(const RangeScan& scan) { return Serialized(ToWire(scan)); }
std::string Encode(const SignalState& state) { return Serialized(ToWire(state)); }
std::string Encode(const RosterEntry& entry) { return Serialized(ToWire(entry)); }
std::string Encode(const MotorCommand& command) { return Serialized(ToWire(command)); }
std::string Encode(const RunFigures& figures) { return Serialized(ToWire(figures)); }

Decoded DecodeInto(std::string_view topic, std::string_view bytes, Observed* observed) {
  if (topic == TopicOf<wire::Beacon>::kName) return AppendBeacon(bytes, &observed->beacons);
  if (topic == TopicOf<wire::Status>::kName)
    return Append<wire::Status>(bytes, &observed->statuses);
  if (topic == TopicOf<wire::Truth>::kName) return Append<wire::Truth>(bytes, &observed->truths);
  if (topic == TopicOf<wire::Event>::kName) return Append<wire::Event>(bytes, &observed->events);
  if (topic == TopicOf<wire::Roster>::kName) return Append<wire::Roster>(bytes, &observed->roster);
  if (topic == TopicOf<wire::SignalState>::kName) {
    return Append<wire::SignalState>(bytes, &observed->signals);
  }
  if (topic == TopicOf<wire::RangeScan>::kName) {
    return Append<wire::RangeScan>(bytes, &observed->ranges);
  }
  if (topic == TopicOf<wire::MotorCommand>::kName) {
    return Append<wire::MotorCommand>(bytes, &observed->commands);
  }
  if (topic == TopicOf<wire::Figures>::kName) return SetFigures(bytes, &observed->figures);
  return Decoded::kUnknownTopic;
}

std::optional<MotorCommand> DecodeMotorCommand(std::string_view bytes) {
  const auto sample = Deserialized<wire::MotorCommand>(bytes);
  MotorCommand command;
  if (!sample || !FromWire(*sample, command)) return std::nullopt;
  return command;
}

}  // namespace giveway::link
