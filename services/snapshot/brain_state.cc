#include "services/snapshot/brain_state.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

#include "services/snapshot/state_fields.h"
#include "services/vehicle/estimation/beacon_check.h"
#include "services/vehicle/estimation/scan_check.h"

namespace giveway {
namespace {

constexpr std::uint32_t kAllSensors = (1U << kSensorCount) - 1;
// Of anything a brain remembers; its square is far from overflowing.
constexpr double kMostNumber = 1e10;
constexpr double kUnitSlack = 1e-6;
// The difference of any two times does not overflow.
constexpr std::int64_t kMostTime_ns = std::numeric_limits<std::int64_t>::max() / 2;

// The last enumerator; ids, which are enumerations too, have none.
template <typename Enum>
constexpr std::uint64_t kLast = std::numeric_limits<std::uint32_t>::max();
template <>
constexpr std::uint64_t kLast<Mode> = static_cast<std::uint64_t>(Mode::kLeaving);
template <>
constexpr std::uint64_t kLast<Rule> = static_cast<std::uint64_t>(kLastRule);
template <>
constexpr std::uint64_t kLast<RunState> = static_cast<std::uint64_t>(RunState::kEnded);
template <>
constexpr std::uint64_t kLast<Echo> = static_cast<std::uint64_t>(Echo::kEcho);
template <>
constexpr std::uint64_t kLast<ScanNews> = static_cast<std::uint64_t>(ScanNews::kOther);
template <>
constexpr std::uint64_t kLast<SeenClass> = static_cast<std::uint64_t>(SeenClass::kSignal);
template <>
constexpr std::uint64_t kLast<SignalPhase> = static_cast<std::uint64_t>(SignalPhase::kGreen);

template <typename T>
concept Array = !std::is_same_v<T, Nanoseconds> && requires(T list) {
  list.begin();
  list.size();
};

// Little-endian, without padding.
class StateWriter {
 public:
  explicit StateWriter(StateFormat format) : format_(format) {}

  void operator()(const auto&... values) { (Put(values), ...); }
  bool Has(StateFormat part) const { return format_ >= part; }
  std::string Take() { return std::move(bytes_); }

 private:
  template <typename T>
  void Put(const T& value) {
    if constexpr (std::is_same_v<T, Nanoseconds>) {
      Bytes(static_cast<std::uint64_t>(value.count()), 8);
    } else if constexpr (std::is_same_v<T, double>) {
      Bytes(std::bit_cast<std::uint64_t>(value), 8);
    } else if constexpr (Array<T>) {
      for (const auto& element : value) Put(element);
    } else if constexpr (std::is_class_v<T>) {
      Visit(*this, value);
    } else {
      Bytes(static_cast<std::uint64_t>(value), sizeof(T));
    }
  }
  void Bytes(std::uint64_t number, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) bytes_ += static_cast<char>(number >> 8 * i);
  }

  StateFormat format_;
  std::string bytes_;
};

class StateReader {
 public:
  explicit StateReader(std::string_view bytes) : bytes_(bytes) {}

  void operator()(auto&... values) { (Get(&values), ...); }
  // Of the layout that is read.
  void SetFormat(StateFormat format) { format_ = format; }
  bool Has(StateFormat part) const { return format_ >= part; }
  bool IsSound() const { return sound_; }
  bool IsAtEnd() const { return bytes_.empty(); }

