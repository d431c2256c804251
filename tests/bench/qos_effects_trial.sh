#!/usr/bin/env bash
# One fleet with one profile set, in the network namespace and with the /dev/shm it is started in:
# prints what it cost and what arrived, one flat JSON object. Only tests/bench/qos_effects.sh calls it.
# Usage: qos_effects_trial.sh SET FOLDER [OPTION=VALUE ...]; the options are those of `asked`.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=$here/../../build/release/bin
set_file=$1 folder=$2
shift 2
declare -A asked=(
  [vehicles]=8       # in lanes of their own, all in radio range, with every sensor, and two traffic lights
  [impair]=none      # what every vehicle hears through
  [seconds]=4        # measured, once all are matched or the wait is over
  [wait]=15          # for the matches, seconds at most
  [stop_vehicle]=0   # vehicle 1 stands still so long in the time measured, seconds
  [stop_observers]=0 # and the outside listeners
  [late]=""          # yes: a vehicle joins when the others drive
  [listen]=""        # further topics to listen to: world/truth,world/event
  [ask]=0            # so many operators ask vehicle 1 at once what it runs with
  [silence]=0        # after a kill -9 the others are watched for so long, seconds
  [capture]=""       # yes: look at the packets for their time to live
  [server_after]=""  # a discovery server is started so long after the fleet, seconds
)
for option in "$@"; do
  [[ -v asked[${option%%=*}] ]] || { echo "no option ${option%%=*}" >&2 && exit 2; }
  asked[${option%%=*}]=${option#*=}
done
vehicles=${asked[vehicles]}
mkdir -p "$folder/logs"
cd "$folder"
ip link set lo up
mount -t tmpfs tmpfs /dev/shm

scenario() {
  echo 'name: "qos_effects" duration_s: 600 start_timeout_s: 60 emission_radius_m: 1000'
  echo 'profile { sensors { radar: true lidar: true camera: true } }'
  local i
  for i in 1 2; do
    echo "signal { id: $i heading_deg: 0 line { from { x_m: 0 y_m: -4$i } to { x_m: 0 y_m: -4$i.8 } } }"
  done
  for ((i = 1; i <= vehicles; ++i)); do
    echo "vehicle { id: $i start { x_m: 0 y_m: $((3 * i)) heading_deg: 0 } cruise_m_s: 0.05" \
      "goal { x_m: 1000 y_m: $((3 * i)) } }"
  done
  # For the vehicle that comes late; and in an open fleet a death is not the end of the run.
  echo 'spawn { start { x_m: 0 y_m: -30 heading_deg: 0 } cruise_m_s: 0.05 goal { x_m: 1000 y_m: -30 } }'
  echo 'expect { any_halted: true any_arrived: true }'
}

now_ns() { awk '{ printf "%.0f", $1 * 1e9 }' /proc/uptime; } # the clock of the logs' steady_ns
texts() { jq -c --arg start "$1" 'select(.text | startswith($start))' logs/*.log 2>/dev/null || true; }
matched() { texts 'matched: vehicle ' | jq -s 'unique_by([.process, .text]) | length'; }
# field PATTERN NAME FILE: a counter of /proc/net, whose names stand a line above its numbers.
field() {
  awk -v line="$1" -v name="$2" '$1 == line && !at { for (i = 2; i <= NF; ++i) if ($i == name) at = i; next }
    $1 == line { print $at }' "$3"
}
cpu_ticks() { # of processes: user and system, by proc(5), behind the name
  local pid sum=0 rest words
  for pid in "$@"; do
    rest=$(cat "/proc/$pid/stat" 2>/dev/null) || continue
    read -ra words <<<"${rest##*) }"
    sum=$((sum + words[11] + words[12]))
  done
  echo "$sum"
}
of_status() { # NAME: a number of /proc/PID/status, the mean over the vehicles
  local pid
  for pid in "${cars[@]}"; do
    awk -v name="$1:" '$1 == name { print $2 }' "/proc/$pid/status" 2>/dev/null || true
  done | awk '{ sum += $1 } END { print NR ? sum / NR : 0 }'
}
sockets() {
  find "/proc/${cars[0]}/fd" -lname 'socket:*' | wc -l
}
shared_maps() { grep -c ' /dev/shm/' "/proc/${cars[0]}/maps" || true; }
lo() { awk -v at="$1" '$1 == "lo:" { print $at }' /proc/net/dev; }
count_shm() { find /dev/shm -type f | wc -l; }
snapshot() {
  printf '{"packets":%s,"bytes":%s,"multicasts":%s,"overflows":%s,"cpu":%s,"world_cpu":%s,"at":%s}\n' \
    "$(lo 3)" "$(lo 2)" "$(field IpExt: OutMcastPkts /proc/net/netstat)" \
    "$(field Udp: RcvbufErrors /proc/net/snmp)" \
    "$(cpu_ticks "${cars[@]}")" "$(cpu_ticks "$world")" "$(now_ns)"
}
# What leaves by multicast and to one: the greatest TTL in some two seconds, as "1 64".
ttl_seen() {
  # shellcheck disable=SC2016  # perl's
  timeout 10 perl -e 'use Socket; socket(S, 17, 2, 0x0008) or die; my ($m, $u) = (0, 0);
    my $end = time + 3; while (time < $end) { recv(S, my $p, 2048, 0) // last;
      my $ttl = ord substr $p, 8, 1;
      if ((ord(substr $p, 16, 1) & 0xf0) == 0xe0) { $m = $ttl if $ttl > $m }
      else { $u = $ttl if $ttl > $u } }
    print "$m $u\n"'
}

members=()
end_all() { # without bash saying so
  [[ ${#members[@]} -eq 0 ]] || kill -9 "${members[@]}" 2>/dev/null || true
}
trap end_all EXIT

# What a listener receives that joins when the fleet already drives; it listens to the end.
listen() { # TOPIC FILE
  "$bin/fleetctl" listen "$1" --domain "$domain" --qos "$set_file" --json >"$2" 2>"$2.err" &
  members+=($!)
  observers+=($!)
}

scenario >scenario.textproto
if [[ -n ${asked[server_after]} ]]; then
  (sleep "${asked[server_after]}" && exec fast-discovery-server -i 0 -l 127.0.0.1 -p 11811) \
    >server.log 2>&1 &
  members+=($!)
fi
started_ns=$(now_ns)
GIVEWAY_LOG_FORMAT=json "$bin/fleetctl" run scenario.textproto --vehicles 0 --seed 7 --json \
  --qos "$set_file" --impair "${asked[impair]}" --logs logs >run.json 2>run.err &
fleet=$!
members+=("$fleet")
wanted=$((vehicles * (vehicles - 1))) limit=$((SECONDS + asked[wait]))
until (($(matched) >= wanted || SECONDS >= limit)) || ! kill -0 "$fleet" 2>/dev/null; do sleep 0.1; done
domain=$(sed -n 's/.* on domain \([0-9]*\)$/\1/p' run.err)
mapfile -t cars < <(pgrep -P "$fleet" -f giveway-vehicle)
world=$(pgrep -P "$fleet" -f giveway-world || echo 0)
observers=()
[[ -n $domain && ${#cars[@]} -gt 0 ]] || { cat run.err >&2 && exit 2; }
for topic in fleet/status ${asked[listen]//,/ }; do listen "$topic" "${topic#*/}.json"; done
sleep 2 # for the listeners to be matched
snapshot >before.json
if [[ ${asked[stop_vehicle]} != 0 ]]; then
  kill -STOP "${cars[0]}"
  sleep "${asked[stop_vehicle]}"
  kill -CONT "${cars[0]}"
fi
if [[ ${asked[stop_observers]} != 0 ]]; then
  kill -STOP "${observers[@]}"
  sleep "${asked[stop_observers]}"
  kill -CONT "${observers[@]}"
fi
operators=()
for ((i = 0; i < asked[ask]; ++i)); do
  "$bin/fleetctl" qos show --live 1 --domain "$domain" --qos "$set_file" >answer$i.txt 2>&1 &
  operators+=($!)
done
answered=0
for operator in "${operators[@]}"; do wait "$operator" && answered=$((answered + 1)); done
if [[ -n ${asked[late]} ]]; then
  late_begun=$(now_ns)
  "$bin/giveway-vehicle" --scenario scenario.textproto --domain "$domain" --qos "$set_file" \
    --log-format json 2>logs/late.log &
  members+=($!)
fi
sleep "${asked[seconds]}"
snapshot >after.json
multicast_ttl=null unicast_ttl=null
[[ -z ${asked[capture]} ]] || read -r multicast_ttl unicast_ttl < <(ttl_seen)
{
  printf '{"threads":%s,"rss_kb":%s,"sockets":%s,' "$(of_status Threads)" "$(of_status VmRSS)" \
    "$(sockets)"
  printf '"shared_maps":%s,"shm_files":%s,"shm_kb":%s,"multicast_ttl":%s,"unicast_ttl":%s}\n' \
    "$(shared_maps)" "$(count_shm)" "$(du -sk --apparent-size /dev/shm | cut -f1)" "$multicast_ttl" \
    "$unicast_ttl"
} >held.json
killed_at=$(now_ns)
kill -9 "${cars[-1]}"
sleep "${asked[silence]}"
# In good order, the fleet first, so that what stays in /dev/shm is the killed one's.
leave() {
  kill -INT "$@" 2>/dev/null || true
  for _ in $(seq 50); do
    kill -0 "$@" 2>/dev/null || break
    sleep 0.1
  done
}
leave "$fleet"
leave "${observers[@]}"
end_all
wait "${members[@]}" 2>/dev/null || true

# link NAME: the sum of a counter that vehicles log at their end.
link() { texts 'link: ' | jq -r .text | grep -o "$1=[0-9]*" | awk -F= '{ s += $2 } END { print s + 0 }'; }
lines() { if [[ -f $1 ]]; then wc -l <"$1"; else echo 0; fi; }
touch status.json truth.json roster.json
jq -n --slurpfile shots <(cat before.json after.json held.json) \
  --slurpfile status status.json --slurpfile truth truth.json \
  --slurpfile roster roster.json \
  --argjson hz "$(getconf CLK_TCK)" --argjson vehicles "$vehicles" --argjson started_ns "$started_ns" \
  --argjson late "${late_begun:-0}" --argjson killed "${killed_at:-0}" \
  --slurpfile matches <(texts 'matched: vehicle ') --slurpfile gone <(texts 'unmatched: vehicle ') \
  --slurpfile driving <(jq -c 'select(.text | startswith("cruise"))' logs/late.log 2>/dev/null || true) \
  --argjson events "$(lines event.json)" --argjson signals "$(lines signal.json)" \
  --argjson left "$(count_shm)" --argjson answered "$answered" \
  --argjson figures "$(lines figures.json)" \
  --argjson ranges_missed "$(link ranges_deadline_missed)" --argjson skipped "$(link ranges_skipped)" \
  --argjson sensors_missed "$(link sensors_deadline_missed)" \
  --argjson signals_missed "$(link signals_deadline_missed)" '
  def round1: . * 10 | round / 10;
  def round2: . * 100 | round / 100;
  def ms: . / 1e6 | round;
  $shots as [$a, $b, $held]
  | (($b.at - $a.at) / 1e9) as $s
  # Of each vehicle its first and its last report; what it counted between them.
  | [$status | group_by(.vehicle)[] | [.[0], .[-1]]] as $pairs
  | ([$pairs[] | (.[1].tick - .[0].tick) * 0.05] | add // 0) as $vehicle_s
  | def counted(f): [$pairs[] | (.[1] | f) - (.[0] | f)] | add // 0;
    def hourly(f): if $vehicle_s > 0 then counted(f) / $vehicle_s * 3600 | round else null end;
    def grown(name): $b[name] - $a[name];
    def rate(name): grown(name) / ($s * $vehicles);
    def cpu(name): grown(name) / ($hz * $s / 60) | round2;
    def whole_hourly: . / ($vehicles * ($b.at - $started_ns) / 1e9) * 3600 | round;
  def id: ltrimstr("matched: ") | ltrimstr("vehicle ") | tonumber? // ($vehicles + 1);
  ($matches | map(select((.process | id) <= $vehicles and (.text | id) <= $vehicles))
    | unique_by([.process, .text])) as $met
  | {
      packets_s: (rate("packets") | round1), kB_s: (rate("bytes") / 1000 | round1),
      multicasts_s: (rate("multicasts") | round1), overflows: grown("overflows"),
      cpu_s_min: (cpu("cpu") / $vehicles | round2),
      world_cpu_s_min: cpu("world_cpu"),
      threads: $held.threads, rss_MB: ($held.rss_kb / 1000 | round1), sockets: $held.sockets,
      shared_maps: $held.shared_maps, shm_files: $held.shm_files, shm_kB: $held.shm_kb,
      shm_left: $left, multicast_ttl: $held.multicast_ttl, unicast_ttl: $held.unicast_ttl,
      speaking: ($pairs | length),
      driving: ([$status | group_by(.vehicle)[] | select(any(.rule != "not_running"))] | length),
      matched: ($met | length),
      all_matched_ms: (if ($met | length) == $vehicles * ($vehicles - 1)
                       then [$met[].steady_ns] | max - $started_ns | ms else null end),
      # Of the killed one alone: at the end all leave.
      unmatched_ms: ([$gone[] | select(.text == "unmatched: vehicle \($vehicles)") | .steady_ns]
                     | if length > 0 then max - $killed | ms else null end),
      unmatched_alive: ([$gone[] | select(.steady_ns < $killed)] | length),
      peers_heard: ([$status | group_by(.vehicle)[] | map(.peers_heard) | max]
                    | if length > 0 then add / length | round1 else 0 end),
      statuses: ($status | length),
      beacons_taken_s: (if $vehicle_s > 0 then counted(.beacons.taken) / $vehicle_s | round1 else 0 end),
      beacons_lost: counted(.beacons.lost), beacons_superseded: counted(.beacons_superseded),
      misses_hour: hourly(.qos.deadline_missed), liveliness_lost_hour: hourly(.qos.liveliness_lost),
      ranges_misses_hour: ($ranges_missed | whole_hourly),
      sensors_misses_hour: ($sensors_missed | whole_hourly),
      signals_misses_hour: ($signals_missed | whole_hourly),
      ranges_skipped: $skipped,
      answered: $answered, figures_heard: $figures, late_events: $events,
      late_entries: ($roster | map(.session) | unique | length),
      signals_heard: $signals, truths_heard: ($truth | length),
      truths_missing: ([$truth | group_by(.vehicle)[] | map(.tick) | unique
                        | (.[-1] - .[0] + 1 - length)] | add // 0),
      late_drives_ms: (if $driving | length > 0 then $driving[0].steady_ns - $late | ms else null end)
    } | map_values(select(. != null))'
