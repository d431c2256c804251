// What a brain hands over to the next process of its vehicle, so that this one drives on from where
// the other stopped: where it believes to be, how sure it is, and how far it is with its task.
#pragma once

#include "services/types/fleet_facts.h"
#include "services/types/ids.h"
#include "services/types/math/pose.h"
#include "services/types/task_progress.h"

namespace giveway {

struct Handover {
  WorldEpoch epoch = kNoEpoch;
  Tick tick = kNoTick;        // of the pose
  WheelAngles counted;        // by the encoders at that tick
  Pose world_from_body;       // by dead reckoning
  PoseCovariance covariance;  // of world_from_body
  TaskProgress task;

  friend bool operator==(const Handover&, const Handover&) = default;
};

// True if a brain could have been there: finite numbers, a tick of a world, and a covariance.
bool IsSound(const Handover& handover);

// True if it is of the body that the world's answer is about. Otherwise the world was restarted
// since, or the body was replaced by another one: then the answer says where it is.
bool IsOfTheSameBody(const Handover& handover, const RosterEntry& entry);

}  // namespace giveway
