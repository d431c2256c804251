#!/usr/bin/env bash
# Verifies one run of runs.txt exhaustively and says what it took. Exit code 0: SPIN found what it
# must; 1: it found something else, and a counter-example is printed; 2: it could not run.
# Usage: check.sh NAME [FOLDER]; FOLDER keeps the verifier and the trail.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

die() {
  printf 'error: %s\n' "$*" >&2
  exit 2
}

[[ $# -ge 1 && $1 != --help ]] || die "usage: check.sh NAME [FOLDER]; names are in runs.txt"
name=$1
# Enough for every run; a runaway one ends here instead of swapping.
MEMORY_MB=4096
read -r _ _ property expected switches < <(grep "^$name " "$here/runs.txt") ||
  die "no run of the name '$name' in runs.txt"
folder=${2:-$(mktemp -d)}
mkdir -p "$folder"
folder=$(realpath "$folder")
[[ $# -ge 2 ]] || trap 'rm -rf "$folder"' EXIT
cd "$folder"
cp "$here"/*.pml .
rm -f giveway.pml.trail
read -ra flags <<<"$switches"

# Breadth first finds the shortest counter-example; where there is none, depth first takes less memory.
compile=(-O2 -w -DNOREDUCE -DCOLLAPSE "-DMEMLIM=$MEMORY_MB")
run=(-m3000000)
case $property in
  safety)
    compile+=(-DSAFETY)
    [[ $expected == holds ]] || compile+=(-DBFS)
    ;;
  passes)
    flags+=(-DWEATHER)
    compile+=(-DNFAIR=3)
    run+=(-a -f)
    ;;
  *) die "$name: unknown property '$property'" ;;
esac

printf '%s\n' "${flags[@]}" >switches
spin -a "${flags[@]}" giveway.pml >spin.log || die "spin refuses the model: $(cat spin.log)"
gcc "${compile[@]}" -o pan pan.c || die "the verifier does not compile"
started=$SECONDS
./pan "${run[@]}" >pan.log 2>&1 || true

# The result, in the terms of runs.txt.
if grep -qE 'out of memory|max search depth too small|aborting' pan.log; then
  found=unfinished
elif grep -q 'errors: 0$' pan.log; then
  found=holds
elif grep -q 'assertion violated .*two_in_zone' pan.log; then
  found=exclusion
elif grep -q 'assertion violated .*out_of_order' pan.log; then
  found=order
elif grep -q 'assertion violated .*unfrozen' pan.log; then
  found=frozen
elif grep -q 'assertion violated .*unlatched' pan.log; then
  found=latch
elif grep -q 'acceptance cycle' pan.log; then
  found=passes
elif grep -q 'invalid end state' pan.log; then
  found=deadlock
else
  found=unfinished
fi
states=$(sed -nE 's/^ *([0-9.e+]+) states, stored.*/\1/p' pan.log)
memory=$(sed -nE 's/^ *([0-9.]+)\ttotal actual memory usage.*/\1/p' pan.log)
printf '%s: %s; %s states, %s MB, %d s\n' "$name" "$found" "${states:-?}" "${memory:-?}" \
  $((SECONDS - started))
[[ $found == "$expected" ]] && exit 0
printf 'expected: %s\n' "$expected"
[[ $found == unfinished ]] && cat pan.log
if [[ -f giveway.pml.trail ]]; then
  bash "$here/trail.sh" "$folder"
fi
exit 1
