// Writes an MCAP file record by record: messages in compressed chunks with an index, a summary at
// the end, checksums over all of it. What has been flushed can be read whatever happens to the
// rest, for nothing is ever changed that was written. Knows no files and no clock: bytes go to a
// sink.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "services/mcap/mcap_format.h"

namespace giveway::mcap {

// CRC-32 of zip, continued from that of the bytes before; 0 at the start.
std::uint32_t Crc32(std::string_view bytes, std::uint32_t before = 0);

class McapWriter {
 public:
  // Takes the bytes, or is false where it could not; then every later call is false, too.
  using Sink = std::function<bool(std::string_view bytes)>;

  // `library` names the program that writes, `profile` a convention that the file follows.
  McapWriter(Sink sink, const std::string& library, const std::string& profile = "");

  // Their ids are given here, from 1 on.
  std::uint16_t AddSchema(Schema schema);
  std::uint16_t AddChannel(Channel channel);
  // False where the sink failed.
  bool Write(const Message& message);
  // A file within the file, such as a recording of a brain.
  bool Attach(const std::string& name, const std::string& media_type, std::string_view data,
              std::uint64_t log_ns);
  // What was written so far can be read from here on.
  bool Flush();
  // The summary. Nothing can be written after it.
  bool Close();

  std::uint64_t Size() const { return size_; }  // bytes the sink has taken
  std::uint64_t Messages() const { return messages_; }
  std::size_t Chunks() const { return chunk_indexes_.size(); }  // each has an entry in memory
  // Bytes that wait for the chunk to end.
  std::uint64_t Pending() const { return chunk_.Bytes().size(); }

 private:
  struct Span {
    std::uint64_t from_ns = 0;
    std::uint64_t to_ns = 0;
    bool any = false;
    void Add(std::uint64_t from, std::uint64_t to);
  };
  struct ChunkIndex {
    Span span;
    std::uint64_t start = 0;
    std::uint64_t length = 0;
    std::map<std::uint16_t, std::uint64_t> message_indexes;
    std::uint64_t message_indexes_length = 0;
    std::string_view compression;
    std::uint64_t compressed = 0;
    std::uint64_t uncompressed = 0;
    std::string Content() const;
  };
  using Entries = std::vector<std::pair<std::uint64_t, std::uint64_t>>;  // log time, offset

  bool Emit(std::string_view bytes);
  bool EmitRecord(Opcode opcode, std::string_view content);
  bool EndChunk();
  bool WriteMessageIndexes(ChunkIndex* index);
  std::string Summary(std::uint64_t start, std::string* offsets);
  std::string StatisticsContent() const;

  Sink sink_;
  bool failed_ = false;
  bool closed_ = false;
  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;  // of all that was written
  FieldWriter chunk_;
  Span chunk_span_;
  std::map<std::uint16_t, Entries> chunk_entries_;
  std::vector<std::string> schemas_;   // contents of the records
  std::vector<std::string> channels_;  // of these, too
  std::vector<std::string> attachments_;
  std::vector<std::string> chunk_indexes_;
  std::map<std::uint16_t, std::uint64_t> counts_;  // messages by channel
  std::uint64_t messages_ = 0;
  Span span_;
};

}  // namespace giveway::mcap
