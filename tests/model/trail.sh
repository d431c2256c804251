#!/usr/bin/env bash
# Prints a counter-example of the model, tick by tick, and turns it into something to run: a
# scenario file and a fleetctl command line.
# Usage: trail.sh FOLDER SWITCHES...; FOLDER holds the model and its trail, as check.sh left them.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if [[ $# -lt 2 || $1 == --help || ! -f $1/giveway.pml.trail ]]; then
  echo "usage: trail.sh FOLDER SWITCHES...; FOLDER must hold giveway.pml and giveway.pml.trail" >&2
  exit 2
fi
cd "$1"
shift
spin -t -T "$@" giveway.pml >trail.txt
awk -v scenario="$PWD/counter_example.textproto" -f "$here/trail.awk" trail.txt
