#!/usr/bin/env bash
# Prints a counter-example of the model, tick by tick, and turns it into something to run: a
# scenario file and a fleetctl command line.
# Usage: trail.sh FOLDER; it holds the model, its switches and its trail, as check.sh left them.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if [[ $# -ne 1 || $1 == --help || ! -f $1/giveway.pml.trail || ! -f $1/switches ]]; then
  echo "usage: trail.sh FOLDER; it must hold giveway.pml, giveway.pml.trail and switches" >&2
  exit 2
fi
cd "$1"
mapfile -t switches <switches
spin -t -T "${switches[@]}" giveway.pml >trail.txt
awk -v scenario="$PWD/counter_example.textproto" -f "$here/trail.awk" trail.txt
