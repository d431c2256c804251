// The parts that several conversions share. Internal to convert*.cc.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "services/link/fastdds/fastdds_version.h"
#include "services/types/admin.h"
#include "services/types/decision.h"
#include "services/types/fleet_facts.h"
#include "services/types/math/pose.h"
#include "services/types/qos_event.h"
#include "services/types/sensor_scan.h"
#include "services/types/signal.h"

namespace giveway::link {

// Wire enumerators stand in the order of ours, so a number is enough; `last` is our last one.
template <typename Wire, typename Ours>
constexpr bool SameOrder(Wire wire_last, Ours last) {
  return static_cast<std::uint32_t>(wire_last) == static_cast<std::uint32_t>(last);
}
static_assert(SameOrder(wire::DriveMode::MODE_LEAVING, Mode::kLeaving));
static_assert(SameOrder(wire::DriveRule::RULE_LOST, kLastRule));
static_assert(SameOrder(wire::EchoKind::ECHO_HEARD, Echo::kEcho));
static_assert(SameOrder(wire::SeenClass::SEEN_SIGNAL, SeenClass::kSignal));
static_assert(SameOrder(wire::SignalPhase::PHASE_GREEN, SignalPhase::kGreen));
static_assert(SameOrder(wire::QosEventKind::QOS_EVENT_SAMPLE_LOST,
                        giveway::QosEventKind::kSampleLost));
static_assert(SameOrder(wire::RunPhase::RUN_ENDED, RunState::kEnded));
static_assert(SameOrder(wire::EventKind::EVENT_FAULT_OVER, giveway::EventKind::kFaultOver));
static_assert(SameOrder(wire::OrderKind::ORDER_KEEP_RING, giveway::AdminRequestKind::kKeepRing));
static_assert(SameOrder(wire::AnswerState::ANSWER_REFUSED, giveway::AnswerState::kRefused));

template <typename Wire, typename Ours>
constexpr Wire ToWireEnum(Ours ours) {
  return static_cast<Wire>(static_cast<std::uint32_t>(ours));
}

// False, leaving `ours` alone, if the sender knows an enumerator that this build does not.
template <typename Wire, typename Ours>
constexpr bool FromWireEnum(Wire sent, Ours last, Ours& ours) {
  const auto number = static_cast<std::uint32_t>(sent);
  if (number > static_cast<std::uint32_t>(last)) return false;
  ours = static_cast<Ours>(number);
  return true;
}

inline wire::PlanarCovariance ToWirePart(const PoseCovariance& covariance) {
  wire::PlanarCovariance sent;
  sent.xx_m2(covariance.xx_m2);
  sent.xy_m2(covariance.xy_m2);
  sent.yy_m2(covariance.yy_m2);
  sent.xh_m_rad(covariance.xh_m_rad);
  sent.yh_m_rad(covariance.yh_m_rad);
  sent.hh_rad2(covariance.hh_rad2);
  return sent;
}
inline void FromWirePart(const wire::PlanarCovariance& sent, PoseCovariance& covariance) {
  covariance = {sent.xx_m2(),    sent.xy_m2(),    sent.yy_m2(),
                sent.xh_m_rad(), sent.yh_m_rad(), sent.hh_rad2()};
}

inline bool FromWirePart(wire::DriveMode sent, Mode& mode) {
  return FromWireEnum(sent, Mode::kLeaving, mode);
}
inline bool FromWirePart(wire::DriveRule sent, Rule& rule) {
  return FromWireEnum(sent, kLastRule, rule);
}
inline bool FromWirePart(wire::EchoKind sent, Echo& echo) {
  return FromWireEnum(sent, Echo::kEcho, echo);
}
inline bool FromWirePart(wire::SeenClass sent, SeenClass& seen_class) {
  return FromWireEnum(sent, SeenClass::kSignal, seen_class);
}
inline bool FromWirePart(wire::SignalPhase sent, SignalPhase& phase) {
  return FromWireEnum(sent, SignalPhase::kGreen, phase);
}
inline bool FromWirePart(wire::RunPhase sent, RunState& state) {
  return FromWireEnum(sent, RunState::kEnded, state);
}
inline bool FromWirePart(wire::EventKind sent, giveway::EventKind& kind) {
  return FromWireEnum(sent, giveway::EventKind::kFaultOver, kind);
}

inline wire::PlanarPose ToWirePart(const Pose& pose) {
  wire::PlanarPose sent;
  sent.x_m(pose.position_world.x);
  sent.y_m(pose.position_world.y);
  sent.heading_rad(pose.heading_rad);
  return sent;
}

inline Pose FromWirePart(const wire::PlanarPose& sent) {
  return {{sent.x_m(), sent.y_m()}, sent.heading_rad()};
}
inline bool IsFinite(Vec2 point) { return std::isfinite(point.x) && std::isfinite(point.y); }
inline bool IsFinite(const Pose& pose) {
  return IsFinite(pose.position_world) && std::isfinite(pose.heading_rad);
}

inline wire::DecisionRecord ToWirePart(const Decision& decision) {
  wire::DecisionRecord sent;
  sent.mode(ToWireEnum<wire::DriveMode>(decision.mode));
  sent.rule(ToWireEnum<wire::DriveRule>(decision.rule));
  sent.peer(Number(decision.peer));
  sent.sensor(decision.sensor);
  sent.cause_tick(Number(decision.cause_tick));
  return sent;
}

inline bool FromWirePart(const wire::DecisionRecord& sent, Decision& decision) {
  decision.peer = VehicleId{sent.peer()};
  decision.sensor = sent.sensor();
  decision.cause_tick = Tick{sent.cause_tick()};
  const bool mode_known = FromWirePart(sent.mode(), decision.mode);
  return FromWirePart(sent.rule(), decision.rule) && mode_known;
}

inline wire::OptionalNumber ToWirePart(const std::optional<double>& number) {
  wire::OptionalNumber sent;
  sent.known(number.has_value());
  sent.number(number.value_or(0));
  return sent;
}

inline std::optional<double> FromWirePart(const wire::OptionalNumber& sent) {
  return sent.known() ? std::optional(sent.number()) : std::nullopt;
}

// At most so many bytes, never ending inside a UTF-8 character.
inline std::string CutText(std::string_view text, std::size_t most = 255) {
  if (text.size() <= most) return std::string(text);
  std::size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return std::string(text.substr(0, end));
}

}  // namespace giveway::link
