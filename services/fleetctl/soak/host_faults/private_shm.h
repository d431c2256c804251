// A /dev/shm for one soak and its processes alone, in a mount namespace of its own, and what may
// happen to it: its files are deleted, segments of dead processes lie there, it is full. Needs
// root. Touches nothing in the machine's own /dev/shm. Single-threaded.
#pragma once

#include <cstddef>
#include <filesystem>
#include <utility>
#include <vector>

namespace giveway::fleetctl {

// Null: this process may have mounts of its own. Otherwise why not.
const char* WhyNoPrivateShm();

class PrivateShm {
 public:
  // From now on this thread, and the threads and processes that it starts, have a /dev/shm of their
  // own. Before any other thread that is to share it. Throws StartError.
  PrivateShm();
  // For tests: as if `folder` were /dev/shm. Mounts nothing.
  explicit PrivateShm(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // Every file, also of who still maps it. How many there were.
  std::size_t DeleteAll();
  // Copies of segments that are there, under names no process uses: what one that was killed
  // leaves. How many were made: none where nothing is there to be copied.
  std::size_t LeaveOver(std::size_t count);
  void RemoveLeftOver();
  // Leaves no byte free. False where that did not succeed.
  bool Fill();
  void Empty();

 private:
  std::filesystem::path folder_ = "/dev/shm";
  std::vector<std::filesystem::path> left_over_;
};

}  // namespace giveway::fleetctl
