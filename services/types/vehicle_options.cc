#include "services/types/vehicle_options.h"

namespace giveway {

BraitenbergWeights LectureWeights() {
  return {.base_rad_s = 2.0,
          .near_gate_m = 0.2,
          .far_gate_m = 1.0,
          .left = {1, 1, 1, 1, 0, 0, 0, 0},
          .right = {0, 0, 0, 0, 1, 1, 1, 1}};
}

BraitenbergWeights StockWeights() {
  return {.base_rad_s = 2.0,
          .near_gate_m = 0.2,
          .far_gate_m = 0.5,
          .left = {-0.2, -0.4, -0.6, -0.8, -1.0, -1.2, -1.4, -1.6},
          .right = {-1.6, -1.4, -1.2, -1.0, -0.8, -0.6, -0.4, -0.2}};
}

BraitenbergWeights WeightsOf(Behaviour behaviour) {
  return behaviour == Behaviour::kStockAvoid ? StockWeights() : LectureWeights();
}

}  // namespace giveway
