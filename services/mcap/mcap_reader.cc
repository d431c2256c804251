#include "services/mcap/mcap_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "services/mcap/lz4_frame.h"
#include "services/mcap/mcap_writer.h"

namespace giveway::mcap {
namespace {

// What a record or a chunk may take in memory: a writer's chunk is a megabyte or a few.
constexpr std::uint64_t kMostBytes = 256ULL << 20U;
// What schemas and channels may take, which are kept: a recording of ours has some hundred kB.
constexpr std::uint64_t kMostKept = 32ULL << 20U;
// Bytes of LZ4 give at most this many times as many.
constexpr std::uint64_t kMostExpansion = 256;

// Of the others, such as attachments, only the checksum of them all is looked at.
bool IsRead(std::uint8_t opcode) {
  const auto kind = static_cast<Opcode>(opcode);
  return kind == Opcode::kSchema || kind == Opcode::kChannel || kind == Opcode::kMessage ||
         kind == Opcode::kChunk || kind == Opcode::kDataEnd;
}

// An attachment may be a whole file, and is passed over.
bool IsBounded(std::uint8_t opcode) { return static_cast<Opcode>(opcode) != Opcode::kAttachment; }

}  // namespace

ReadResult McapReader::Read(const Source& source, const Visit& visit) {
  McapReader reader(source, visit);
  reader.Run();
  return reader.result_;
}

ReadResult McapReader::Read(std::string_view bytes, const Visit& visit) {
  return Read(
      [&bytes](char* to, std::size_t most) {
        const std::size_t got = bytes.copy(to, most);
        bytes.remove_prefix(got);
        return got;
      },
      visit);
}

std::size_t McapReader::Pull(char* to, std::size_t most) {
  const std::size_t got = source_(to, most);
  crc_ = Crc32({to, got}, crc_);
  last_ += std::string_view(to, got).substr(got - std::min(got, kMagic.size()));
  last_.erase(0, last_.size() - std::min(last_.size(), kMagic.size()));
  return got;
}

bool McapReader::Fill(std::uint64_t size, std::string* to) {
  constexpr std::uint64_t kStep = 1ULL << 20U;  // what a length claims is not allocated at once
  to->clear();
  while (to->size() < size) {
    const std::size_t before = to->size();
    const std::size_t most = std::min(kStep, size - before);
    to->resize(before + most);
    const std::size_t got = Pull(to->data() + before, most);
    to->resize(before + got);
    if (got < most) return false;
  }
  return true;
}

bool McapReader::Skip(std::uint64_t size) {
  constexpr std::uint64_t kStep = 1ULL << 16U;
  std::string step(std::min(kStep, size), '\0');
  while (size > 0) {
    const std::size_t most = std::min<std::uint64_t>(step.size(), size);
    if (Pull(step.data(), most) < most) return false;
    size -= most;
  }
  return true;
}

McapReader::Next McapReader::Fault(std::string why) {
  result_.fault = std::move(why);
  return Next::kFault;
}

void McapReader::Run() {
  std::string bytes;
  if (!Fill(kMagic.size(), &bytes) || bytes != kMagic) {
    Fault("not an MCAP file: it does not start with the bytes of one");
    return;
  }
  last_.clear();  // those that start a file
  constexpr std::uint64_t kPrefix = 1 + 8;
  while (true) {
    data_crc_ = crc_;
    if (!Fill(kPrefix, &bytes)) break;
    FieldReader prefix(bytes);
    const auto opcode = prefix.Get<std::uint8_t>();
    const auto length = prefix.Get<std::uint64_t>();
    if (IsBounded(opcode) && length > kMostBytes) {
      Fault(fmt::format("a record claims {} bytes; at most {} are read", length, kMostBytes));
      return;
    }
    if (!IsRead(opcode)) {
      if (Take(opcode, {}, false) != Next::kGoOn) return;
      if (!Skip(length)) break;
      continue;
    }
    if (!Fill(length, &bytes)) break;
    if (Take(opcode, bytes, false) != Next::kGoOn) return;
  }
  if (last_ == kMagic) {
    Fault("a record claims more bytes than the file has, which was closed in good order");
    return;
  }
  result_.cut_off = true;
}

McapReader::Next McapReader::Take(std::uint8_t opcode, std::string_view content, bool in_chunk) {
  switch (static_cast<Opcode>(opcode)) {
    case Opcode::kSchema:
      return TakeSchema(content);
    case Opcode::kChannel:
      return TakeChannel(content);
    case Opcode::kMessage:
      return TakeMessage(content);
    case Opcode::kChunk:
      return in_chunk ? Fault("a chunk within a chunk") : TakeChunk(content);
    case Opcode::kDataEnd:
      return in_chunk ? Fault("an end of the data within a chunk") : TakeDataEnd(content);
    case Opcode::kFooter:
      return Next::kEnd;
    default:
      return Next::kGoOn;
  }
}

McapReader::Next McapReader::Keep(std::uint64_t size) {
  kept_ += size;  // at most kMostBytes more than its limit
  if (kept_ <= kMostKept) return Next::kGoOn;
  return Fault(fmt::format("schemas and channels take more than {} bytes", kMostKept));
}

McapReader::Next McapReader::TakeSchema(std::string_view content) {
  FieldReader fields(content);
  Schema schema;
  schema.id = fields.Get<std::uint16_t>();
  schema.name = fields.GetText();
  schema.encoding = fields.GetText();
  schema.data = fields.GetText();
  if (!fields.Ok()) return Fault("a schema's record ends early");
  if (!schemas_.try_emplace(schema.id, std::move(schema)).second) return Next::kGoOn;
  return Keep(content.size());
}

McapReader::Next McapReader::TakeChannel(std::string_view content) {
  FieldReader fields(content);
  Channel channel;
  channel.id = fields.Get<std::uint16_t>();
  channel.schema = fields.Get<std::uint16_t>();
  channel.topic = fields.GetText();
  channel.encoding = fields.GetText();
  FieldReader metadata(fields.GetText());
  while (fields.Ok() && metadata.Ok() && !metadata.Rest().empty()) {
    std::string key(metadata.GetText());
    channel.metadata[std::move(key)] = metadata.GetText();
  }
  if (!fields.Ok() || !metadata.Ok()) return Fault("a channel's record ends early");
  if (channel.schema != 0 && !schemas_.contains(channel.schema)) {
    return Fault(fmt::format("channel {} names schema {}, which the file has not", channel.topic,
                             channel.schema));
  }
  if (!channels_.try_emplace(channel.id, std::move(channel)).second) return Next::kGoOn;
  return Keep(content.size());
}

McapReader::Next McapReader::TakeMessage(std::string_view content) {
  FieldReader fields(content);
  Message message;
  message.channel = fields.Get<std::uint16_t>();
  message.sequence = fields.Get<std::uint32_t>();
  message.log_ns = fields.Get<std::uint64_t>();
  message.publish_ns = fields.Get<std::uint64_t>();
  if (!fields.Ok()) return Fault("a message's record ends early");
  message.data = fields.Rest();
  const auto channel = channels_.find(message.channel);
  if (channel == channels_.end()) {
    return Fault(fmt::format("a message of channel {}, which the file has not", message.channel));
  }
  ++result_.messages;
  static const Schema kNone;
  const auto schema = schemas_.find(channel->second.schema);
  const bool go_on =
      visit_(message, channel->second, schema == schemas_.end() ? kNone : schema->second);
  return go_on ? Next::kGoOn : Next::kEnd;
}

McapReader::Next McapReader::TakeChunk(std::string_view content) {
  FieldReader fields(content);
  fields.Take(16);  // its first and last time
  const auto size = fields.Get<std::uint64_t>();
  const auto crc = fields.Get<std::uint32_t>();
  const std::string_view compression = fields.GetText();
  const std::string_view stored = fields.Take(fields.Get<std::uint64_t>());
  if (!fields.Ok()) return Fault("a chunk's record ends early");
  if (size > kMostBytes || size / kMostExpansion > stored.size()) {
    return Fault(fmt::format("a chunk claims {} bytes", size));
  }
  std::string inflated;
  std::string_view records = stored;
  if (compression == "lz4") {
    auto bytes = FromLz4Frame(stored, size);
    if (!bytes) return Fault("a chunk's LZ4 frame is damaged");
    inflated = std::move(*bytes);
    records = inflated;
  } else if (!compression.empty()) {
    return Fault(fmt::format("a chunk is compressed by \"{}\"; lz4 and none are read",
                             compression.substr(0, 16)));
  }
  if (crc != 0 && Crc32(records) != crc) return Fault("a chunk's checksum is wrong");
  return TakeRecords(records);
}

McapReader::Next McapReader::TakeDataEnd(std::string_view content) {
  FieldReader fields(content);
  const auto crc = fields.Get<std::uint32_t>();
  if (!fields.Ok()) return Fault("the end of the data ends early");
  if (crc != 0 && crc != data_crc_) return Fault("the checksum of the data is wrong");
  return Next::kEnd;
}

McapReader::Next McapReader::TakeRecords(std::string_view records) {
  FieldReader fields(records);
  while (!fields.Rest().empty()) {
    const auto opcode = fields.Get<std::uint8_t>();
    const std::string_view content = fields.Take(fields.Get<std::uint64_t>());
    if (!fields.Ok()) return Fault("a record in a chunk ends early");
    const Next next = Take(opcode, content, true);
    if (next != Next::kGoOn) return next;
  }
  return Next::kGoOn;
}

}  // namespace giveway::mcap
