// The table of all kinds of faults: its word, the actor, the target, whether it takes time, which
// parameters it has. One table serves reading, expanding, printing and `fleetctl faults list`. Says
// what a kind may be, never does it. ToString, KindOf and ActorOf of fault.h look into it. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "services/faults/fault.h"

namespace giveway::faults {

// The members of Parameters that are numbers.
enum class Quantity : std::uint8_t {
  kProbability,
  kShare,
  kFactor,
  kDelay,
  kPeriod,
  kOffset,
  kRate,
  kBytes,
  kCount,
};
inline constexpr std::size_t kQuantities = static_cast<std::size_t>(Quantity::kCount) + 1;

// As fault files have it: "probability", "delay_s".
std::string_view FieldOf(Quantity quantity);
// In its SI unit; "" of a share or a count.
std::string_view UnitOf(Quantity quantity);
std::optional<double> Get(const Parameters& parameters, Quantity quantity);
void Set(Parameters* parameters, Quantity quantity, double value);

// A number that a kind takes, in [low, high].
struct QuantityRow {
  Quantity quantity = Quantity::kCount;
  double usual = 0;  // where a file says nothing
  double low = 0;
  double high = 0;
};

// The targets a kind allows, as bits.
inline constexpr unsigned kOnVehicle = 1U << static_cast<unsigned>(Target::What::kVehicle);
inline constexpr unsigned kOnWorld = 1U << static_cast<unsigned>(Target::What::kWorld);
inline constexpr unsigned kOnServer = 1U << static_cast<unsigned>(Target::What::kDiscoveryServer);
inline constexpr unsigned kOnAll = 1U << static_cast<unsigned>(Target::What::kAll);

struct KindRow {
  Kind kind = Kind::kKill;
  std::string_view word;
  Actor actor = Actor::kSupervisor;
  unsigned targets = kOnVehicle;
  bool takes_time = true;        // for_s is required; otherwise refused
  bool in_virtual_time = false;  // the virtual fleet can carry it out
  std::span<const QuantityRow> numbers;
  bool takes_from = false;          // `from`
  std::string_view usual_qos = "";  // of those that take `qos`
  std::string_view what;            // one line for people

  bool Allows(Target::What what_target) const {
    return (targets >> static_cast<unsigned>(what_target) & 1U) != 0;
  }
};

// In the order of Kind.
std::span<const KindRow> KindTable();
const KindRow& RowOf(Kind kind);
// Of a number that the kind takes.
const QuantityRow* RowOf(Kind kind, Quantity quantity);

std::string_view ToString(Actor actor);
// "vehicle", "world", "discovery_server", "all".
std::string_view ToString(Target::What what);
// "vehicle 3", "world".
std::string ToString(const Target& target);
// "vehicle, world or all".
std::string TargetsOf(const KindRow& row);
// The word most similar to a mistyped one.
std::string_view NearestKind(std::string_view word);

// What is absent filled in with the kind's usual values.
Parameters Filled(Kind kind, Parameters parameters);

}  // namespace giveway::faults
