// The resource use of a fleet's processes over time, per life, and how fast it grows. Bounded for
// weeks: a life keeps kMostPoints samples of each resource, and averages neighbours whenever they
// are full; of a life that has ended only the slopes are kept.
//
// Heap in use is not included: only the process itself can ask its allocator (mallinfo2). From
// outside, only resident private memory is visible, which an allocator may keep after it is freed.
#pragma once

#include <sys/types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "services/fleetctl/process/process_resources.h"
#include "services/fleetctl/soak/soak_result.h"
#include "services/statistics/slope.h"

namespace giveway::fleetctl {

// One figure over time in bounded memory.
class BoundedSeries {
 public:
  static constexpr std::size_t kMostPoints = 1024;

  // `time_s` ascending.
  void Add(double time_s, double value);
  // Each the mean of Stride() samples, the last ones still being gathered left out.
  const std::vector<statistics::Sample>& Points() const { return points_; }
  std::size_t Stride() const { return stride_; }

 private:
  std::vector<statistics::Sample> points_;
  std::size_t stride_ = 1;
  statistics::Sample sum_;
  std::size_t summed_ = 0;
};

// Pools and histories fill up in the first minutes of a life: of a shorter one no growth is called
// a leak.
inline constexpr double kLeastLeakSpan_s = 120;

class ResourceSeries {
 public:
  // The first `warm_up_s` of each life are not judged.
  explicit ResourceSeries(double warm_up_s) : warm_up_s_(warm_up_s) {}

  // To be called at 1 Hz with what ReadResources gave, `time_s` since the start signal. The first
  // call for a process starts its first life.
  void Add(const std::string& process, double time_s, const ProcessResources& resources);
  // What the fleet has in /dev/shm.
  void AddSharedMemory(double time_s, std::uint64_t bytes);
  // The process has ended: what comes next under its name is another life.
  void EndLife(const std::string& process);

  // Of all lives, those that last still included, by process, life and kind, with MarkLeaks. Costs
  // up to 10 ms a living process and resource: not for every second.
  std::vector<ResourceSlope> Slopes() const;
  // Of lives that have ended alone, without MarkLeaks. Costs nothing.
  const std::vector<ResourceSlope>& EndedSlopes() const { return ended_; }
  // Lives that ended before they could be judged.
  std::uint64_t LivesTooShort() const { return lives_too_short_; }

 private:
  struct Life {
    std::uint32_t number = 0;
    double began_s = 0;
    double last_cpu_s = 0;
    double last_s = 0;
    bool has_last = false;
    std::array<BoundedSeries, kResourceKinds> series;
  };
  // Of ended lives the leaks are kept first.
  void Keep(std::vector<ResourceSlope> slopes);
  std::vector<ResourceSlope> SlopesOf(const std::string& process, const Life& life) const;
  Life& LifeOf(const std::string& process, double time_s);

  double warm_up_s_;
  std::map<std::string, Life> living_;
  std::map<std::string, std::uint32_t> next_life_;
  std::vector<ResourceSlope> ended_;
  std::uint64_t lives_too_short_ = 0;
  std::size_t rows_dropped_ = 0;
};

// A leak is a row whose slope is one by itself (statistics::IsLeak) and remains one when the
// chances of all rows, and of `more` that are not among them, are taken together (Holm at
// kMostLeakChance): a fleet of twenty has a hundred slopes, and of those that do not grow every
// fortieth seems to.
inline constexpr double kMostLeakChance = 0.01;
void MarkLeaks(std::vector<ResourceSlope>* rows, std::size_t more);

// The bytes of /dev/shm that the texts of /proc/PID/maps show mapped, each segment once. Pure.
std::uint64_t SharedMemoryIn(const std::vector<std::string>& maps);
// The same of living processes; one that is gone has none.
std::uint64_t ReadSharedMemory(const std::vector<pid_t>& processes);

}  // namespace giveway::fleetctl
