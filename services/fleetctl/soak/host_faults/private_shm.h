// A /dev/shm for one soak and its processes alone, in a mount namespace of its own, and the faults
// that it can have: its files are deleted, it holds segments of dead processes, it is full. Needs
// root. Changes nothing in the machine's own /dev/shm. Single-threaded.
#pragma once

#include <cstddef>
#include <filesystem>
#include <utility>
#include <vector>

namespace giveway::fleetctl {

// Null if this process may have mounts of its own, else the reason.
const char* WhyNoPrivateShm();

class PrivateShm {
 public:
  // From now on this thread, and the threads and processes that it starts, have a private /dev/shm.
  // Call it before starting any other thread that is to share it. Throws StartError.
  PrivateShm();
  // For tests: as if `folder` were /dev/shm. Mounts nothing.
  explicit PrivateShm(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // Deletes every file, also those still mapped. Returns their number.
  std::size_t DeleteAll();
  // Copies existing segments under names that no process uses: what a killed process leaves.
  // Returns the number of copies: none if there is nothing to copy.
  std::size_t LeaveOver(std::size_t count);
  void RemoveLeftOver();
  // Leaves no byte free. Returns false on failure.
  bool Fill();
  void Empty();

 private:
  std::filesystem::path folder_ = "/dev/shm";
  std::vector<std::filesystem::path> left_over_;
};

}  // namespace giveway::fleetctl
