// The messages of the Foxglove WebSocket protocol, as far as a server that only publishes needs
// them: texts to send, a client's requests read, the head of a sample. Knows no sockets. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace giveway {

// The subprotocols that are spoken here, in the order of preference. Newer clients of Foxglove
// offer the second; what is used here is the same in both.
inline constexpr std::array<std::string_view, 2> kFoxgloveProtocols{"foxglove.websocket.v1",
                                                                    "foxglove.sdk.v1"};

struct FoxgloveChannel {
  std::uint32_t id = 0;
  std::string topic;            // "fleet/beacon"
  std::string encoding;         // of the samples: "cdr"
  std::string schema_name;      // "giveway::wire::Beacon"
  std::string schema_encoding;  // "omgidl"
  std::string schema;
};

struct FoxgloveSubscription {
  std::uint32_t id = 0;  // chosen by the client
  std::uint32_t channel = 0;
};

// A client's message. With `fault` it is refused as a whole, and the rest is empty.
struct FoxgloveRequest {
  std::vector<FoxgloveSubscription> subscribe;
  std::vector<std::uint32_t> unsubscribe;
  std::string fault;
};

enum class FoxgloveLevel : std::uint8_t { kInfo = 0, kWarning = 1, kError = 2 };

// First of all to each client. `session` differs whenever channels may have changed.
std::string ServerInfoText(std::string_view name, std::string_view session);
std::string AdvertiseText(const std::vector<FoxgloveChannel>& channels);
std::string StatusText(FoxgloveLevel level, std::string_view message);

// What stands before the bytes of a sample in a binary message: opcode, subscription, time.
constexpr std::size_t kFoxgloveHeadBytes = 13;
std::array<std::uint8_t, kFoxgloveHeadBytes> SampleHead(std::uint32_t subscription,
                                                        std::uint64_t reception_ns);

FoxgloveRequest ReadFoxgloveRequest(std::string_view text);

// Of a client's list in Sec-WebSocket-Protocol, the one to speak; empty where none is known.
std::string_view ChooseFoxgloveProtocol(std::string_view offered);

}  // namespace giveway
