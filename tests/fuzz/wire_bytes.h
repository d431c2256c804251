// Samples of the wire as bytes and back, through the same type support as on a real reader. An
// input is a row of records of one size; the last may be cut off anywhere.
#pragma once

#include <algorithm>
#include <cstring>
#include <span>

#include "services/link/fastdds/topics.h"
#include "tests/fuzz/target.h"

namespace giveway::fuzz {

using ByteSpan = std::span<const std::uint8_t>;

template <typename Wire>
std::size_t WireBytes() {
  static const std::size_t bytes = link::LargestSize(typename link::TopicOf<Wire>::Type());
  return bytes;
}

template <typename Wire>
Input Serialized(Wire sample) {
  typename link::TopicOf<Wire>::Type type;
  link::rtps::SerializedPayload_t payload(link::LargestSize(type));
  GIVEWAY_CHECK(link::Serialize(type, &sample, payload));
  Input bytes(reinterpret_cast<const char*>(payload.data), payload.length);
  bytes.resize(WireBytes<Wire>());
  return bytes;
}

// False if the bytes are no such sample.
template <typename Wire>
bool Deserialize(ByteSpan bytes, Wire* sample) {
  static typename link::TopicOf<Wire>::Type type;
  link::rtps::SerializedPayload_t payload(static_cast<std::uint32_t>(bytes.size()));
  payload.length = static_cast<std::uint32_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), payload.data);
  return link::Deserialize(type, payload, sample);
}

// One byte that says what happens, and the sample it happens with.
struct Record {
  std::uint8_t how = 0;
  ByteSpan sample;

  bool Says(unsigned bit) const { return (how >> bit & 1U) != 0; }
};

// Takes the next record off `bytes`, which are not empty.
template <typename Wire>
Record NextRecord(ByteSpan* bytes) {
  const std::size_t size = std::min(bytes->size(), 1 + WireBytes<Wire>());
  const Record record{bytes->front(), bytes->subspan(1, size - 1)};
  *bytes = bytes->subspan(size);
  return record;
}

}  // namespace giveway::fuzz
