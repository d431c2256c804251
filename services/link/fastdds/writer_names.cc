#include "services/link/fastdds/writer_names.h"

#include <charconv>
#include <cstring>

namespace giveway::link {
namespace {

// Writers that left stay known, because their last samples and the event that they left are drained
// after the news of it: for two updates, however many leave at once, and the last few until others
// follow, so that one that is found again keeps its place in the order. Some 110 bytes each.
constexpr std::uint64_t kGoneUpdates = 2;
constexpr std::size_t kGoneKept = 256;

constexpr std::uint64_t Mix(std::uint64_t bits) {
  bits = (bits ^ (bits >> 32U)) * 0xd6e8feb86659fd93ULL;
  return bits ^ (bits >> 32U);
}

thread_local rtps::GUID_t found_by_this_thread;

}  // namespace

VehicleId NamedVehicle(const std::vector<std::string>& partitions) {
  if (partitions.size() != 1) return kNoVehicle;
  std::string_view name = partitions.front();
  name.remove_prefix(name.rfind('/') + 1);  // npos + 1 is 0: no area before the name
  if (name.size() < 2 || name[0] != 'v' || name[1] == '0') return kNoVehicle;
  std::uint32_t number = 0;
  const char* const end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data() + 1, end, number);
  if (error != std::errc{} || stop != end) return kNoVehicle;
  return VehicleId{number};
}

std::string BeaconArea(const std::vector<std::string>& partitions) {
  if (NamedVehicle(partitions) == kNoVehicle) return "";
  const std::string& name = partitions.front();
  const std::size_t slash = name.rfind('/');
  return slash == std::string::npos ? "" : name.substr(0, slash);
}

std::uint64_t Identity(const rtps::GUID_t& endpoint) {
  static_assert(sizeof(endpoint.guidPrefix.value) + sizeof(endpoint.entityId.value) == 16);
  std::uint64_t high = 0;
  std::uint64_t low = 0;
  std::memcpy(&high, endpoint.guidPrefix.value, 8);
  std::memcpy(&low, endpoint.guidPrefix.value + 8, 4);
  std::uint32_t entity = 0;
  std::memcpy(&entity, endpoint.entityId.value, 4);
  const std::uint64_t hash = Mix(Mix(high) + (low << 32U | entity));
  return hash == 0 ? 1 : hash;
}

rtps::GUID_t GuidOf(const dds::InstanceHandle_t& handle) {
  rtps::GUID_t guid;
  rtps::iHandle2GUID(guid, handle);
  return guid;
}

void WriterNames::OnWriter(Change change, const rtps::GUID_t& writer,
                           const std::vector<std::string>& partitions) {
  const Queued queued{change, Identity(writer), NamedVehicle(partitions), BeaconArea(partitions)};
  if (change == Change::kFound) found_by_this_thread = writer;
  const std::scoped_lock lock(mutex_);
  queue_.push_back(queued);
}

const rtps::GUID_t& WriterNames::FoundByThisThread() { return found_by_this_thread; }

void WriterNames::Update() {
  ++updates_;
  batch_.clear();
  left_now_.clear();
  {
    const std::scoped_lock lock(mutex_);
    batch_.swap(queue_);
  }
  for (const Queued& queued : batch_) {
    WriterEntry& entry = writers_[queued.identity];
    entry.identity = queued.identity;
    if (entry.found == 0) entry.found = ++found_;
    // To the library it is a new one: of what it sent meanwhile nothing was received.
    if (entry.gone && queued.change == Change::kFound) entry.last_sequence = 0;
    entry.gone = queued.change == Change::kGone;
    if (entry.gone) {
      gone_.push_back({queued.identity, updates_});
      left_now_.push_back(queued.identity);
    } else {
      entry.vehicle = queued.vehicle;
      entry.area = queued.area;
    }
  }
  ForgetGone();
}

void WriterNames::ForgetGone() {
  const auto is_old = [this](const Gone& gone) { return updates_ - gone.update > kGoneUpdates; };
  for (; gone_.size() > kGoneKept && is_old(gone_.front()); gone_.pop_front()) {
    const auto oldest = writers_.find(gone_.front().identity);
    if (oldest != writers_.end() && oldest->second.gone) writers_.erase(oldest);
  }
}

WriterEntry* WriterNames::Find(const rtps::GUID_t& writer) {
  const auto found = writers_.find(Identity(writer));
  return found == writers_.end() ? nullptr : &found->second;
}

const WriterEntry* WriterNames::Find(const rtps::GUID_t& writer) const {
  return Find(Identity(writer));
}

const WriterEntry* WriterNames::Find(std::uint64_t identity) const {
  const auto found = writers_.find(identity);
  return found == writers_.end() ? nullptr : &found->second;
}

}  // namespace giveway::link
