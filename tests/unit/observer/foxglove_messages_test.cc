// The Foxglove WebSocket protocol as text and bytes: what is sent, and how a client's messages are
// read, malformed ones included.
#include "services/observer/foxglove/foxglove_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace giveway {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(FoxgloveMessages, ServerInfoHasTheNamesOfTheProtocol) {
  EXPECT_EQ(ServerInfoText("fleet \"7\"", "s1"),
            R"({"op":"serverInfo","name":"fleet \"7\"","capabilities":[],"supportedEncodings":[],)"
            R"("metadata":{},"sessionId":"s1"})");
}

TEST(FoxgloveMessages, ChannelsAreAdvertisedWithTheirSchemaAsText) {
  const std::string text = AdvertiseText(
      {{3, "fleet/beacon", "cdr", "giveway::wire::Beacon", "omgidl", "struct A {\n};"}, {}});
  EXPECT_THAT(text, HasSubstr(R"({"op":"advertise","channels":[{"id":3,"topic":"fleet/beacon",)"
                              R"("encoding":"cdr","schemaName":"giveway::wire::Beacon",)"
                              R"("schemaEncoding":"omgidl","schema":"struct A {\n};"},{"id":0)"));
}

TEST(FoxgloveMessages, StatusHasALevel) {
  EXPECT_EQ(StatusText(FoxgloveLevel::kError, "no"), R"({"op":"status","level":2,"message":"no"})");
}

TEST(FoxgloveMessages, TheHeadOfASampleIsLittleEndian) {
  const auto head = SampleHead(0x01020304, 0x1122334455667788);
  const std::array<std::uint8_t, kFoxgloveHeadBytes> expected{
      0x01, 0x04, 0x03, 0x02, 0x01, 0x88, 0x77, 0x66, 0x55, 0x44, 0x33, 0x22, 0x11};
  EXPECT_EQ(head, expected);
}

TEST(FoxgloveMessages, SubscriptionsAreRead) {
  const FoxgloveRequest request = ReadFoxgloveRequest(
      R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":3},{"id":4294967295,"channelId":9}]})");
  EXPECT_EQ(request.fault, "");
  ASSERT_EQ(request.subscribe.size(), 2U);
  EXPECT_EQ(request.subscribe[0].id, 0U);
  EXPECT_EQ(request.subscribe[0].channel, 3U);
  EXPECT_EQ(request.subscribe[1].id, 4294967295U);
  EXPECT_THAT(request.unsubscribe, IsEmpty());
}

TEST(FoxgloveMessages, UnsubscriptionsAreReadAndUnknownFieldsAreIgnored) {
  const FoxgloveRequest request = ReadFoxgloveRequest(
      R"({"op":"unsubscribe","subscriptionIds":[7,8],"later":{"a":[1,{}]},"id":"x"})");
  EXPECT_EQ(request.fault, "");
  EXPECT_EQ(request.unsubscribe, (std::vector<std::uint32_t>{7, 8}));
  EXPECT_THAT(request.subscribe, IsEmpty());
}

