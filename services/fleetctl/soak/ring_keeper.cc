#include "services/fleetctl/soak/ring_keeper.h"

#include <algorithm>
#include <map>
#include <utility>

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

constexpr Nanoseconds kPruneEvery = std::chrono::seconds(30);
constexpr const char* kEnding = ".recording";

struct RingFile {
  fs::file_time_type written;
  fs::path path;
};

// By vehicle, the newest first: "vehicle-3" of vehicle-3.17.recording.
std::map<std::string, std::vector<RingFile>> RingFilesIn(const fs::path& folder) {
  std::map<std::string, std::vector<RingFile>> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename();
    if (!name.ends_with(kEnding)) continue;
    const fs::file_time_type written = entry.last_write_time(error);
    files[name.substr(0, name.find('.'))].push_back({written, entry.path()});
  }
  for (auto& [vehicle, of_one] : files) {
    std::ranges::sort(of_one, std::ranges::greater(), &RingFile::written);
  }
  return files;
}

}  // namespace

void RingOrders::Add(std::uint64_t number, VehicleId vehicle, std::size_t keep) {
  orders_.emplace(number, Waiting{vehicle, keep});
}

std::optional<std::size_t> RingOrders::Take(const AdminAnswer& answer) {
  const auto order = orders_.find(answer.order);
  if (order == orders_.end() || order->second.vehicle != answer.vehicle) return std::nullopt;
  if (has_key_ && answer.seal == Seal{}) return std::nullopt;
  const std::size_t keep = order->second.keep;
  orders_.erase(order);
  if (answer.state != AnswerState::kInEffect) return std::nullopt;
  return keep;
}

RingKeeper::RingKeeper(const link::LinkOptions& options, const std::string& key,
                       std::span<const VehicleId> fleet, fs::path folder, Nanoseconds ring)
    : link_(options, key),
      orders_(!key.empty()),
      fleet_(fleet.begin(), fleet.end()),
      folder_(std::move(folder)),
      ring_(ring) {
  for (const VehicleId vehicle : fleet_) link_.Seek(vehicle);
  // A resumed soak keeps those of the fleet before, which its report may name.
  for (const auto& [vehicle, files] : RingFilesIn(folder_)) {
    for (const RingFile& file : files) kept_files_.insert(file.path);
  }
}

void RingKeeper::Keep(SteadyTime now, double time_s) {
  const bool soon = !kept_.empty() && now - ordered_ < ring_;
  if (soon || kept_.size() == kMostOrders) return;
  ordered_ = now;
  KeptRings kept{.time_s = time_s};
  for (const auto& [vehicle, files] : RingFilesIn(folder_)) {
    for (const RingFile& file : files) kept_files_.insert(file.path);
  }
  for (const VehicleId vehicle : fleet_) {
    if (!link_.Reaches(vehicle)) continue;
    const AdminRequest order{.vehicle = vehicle,
                             .number = link::OperatorLink::NextNumber(),
                             .kind = AdminRequestKind::kKeepRing};
    orders_.Add(order.number, vehicle, kept_.size());
    if (link_.Send(order)) ++kept.ordered;
  }
  kept_.push_back(kept);
}

void RingKeeper::Turn(SteadyTime now) {
  for (const AdminAnswer& answer : link_.Take()) {
    if (const auto keep = orders_.Take(answer)) ++kept_[*keep].kept;
  }
  if (now < next_prune_) return;
  next_prune_ = now + kPruneEvery;
  Prune();
}

// A kept file may be followed by others that the vehicle has yet to keep.
void RingKeeper::Prune() {
  for (const auto& [vehicle, files] : RingFilesIn(folder_)) {
    std::size_t unkept = 0;
    for (const RingFile& file : files) {
      if (kept_files_.contains(file.path) || ++unkept <= kMostUnkept) continue;
      std::error_code error;
      fs::remove(file.path, error);
    }
  }
}

}  // namespace giveway::fleetctl
