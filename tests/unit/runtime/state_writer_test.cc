// The writer of a process's state, with a disk that stalls until the test releases it.
#include "services/runtime/state_writer.h"

#include <gmock/gmock.h>

#include <future>
#include <string>
#include <vector>

namespace giveway {
namespace {

using testing::ElementsAre;

// Writes nowhere. The first write does not end before Release.
class StalledDisk {
 public:
  std::string Write(const std::string& bytes) {
    written_.push_back(bytes);
    if (written_.size() == 1) {
      started_.set_value();
      released_.get_future().wait();
    }
    return bytes == "bad" ? "the disk is full" : "";
  }
  void AwaitStart() { started_.get_future().wait(); }
  void Release() { released_.set_value(); }
  // Only once the writer has finished.
  const std::vector<std::string>& Written() const { return written_; }

 private:
  std::vector<std::string> written_;
  std::promise<void> started_;
  std::promise<void> released_;
};

struct Stalled {
  StalledDisk disk;
  StateWriter<> writer{[this](const std::string& bytes) { return disk.Write(bytes); }};
};

TEST(StateWriter, HandingOverAStateDoesNotWaitForADiskThatStalls) {
  Stalled stalled;
  stalled.writer.Write("first");
  stalled.disk.AwaitStart();
  stalled.writer.Write("second");
  EXPECT_FALSE(stalled.writer.TakeOutcome());
  stalled.disk.Release();
}

TEST(StateWriter, OfStatesThatWaitOnlyTheNewestIsWritten) {
  Stalled stalled;
  stalled.writer.Write("first");
  stalled.disk.AwaitStart();
  for (const char* state : {"second", "third", "bad"}) stalled.writer.Write(state);
  stalled.disk.Release();
  stalled.writer.Finish();
  EXPECT_THAT(stalled.disk.Written(), ElementsAre("first", "bad"));
  EXPECT_EQ(stalled.writer.TakeOutcome(), "the disk is full");
  EXPECT_FALSE(stalled.writer.TakeOutcome());
}

// The file of a run that has ended is removed then: nothing may bring it back.
TEST(StateWriter, HasWrittenTheNewestStateOnceItHasFinished) {
  Stalled stalled;
  stalled.writer.Write("first");
  stalled.disk.AwaitStart();
  stalled.writer.Write("second");
  stalled.disk.Release();
  stalled.writer.Finish();
  EXPECT_THAT(stalled.disk.Written(), ElementsAre("first", "second"));
}

}  // namespace
}  // namespace giveway
