#include "sim_world/run/run_checkpoint.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <optional>
#include <type_traits>
#include <utility>

#include "services/types/state_hash.h"

namespace giveway::sim {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are kept as they lie in memory");

constexpr std::string_view kMagic = "giveway-world-6\n";  // the number counts formats

template <typename T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

// Both directions of one format: Visit passes both over the same fields in the same order, so they
// cannot disagree.
class Writer {
 public:
  template <typename... Fields>
  void operator()(Fields&... fields) {
    (Visit(*this, fields), ...);
  }
  template <Plain T>
  void Number(T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  std::size_t Count(std::uint64_t count) {
    Number(count);
    return count;
  }
  std::string Bytes() && { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  template <typename... Fields>
  void operator()(Fields&... fields) {
    (Visit(*this, fields), ...);
  }
  template <Plain T>
  void Number(T& value) {
    if (bytes_.size() < sizeof value) {
      ran_out_ = true;
      return;
    }
    if constexpr (std::is_same_v<T, bool>) {
      value = bytes_.front() != 0;  // any other byte in a bool is undefined
    } else {
      std::memcpy(&value, bytes_.data(), sizeof value);
    }
    bytes_.remove_prefix(sizeof value);
  }
  // Every element takes a byte at least, so that a wrong count cannot ask for all memory.
  std::size_t Count(std::uint64_t) {
    std::uint64_t count = 0;
    Number(count);
    ran_out_ = ran_out_ || count > bytes_.size();
    return ran_out_ ? 0 : count;
  }
  bool HasReadAll() const { return !ran_out_ && bytes_.empty(); }

 private:
  std::string_view bytes_;
  bool ran_out_ = false;
};

template <typename Archive, Plain T>
void Visit(Archive& archive, T& value) {
  archive.Number(value);
}

template <typename Archive, typename T>
void Visit(Archive& archive, std::vector<T>& elements) {
  elements.resize(archive.Count(elements.size()));
  for (T& element : elements) archive(element);
}

template <typename Archive, typename T>
void Visit(Archive& archive, std::optional<T>& value) {
  bool has = value.has_value();
  archive(has);
  if (has && !value) value.emplace();
  if (has) archive(*value);
}

template <typename Archive>
void Visit(Archive& archive, SessionId& session) {
  for (std::uint32_t& word : session) archive(word);
}

template <typename Archive>
void Visit(Archive& archive, Vec2& v) {
  archive(v.x, v.y);
}

template <typename Archive>
void Visit(Archive& archive, Pose& pose) {
  archive(pose.position_world, pose.heading_rad);
}

template <typename Archive>
void Visit(Archive& archive, WheelSpeeds& wheels) {
  archive(wheels.left_rad_s, wheels.right_rad_s);
}

template <typename Archive>
void Visit(Archive& archive, WheelAngles& angles) {
  archive(angles.left_rad, angles.right_rad);
}

template <typename Archive>
void Visit(Archive& archive, Decision& decision) {
  archive(decision.mode, decision.rule, decision.peer, decision.sensor, decision.cause_tick);
}

template <typename Archive>
void Visit(Archive& archive, MotorCommand& command) {
  archive(command.vehicle, command.epoch, command.tick, command.target, command.decision,
          command.decision_changed, command.matched_peers, command.task.waypoint,
          command.task.waited_ticks);
}

template <typename Archive>
void Visit(Archive& archive, BodyState& body) {
  archive(body.vehicle, body.world_from_body, body.wheels, body.counted, body.command,
          body.present);
}

template <typename Archive>
void Visit(Archive& archive, ObstacleState& obstacle) {
  archive(obstacle.position_world, obstacle.progress_m);
}

template <typename Archive>
void Visit(Archive& archive, ContactPair& pair) {
  archive(pair.vehicle, pair.touched, pair.other);
}

template <typename Archive>
void Visit(Archive& archive, ClosestApproach& closest) {
  archive(closest.vehicle, closest.other, closest.gap_m, closest.position_world,
          closest.other_position_world);
}

template <typename Archive>
void Visit(Archive& archive, SeparationRecord& record) {
  struct Pair {
    VehicleId vehicle = kNoVehicle;
    VehicleId other = kNoVehicle;
    double gap_m = 0;
  };
  std::vector<Pair> pairs;
  for (const auto& [who, gap_m] : record.closest_of_pair_m) {
    pairs.push_back({who.first, who.second, gap_m});
  }
  pairs.resize(archive.Count(pairs.size()));
  for (Pair& pair : pairs) {
    archive(pair.vehicle, pair.other, pair.gap_m);
    record.closest_of_pair_m[{pair.vehicle, pair.other}] = pair.gap_m;
  }
  archive(record.closest);
}

template <typename Archive>
void Visit(Archive& archive, Checkpoint& world) {
  archive(world.now, world.driven_ticks, world.contacts, world.bodies, world.obstacles,
          world.door_openings, world.touching, world.separation);
}

template <typename Archive>
void Visit(Archive& archive, RunEvaluator::Track& track) {
  archive(track.vehicle, track.still_ticks, track.halted, track.halted_once, track.stopping_for,
          track.halted_for, track.arrived_before, track.arrived_s);
}

template <typename Archive>
void Visit(Archive& archive, LivenessMonitor::Entry& entry) {
  archive(entry.vehicle, entry.heard, entry.spoke, entry.silent_since, entry.removed);
}

template <typename Archive>
void Visit(Archive& archive, WorldFaults::HeldWheels& held) {
  archive(held.vehicle, held.wheels);
}

template <typename Archive>
void Visit(Archive& archive, WorldFaults::State& fault) {
  archive(fault.fault, fault.begun, fault.held);
}

template <typename Archive>
void Visit(Archive& archive, RunCheckpoint& run) {
  archive(run.epoch, run.started, run.ticks_run, run.event_seq, run.faults, run.world_faults,
          run.tracks, run.liveness, run.world);
}

template <typename Archive>
void Visit(Archive& archive, Slot& slot) {
  archive(slot.vehicle, slot.spawn, slot.taken, slot.session);
}

template <typename Archive>
void Visit(Archive& archive, FleetCheckpoint& checkpoint) {
  archive(checkpoint.scenario, checkpoint.run, checkpoint.slots);
}

// Eight bytes at a time; what is left over counts as a number of its own.
std::uint64_t Checksum(std::string_view bytes) {
  StateHash hash;
  while (!bytes.empty()) {
    std::uint64_t word = 0;
    const std::size_t size = std::min(bytes.size(), sizeof word);
    std::memcpy(&word, bytes.data(), size);
    hash.Add(word);
    bytes.remove_prefix(size);
  }
  return hash.Value();
}

std::string BytesOf(std::uint64_t number) {
  Writer writer;
  writer(number);
  return std::move(writer).Bytes();
}

}  // namespace

// magic, checksum of the rest, the rest
std::string ToBytes(FleetCheckpoint checkpoint) {
  Writer writer;
  writer(checkpoint);
  const std::string rest = std::move(writer).Bytes();
  return std::string(kMagic) + BytesOf(Checksum(rest)) + rest;
}

std::variant<FleetCheckpoint, std::string> FromBytes(std::string_view bytes) {
  if (!bytes.starts_with(kMagic)) return "it is no checkpoint of this version of the world";
  bytes.remove_prefix(kMagic.size());
  if (bytes.size() < sizeof(std::uint64_t)) return "it was cut off";
  const std::string_view rest = bytes.substr(sizeof(std::uint64_t));
  if (!bytes.starts_with(BytesOf(Checksum(rest)))) return "its checksum is wrong";
  FleetCheckpoint checkpoint;
  Reader reader(rest);
  reader(checkpoint);
  if (!reader.HasReadAll()) return "it is not what its version says";
  return checkpoint;
}

}  // namespace giveway::sim
