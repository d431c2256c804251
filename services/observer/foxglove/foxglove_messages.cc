#include "services/observer/foxglove/foxglove_messages.h"

#include <google/protobuf/util/json_util.h>

#include <algorithm>

#include "foxglove.pb.h"
#include "services/observer/fleet/json_object.h"

namespace giveway {
namespace {

constexpr std::size_t kMostListed = 1024;  // subscriptions in one message

void PutLittleEndian(std::uint64_t value, std::size_t bytes, std::uint8_t* to) {
  for (std::size_t i = 0; i < bytes; ++i) to[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

std::string ChannelJson(const FoxgloveChannel& channel) {
  JsonObject object;
  object.Add("id", channel.id);
  object.Add("topic", std::string_view(channel.topic));
  object.Add("encoding", std::string_view(channel.encoding));
  object.Add("schemaName", std::string_view(channel.schema_name));
  object.Add("schemaEncoding", std::string_view(channel.schema_encoding));
  object.Add("schema", std::string_view(channel.schema));
  return object.Text();
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

FoxgloveRequest RequestOf(const schema::FoxgloveRequest& message) {
  FoxgloveRequest request;
  if (message.op() == "subscribe") {
    for (const auto& wanted : message.subscriptions()) {
      request.subscribe.push_back({wanted.id(), wanted.channel_id()});
    }
  } else if (message.op() == "unsubscribe") {
    request.unsubscribe.assign(message.subscription_ids().begin(),
                               message.subscription_ids().end());
  } else {
    return Refused(
        "op " + Quoted(message.op()) +
        " is not served: this server only publishes; there are subscribe and unsubscribe");
  }
  if (request.subscribe.size() + request.unsubscribe.size() > kMostListed) {
    return Refused("more than 1024 subscriptions in one message");
  }
  return request;
}

}  // namespace

std::string ServerInfoText(std::string_view name, std::string_view session) {
  JsonObject info;
  info.Add("op", "serverInfo");
  info.Add("name", name);
  info.AddRaw("capabilities", "[]");
  info.AddRaw("supportedEncodings", "[]");
  info.AddRaw("metadata", "{}");
  info.Add("sessionId", session);
  return info.Text();
}

std::string AdvertiseText(const std::vector<FoxgloveChannel>& channels) {
  JsonObject message;
  message.Add("op", "advertise");
  message.AddRaw("channels", JsonArray(channels, ChannelJson));
  return message.Text();
}

std::string StatusText(FoxgloveLevel level, std::string_view message) {
  JsonObject status;
  status.Add("op", "status");
  status.Add("level", static_cast<unsigned>(level));
  status.Add("message", message);
  return status.Text();
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
  google::protobuf::util::JsonParseOptions options;
  options.ignore_unknown_fields = true;
  schema::FoxgloveRequest message;
  const auto status =
      google::protobuf::util::JsonStringToMessage(std::string(text), &message, options);
  if (!status.ok())
    return Refused(
        "not a message of the Foxglove WebSocket protocol: it must be a JSON object with op, and "
        "ids of 0 to 4294967295");
  return RequestOf(message);
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
