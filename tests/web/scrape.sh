#!/usr/bin/env bash
# A real Prometheus scrapes the observer of a fleet that drives, with the rules of
# config/deploy/monitoring: every expression of the dashboard returns data, and so does each series an
# alert compares; then a vehicle, the world and the observer are killed, and the alert for each
# fires. The scrape interval is 1 s here, for a test must not wait for 5 s ones.
# Usage: scrape.sh [--seconds S]; S: how long it scrapes before it asks, 12 if not given. Wants prometheus,
# curl and jq. Lines "ok NAME" and "FAILED NAME". Exit code: 0 all ok, 1 something failed, 2 could not check.
set -uo pipefail
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$project/tests/support/members.sh"
set +e # what fails here is reported
seconds=12
[[ ${1:-} == --seconds ]] && seconds=$2
folder=$project/config/deploy/monitoring
code=0

report() { # NAME PROBLEM: ok where there is none
  if [[ -z $2 ]]; then
    printf 'ok      scrape.%s\n' "$1"
  else
    printf '| scrape.%s: %s\nFAILED  scrape.%s\n' "$1" "$2" "$1"
    code=1
  fi
}

free_port() {
  local port
  for port in $(shuf -i 20000-32000 -n 50); do
    (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null || { echo "$port" && return; }
  done
}

ask() { # PATH [PARAMETERS OF CURL]
  curl -fsG "http://127.0.0.1:$prometheus_port/api/v1/$1" "${@:2}"
}

# Series that an expression returns.
series_of() { ask query --data-urlencode "query=$1" | jq '.data.result | length'; }

# await_query SECONDS EXPRESSION: true once it returns a series.
await_query() {
  local until=$((SECONDS + $1)) count
  while ((SECONDS < until)); do
    count=$(series_of "$2")
    [[ ${count:-0} -gt 0 ]] && return
    sleep 0.2
  done
  return 1
}

# What an alert compares: its expression without the comparisons with numbers, except for those that select
# series.
compared() {
  local kept=${1%% unless *}
  printf '%s%s\n' "$(sed -E 's/ (==|>|<) [0-9.e+]+//g' <<<"$kept")" "${1#"$kept"}"
}

all_return_data() { # NAME, expressions on stdin, one a line
  local expression empty=''
  while read -r expression; do
    await_query 10 "$expression" || empty+="no data: $expression; "
  done
  report "$1" "$empty"
}

fires() { # ALERT SECONDS
  local problem=''
  await_query "$2" "ALERTS{alertname=\"$1\",alertstate=\"firing\"}" || problem="does not fire in $2 s"
  report "$1_fires" "$problem"
}

for tool in prometheus curl jq; do
  command -v "$tool" >/dev/null || {
    echo "error: $tool is missing" >&2
    exit 2
  }
done
take_domain
page_port=$(free_port)
prometheus_port=$(free_port)
mkdir "$SCRATCH/prometheus"
cp "$folder/alerts.yml" "$SCRATCH/prometheus"
sed -e "s/observer:8080/127.0.0.1:$page_port/" -e 's/\(_interval:\) 5s/\1 1s/' "$folder/prometheus.yml" \
  >"$SCRATCH/prometheus/prometheus.yml"
LANES=$project/config/scenarios/patrol.textproto
start world giveway-world
for name in a b c d; do start "$name" giveway-vehicle; done
start observer giveway-observer --port "$page_port"
prometheus --config.file="$SCRATCH/prometheus/prometheus.yml" --storage.tsdb.path="$SCRATCH/prometheus/data" \
  --web.listen-address="127.0.0.1:$prometheus_port" 2>"$SCRATCH/prometheus.log" &
PID[prometheus]=$!

await_query 30 'sum(giveway_vehicle_heard) == 4' || report fleet "four vehicles are not heard"
sleep "$seconds"
jq -r '.panels[].targets[].expr | gsub("[$]__rate_interval"; "1m") | gsub("[$]observer"; ".*")' "$folder/dashboard.json" |
  all_return_data dashboard
while read -r expression; do compared "$expression"; done \
  < <(ask rules | jq -r '.data.groups[].rules[].query') | all_return_data alerts
firing=$(series_of 'ALERTS{alertstate="firing"}')
report healthy "$([[ $firing == 0 ]] || echo "$firing alerts fire in a healthy fleet: $(ask alerts | jq -c '[.data.alerts[].labels]')")"

kill_now a
kill_now world
fires VehicleSilent 20
fires WorldSilent 25
kill_now observer
fires ObserverDown 30
exit "$code"
