// Reads an MCAP file from its start to its end, or to where it was cut off: a recorder that was
// killed leaves a file without its end. Untrusted bytes are read in bounded memory and refused with
// an explanation.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "services/mcap/mcap_format.h"

namespace giveway::mcap {

struct ReadResult {
  std::uint64_t messages = 0;
  bool cut_off = false;  // it ends without its last record: as after kill -9, or a full disk
  std::string fault;     // why the rest could not be read; empty: it could
};

class McapReader {
 public:
  // Fills `to` with up to `most` bytes and says how many; fewer mean that there are no more.
  using Source = std::function<std::size_t(char* to, std::size_t most)>;
  // The schema is empty where the file names none. False: enough.
  using Visit =
      std::function<bool(const Message& message, const Channel& channel, const Schema& schema)>;

  // Messages in the order of the file.
  static ReadResult Read(const Source& source, const Visit& visit);
  static ReadResult Read(std::string_view bytes, const Visit& visit);

 private:
  enum class Next : std::uint8_t { kGoOn, kEnd, kFault };

  McapReader(const Source& source, const Visit& visit) : source_(source), visit_(visit) {}
  void Run();
  // From the source into the checksum.
  std::size_t Pull(char* to, std::size_t most);
  // True if all of `size` came.
  bool Fill(std::uint64_t size, std::string* to);
  bool Skip(std::uint64_t size);
  // Of one record; chunks contain records of their own.
  Next Take(std::uint8_t opcode, std::string_view content, bool in_chunk);
  Next TakeSchema(std::string_view content);
  Next TakeChannel(std::string_view content);
  Next TakeMessage(std::string_view content);
  Next TakeChunk(std::string_view content);
  Next TakeRecords(std::string_view records);
  Next TakeDataEnd(std::string_view content);
  Next Keep(std::uint64_t size);
  Next Fault(std::string why);

  const Source& source_;
  const Visit& visit_;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::uint64_t kept_ = 0;      // bytes of both
  std::string last_;            // the last bytes that were read: those of kMagic end a file
  std::uint32_t crc_ = 0;       // of all that was read
  std::uint32_t data_crc_ = 0;  // of all before the record that is read, as a DataEnd says it
  ReadResult result_;
};

}  // namespace giveway::mcap
