#!/usr/bin/env bash
# Each violation that manuals.sh looks for, in a tree of its own: it must be named.
set -euo pipefail
rules=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failed=0

lay_out() { # FILE TEXT: a sound tree with one file as given
  rm -rf "${tree:?}"/*
  mkdir -p "$tree/tests/rules" "$tree/services/types"
  printf 'services/types | pure | - | - | structs\n' >"$tree/tests/rules/modules.txt"
  printf '# A\n\n## See it\n\n[b](services/types/README.md) [c](#see-it)\n' >"$tree/README.md"
  printf '# B\n\n[a](../../README.md#see-it)\n' >"$tree/services/types/README.md"
  [[ $# -eq 0 ]] || printf '%b' "$2" >"$tree/$1"
}

expect() { # EXIT CODE, WHAT IT SAYS
  local said code=0
  said=$(bash "$rules/manuals.sh" "$tree") || code=$?
  if [[ $code -eq $1 ]] && grep -qF -- "$2" <<<"$said"; then return; fi
  echo "wanted '$2' and exit code $1, got $code: $said"
  failed=1
}

lay_out && expect 0 '2 manuals, 0 violations'
lay_out README.md "$(printf 'x\\n%.0s' {1..251})" && expect 1 'README.md: 251 lines, of at most 250'
lay_out services/types/README.md "$(printf 'x\\n%.0s' {1..121})" && expect 1 '121 lines, of at most 120'
lay_out README.md "$(printf 'x%.0s' {1..121})\n" && expect 1 'README.md:1: 121 columns'
lay_out README.md '[x](nowhere.md)\n' && expect 1 'the link to nowhere.md leads nowhere'
lay_out README.md '# A\n[x](#other)\n' && expect 1 'there is no heading for #other'
lay_out && rm "$tree/services/types/README.md" && expect 1 'services/types: no README.md'
exit "$failed"
