#!/usr/bin/env bash
# What words.sh counts and what it does not, in a tree of its own.
set -euo pipefail
rules=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree/services"
export GIVEWAY_WORDS_ROOT=$tree GIVEWAY_WORDS_TABLE=$tree/words.txt
failed=0

expect() { # HOW MANY, OF THE TEXT ROW (at most 1), NAME OF A FILE, TEXT
  local said code=0 wanted=0
  printf '# a table\ntext | anew / told | again | 1\nname | Say | MakeBeacon | 1\n' >"$tree/words.txt"
  rm -f "$tree"/services/*
  printf '%b' "$3" >"$tree/services/$2"
  said=$(bash "$rules/words.sh") || code=$?
  [[ $1 -le 1 ]] || wanted=1
  if [[ $code -eq $wanted ]] && grep -q "^$1 words of the list" <<<"$said"; then return; fi
  echo "$2 '$3': wanted $1, got exit code $code: $said"
  failed=1
}

expect 1 a.cc '// It starts anew.\n'
expect 2 a.cc '// It starts anew.\nint a;  // told so\n'
expect 2 a.cc 'Print("told, and Anew");\n'
expect 0 a.cc 'const bool told = anew();\n'
expect 0 a.cc '// renewed, untold\n'
expect 1 a.cc 'Vehicle::Say(1);\n'
expect 0 a.cc 'Vehicle::Sayings(1);\n'
expect 2 a.md 'told anew\n'
expect 0 a.md 'Say\n'

# --record takes the current counts, which then are the limit.
printf '// anew\n// anew\n// told\n' >"$tree/services/a.cc"
bash "$rules/words.sh" --record
bash "$rules/words.sh" >/dev/null || { echo "the record is not kept to"; failed=1; }
grep -q '^text | anew / told | again | 3$' "$tree/words.txt" || { echo "recorded: $(<"$tree/words.txt")"; failed=1; }
echo '// anew' >>"$tree/services/a.cc"
if bash "$rules/words.sh" >/dev/null; then echo "a word more is accepted"; failed=1; fi
exit "$failed"
