// The hearers' faults as the impairment that each vehicle is given when it is started: rules that
// hold from one second to another. Pure.
#pragma once

#include <map>
#include <span>

#include "services/faults/fault.h"
#include "services/types/impairment.h"

namespace giveway::faults {

// A fault that flaps more often is refused: services/config/impair.h takes no more at once.
inline constexpr double kMostFlaps = 1000;

// For each of `vehicles` whose reception the list ever impairs: the rules of its impairment. Only
// samples of other vehicles are impaired: what a vehicle senses of the world comes by no radio.
std::map<VehicleId, Impairment> ImpairmentOf(const Schedule& schedule,
                                             std::span<const VehicleId> vehicles);
// The same behind `always`, the rules of a scenario, whose place an impairment takes, so that the
// faults hold while they last: for each of `vehicles`, or for none where the list impairs none.
std::map<VehicleId, Impairment> ImpairmentWith(const Schedule& schedule,
                                               std::span<const VehicleId> vehicles,
                                               const Impairment& always);

}  // namespace giveway::faults
