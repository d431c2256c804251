#!/usr/bin/env bash
# Words that an engineer of the field stumbles over: words.txt says what to write instead, and how many there
# may still be. A count may only fall; --record writes the current counts into the table.
# Usage: words.sh [--record | --show PATTERN]; a line for each that rose; exit code 1 if one did.
set -euo pipefail
rules=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "${GIVEWAY_WORDS_ROOT:-$rules/../..}"
table=${GIVEWAY_WORDS_TABLE:-$rules/words.txt}

mapfile -t sources < <(find services sim_world config idl tests README.md CMakeLists.txt \
  -path '*/node_modules' -prune -o -type f \( -name CMakeLists.txt -o -name '*.h' -o -name '*.cc' -o -name '*.c' -o -name '*.inc' \
  -o -name '*.idl' -o -name '*.proto' -o -name '*.sh' -o -name '*.md' -o -name '*.xml' -o -name '*.txt' \) \
  -print 2>/dev/null | grep -v '^tests/rules/words' | LC_ALL=C sort)
counts=$(awk -v show="$([[ ${1:-} == --show ]] && echo "${2:-}")" -f "$rules/words.awk" "$table" "${sources[@]}")
[[ ${1:-} != --show ]] || exit 0

if [[ ${1:-} == --record ]]; then
  new=$(awk -F ' *[|] *' -v counts="$counts" '
    BEGIN {
      n = split(counts, line, "\n")
      for (i = 1; i <= n; ++i) { split(line[i], cell, "\t"); now[cell[1]] = cell[2] }
    }
    /^#/ || NF < 4 { print; next }
    { printf "%s | %s | %s | %d\n", $1, $2, $3, now[$2] }' "$table")
  printf '%s\n' "$new" >"$table"
  exit
fi
risen=$(awk -F '\t' '$2 > $3 {printf "%s: %d times, of at most %d; write: %s\n", $1, $2, $3, $4}' <<<"$counts")
[[ -z $risen ]] || printf '%s\nsee them with: bash tests/rules/words.sh --show PATTERN\n' "$risen"
awk -F '\t' '{n += $2; most += $3} END {printf "%d words of the list, of at most %d\n", n, most}' <<<"$counts"
[[ -z $risen ]]
