#include "services/recording/framed_stream.h"

#include <array>
#include <boost/crc.hpp>

#include "services/types/check.h"

namespace giveway {
namespace {

constexpr std::size_t kNumberBytes = 4;
constexpr std::size_t kSummedBytes = 2 * kNumberBytes;  // of the head
constexpr std::size_t kHeadBytes = 3 * kNumberBytes;

std::uint32_t Sum(std::string_view bytes) {
  boost::crc_optimal<32, 0x1EDC6F41, 0xFFFFFFFF, 0xFFFFFFFF, true, true> crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

void Append(std::uint32_t number, std::string* bytes) {
  for (std::size_t i = 0; i < kNumberBytes; ++i) {
    bytes->push_back(static_cast<char>(number >> (8 * i) & 0xffU));
  }
}

std::uint32_t NumberAt(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < kNumberBytes; ++i) {
    number |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  }
  return number;
}

// How many came.
std::size_t Read(std::istream& stream, char* bytes, std::size_t count) {
  stream.read(bytes, static_cast<std::streamsize>(count));
  return static_cast<std::size_t>(stream.gcount());
}

}  // namespace

std::string Framed(std::string_view payload) {
  GIVEWAY_CHECK(payload.size() <= kMostPayloadBytes, payload.size());
  std::string frame;
  frame.reserve(kHeadBytes + payload.size());
  Append(static_cast<std::uint32_t>(payload.size()), &frame);
  Append(Sum(payload), &frame);
  Append(Sum(frame), &frame);
  frame += payload;
  return frame;
}

FrameEnd ReadFrame(std::istream& stream, std::string* payload) {
  std::array<char, kHeadBytes> bytes{};
  const std::size_t came = Read(stream, bytes.data(), bytes.size());
  if (came == 0) return FrameEnd::kEnd;
  if (came < bytes.size()) return FrameEnd::kCutOff;
  const std::string_view head(bytes.data(), bytes.size());
  const std::uint32_t length = NumberAt(head, 0);
  if (Sum(head.substr(0, kSummedBytes)) != NumberAt(head, kSummedBytes) ||
      length > kMostPayloadBytes) {
    return FrameEnd::kDamaged;
  }
  payload->resize(length);
  if (Read(stream, payload->data(), length) < length) return FrameEnd::kCutOff;
  return Sum(*payload) == NumberAt(head, kNumberBytes) ? FrameEnd::kFrame : FrameEnd::kDamaged;
}

}  // namespace giveway