TEST(FoxgloveMessages, WhatAPublishingServerDoesNotServeIsNamed) {
  for (const char* op : {"advertise", "unadvertise", "getParameters", "setParameters",
                         "subscribeParameterUpdates", "subscribeConnectionGraph", "fetchAsset"}) {
    const FoxgloveRequest request =
        ReadFoxgloveRequest("{\"op\":\"" + std::string(op) + "\",\"channels\":[{\"id\":1}]}");
    EXPECT_THAT(request.fault, HasSubstr(op));
  }
  const std::string longest(60'000, 'x');
  EXPECT_LT(ReadFoxgloveRequest("{\"op\":\"" + longest + "\"}").fault.size(), 200U);
}

TEST(FoxgloveMessages, MalformedOnesAreRefusedAsAWhole) {
  for (const std::string& text :
       {std::string(),
        std::string("null"),
        std::string("[]"),
        std::string("7"),
        std::string("\"subscribe\""),
        std::string("{"),
        std::string("{\"op\":\"subscribe\""),
        std::string("{\"op\":7"),
        std::string("{}"),
        std::string("{\"op\":\"\"}"),
        std::string("{\"op\":[\"subscribe\"]}"),
        std::string("{\"op\":\"subscribe\"}}"),
        std::string(R"({"op":"subscribe","subscriptions":[[1,2]]})"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":1}]})"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":1.5,"channelId":1}]})"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":1e99,"channelId":1}]})"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":"x","channelId":1}]})"),
        std::string(R"({"op":"unsubscribe","subscriptionIds":["a"]})"),
        std::string(R"({"op":"unsubscribe","subscriptionIds":[null]})"),
        std::string(R"({"op":"unsubscribe","subscriptionIds":7})"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":1}]})"),
        std::string(R"({"op":"subscribe","subscriptions":{"id":1,"channelId":2}})"),
        std::string("{\"op\":\"subscribe\",\"subscriptions\":[{\"id\":1,\"channelId\":\xff}]}"),
        std::string("\x01\x02\x03\x00\xff", 5)}) {
    const FoxgloveRequest request = ReadFoxgloveRequest(text);
    EXPECT_THAT(request.fault, Not(IsEmpty())) << text.substr(0, 80);
    EXPECT_THAT(request.subscribe, IsEmpty()) << text.substr(0, 80);
    EXPECT_THAT(request.unsubscribe, IsEmpty()) << text.substr(0, 80);
  }
}

TEST(FoxgloveMessages, DeepNestingInAnIgnoredFieldTakesNoStack) {
  constexpr std::size_t kDeep = 32'000;
  const FoxgloveRequest request = ReadFoxgloveRequest(
      R"({"op":"unsubscribe","x":)" + std::string(kDeep, '[') + std::string(kDeep, ']') + "}");
  EXPECT_THAT(request.unsubscribe, IsEmpty());
}

// Every prefix of a good message, and the message with each byte replaced: refused or read, never
// more subscriptions than it has.
TEST(FoxgloveMessages, CutAndCorruptedOnesNeverGiveMore) {
  const std::string good =
      R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":2},{"id":3,"channelId":4}]})";
  for (std::size_t length = 0; length < good.size(); ++length) {
    EXPECT_THAT(ReadFoxgloveRequest(good.substr(0, length)).fault, Not(IsEmpty())) << length;
  }
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (const char c : {'\0', '"', '{', '}', '[', ']', ',', ':', '9', '-', '\x7f', '\xff'}) {
      std::string corrupted = good;
      corrupted[at] = c;
      EXPECT_LE(ReadFoxgloveRequest(corrupted).subscribe.size(), 2U) << corrupted;
    }
  }
}

TEST(FoxgloveMessages, TooManySubscriptionsInOneMessageAreRefused) {
  std::string ids;
  for (int i = 0; i < 1025; ++i) ids += (i == 0 ? "" : ",") + std::to_string(i);
  EXPECT_THAT(ReadFoxgloveRequest(R"({"op":"unsubscribe","subscriptionIds":[)" + ids + "]}").fault,
              HasSubstr("1024"));
}

TEST(FoxgloveMessages, OneOfTheOfferedProtocolsIsChosen) {
  EXPECT_EQ(ChooseFoxgloveProtocol("foxglove.websocket.v1"), "foxglove.websocket.v1");
  EXPECT_EQ(ChooseFoxgloveProtocol("foxglove.sdk.v1"), "foxglove.sdk.v1");
  EXPECT_EQ(ChooseFoxgloveProtocol("foxglove.sdk.v1,\tfoxglove.websocket.v1 "),
            "foxglove.websocket.v1");
  for (const char* none : {"", ",", " , ,", "foxglove.websocket.v2", "foxglove.websocket.v1x",
                           "Foxglove.websocket.v1", "chat, superchat"}) {
    EXPECT_EQ(ChooseFoxgloveProtocol(none), "") << none;
  }
}

}  // namespace
}  // namespace giveway
