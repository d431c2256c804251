#include "services/faults/exclusion.h"

#include <limits>
#include <vector>

#include "services/faults/kind_table.h"

namespace giveway::faults {
namespace {

// Kinds of one group exclude each other on one target; `kAlone` only themselves.
enum class Group : std::uint8_t { kAlone, kProcess, kSharedMemory, kCut, kSonar, kMotor };

Group GroupOf(Kind kind) {
  switch (kind) {
    case Kind::kChurn:
      return Group::kAlone;  // of processes that are in no list
    case Kind::kSharedMemoryGone:
    case Kind::kSharedMemoryLeftOver:
    case Kind::kSharedMemorySmall:
      return Group::kSharedMemory;
    case Kind::kOneWayCut:
    case Kind::kPartition:
    case Kind::kFlapping:
      return Group::kCut;
    case Kind::kSonarOff:
    case Kind::kSonarStuck:
    case Kind::kSonarGarbage:
    case Kind::kSonarWrong:
    case Kind::kSonarSlow:
    case Kind::kSonarDelayed:
    case Kind::kSonarIntermittent:
      return Group::kSonar;
    case Kind::kMotorWeak:
    case Kind::kMotorStuck:
      return Group::kMotor;
    default:
      return ActorOf(kind) == Actor::kSupervisor ? Group::kProcess : Group::kAlone;
  }
}

double LastsUntil_s(const Fault& fault) {
  return fault.kind == Kind::kKill ? std::numeric_limits<double>::infinity() : fault.EndsAt_s();
}

// There is no process to kill while all are away for a while.
bool IsAwayAt(const Fault& kill, const Fault& other) {
  const bool takes_away = other.kind == Kind::kRestart || other.kind == Kind::kQosMismatch;
  return takes_away && other.target.what == Target::What::kAll && kill.at_s >= other.at_s;
}

// A kill concerns its one process only: what meets all continues meeting the others.
bool OnOneTarget(const Fault& a, const Fault& b) {
  if (a.kind == Kind::kKill && IsAwayAt(a, b)) return true;
  if (b.kind == Kind::kKill && IsAwayAt(b, a)) return true;
  if (a.kind == Kind::kKill || b.kind == Kind::kKill) return a.target == b.target;
  return a.target == b.target || a.target.what == Target::What::kAll ||
         b.target.what == Target::What::kAll;
}

// Nothing is said by the target meanwhile.
bool Silences(Kind kind) {
  return kind == Kind::kRestart || kind == Kind::kPause || kind == Kind::kHang ||
         kind == Kind::kQosMismatch;
}

// An intruder goes by what its target says. Of all it hears enough while one is silent; and what
// silences all does so for a moment.
bool Deafens(const Fault& a, const Fault& b) {
  return Silences(a.kind) && ActorOf(b.kind) == Actor::kAttacker && a.target == b.target;
}

// The target hears nothing for as long as the other lasts, and until it has joined again: there is
// nothing to lose, delay or cut. A loop that hangs leaves the threads that receive alone.
bool IsWithin(const Fault& heard, const Fault& silence) {
  constexpr double kUntilHeard_s = 3;
  return ActorOf(heard.kind) == Actor::kHearer && Silences(silence.kind) &&
         silence.kind != Kind::kHang && heard.target.what == Target::What::kVehicle &&
         heard.at_s >= silence.at_s && heard.EndsAt_s() <= silence.EndsAt_s() + kUntilHeard_s;
}

bool KindsExclude(const Fault& a, const Fault& b) {
  if (a.kind == b.kind) return true;
  if (a.kind == Kind::kKill || b.kind == Kind::kKill) return true;
  if (Deafens(a, b) || Deafens(b, a)) return true;
  if (IsWithin(a, b) || IsWithin(b, a)) return true;
  const Group group = GroupOf(a.kind);
  return group != Group::kAlone && group == GroupOf(b.kind);
}

}  // namespace

bool Exclude(const Fault& a, const Fault& b) {
  return a.at_s <= LastsUntil_s(b) && b.at_s <= LastsUntil_s(a) && OnOneTarget(a, b) &&
         KindsExclude(a, b);
}

void ForEachExcluding(std::span<const Fault> faults,
                      const std::function<void(std::size_t, std::size_t)>& pair) {
  std::vector<std::size_t> under_way;
  for (std::size_t i = 0; i < faults.size(); ++i) {
    std::erase_if(under_way,
                  [&](std::size_t j) { return LastsUntil_s(faults[j]) < faults[i].at_s; });
    for (const std::size_t j : under_way) {
      if (Exclude(faults[j], faults[i])) pair(j, i);
    }
    under_way.push_back(i);
  }
}

}  // namespace giveway::faults
