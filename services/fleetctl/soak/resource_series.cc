#include "services/fleetctl/soak/resource_series.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <sstream>
#include <tuple>

#include "services/runtime/whole_file.h"
#include "services/statistics/two_sample.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kFleet = "fleet";
constexpr std::size_t kMostEndedRows = 3000;  // of lives that are over
constexpr std::size_t kMostNames = 10'000;
constexpr std::size_t kCurvePoints = 60;
constexpr std::string_view kSharedMemoryFolder = "/dev/shm/";

// Faults change processor time: it need not grow in every part of a life.
bool GrowsLikeALeak(ResourceKind kind, std::span<const statistics::Sample> points) {
  return kind == ResourceKind::kProcessors || statistics::GrowsThroughout(points);
}

double LeastLeak(ResourceKind kind) {
  switch (kind) {
    case ResourceKind::kDescriptors:
    case ResourceKind::kThreads:
      return statistics::kLeastLeakPieces;
    case ResourceKind::kProcessors:
      return statistics::kLeastLeakProcessors;
    case ResourceKind::kPrivateBytes:
    case ResourceKind::kHeapBytes:
    case ResourceKind::kResidentBytes:
    case ResourceKind::kSharedMemoryBytes:
      break;
  }
  return statistics::kLeastLeakBytes;
}

// inode -> bytes, of one process; a segment may be mapped in several parts.
std::map<std::string, std::uint64_t> SegmentsIn(const std::string& maps) {
  std::map<std::string, std::uint64_t> segments;
  std::istringstream lines(maps);
  for (std::string line; std::getline(lines, line);) {
    if (line.find(kSharedMemoryFolder) == std::string::npos) continue;
    std::istringstream fields(line);
    std::string range, rights, offset, device, inode;
    if (!(fields >> range >> rights >> offset >> device >> inode)) continue;
    char* end = nullptr;
    const std::uint64_t low = std::strtoull(range.c_str(), &end, 16);
    if (end == range.c_str() || *end != '-') continue;
    const std::uint64_t high = std::strtoull(end + 1, nullptr, 16);
    if (high > low) segments[inode] += high - low;
  }
  return segments;
}

}  // namespace

void BoundedSeries::Add(double time_s, double value) {
  sum_.time_s += time_s;
  sum_.value += value;
  if (++summed_ < stride_) return;
  const double n = static_cast<double>(summed_);
  points_.push_back({sum_.time_s / n, sum_.value / n});
  sum_ = {};
  summed_ = 0;
  if (points_.size() < kMostPoints) return;
  for (std::size_t i = 0; i < kMostPoints / 2; ++i) {
    const statistics::Sample& first = points_[2 * i];
    const statistics::Sample& second = points_[2 * i + 1];
    points_[i] = {(first.time_s + second.time_s) / 2, (first.value + second.value) / 2};
  }
  points_.resize(kMostPoints / 2);
  stride_ *= 2;
}

ResourceSeries::Life& ResourceSeries::LifeOf(const std::string& process, double time_s) {
  const auto [entry, is_new] = living_.try_emplace(process);
  if (is_new) {
    // Lives beyond that number of names are not kept.
    if (next_life_.size() >= kMostNames) next_life_.clear();
    entry->second.number = next_life_[process]++;
    entry->second.began_s = time_s;
  }
  return entry->second;
}

void ResourceSeries::Add(const std::string& process, double time_s,
                         const ProcessResources& resources,
                         std::optional<std::uint64_t> heap_bytes) {
  Life& life = LifeOf(process, time_s);
  const double since_s = time_s - life.last_s;
  const double cpu_s = resources.cpu_s - life.last_cpu_s;
  const bool has_share = life.has_last && since_s > 0;
  // A life that started between two samples has used all of its time since the first of them.
  if (life.has_last || life.number > 0) fleet_cpu_s_ += cpu_s;
  life.last_s = time_s;
  life.last_cpu_s = resources.cpu_s;
  life.has_last = true;
  if (time_s - life.began_s < warm_up_s_) return;
  const auto add = [&life, time_s](ResourceKind kind, double value) {
    life.series[static_cast<std::size_t>(kind)].Add(time_s, value);
  };
  add(ResourceKind::kPrivateBytes, static_cast<double>(resources.private_bytes));
  if (heap_bytes) add(ResourceKind::kHeapBytes, static_cast<double>(*heap_bytes));
  add(ResourceKind::kResidentBytes, static_cast<double>(resources.resident_bytes));
  add(ResourceKind::kDescriptors, resources.descriptors);
  add(ResourceKind::kThreads, resources.threads);
  if (has_share) add(ResourceKind::kProcessors, cpu_s / since_s);
}

void ResourceSeries::AddSharedMemory(double time_s, std::uint64_t bytes) {
  Life& life = LifeOf(kFleet, time_s);
  if (time_s - life.began_s < warm_up_s_) return;
  life.series[static_cast<std::size_t>(ResourceKind::kSharedMemoryBytes)].Add(
      time_s, static_cast<double>(bytes));
}