 private:
  template <typename T>
  void Get(T* value) {
    if constexpr (std::is_same_v<T, Nanoseconds>) {
      const auto count = static_cast<std::int64_t>(Number64(8));
      sound_ = sound_ && count >= -kMostTime_ns && count <= kMostTime_ns;
      *value = Nanoseconds{count};
    } else if constexpr (std::is_same_v<T, double>) {
      *value = std::bit_cast<double>(Number64(8));
      sound_ = sound_ && std::abs(*value) <= kMostNumber;  // not of what is no number either
    } else if constexpr (std::is_same_v<T, CachedHeading>) {
      Visit(*this, *value);
      RequireUnit(value->forward_world);
    } else if constexpr (std::is_same_v<T, CachedBearing>) {
      Visit(*this, *value);
      RequireUnit(value->direction_world);
    } else if constexpr (std::is_same_v<T, PeerTable>) {
      GetPeers(value);
    } else if constexpr (Array<T>) {
      for (auto& element : *value) Get(&element);
    } else if constexpr (std::is_class_v<T>) {
      Visit(*this, *value);
    } else if constexpr (std::is_same_v<T, bool>) {
      const std::uint64_t number = Number64(1);
      sound_ = sound_ && number <= 1;
      *value = number == 1;
    } else if constexpr (std::is_enum_v<T>) {
      const std::uint64_t number = Number64(sizeof(T));
      sound_ = sound_ && number <= kLast<T>;
      *value = static_cast<T>(sound_ ? number : 0);
    } else {
      *value = static_cast<T>(Number64(sizeof(T)));
    }
  }
  void RequireUnit(Vec2 vector) {
    sound_ = sound_ && std::abs(Dot(vector, vector) - 1) <= kUnitSlack;
  }
  // How many there are is known, and bounded, before any is read.
  void GetPeers(PeerTable* table) {
    const std::string_view from = bytes_;
    const std::uint64_t count = Number64(sizeof(std::uint32_t));
    sound_ = sound_ && count <= kMaxPeers;
    bytes_ = from;
    if (!sound_) return;
    StateFields::MakePeers(table, static_cast<std::uint32_t>(count));
    Visit(*this, *table);
  }
  // 0 where nothing is left.
  std::uint64_t Number64(std::size_t count) {
    if (bytes_.size() < count) {
      sound_ = false;
      bytes_ = {};
      return 0;
    }
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < count; ++i) {
      number |= std::uint64_t{static_cast<unsigned char>(bytes_[i])} << 8 * i;
    }
    bytes_.remove_prefix(count);
    return number;
  }

  std::string_view bytes_;
  StateFormat format_ = kStateFormat;
  bool sound_ = true;
};

bool IsSensor(int sensor) { return sensor >= -1 && sensor < static_cast<int>(kSensorCount); }

bool IsSound(const Peer& peer) {
  if (peer.id == kNoVehicle || peer.waiting_count > peer.waiting.size()) return false;
  if (peer.known && !IsInRange(peer.beacon)) return false;
  for (std::uint32_t i = 0; i < peer.waiting_count; ++i) {
    if (!IsInRange(peer.waiting[i])) return false;
  }
  return true;
}

bool AreSound(std::span<const Peer> peers) {
  VehicleId before = kNoVehicle;
  for (const Peer& peer : peers) {
    if (!IsSound(peer) || peer.id <= before) return false;  // in the order of their ids
    before = peer.id;
  }
  return true;
}

bool AreSound(const SignalTable& table) {
  if (StateFields::CountOf(table) > kMaxSignals) return false;
  for (std::uint32_t i = 0; i < StateFields::CountOf(table); ++i) {
    if (!IsBelievable(StateFields::SignalOf(table, i))) return false;
  }
  return true;
}

template <typename Scan>
bool IsSound(const HeldScan<Scan>& held) {
  if constexpr (requires { held.scan.count; }) {
    if (held.scan.count > kMaxDetections) return false;
  }
  return held.scan.tick == kNoTick || IsBelievable(held.scan);
}

bool IsSound(const ObstacleGrid& grid) {
  const Vec2 at = StateFields::PlaceOf(grid);
  const auto is_in = [](double at_m) { return at_m >= 0 && at_m < ObstacleGrid::kWide_m; };
  const auto rows = StateFields::RowsOf(grid);
  const bool has_columns = std::all_of(
      rows.begin(), rows.end(), [](std::uint64_t row) { return row >> ObstacleGrid::kSide == 0; });
  const auto cells = StateFields::CellsOf(grid);
  const bool has_cells = std::all_of(cells.begin(), cells.end(), [](std::uint8_t cell) {
    return cell <= ObstacleGrid::kSurestNear;
  });
  return is_in(at.x) && is_in(at.y) && has_columns && has_cells &&
         StateFields::UnsureOf(grid) >= 0 && StateFields::FadedOf(grid) >= 0;
}

// What a scan may bring, as scan_check.h has it.
bool IsSound(const RangeView& ranges, const VehicleOptions& options) {
  const auto views = StateFields::SensorsOf(ranges);
  return std::all_of(views.begin(), views.end(), [&](const SensorView& view) {
    return IsRange(view.range_m, options.profile) && view.echo_before_s >= 0;
  });
}

bool IsKnown(std::uint32_t format) {
  return format >= static_cast<std::uint32_t>(StateFormat::kFirst) &&
         format <= static_cast<std::uint32_t>(StateFormat::kWithDoubtedSonar);
}

