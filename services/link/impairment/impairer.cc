#include "services/link/impairment/impairer.h"

#include <algorithm>

#include "services/link/fastdds/writer_names.h"

namespace giveway::link {
namespace {

// RTPS header: "RTPS", version (2), vendor (2), GUID prefix (12).
constexpr std::size_t kPrefixAt = 8;
constexpr std::array<std::uint8_t, 4> kMagic = {'R', 'T', 'P', 'S'};
constexpr std::size_t kMaxNamed = 4096;
// Heard before they were named; apart from the named, since any packet has a prefix, and those of
// forged headers must neither fill the memory nor keep a vehicle from being identified. Later ones
// share a channel until they are named.
constexpr std::uint32_t kMaxUnknown = 4096;

// All zero, which no participant has, for what is no RTPS packet.
PrefixBytes PrefixOf(std::span<const std::uint8_t> packet) {
  PrefixBytes prefix{};
  if (packet.size() < kPrefixAt + prefix.size()) return prefix;
  if (!std::equal(kMagic.begin(), kMagic.end(), packet.begin())) return prefix;
  std::copy_n(packet.begin() + kPrefixAt, prefix.size(), prefix.begin());
  return prefix;
}

Sender NamedBy(const std::vector<std::string>& partitions) {
  if (partitions.size() != 1) return {};
  if (partitions.front() == "world") return {Sender::Kind::kWorld, 0};
  if (partitions.front().find('/') == std::string::npos) return {};
  const VehicleId vehicle = NamedVehicle(partitions);
  if (vehicle == kNoVehicle) return {};
  return {Sender::Kind::kVehicle, Number(vehicle)};
}

}  // namespace

void Impairer::NameOwn(const PrefixBytes& own) {
  const std::scoped_lock lock(mutex_);
  own_ = own;
}

void Impairer::NameHearer(VehicleId hearer) {
  const std::scoped_lock lock(mutex_);
  model_.NameHearer(hearer);
}

void Impairer::Start(SteadyTime now) {
  const std::scoped_lock lock(mutex_);
  model_.Start(now);
}

std::optional<SteadyTime> Impairer::Started() const {
  const std::scoped_lock lock(mutex_);
  return model_.Started();
}

void Impairer::OnWriter(const PrefixBytes& process, const std::vector<std::string>& partitions) {
  const Sender named = NamedBy(partitions);
  if (named.kind == Sender::Kind::kUnknown) return;
  const std::scoped_lock lock(mutex_);
  if (!named_.contains(process) && !MakeRoom()) return;
  named_[process] = {named, 0};
  unknown_.erase(process);
}

void Impairer::OnWriterGone(const PrefixBytes& process,
                            const std::vector<std::string>& partitions) {
  if (NamedBy(partitions).kind == Sender::Kind::kUnknown) return;
  const std::scoped_lock lock(mutex_);
  const auto known = named_.find(process);
  if (known != named_.end()) known->second.gone = ++gone_;
}

// In the place of the one whose writer is gone longest. False if all are there.
bool Impairer::MakeRoom() {
  if (named_.size() < kMaxNamed) return true;
  const auto longest = std::ranges::min_element(
      named_, {}, [](const auto& named) { return named.second.gone - 1; });  // 0 last: it wraps
  if (longest->second.gone == 0) return false;
  named_.erase(longest);
  return true;
}

Sender Impairer::SenderOf(const PrefixBytes& process) {
  const auto named = named_.find(process);
  if (named != named_.end()) return named->second.sender;
  const auto unknown = unknown_.find(process);
  if (unknown != unknown_.end()) return {Sender::Kind::kUnknown, unknown->second};
  if (numbers_ == kMaxUnknown) return {};
  unknown_[process] = ++numbers_;
  return {Sender::Kind::kUnknown, numbers_};
}

PacketFate Impairer::Decide(std::span<const std::uint8_t> packet, SteadyTime now) {
  const PrefixBytes prefix = PrefixOf(packet);
  const std::scoped_lock lock(mutex_);
  if (!own_ || prefix == *own_) return {};
  return model_.Decide(SenderOf(prefix), static_cast<std::uint32_t>(packet.size()), now);
}

void Impairer::NoteAbandoned(std::size_t packets) {
  const std::scoped_lock lock(mutex_);
  abandoned_ += packets;
}

ImpairmentCounters Impairer::Counters() const {
  const std::scoped_lock lock(mutex_);
  ImpairmentCounters counters = model_.Counters();
  counters.abandoned = abandoned_;
  return counters;
}

ImpairmentCounters Impairer::CountersOf(VehicleId sender) const {
  const std::scoped_lock lock(mutex_);
  return model_.CountersOf({Sender::Kind::kVehicle, Number(sender)});
}

std::size_t Impairer::Senders() const {
  const std::scoped_lock lock(mutex_);
  return named_.size() + unknown_.size();
}

}  // namespace giveway::link