void ResourceSeries::AddSupervisor(double cpu_s) {
  if (!supervisor_first_cpu_s_) supervisor_first_cpu_s_ = cpu_s;
  supervisor_last_cpu_s_ = cpu_s;
}

std::optional<double> ResourceSeries::SupervisorShare() const {
  if (!supervisor_first_cpu_s_ || fleet_cpu_s_ <= 0) return std::nullopt;
  return (supervisor_last_cpu_s_ - *supervisor_first_cpu_s_) / fleet_cpu_s_;
}

std::vector<ResourceSlope> ResourceSeries::SlopesOf(const std::string& process,
                                                    const Life& life) const {
  std::vector<ResourceSlope> slopes;
  for (std::size_t i = 0; i < kResourceKinds; ++i) {
    const auto kind = static_cast<ResourceKind>(i);
    const std::vector<statistics::Sample>& points = life.series[i].Points();
    const auto slope = statistics::TheilSen(points);
    if (!slope) continue;
    ResourceSlope row{.process = process, .life = life.number, .kind = kind, .slope = *slope};
    row.slope.samples *= life.series[i].Stride();
    row.last = points.back().value;
    row.lasting = slope->spans_s >= kLeastLeakSpan_s && GrowsLikeALeak(kind, points);
    row.leak = row.lasting && statistics::IsLeak(*slope, LeastLeak(kind));
    if (kind == ResourceKind::kPrivateBytes || kind == ResourceKind::kHeapBytes) {
      row.curve = statistics::BlockMedians(points, kCurvePoints);
    }
    slopes.push_back(std::move(row));
  }
  return slopes;
}

void ResourceSeries::EndLife(const std::string& process) {
  const auto life = living_.find(process);
  if (life == living_.end()) return;
  std::vector<ResourceSlope> slopes = SlopesOf(process, life->second);
  if (IsTooShort(life->second)) ++lives_too_short_;
  living_.erase(life);
  Keep(std::move(slopes));
}

bool ResourceSeries::IsTooShort(const Life& life) {
  return std::ranges::none_of(life.series, [](const BoundedSeries& series) {
    const std::vector<statistics::Sample>& points = series.Points();
    return !points.empty() && points.back().time_s - points.front().time_s >= kLeastLeakSpan_s;
  });
}

std::uint64_t ResourceSeries::LivesTooShort() const {
  const auto living = std::ranges::count_if(
      living_, [](const auto& entry) { return entry.first != kFleet && IsTooShort(entry.second); });
  return lives_too_short_ + static_cast<std::uint64_t>(living);
}

void ResourceSeries::Keep(std::vector<ResourceSlope> slopes) {
  for (ResourceSlope& slope : slopes) {
    if (ended_.size() >= kMostEndedRows) {
      ++rows_dropped_;
      const auto without = std::ranges::find(ended_, false, &ResourceSlope::leak);
      if (without == ended_.end()) continue;
      ended_.erase(without);
    }
    ended_.push_back(std::move(slope));
  }
}

std::vector<ResourceSlope> ResourceSeries::Slopes() const {
  std::vector<ResourceSlope> slopes = ended_;
  for (const auto& [process, life] : living_) {
    std::vector<ResourceSlope> more = SlopesOf(process, life);
    std::ranges::move(more, std::back_inserter(slopes));
  }
  MarkLeaks(&slopes, rows_dropped_);
  std::ranges::sort(slopes, [](const ResourceSlope& a, const ResourceSlope& b) {
    return std::tie(a.process, a.life, a.kind) < std::tie(b.process, b.life, b.kind);
  });
  return slopes;
}

std::vector<ResourceSlope> ResourceSeries::EndedSlopes() const {
  std::vector<ResourceSlope> slopes = ended_;
  MarkLeaks(&slopes, rows_dropped_);
  return slopes;
}

void MarkLeaks(std::vector<ResourceSlope>* rows, std::size_t more) {
  std::vector<double> chances;
  for (const ResourceSlope& row : *rows) chances.push_back(row.slope.chance);
  chances.resize(rows->size() + more, 1.0);
  const std::vector<double> adjusted = statistics::HolmAdjusted(chances);
  for (std::size_t i = 0; i < rows->size(); ++i) {
    ResourceSlope& row = (*rows)[i];
    row.leak = row.lasting && statistics::IsLeak(row.slope, LeastLeak(row.kind)) &&
               adjusted[i] < kMostLeakChance;
  }
}

std::uint64_t SharedMemoryIn(const std::vector<std::string>& maps) {
  std::map<std::string, std::uint64_t> all;
  for (const std::string& of_one : maps) {
    for (const auto& [inode, bytes] : SegmentsIn(of_one)) {
      all[inode] = std::max(all[inode], bytes);
    }
  }
  std::uint64_t sum = 0;
  for (const auto& [inode, bytes] : all) sum += bytes;
  return sum;
}

std::uint64_t ReadSharedMemory(const std::vector<pid_t>& processes) {
  std::vector<std::string> maps;
  for (const pid_t process : processes) {
    maps.push_back(ReadWholeFile("/proc/" + std::to_string(process) + "/maps").value_or(""));
  }
  return SharedMemoryIn(maps);
}

}  // namespace giveway::fleetctl
