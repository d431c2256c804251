#!/usr/bin/env bash
# Checks config/deploy/compose.yaml and what is added to it, without an engine: what is to be found by discovery
# servers has the address of each in its own files. Regression: Docker's name server has none for a container that
# does not run, and with one server down no vehicle, world, observer or tool could start.
# Usage: compose.sh; lines "ok NAME" and "FAILED NAME". Exit code: 0 all ok, 1 something failed, 2 could not check.
set -euo pipefail
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
folder=${GIVEWAY_DEPLOY:-$project/config/deploy}
command -v docker-compose >/dev/null || {
  echo "error: docker-compose is missing; apt-get install docker-compose" >&2
  exit 2
}

# A line for each service, of either release of compose: "NAME server NAME", "NAME knows NAME ADDRESS" and
# "NAME has ADDRESS".
facts() {
  docker-compose --env-file "$folder/discovery_server.env" --profile discovery-server --profile tools \
    -f "$folder/compose.yaml" -f "$folder/compose.monitoring.yaml" config | tr -d "\"'" |
    awk '/^[a-z]/ {inside = $1 == "services:"}
      !inside {next}
      /^  [a-z]/ {service = $1; sub(":", "", service)}
      $1 == "GIVEWAY_DISCOVERY_SERVER:" {n = split($2, one, ","); while (n) print service, "server", one[n--]}
      $1 == "ipv4_address:" {print service, "has", $2}
      /^ +(- )?discovery-[0-9]+[=:] ?[0-9.]+$/ {sub("- ", ""); gsub("[=:]", " "); print service, "knows", $1, $2}'
}

code=0
said=$(facts) || exit 2
while read -r service _ server; do
  address=$(sed -n "s/^$server has //p" <<<"$said")
  if [[ -n $address ]] && grep -qx "$service knows $server $address" <<<"$said"; then
    printf 'ok      compose.%s_finds_%s\n' "$service" "$server"
  else
    printf 'FAILED  compose.%s_finds_%s\n    it has no address for it while it is down\n' "$service" "$server"
    code=1
  fi
done < <(grep ' server ' <<<"$said" || true)
[[ $(grep -c ' server ' <<<"$said") -ge 8 ]] || {
  printf 'FAILED  compose.all_services_by_servers\n%s\n' "$said"
  code=1
}
exit "$code"
