#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "services/mcap/lz4_frame.h"
#include "services/mcap/mcap_reader.h"
#include "services/mcap/mcap_writer.h"

namespace giveway::mcap {
namespace {

using ::testing::HasSubstr;

struct ReadBack {
  std::vector<std::string> data;
  std::vector<std::uint64_t> log_ns;
  std::string topic;
  std::string schema;
  ReadResult result;
};

ReadBack ReadAll(std::string_view bytes) {
  ReadBack read_back;
  read_back.result = McapReader::Read(
      bytes, [&read_back](const Message& message, const Channel& channel, const Schema& schema) {
        read_back.data.emplace_back(message.data);
        read_back.log_ns.push_back(message.log_ns);
        read_back.topic = channel.topic;
        read_back.schema = schema.name;
        return true;
      });
  return read_back;
}

// A writer with one channel, its bytes, and a sink that can be made to fail.
struct Recorder {
  std::string bytes;
  std::size_t room = std::string::npos;
  McapWriter writer{[this](std::string_view more) {
                      if (more.size() > room - bytes.size()) return false;
                      bytes += more;
                      return true;
                    },
                    "test"};
  std::uint16_t channel = 0;

  Recorder() {
    const std::uint16_t schema = writer.AddSchema({.name = "T", .encoding = "omgidl", .data = "x"});
    channel = writer.AddChannel({.schema = schema,
                                 .topic = "fleet/beacon",
                                 .encoding = "cdr",
                                 .metadata = {{"reliability", "best_effort"}}});
  }
  bool Put(std::uint32_t n) {
    const std::string data = "sample " + std::to_string(n);
    return writer.Write(
        {.channel = channel, .sequence = n, .log_ns = n, .publish_ns = n, .data = data});
  }
};

TEST(Mcap, TheChecksumIsThatOfZip) {
  EXPECT_EQ(Crc32("123456789"), 0xcbf43926U);
  EXPECT_EQ(Crc32("6789", Crc32("12345")), 0xcbf43926U);
  EXPECT_EQ(Crc32(""), 0U);
}

TEST(Mcap, WhatWasWrittenIsReadInItsOrder) {
  Recorder recorder;
  for (std::uint32_t n = 1; n <= 1000; ++n) ASSERT_TRUE(recorder.Put(n));
  ASSERT_TRUE(recorder.writer.Close());
  const ReadBack read_back = ReadAll(recorder.bytes);
  EXPECT_EQ(read_back.result.fault, "");
  EXPECT_FALSE(read_back.result.cut_off);
  ASSERT_EQ(read_back.data.size(), 1000U);
  EXPECT_EQ(read_back.data.back(), "sample 1000");
  EXPECT_EQ(read_back.log_ns.front(), 1U);
  EXPECT_EQ(read_back.topic, "fleet/beacon");
  EXPECT_EQ(read_back.schema, "T");
}

TEST(Mcap, AFileCutOffAnywhereGivesAllThatWasFlushedBefore) {
  Recorder recorder;
  std::vector<std::size_t> flushed{recorder.bytes.size()};
  for (std::uint32_t n = 1; n <= 20; ++n) {
    recorder.Put(n);
    recorder.writer.Flush();
    flushed.push_back(recorder.bytes.size());
  }
  const std::size_t data = recorder.bytes.size();
  for (std::size_t cut = flushed.front(); cut < data; ++cut) {
    const ReadBack read_back = ReadAll(std::string_view(recorder.bytes).substr(0, cut));
    EXPECT_EQ(read_back.result.fault, "") << cut;
    EXPECT_TRUE(read_back.result.cut_off);
    std::size_t whole = 0;
    while (whole + 1 < flushed.size() && flushed[whole + 1] <= cut) ++whole;
    EXPECT_GE(read_back.data.size(), whole) << cut;
  }
}

TEST(Mcap, ASinkThatFailsEndsTheFileForGood) {
  Recorder recorder;
  recorder.room = recorder.bytes.size() + 300;
  bool ok = true;
  for (std::uint32_t n = 1; n <= 100; ++n) ok = recorder.Put(n) && recorder.writer.Flush() && ok;
  EXPECT_FALSE(ok);
  recorder.room = std::string::npos;
  EXPECT_FALSE(recorder.writer.Flush());
  EXPECT_FALSE(recorder.writer.Close());
  EXPECT_EQ(ReadAll(recorder.bytes).result.fault, "");
}

TEST(Mcap, ALargeChunkIsEndedByItself) {
  Recorder recorder;
  const std::string data(100'000, 'x');
  for (int n = 0; n < 10; ++n) {
    recorder.writer.Write({.channel = recorder.channel, .data = data});
  }
  EXPECT_LT(recorder.writer.Pending(), 768U << 10U);
  EXPECT_GE(ReadAll(recorder.bytes).data.size(), 8U);
}

TEST(Mcap, AnAttachmentStandsBetweenChunks) {
  Recorder recorder;
  recorder.Put(1);
  ASSERT_TRUE(recorder.writer.Attach("brain.recording", "application/octet-stream", "bytes", 7));
  recorder.Put(2);
  ASSERT_TRUE(recorder.writer.Close());
  EXPECT_THAT(recorder.bytes, HasSubstr("brain.recording"));
  EXPECT_EQ(ReadAll(recorder.bytes).data.size(), 2U);
}

TEST(Mcap, OtherBytesAreRefusedInWords) {
  EXPECT_THAT(ReadAll("").result.fault, HasSubstr("not an MCAP file"));
  EXPECT_THAT(ReadAll("SQLite format 3").result.fault, HasSubstr("not an MCAP file"));
  const std::string magic(kMagic);
  const std::string huge = magic + '\x06' + std::string(8, '\x7f');
  EXPECT_THAT(ReadAll(huge).result.fault, HasSubstr("claims"));
}

TEST(Mcap, ALargeAttachmentIsPassedOver) {
  FieldWriter head;
  head.PutBytes(kMagic);
  head.Put(static_cast<std::uint8_t>(Opcode::kAttachment));
  head.Put(std::uint64_t{300} << 20U);
  std::uint64_t left = head.Bytes().size() + (std::uint64_t{300} << 20U);
  std::size_t most_at_once = 0;
  const ReadResult result = McapReader::Read(
      [&, rest = std::string_view(head.Bytes())](char* to, std::size_t most) mutable {
        most_at_once = std::max(most_at_once, most);
        const std::size_t got = std::min<std::uint64_t>(most, left);
        rest.remove_prefix(rest.copy(to, got));
        left -= got;
        return got;
      },
      [](const auto&, const auto&, const auto&) { return true; });
  EXPECT_EQ(result.fault, "");
  EXPECT_TRUE(result.cut_off);
  EXPECT_EQ(left, 0U);
  EXPECT_LE(most_at_once, std::size_t{1} << 20U);
}

TEST(Mcap, SchemasWithoutEndAreRefused) {
  std::string bytes;
  McapWriter writer(
      [&bytes](std::string_view more) {
        bytes += more;
        return true;
      },
      "test");
  const std::string data(std::size_t{1} << 20U, 'x');
  std::uint16_t schema = 0;
  for (int n = 0; n < 40; ++n) schema = writer.AddSchema({.name = "T", .data = data});
  const std::uint16_t channel = writer.AddChannel({.schema = schema, .topic = "t"});
  writer.Write({.channel = channel, .data = "x"});
  writer.Close();
  const ReadResult result =
      McapReader::Read(bytes, [](const auto&, const auto&, const auto&) { return true; });
  EXPECT_THAT(result.fault, HasSubstr("schemas and channels take more than"));
  EXPECT_EQ(result.messages, 0U);
}

TEST(Mcap, ADamagedChunkIsNoticed) {
  Recorder recorder;
  for (std::uint32_t n = 1; n <= 100; ++n) recorder.Put(n);
  recorder.writer.Flush();
  std::string damaged = recorder.bytes;
  const std::size_t last_index = damaged.size() - 100 * 16 - 40;
  damaged[last_index] = static_cast<char>(damaged[last_index] ^ 1);
  EXPECT_NE(ReadAll(damaged).result.fault, "");
}

// Of the indexes between chunks a reader in order needs nothing: only the checksum of the data
// covers them.
TEST(Mcap, DamageAnywhereInTheDataIsNoticed) {
  Recorder recorder;
  for (std::uint32_t n = 1; n <= 20; ++n) {
    recorder.Put(n);
    if (n % 10 == 0) recorder.writer.Flush();
  }
  const std::size_t data_end = recorder.bytes.size();
  recorder.writer.Close();
  ASSERT_EQ(ReadAll(recorder.bytes).result.fault, "");
  constexpr std::size_t kDamage = 64;
  for (std::size_t at = 0; at + kDamage <= data_end; ++at) {
    std::string damaged = recorder.bytes;
    damaged.replace(at, kDamage, kDamage, '\xff');
    EXPECT_NE(ReadAll(damaged).result.fault, "") << "at " << at;
  }
}

TEST(Mcap, RandomDamageNeverDoesMoreThanEndTheReading) {
  Recorder recorder;
  for (std::uint32_t n = 1; n <= 50; ++n) recorder.Put(n);
  recorder.writer.Close();
  std::minstd_rand random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    std::string damaged = recorder.bytes;
    for (int hit = 0; hit < 3; ++hit) {
      damaged[random() % damaged.size()] = static_cast<char>(random());
    }
    damaged.resize(random() % (damaged.size() + 1));
    EXPECT_LE(ReadAll(damaged).data.size(), 50U);
  }
}

TEST(Mcap, AFrameOfAnotherLengthIsNone) {
  const auto frame = ToLz4Frame("some bytes");
  ASSERT_TRUE(frame);
  EXPECT_EQ(FromLz4Frame(*frame, 10), "some bytes");
  EXPECT_FALSE(FromLz4Frame(*frame, 9));
  EXPECT_FALSE(FromLz4Frame(*frame, 11));
  EXPECT_FALSE(FromLz4Frame(frame->substr(0, frame->size() - 5), 10));
}

}  // namespace
}  // namespace giveway::mcap
