#include "services/observer/foxglove/foxglove_messages.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "services/runtime/json.h"

namespace giveway {
namespace {

constexpr std::size_t kMostListed = 1024;  // subscriptions in one message

void PutLittleEndian(std::uint64_t value, std::size_t bytes, std::uint8_t* to) {
  for (std::size_t i = 0; i < bytes; ++i) to[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

Json ChannelJson(const FoxgloveChannel& channel) {
  Json object;
  object["id"] = channel.id;
  object["topic"] = channel.topic;
  object["encoding"] = channel.encoding;
  object["schemaName"] = channel.schema_name;
  object["schemaEncoding"] = channel.schema_encoding;
  object["schema"] = channel.schema;
  return object;
}

FoxgloveRequest Refused(std::string why) {
  return {.subscribe = {}, .unsubscribe = {}, .fault = std::move(why)};
}

std::string_view Trimmed(std::string_view text) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

// What stands in a message that goes back to the client: its own text, cut.
std::string Quoted(std::string_view text) {
  constexpr std::size_t kMostQuoted = 40;
  return "\"" + std::string(text.substr(0, kMostQuoted)) + "\"";
}

// The list of that name; one that is not there is empty.
Json ListIn(const Json& message, const char* name) {
  Json list = message.value(name, Json::array());
  if (!list.is_array()) throw std::invalid_argument("no list");
  return list;
}

// Throws where the message is not as the protocol has it.
FoxgloveRequest RequestOf(const Json& message) {
  FoxgloveRequest request;
  const auto op = message.at("op").get<std::string>();
  if (op == "subscribe") {
    for (const Json& wanted : ListIn(message, "subscriptions")) {
      request.subscribe.push_back({Uint32Of(wanted.at("id")), Uint32Of(wanted.at("channelId"))});
    }
  } else if (op == "unsubscribe") {
    for (const Json& id : ListIn(message, "subscriptionIds")) {
      request.unsubscribe.push_back(Uint32Of(id));
    }
  } else {
    return Refused(
        "op " + Quoted(op) +
        " is not served: this server only publishes; there are subscribe and unsubscribe");
  }
  if (request.subscribe.size() + request.unsubscribe.size() > kMostListed) {
    return Refused("more than 1024 subscriptions in one message");
  }
  return request;
}

}  // namespace

std::string ServerInfoText(std::string_view name, std::string_view session) {
  Json info;
  info["op"] = "serverInfo";
  info["name"] = name;
  info["capabilities"] = Json::array();
  info["supportedEncodings"] = Json::array();
  info["metadata"] = Json::object();
  info["sessionId"] = session;
  return JsonText(std::move(info));
}

std::string AdvertiseText(const std::vector<FoxgloveChannel>& channels) {
  Json message;
  message["op"] = "advertise";
  message["channels"] = JsonArray(channels, ChannelJson);
  return JsonText(std::move(message));
}

std::string StatusText(FoxgloveLevel level, std::string_view message) {
  Json status;
  status["op"] = "status";
  status["level"] = static_cast<unsigned>(level);
  status["message"] = message;
  return JsonText(std::move(status));
}

std::array<std::uint8_t, kFoxgloveHeadBytes> SampleHead(std::uint32_t subscription,
                                                        std::uint64_t reception_ns) {
  constexpr std::uint8_t kMessageData = 0x01;
  std::array<std::uint8_t, kFoxgloveHeadBytes> head{kMessageData};
  PutLittleEndian(subscription, sizeof(subscription), &head[1]);
  PutLittleEndian(reception_ns, sizeof(reception_ns), &head[5]);
  return head;
}

FoxgloveRequest ReadFoxgloveRequest(std::string_view text) {
  try {
    if (const auto message = ReadJson(text)) return RequestOf(*message);
  } catch (const std::exception&) {  // something is missing, or is not what it must be
  }
  return Refused(
      "not a message of the Foxglove WebSocket protocol: it must be a JSON object with op, and "
      "ids of 0 to 4294967295");
}

std::string_view ChooseFoxgloveProtocol(std::string_view offered) {
  std::vector<std::string_view> names;
  while (!offered.empty()) {
    const std::size_t comma = std::min(offered.find(','), offered.size());
    names.push_back(Trimmed(offered.substr(0, comma)));
    offered.remove_prefix(std::min(comma + 1, offered.size()));
  }
  for (const std::string_view known : kFoxgloveProtocols) {
    if (std::ranges::find(names, known) != names.end()) return known;
  }
  return {};
}

}  // namespace giveway
