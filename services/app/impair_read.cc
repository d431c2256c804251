#include "services/app/impair_read.h"

#include <array>
#include <cmath>

#include "services/app/impair_fields.h"
#include "services/app/vehicle_read.h"

namespace giveway::app {
namespace {

// kNobody where absent.
VehicleId ReadVehicleId(const Section& section, const char* field, const KnownIds& known) {
  if (!section.Has(field)) return kNobody;
  const VehicleId id{section.Whole(field, kId)};
  if (id != kNobody && !known.vehicles.contains(id) && !known.joining.contains(id)) {
    section.Complain(field, "no vehicle has this id", "name the id of a vehicle of this file");
  }
  return id;
}

ImpairedSender ReadFrom(const Section& section) {
  constexpr std::array kAsNumberedInTheSchema = {ImpairedSender::kAnyone, ImpairedSender::kVehicles,
                                                 ImpairedSender::kWorld};
  if (section.Has("from_vehicle")) {
    if (section.Has("from")) {
      section.Complain("from", "is given beside from_vehicle", "remove one of the two");
    }
    return ImpairedSender::kOneVehicle;
  }
  const int from = section.Choice("from").value_or(0);
  return kAsNumberedInTheSchema[static_cast<std::size_t>(from)];
}

Blackout ReadBlackout(const Section& section) {
  const Blackout blackout{section.Number("from_s", kBlackoutTime),
                          section.Number("to_s", kBlackoutTime)};
  if (blackout.from_s >= blackout.to_s) {
    section.Complain("to_s", "the blackout ends before it begins", "write to_s above from_s");
  }
  return blackout;
}

}  // namespace

ImpairmentRule ReadImpairmentRule(const Section& section, const KnownIds& known) {
  ImpairmentRule rule;
  rule.from = ReadFrom(section);
  rule.from_vehicle = ReadVehicleId(section, "from_vehicle", known);
  rule.to_vehicle = ReadVehicleId(section, "to_vehicle", known);
  for (const ImpairField& field : ImpairFields()) {
    double& value = rule.*field.member;
    value = section.NumberOr(value * field.per_si, field.field, field.allowed) / field.per_si;
  }
  for (const RuleConflict& conflict : ConflictsIn(rule)) {
    section.Complain(conflict.field, conflict.message, conflict.remedy);
  }
  if (section.Count("blackout") > kMaxBlackouts) {
    section.Complain("blackout", "is one too many: at most 64 are allowed", "leave some out",
                     kMaxBlackouts);
    return rule;
  }
  for (const Section& blackout : section.Subs("blackout")) {
    rule.blackouts.push_back(ReadBlackout(blackout));
  }
  return rule;
}

}  // namespace giveway::app