// Format 5 had the doubt of the ultrasonics once a peer. It is not taken on.
void VisitDoubtsByPeer(auto& fields, Is<VehicleState> auto& state) {
  for ([[maybe_unused]] auto& peer : state.heard.peers.Peers()) {
    SonarDoubt none;
    fields(none);
  }
}

// Format 6 had the tick since which the ultrasonics were doubted. It is not taken on either.
void VisitTickOfDoubt(auto& fields) {
  Tick none = kNoTick;
  fields(none);
}

// What formats after the second have at the end.
void VisitAppended(auto& fields, Is<VehicleState> auto& state) {
  if (fields.Has(StateFormat::kWithGrid)) fields(state.sensed.grid);
  if (fields.Has(StateFormat::kWithDoubtedHeading)) fields(state.motion.pose.disagreement.off_rad);
  if (fields.Has(StateFormat::kWithWrongFixes)) fields(state.motion.pose.wrong_share);
  if (fields.Has(StateFormat::kWithTimedDoubt)) {
    fields(state.sensed.doubt);
    if (!fields.Has(StateFormat::kWithDoubtedSonar)) VisitTickOfDoubt(fields);
  } else if (fields.Has(StateFormat::kWithWrongFixes)) {
    VisitDoubtsByPeer(fields, state);
  }
}

std::string BytesIn(StateFormat format, const VehicleState& state) {
  StateWriter writer(format);
  writer(static_cast<std::uint32_t>(format), VehicleState::kVersion, state);
  VisitAppended(writer, state);
  return writer.Take();
}

// The oldest that has all of it.
StateFormat FormatOf(const VehicleState& state) {
  if (state.motion.pose.wrong_share != 0 || state.sensed.doubt.ticks > 0)
    return StateFormat::kWithDoubtedSonar;
  if (state.motion.pose.disagreement.off_rad != 0) return StateFormat::kWithDoubtedHeading;
  return state.sensed.grid.IsActive() ? StateFormat::kWithGrid : kStateFormat;
}

// What a number is used as a place by.
bool IsSound(const VehicleState& state, const VehicleOptions& options) {
  const bool on_route =
      OnRoute(options.route, {state.route.waypoint, 0}).waypoint == state.route.waypoint;
  const PoseCovariance covariance = state.motion.odometry.Covariance();
  const bool can_be_there =
      covariance.xx_m2 >= 0 && covariance.yy_m2 >= 0 && covariance.hh_rad2 >= 0;
  return state.published.boot_epoch != 0 && can_be_there && on_route &&
         IsSensor(state.movers.unidentified_sensor) && IsSensor(state.last.decision.sensor) &&
         state.last.steer_side >= -1 && state.last.steer_side <= 1 &&
         (StateFields::SensorBitsOf(state.sensed.ranges) & ~kAllSensors) == 0 &&
         IsSound(state.sensed.ranges, options) && IsSound(state.motion.pose) &&
         AreSound(state.heard.peers.Peers()) && AreSound(state.heard.signals) &&
         IsSound(state.sensed.grid) && IsSound(state.sensed.objects.radar) &&
         IsSound(state.sensed.objects.lidar) && IsSound(state.sensed.objects.camera);
}

}  // namespace

std::string BytesOf(const VehicleState& state) { return BytesIn(FormatOf(state), state); }

bool AreBytesOf(std::string_view bytes, const VehicleState& state) {
  StateReader reader(bytes);
  std::uint32_t format = 0;
  reader(format);
  return IsKnown(format) && BytesIn(StateFormat{format}, state) == bytes;
}

std::unique_ptr<VehicleState> StateFrom(std::string_view bytes, const VehicleOptions& options) {
  StateReader reader(bytes);
  std::uint32_t format = 0;
  std::uint32_t version = 0;
  reader(format, version);
  if (!IsKnown(format) || version != VehicleState::kVersion) return nullptr;
  reader.SetFormat(StateFormat{format});
  auto state = std::make_unique<VehicleState>();
  Begin(options.profile, &state->motion.pose);  // an image without it
  reader(*state);
  VisitAppended(reader, *state);
  if (!reader.IsSound() || !reader.IsAtEnd() || !IsSound(*state, options)) return nullptr;
  return state;
}

}  // namespace giveway
