// The resource use of a fleet's processes over time, per life, and how fast it grows. Bounded for
// weeks: a life keeps kMostPoints samples of each resource, and averages neighbours whenever they
// are full; of a life that has ended only the slopes are kept.
//
// Heap in use is what a vehicle's status says of it: only the process itself can ask its allocator.
// The world publishes no status; of it only private memory is judged, which is visible from
// outside, and which an allocator may keep after it is freed.
#pragma once

#include <sys/types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/fleetctl/process/process_resources.h"
#include "services/fleetctl/soak/soak_result.h"
#include "services/statistics/slope.h"

namespace giveway::fleetctl {

// One figure over time, in bounded memory.
class BoundedSeries {
 public:
  static constexpr std::size_t kMostPoints = 1024;

  // `time_s` ascending.
  void Add(double time_s, double value);
  // Each is the mean of Stride() samples, without the last ones, which are still being averaged.
  const std::vector<statistics::Sample>& Points() const { return points_; }
  std::size_t Stride() const { return stride_; }

 private:
  std::vector<statistics::Sample> points_;
  std::size_t stride_ = 1;
  statistics::Sample sum_;
  std::size_t summed_ = 0;
};

// Pools and histories fill up in the first minutes of a life: growth in a shorter life is not
// called a leak.
inline constexpr double kLeastLeakSpan_s = 120;

class ResourceSeries {
 public:
  // The first `warm_up_s` of each life are not judged.
  explicit ResourceSeries(double warm_up_s) : warm_up_s_(warm_up_s) {}

  // Call at 1 Hz with the result of ReadResources, `time_s` since the start signal. The first call
  // for a process starts its first life. `heap_bytes` if the process has said so just now.
  void Add(const std::string& process, double time_s, const ProcessResources& resources,
           std::optional<std::uint64_t> heap_bytes = std::nullopt);
  // The bytes of the fleet in /dev/shm.
  void AddSharedMemory(double time_s, std::uint64_t bytes);
  // The processor time the supervisor has used since it started, as often as Add.
  void AddSupervisor(double cpu_s);
  // The process has ended: further samples under its name belong to another life.
  void EndLife(const std::string& process);

  // Of all lives, the current ones included, by process, life and kind, with MarkLeaks. Costs up to
  // 10 ms per live process and resource: not for every second.
  std::vector<ResourceSlope> Slopes() const;
  // Of ended lives alone, with MarkLeaks. Costs a millisecond.
  std::vector<ResourceSlope> EndedSlopes() const;
  // Lives of processes of which nothing is judged up to now: they ended, or started, too soon for
  // kLeastLeakSpan_s.
  std::uint64_t LivesTooShort() const;
  // The supervisor's processor time in relation to that of all processes, since the first sample.
  // nullopt before there are two.
  std::optional<double> SupervisorShare() const;

 private:
  struct Life {
    std::uint32_t number = 0;
    double began_s = 0;
    double last_cpu_s = 0;
    double last_s = 0;
    bool has_last = false;
    std::array<BoundedSeries, kResourceKinds> series;
  };
  // Of ended lives leaks are kept in preference.
  void Keep(std::vector<ResourceSlope> slopes);
  static bool IsTooShort(const Life& life);
  std::vector<ResourceSlope> SlopesOf(const std::string& process, const Life& life) const;
  Life& LifeOf(const std::string& process, double time_s);

  double warm_up_s_;
  std::map<std::string, Life> living_;
  std::map<std::string, std::uint32_t> next_life_;
  std::vector<ResourceSlope> ended_;
  std::uint64_t lives_too_short_ = 0;  // of those that ended
  std::size_t rows_dropped_ = 0;
  double fleet_cpu_s_ = 0;  // of all processes, between their samples
  std::optional<double> supervisor_first_cpu_s_;
  double supervisor_last_cpu_s_ = 0;
};

// A row is a leak if its slope is one by itself (statistics::IsLeak) and remains one after
// correction for all rows, and `more` that are not among them (Holm at kMostLeakChance): a fleet of
// twenty has a hundred slopes, and every fortieth of those without growth would seem to grow.
inline constexpr double kMostLeakChance = 0.01;
void MarkLeaks(std::vector<ResourceSlope>* rows, std::size_t more);

// The bytes of /dev/shm that are mapped according to the texts of /proc/PID/maps, each segment
// once. Pure.
std::uint64_t SharedMemoryIn(const std::vector<std::string>& maps);
// The same of live processes; one that is gone has none.
std::uint64_t ReadSharedMemory(const std::vector<pid_t>& processes);

}  // namespace giveway::fleetctl
