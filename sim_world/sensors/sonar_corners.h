// What a vehicle's transducers hear of corners: edges, which diffract, and inner corners, which
// send back from any angle. The tiers above ideal add it to what faces answer (sonar_ring.h).
//
// An edge's echo is 20 to 30 dB below that of a face at the same distance, falls with the range to
// the power of 3/2 instead of 1, and by the beam both out and back: so it is heard only at short
// range, and at even shorter range towards the rim of the cone (Kuc and Siegel, IEEE PAMI 9(6),
// 1987; Kleeman and Kuc, IJRR 14(4), 1995, section 2). An inner corner echoes as strongly as a
// face.
#pragma once

#include <cstdint>

#include "services/types/math/pose.h"
#include "services/types/scenario.h"
#include "sim_world/sensors/scene.h"
#include "sim_world/sensors/sonar_ring.h"

namespace giveway::sim {

// Lowers the ranges of the given transducers, one bit each, to those of the nearest corners they
// hear. Occluded corners and those of `self` are not heard.
void HearCorners(const Scene& scene, const SonarRing& ring, const Pose& world_from_body, Owner self,
                 double edge_reach_m, std::uint32_t transducers, Lanes* range_m);

}  // namespace giveway::sim
