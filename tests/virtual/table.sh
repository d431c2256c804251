#!/usr/bin/env bash
# The results of the present brain in every generator, with stock and with mixed robots and by tier of the
# ultrasonics: contacts / other invariants broken, all counted / vehicles that arrived. Eight vehicles a run.
# Usage: table.sh [SEEDS] [GENERATOR ...]
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
fleetctl=${GIVEWAY_BIN:-$root/build/release/bin}/fleetctl
jobs=${GIVEWAY_JOBS:-$(nproc)}
seeds=${1:-50}
[[ $seeds =~ ^[1-9][0-9]{0,5}$ ]] || { sed -n '4s/^# //p' "${BASH_SOURCE[0]}" >&2 && exit 2; }
shift || true
generators=("$@")
[[ ${#generators[@]} -gt 0 ]] || generators=(crossing roundabout corridor merge warehouse swarm convoy
  door one_lane antipodal parking shared_goal mixed_yard)

# cell GENERATOR TIER ROBOTS
cell() {
  { "$fleetctl" virtual "$1" --seeds "1..$seeds" --vehicles 8 --tier "$2" --robots "$3" \
    --jobs "$jobs" --json </dev/null || [[ $? == 1 ]]; } |
    jq -r '[.contacts, ([.violations | to_entries[] | select(.key != "contact").value] | add),
      .arrived] | join(" / ")'
}

echo "| generator | stock, ideal | typical | p3dx | mixed, ideal | typical | p3dx |"
echo "|---|---|---|---|---|---|---|"
for generator in "${generators[@]}"; do
  line="| \`$generator\` |"
  for robots in stock mixed; do
    for tier in ideal typical p3dx; do line+=" $(cell "$generator" "$tier" "$robots") |"; done
  done
  echo "$line"
done
