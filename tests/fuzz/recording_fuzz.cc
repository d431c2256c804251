// Any bytes as a recording: it is replayed or refused with a message, and a second time with the
// same result.
//
// An input is one byte and a file. If the byte is odd, the checksums of the frames are recomputed
// first, so that mutations reach what they guard.
#include <sstream>

#include "services/fleetctl/replay/replayer.h"
#include "services/snapshot/brain_state.h"
#include "services/types/check.h"
#include "tests/fuzz/target.h"
#include "tests/support/recorded_crossing.h"

namespace giveway::fuzz {
namespace {

constexpr std::size_t kHeadBytes = 12;  // of a frame

std::uint32_t LengthAt(const Input& file, std::size_t at) {
  std::uint32_t length = 0;
  for (std::size_t i = 4; i-- > 0;)
    length = length << 8U | static_cast<unsigned char>(file[at + i]);
  return length;
}

// The same frames with right sums; the last takes what is left.
Input Resealed(const Input& file) {
  Input sealed(kRecordingMark);
  for (std::size_t at = sealed.size(); at + kHeadBytes <= file.size();) {
    const std::size_t length =
        std::min<std::size_t>(LengthAt(file, at), file.size() - at - kHeadBytes);
    sealed += Framed(std::string_view(file).substr(at + kHeadBytes, length));
    at += kHeadBytes + length;
  }
  return sealed;
}

std::string Replayed(const Input& file) {
  std::istringstream stream(file);
  const ReplayedFile outcome = fleetctl::Replay(&stream);
  GIVEWAY_CHECK(outcome.vehicle != kNoVehicle || !outcome.finding.empty());
  GIVEWAY_CHECK(outcome.complete || outcome.difference || !outcome.finding.empty() ||
                outcome.steps > 0);
  return ToJson({outcome});
}

}  // namespace

std::vector<Input> Samples() {
  std::vector<Record> records = test::RecordedCrossing(20);
  const std::string plain = test::FileOf(records);
  auto& step = std::get<RecordedStep>(records[2]);
  step.radar.emplace();
  step.lidar.emplace();
  step.camera.emplace();
  step.signals.resize(2);
  step.roster.emplace().accepted = true;
  step.pose_fix.emplace();
  const Record reseat = RecordedReseat{test::DefaultOptions()};
  records.insert(records.begin() + 8, reseat);
  const std::string full = test::FileOf(records);
  Vehicle brain(test::DefaultOptions(), 42);
  std::vector<Record> ring{RecordedContinuation{42, VehicleId{1}, 2, 3}, RecordedImage{}};
  for (std::uint32_t number = 1; number <= 3; ++number) {
    brain.Step(std::get<RecordedStep>(test::RecordedCrossing(3)[number]).AsInputs());
  }
  ring[1] = RecordedImage{test::DefaultOptions(), "test", BytesOf(brain.State()), brain.Hash()};
  ring.push_back(test::RecordedCrossing(4)[4]);
  return {std::string("\0", 1) + plain, "\1" + plain, "\1" + full, "\1" + test::FileOf(ring)};
}

}  // namespace giveway::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const giveway::fuzz::Input file(reinterpret_cast<const char*>(data + 1), size - 1);
  const giveway::fuzz::Input tried = data[0] % 2 == 1 ? giveway::fuzz::Resealed(file) : file;
  GIVEWAY_CHECK(giveway::fuzz::Replayed(tried) == giveway::fuzz::Replayed(tried));
  return 0;
}
