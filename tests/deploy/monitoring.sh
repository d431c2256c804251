#!/usr/bin/env bash
# Checks config/deploy/monitoring: Prometheus reads its configuration, each alert fires in its drill and
# none in a healthy fleet, every metric that alerts and dashboard name is one the observer serves, and no
# window is too short for one scrape a minute. Grafana is not in Debian: of the dashboard the structure and
# the expressions are checked.
# Usage: monitoring.sh; lines "ok NAME" and "FAILED NAME". Exit code: 0 all ok, 1 something failed.
# shellcheck disable=SC2317  # what check runs is called by its name
set -uo pipefail
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
folder=$project/config/deploy/monitoring
code=0

check() {
  local name=$1 said
  shift
  if said=$("$@" 2>&1); then
    printf 'ok      %s\n' "monitoring.$name"
  else
    printf 'FAILED  %s\n%s\n' "monitoring.$name" "$said"
    code=1
  fi
}

# Every expression of the dashboard as a rule, so that promtool parses it, with what Grafana puts in for its
# variables.
dashboard_rules() {
  jq '{groups: [{name: "dashboard", rules: [.panels[].targets[].expr |
      gsub("[$]__rate_interval"; "5m") | gsub("[$]observer"; ".*") | {record: "giveway:panel", expr: .}]}]}' \
    "$folder/dashboard.json" >"$work/dashboard.yml" && promtool check rules "$work/dashboard.yml"
}

# A window needs two scrapes, and a Prometheus that is not ours may scrape every minute.
windows_hold_two_scrapes() {
  ! grep -nE '\[([0-9]+s|[12]m)\]' "$folder/alerts.yml" "$folder/dashboard.json"
}

metrics_are_served() {
  local served named name missing=0
  served=$(grep -rhoE '"(giveway_[a-z_]+|process_[a-z_]+)"' "$project/services/observer/fleet_metrics.cc" | tr -d '"')
  served+=$'\n'$(grep -oE '(OfStatus|ByReason<Of>|Histogram|counter)\(\s*"[a-z0-9_]+"' <(tr '\n' ' ' \
    <"$project/services/observer/fleet_metrics.cc") | sed 's/.*"\(.*\)"/giveway_vehicle_\1/')
  named=$(grep -hoE '(giveway|process)_[a-z0-9_]+' "$folder/alerts.yml" "$folder/dashboard.json" |
    sed 's/_bucket$//' | sort -u)
  for name in $named; do
    grep -qx "$name" <<<"$served" && continue
    echo "no one serves $name"
    missing=1
  done
  return "$missing"
}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
check configuration promtool check config "$folder/prometheus.yml"
check rules promtool check rules "$folder/alerts.yml"
check drills promtool test rules "$folder/alerts_test.yml"
check dashboard_parses dashboard_rules
check dashboard_is_whole jq -e '.panels | length >= 10 and all(.gridPos and .title and (.targets | length > 0))' \
  "$folder/dashboard.json"
check windows windows_hold_two_scrapes
check metrics_served metrics_are_served
exit "$code"
