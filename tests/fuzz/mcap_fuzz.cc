// Any bytes as an MCAP file: read to some end in words, never a crash, and both times alike; what
// it holds of our topics is decoded or counted, and shown on the page. Where the first byte of an
// input is odd the checksum of chunks is made void, so that what it guards is corrupted too.
#include "services/link/sample_codec.h"
#include "services/observer/capture/fleet_capture.h"
#include "services/observer/capture/run_frames.h"
#include "services/types/check.h"
#include "tests/fuzz/target.h"

namespace giveway::fuzz {
namespace {

mcap::McapReader::Source SourceOf(std::string_view bytes) {
  return [bytes](char* to, std::size_t most) mutable {
    const std::size_t got = bytes.copy(to, most);
    bytes.remove_prefix(got);
    return got;
  };
}

std::string Recorded(bool closed) {
  std::string bytes;
  FleetCapture capture(
      [&bytes](std::string_view more) {
        bytes += more;
        return true;
      },
      [](std::size_t) { return "BEST_EFFORT"; });
  Beacon beacon;
  beacon.vehicle = VehicleId{7};
  Truth truth;
  truth.vehicle = VehicleId{7};
  std::uint64_t now_ns = 1'000'000'000;
  for (int n = 0; n < 4; ++n, now_ns += 200'000'000) {
    for (const auto& [topic, sample] :
         {std::pair<const char*, std::string>{"fleet/beacon", link::Encode(beacon)},
          {"world/truth", link::Encode(truth)},
          {"world/event", link::Encode(WorldEvent{})},
          {"fleet/status", link::Encode(VehicleStatus{})}}) {
      capture.Write({RawTopicNamed(topic), now_ns, now_ns, 1, sample});
    }
    capture.Flush();
  }
  if (closed) capture.Close();
  return bytes;
}

// The checksums of the chunks set to 0, which means none.
Input WithoutChecksums(Input file) {
  constexpr std::size_t kPrefix = 9;
  std::size_t at = mcap::kMagic.size();
  while (at + kPrefix < file.size()) {
    mcap::FieldReader prefix(std::string_view(file).substr(at, kPrefix));
    const auto opcode = prefix.Get<std::uint8_t>();
    const auto length = prefix.Get<std::uint64_t>();
    if (length > file.size() - at - kPrefix) break;
    constexpr std::size_t kChecksum = 24;
    if (opcode == static_cast<std::uint8_t>(mcap::Opcode::kChunk) && length > kChecksum + 4) {
      file.replace(at + kPrefix + kChecksum, 4, 4, '\0');
    }
    at += kPrefix + length;
  }
  return file;
}

std::string Shown(const Input& file) {
  const RunRead run = ReadRun(SourceOf(file));
  GIVEWAY_CHECK(run.unreadable <= run.result.messages);
  return run.frames.RunJson("{}") + run.result.fault + (run.result.cut_off ? "cut" : "");
}

}  // namespace

std::vector<Input> Samples() {
  const std::string open = Recorded(false);
  return {std::string("\0", 1) + Recorded(true), "\1" + Recorded(true), "\1" + open};
}

}  // namespace giveway::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const giveway::fuzz::Input file(reinterpret_cast<const char*>(data + 1), size - 1);
  const giveway::fuzz::Input tried =
      data[0] % 2 == 1 ? giveway::fuzz::WithoutChecksums(file) : file;
  GIVEWAY_CHECK(giveway::fuzz::Shown(tried) == giveway::fuzz::Shown(tried));
  return 0;
}
