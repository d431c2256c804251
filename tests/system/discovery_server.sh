#!/usr/bin/env bash
# The packaged discovery server under its supervisor (config/deploy/discovery_server.sh), with a world and
# two vehicles that know its address: one packet of a stranger ends the server, and so does kill -9. Within
# three seconds it holds its port again, each time; the vehicles drive on all the time; and with Fast DDS 3,
# where a client finds such a server again, a newcomer is found through it. Then SIGTERM ends both.
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
source "$REPOSITORY/services/setup.sh"
take_domain
PORT=$((7000 + DOMAIN))
HEALTH=$((21000 + DOMAIN * 10))
bound=$(printf ':%04X ' "$PORT")
settings=(-i 0) # without a number 2.9.1 starts none
[[ $(debian_version) -lt 13 ]] || settings=(-x "$REPOSITORY/config/deploy/discovery_server.xml")

supervise() { exec sh "$REPOSITORY/config/deploy/discovery_server.sh" "$@"; }
supervise "${settings[@]}" -l 127.0.0.1 -p "$PORT" >"$SCRATCH/server.log" 2>&1 &
PID[server]=$!

server() { head -n 1 < <(children_of "${PID[server]}"); }
# serves_again OLD: another process than that one holds the port.
serves_again() {
  local now
  now=$(server)
  [[ -n $now && $now != "$1" ]] && grep -q "0100007F$bound\|00000000$bound" /proc/net/udp &&
    [[ $(cat "/proc/$now/comm") == fast-discovery-* ]]
}
await_server() { # WHAT OLD
  local since
  since=$(date +%s%N)
  until serves_again "$2"; do
    if (($(date +%s%N) - since > 3000000000)); then
      fail "$1: no server after 3 s: $(tail -n 3 "$SCRATCH/server.log")"
      return
    fi
    sleep 0.02
  done
  echo "$1: serves again after $((($(date +%s%N) - since) / 1000000)) ms" >&2
}
await_server "started" none

metric() { "$BIN/giveway-vehicle" --health metrics --health-port "$1" 2>/dev/null | sed -n "s/^$2 //p"; }
by_server=(--discovery-server "127.0.0.1:$PORT")
start world giveway-world "${by_server[@]}"
start a giveway-vehicle "${by_server[@]}" --health-port "$HEALTH"
start b giveway-vehicle "${by_server[@]}" --health-port $((HEALTH + 1))
await "by the server: drives (a)" 20 a 'cruise'
await "by the server: drives (b)" 20 b 'cruise'

# The header of RTPS 2.3 and vendor 1.15 with any GUID prefix, submessage 0x80 of 56 bytes, and zeros.
packet="RTPS\\x02\\x03\\x01\\x0f$(printf '\\x01%.0s' {1..12})\\x80\\x00\\x00\\x38$(printf '\\x00%.0s' {1..60})"
for how in packet kill packet; do
  old=$(server)
  before=$(metric "$HEALTH" giveway_vehicle_beacons_accepted_total)
  if [[ $how == kill ]]; then kill -9 "$old"; else printf '%b' "$packet" >"/dev/udp/127.0.0.1/$PORT"; fi
  await_server "ended by $how" "$old"
  sleep 0.5
  for at in "$HEALTH" $((HEALTH + 1)); do
    for _ in $(seq 20); do # one late scan is no more than that
      [[ $(metric "$at" giveway_vehicle_ready) != 1 ]] || break
      sleep 0.05
    done
    [[ $(metric "$at" giveway_vehicle_ready) == 1 ]] || fail "ended by $how: a vehicle is not ready"
  done
  (($(metric "$HEALTH" giveway_vehicle_beacons_accepted_total) > before + 5)) ||
    fail "ended by $how: a does not hear b"
done
if [[ $(debian_version) -ge 13 ]]; then
  start c giveway-vehicle "${by_server[@]}"
  await "a newcomer is found" 10 c 'cruise'
fi

old=$(server)
kill -TERM "${PID[server]}"
since=$(date +%s%N)
code=0
wait "${PID[server]}" || code=$?
unset "PID[server]"
(($(date +%s%N) - since < 2000000000)) || fail "SIGTERM: the supervisor took longer than 2 s"
[[ $code -eq 0 ]] || fail "SIGTERM: exit code $code"
kill -0 "$old" 2>/dev/null && fail "SIGTERM: the server still runs"

code=0
timeout 10 sh "$REPOSITORY/config/deploy/discovery_server.sh" --no-such-flag >/dev/null 2>&1 || code=$?
[[ $code -ne 0 && $code -ne 124 ]] || fail "bad arguments: exit code $code"
((failures == 0))
