#!/usr/bin/env bash
# The observer in a browser, and its recordings in third-party readers, also of ROS 2: a crossing live, a
# fleet of 200 from virtual time, a recorder killed. Needs chromium, node and the built programs.
# Usage: web.sh; lines "ok NAME" and "FAILED NAME". Screenshots are kept in build/web/.
# Exit code: 0 all ok, 1 something failed, 2 could not check.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
project=$(cd "$here/../.." && pwd)
programs=${GIVEWAY_BIN_DIR:-$project/build/release/bin}
out=$project/build/web

die() {
  printf 'error: %s\n' "$*" >&2
  exit 2
}

for tool in node npm chromium; do
  command -v "$tool" >/dev/null || die "$tool is missing; apt-get install nodejs npm chromium"
done
mkdir -p "$out"
if ! cmp -s "$here/package-lock.json" "$out/.fetched"; then
  cp "$here/package.json" "$here/package-lock.json" "$out"
  (cd "$out" && npm ci --ignore-scripts --no-audit --no-fund >npm.log 2>&1) ||
    die "npm ci failed; $out/npm.log says why"
  cp "$here/package-lock.json" "$out/.fetched"
fi
# Modules are searched for next to the file that names them.
cp "$here"/*.mjs "$out"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
code=0
export ROS2_IDL=$project/idl/ros2.idl
for part in recording ros2 report page foxglove live replay; do
  GIVEWAY_BIN_DIR=$programs WORK=$work timeout 110 node "$out/$part.mjs" || code=1
done
exit "$code"
