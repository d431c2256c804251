#include "services/mcap/mcap_writer.h"

#include <algorithm>
#include <boost/crc.hpp>

#include "services/mcap/lz4_frame.h"

namespace giveway::mcap {
namespace {

// A reader takes a whole chunk into memory; much smaller ones compress worse.
constexpr std::size_t kChunkBytes = 768UL << 10U;
constexpr std::uint32_t kAllOnes = 0xFFFFFFFF;

void PutRecord(Opcode opcode, std::string_view content, FieldWriter* to) {
  to->Put(static_cast<std::uint8_t>(opcode));
  to->Put(static_cast<std::uint64_t>(content.size()));
  to->PutBytes(content);
}

void PutCounts(const std::map<std::uint16_t, std::uint64_t>& counts, FieldWriter* to) {
  constexpr std::uint32_t kEntry = 2 + 8;
  to->Put(static_cast<std::uint32_t>(counts.size() * kEntry));
  for (const auto& [id, value] : counts) {
    to->Put(id);
    to->Put(value);
  }
}

}  // namespace

std::uint32_t Crc32(std::string_view bytes, std::uint32_t before) {
  // The library wants the register that it continues from with its bits in the other order.
  std::uint32_t reversed = 0;
  for (std::uint32_t bit = 0; bit < 32; ++bit) {
    reversed |= ((before ^ kAllOnes) >> bit & 1U) << (31 - bit);
  }
  boost::crc_optimal<32, 0x04C11DB7, kAllOnes, kAllOnes, true, true> crc(reversed);
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

void McapWriter::Span::Add(std::uint64_t from, std::uint64_t to) {
  from_ns = any ? std::min(from_ns, from) : from;
  to_ns = any ? std::max(to_ns, to) : to;
  any = true;
}

std::string McapWriter::ChunkIndex::Content() const {
  FieldWriter content;
  content.Put(span.from_ns);
  content.Put(span.to_ns);
  content.Put(start);
  content.Put(length);
  PutCounts(message_indexes, &content);
  content.Put(message_indexes_length);
  content.PutText(compression);
  content.Put(compressed);
  content.Put(uncompressed);
  return content.Bytes();
}

McapWriter::McapWriter(Sink sink, const std::string& library, const std::string& profile)
    : sink_(std::move(sink)) {
  FieldWriter header;
  header.PutText(profile);
  header.PutText(library);
  Emit(kMagic);
  EmitRecord(Opcode::kHeader, header.Bytes());
}

std::uint16_t McapWriter::AddSchema(Schema schema) {
  schema.id = static_cast<std::uint16_t>(schemas_.size() + 1);
  FieldWriter content;
  content.Put(schema.id);
  content.PutText(schema.name);
  content.PutText(schema.encoding);
  content.PutText(schema.data);
  PutRecord(Opcode::kSchema, content.Bytes(), &chunk_);
  schemas_.push_back(content.Bytes());
  return schema.id;
}

std::uint16_t McapWriter::AddChannel(Channel channel) {
  channel.id = static_cast<std::uint16_t>(channels_.size() + 1);
  FieldWriter metadata;
  for (const auto& [key, value] : channel.metadata) {
    metadata.PutText(key);
    metadata.PutText(value);
  }
  FieldWriter content;
  content.Put(channel.id);
  content.Put(channel.schema);
  content.PutText(channel.topic);
  content.PutText(channel.encoding);
  content.PutText(metadata.Bytes());
  PutRecord(Opcode::kChannel, content.Bytes(), &chunk_);
  channels_.push_back(content.Bytes());
  return channel.id;
}

bool McapWriter::Write(const Message& message) {
  if (closed_) return false;
  chunk_entries_[message.channel].emplace_back(message.log_ns, chunk_.Bytes().size());
  FieldWriter content;
  content.Put(message.channel);
  content.Put(message.sequence);
  content.Put(message.log_ns);
  content.Put(message.publish_ns);
  content.PutBytes(message.data);
  PutRecord(Opcode::kMessage, content.Bytes(), &chunk_);
  chunk_span_.Add(message.log_ns, message.log_ns);
  ++counts_[message.channel];
  ++messages_;
  return chunk_.Bytes().size() < kChunkBytes ? !failed_ : EndChunk();
}

bool McapWriter::Attach(const std::string& name, const std::string& media_type,
                        std::string_view data, std::uint64_t log_ns) {
  if (closed_ || !EndChunk()) return false;
  FieldWriter content;
  content.Put(log_ns);
  content.Put(std::uint64_t{0});
  content.PutText(name);
  content.PutText(media_type);
  content.Put(static_cast<std::uint64_t>(data.size()));
  content.PutBytes(data);
  content.Put(Crc32(content.Bytes()));
  FieldWriter index;
  index.Put(size_);
  index.Put(static_cast<std::uint64_t>(content.Bytes().size() + 9));
  index.Put(log_ns);
  index.Put(std::uint64_t{0});
  index.Put(static_cast<std::uint64_t>(data.size()));
  index.PutText(name);
  index.PutText(media_type);
  attachments_.push_back(index.Bytes());
  return EmitRecord(Opcode::kAttachment, content.Bytes());
}

bool McapWriter::Flush() { return !closed_ && EndChunk(); }

bool McapWriter::Emit(std::string_view bytes) {
  if (failed_) return false;
  failed_ = !sink_(bytes);
  if (failed_) return false;
  crc_ = Crc32(bytes, crc_);
  size_ += bytes.size();
  return true;
}

bool McapWriter::EmitRecord(Opcode opcode, std::string_view content) {
  FieldWriter record;
  PutRecord(opcode, content, &record);
  return Emit(record.Bytes());
}

bool McapWriter::EndChunk() {
  if (chunk_.Bytes().empty()) return !failed_;
  const std::string& records = chunk_.Bytes();
  const auto frame = ToLz4Frame(records);
  ChunkIndex index{.span = chunk_span_, .start = size_};
  index.compression = frame ? "lz4" : "";
  const std::string& stored = frame ? *frame : records;
  index.compressed = stored.size();
  index.uncompressed = records.size();
  FieldWriter content;
  content.Put(chunk_span_.from_ns);
  content.Put(chunk_span_.to_ns);
  content.Put(index.uncompressed);
  content.Put(Crc32(records));
  content.PutText(index.compression);
  content.Put(index.compressed);
  content.PutBytes(stored);
  if (!EmitRecord(Opcode::kChunk, content.Bytes())) return false;
  index.length = size_ - index.start;
  if (!WriteMessageIndexes(&index)) return false;
  if (chunk_span_.any) span_.Add(chunk_span_.from_ns, chunk_span_.to_ns);
  chunk_indexes_.push_back(index.Content());
  chunk_.Clear();
  chunk_span_ = {};
  chunk_entries_.clear();
  return true;
}

bool McapWriter::WriteMessageIndexes(ChunkIndex* index) {
  const std::uint64_t start = size_;
  for (const auto& [channel, entries] : chunk_entries_) {
    index->message_indexes[channel] = size_;
    FieldWriter content;
    content.Put(channel);
    content.Put(static_cast<std::uint32_t>(entries.size() * 16));
    for (const auto& [log_ns, offset] : entries) {
      content.Put(log_ns);
      content.Put(offset);
    }
    if (!EmitRecord(Opcode::kMessageIndex, content.Bytes())) return false;
  }
  index->message_indexes_length = size_ - start;
  return true;
}

std::string McapWriter::StatisticsContent() const {
  FieldWriter content;
  content.Put(messages_);
  content.Put(static_cast<std::uint16_t>(schemas_.size()));
  content.Put(static_cast<std::uint32_t>(channels_.size()));
  content.Put(static_cast<std::uint32_t>(attachments_.size()));
  content.Put(std::uint32_t{0});  // metadata records
  content.Put(static_cast<std::uint32_t>(chunk_indexes_.size()));
  content.Put(span_.from_ns);
  content.Put(span_.to_ns);
  PutCounts(counts_, &content);
  return content.Bytes();
}

// The records of the summary, which stands at `start`, in groups of one opcode each; and where the
// groups are.
std::string McapWriter::Summary(std::uint64_t start, std::string* offsets) {
  FieldWriter summary;
  FieldWriter offset_records;
  const auto add_group = [&](Opcode opcode, const std::vector<std::string>& contents) {
    if (contents.empty()) return;
    const std::uint64_t from = summary.Bytes().size();
    for (const std::string& content : contents) PutRecord(opcode, content, &summary);
    FieldWriter offset;
    offset.Put(static_cast<std::uint8_t>(opcode));
    offset.Put(start + from);
    offset.Put(static_cast<std::uint64_t>(summary.Bytes().size() - from));
    PutRecord(Opcode::kSummaryOffset, offset.Bytes(), &offset_records);
  };
  add_group(Opcode::kSchema, schemas_);
  add_group(Opcode::kChannel, channels_);
  add_group(Opcode::kStatistics, {StatisticsContent()});
  add_group(Opcode::kChunkIndex, chunk_indexes_);
  add_group(Opcode::kAttachmentIndex, attachments_);
  *offsets = offset_records.Bytes();
  return summary.Bytes();
}

bool McapWriter::Close() {
  if (closed_ || !EndChunk()) return false;
  closed_ = true;
  FieldWriter end;
  end.Put(crc_);
  if (!EmitRecord(Opcode::kDataEnd, end.Bytes())) return false;
  const std::uint64_t start = size_;
  std::string offsets;
  const std::string summary = Summary(start, &offsets);
  // The footer's checksum covers the summary and the footer itself up to it.
  constexpr std::uint64_t kFooterContent = 8 + 8 + 4;
  FieldWriter tail;
  tail.PutBytes(summary);
  tail.PutBytes(offsets);
  tail.Put(static_cast<std::uint8_t>(Opcode::kFooter));
  tail.Put(kFooterContent);
  tail.Put(start);
  tail.Put(start + summary.size());
  tail.Put(Crc32(tail.Bytes()));
  tail.PutBytes(kMagic);
  return Emit(tail.Bytes());
}

}  // namespace giveway::mcap
