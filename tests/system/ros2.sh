#!/usr/bin/env bash
# A vehicle that drives, heard as ROS 2 topics by a reader of another vendor's DDS: odometry, ranges,
# transforms, markers and commands at 10 Hz; its marker is deleted after it was killed. The same in a domain
# of its own.
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
LISTENER=$GIVEWAY_ROS2_LISTENER
cd "$SCRATCH"

# is WHAT FILE CONDITION: true of the messages as one list.
is() { jq -es "$3" "$2" >/dev/null || fail "$1: not true: $3: $(wc -l <"$2") messages, $(jq -c .topic "$2" | sort | uniq -c | tr '\n' ' ')"; }

take_domain
# Another domain; scripts that take domains by the lock alone take low ones first.
for other in $(seq 59 -1 40); do
  exec {lock}>>"${TMPDIR:-/tmp}/giveway-domain-$other.lock"
  flock -n "$lock" && break
  exec {lock}>&-
done
sed 's/remove_after_s: 3/remove_after_s: 1/' "$LANES" >lanes.textproto
LANES=$SCRATCH/lanes.textproto
start world giveway-world
start vehicle giveway-vehicle --id 1
start observer giveway-observer --ros2 --port $((18000 + DOMAIN))
start apart giveway-observer --ros2 --ros2-domain "$other" --ros2-rate 5 --port $((18200 + DOMAIN))
await "observer" 10 observer "publishes ROS 2 topics in domain $DOMAIN"
await "observer apart" 10 apart "publishes ROS 2 topics in domain $other"
await "vehicle" 20 vehicle 'vehicle 1: cruise'
# A reader that stops acknowledging delays nothing.
"$LISTENER" "$DOMAIN" 1 60 >heard_stopped &
PID[stopped]=$!
"$LISTENER" "$DOMAIN" 1 20 >heard &
listener=$!
"$LISTENER" "$other" 1 8 >heard_apart || fail "listener apart: exit code $?"
kill -STOP "${PID[stopped]}"
is "a reader, before it is stopped" heard_stopped 'length > 20'
sleep 3 # it misses more than a writer keeps
killed_s=$(date +%s.%N)
kill_now vehicle
wait "$listener" || fail "listener: exit code $?"
late_s=$(late_us "$SCRATCH/late_us")e-6

is "odometry" heard '[.[] | select(.topic == "/giveway/v1/odom")] | length > 20 and
  all(.frame_id == "map" and .child_frame_id == "giveway_v1/base_link" and .y == 0 and .variance_x >= 0) and
  (.[-1].x - .[0].x > 0.5) and (.[-1].forward > 0.2) and
  ((length - 1) / (.[-1].stamp - .[0].stamp) | . > 8 and . < 11)'
is "odometry without a pause" heard '[.[] | select(.topic == "/giveway/v1/odom") | .stamp] |
  ([.[1:], .[:-1]] | transpose | map(.[0] - .[1]) | max < 0.5 + '"$late_s"') and .[-1] > '"$killed_s - 0.5"
is "odometry is stamped by now" heard '[.[] | select(.topic == "/giveway/v1/odom")] |
  all(.[]; .stamp > now - 60 and .stamp < now + 1)'
is "ranges" heard '[.[] | select(.topic == "/giveway/v1/ultrasonics")] | length > 50 and
  all(.radiation_type == 0 and (.field_of_view - 0.5236 | fabs) < 0.001 and .max_range == 5) and
  all(.range == "inf" or (.range >= 0 and .range <= 5)) and any(.range == "inf") and
  ([.[].frame_id] | unique == [range(8) | "giveway_v1/ultrasonic_\(.)"])'
is "commands" heard '[.[] | select(.topic == "/giveway/v1/cmd_vel")] | length > 20 and any(.forward > 0.2)'
is "transforms" heard '[.[] | select(.topic == "/tf") | .transforms[]] | length > 20 and
  all(.frame_id == "map" and .child_frame_id == "giveway_v1/base_link")'
is "sensors in the body, though the listener is late" heard '[.[] | select(.topic == "/tf_static")][0].transforms |
  length == 16 and all(.frame_id == "giveway_v1/base_link") and
  ([.[].child_frame_id] | index("giveway_v1/ultrasonic_5") != null)'
is "marker of a body" heard '[.[] | select(.topic == "/giveway/markers") | .markers[] | select(.action == 0)] |
  length > 20 and all(.id == 1 and .type == 3 and .ns == "giveway" and .frame_id == "map") and
  .[0].alpha == 1 and .[-1].alpha < 1'
is "marker deleted" heard '[.[] | select(.topic == "/giveway/markers")][-1].markers | length == 1 and
  .[0].action == 2 and .[0].id == 1'
is "a domain and a rate of its own" heard_apart '[.[] | select(.topic == "/giveway/v1/odom")] | length > 5 and
  ((length - 1) / (.[-1].stamp - .[0].stamp) | . > 4 and . < 6)'

[[ $failures -eq 0 ]]
