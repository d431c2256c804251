#include "services/vehicle_node/vehicle_end.h"

#include <string>

namespace giveway {
namespace {

NewFlags ToComeBack(const VehicleLoop& loop, const ServiceAdmin& admin) {
  NewFlags flags = admin.ToComeBack();
  flags["--id"] = std::to_string(Number(loop.Id()));
  flags["--resume"] = "";  // where it cannot be held: not that of an earlier restart
  HoldTextFor("--resume", "resume", ToBytes({loop.Session(), admin.Order(), loop.HandOver()}),
              &flags);
  return flags;
}

}  // namespace

LifeEnd EndOf(DriveEnd end, const VehicleLoop& loop, const ServiceAdmin& admin) {
  switch (end) {
    case DriveEnd::kOver:
      return {};
    case DriveEnd::kRefused:
      return {2, {}};
    case DriveEnd::kScansLost:
      return {1, {}};
    case DriveEnd::kRestarts:
      return {0, ToComeBack(loop, admin)};
  }
  return {};
}

}  // namespace giveway
