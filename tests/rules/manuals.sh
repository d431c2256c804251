#!/usr/bin/env bash
# README.md and the manuals next to the code: their lengths, that every link leads to a file or a heading that
# is there, and that every module has a manual in its folder or in the one above.
# Usage: manuals.sh [ROOT]; a line for each violation; exit code 1 if there is one.
set -euo pipefail
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/../..}"

DOOR_LINES=250 MANUAL_LINES=120 LINE_LENGTH=120

# As GitHub makes anchors of headings.
anchors_of() {
  sed -n 's/^##* *//p' "$1" | tr '[:upper:]' '[:lower:]' | sed -E 's/[^a-z0-9 _-]//g; s/ /-/g'
}

check_length() { # MANUAL
  local most=$MANUAL_LINES lines
  [[ $1 != README.md ]] || most=$DOOR_LINES
  lines=$(wc -l <"$1")
  [[ $lines -le $most ]] || echo "$1: $lines lines, of at most $most"
  awk -v file="$1" -v most="$LINE_LENGTH" '
    /^```/ {inside = !inside}
    !inside && !/^\|/ && length($0) > most {printf "%s:%d: %d columns, of at most %d\n", file, FNR, length($0), most}
  ' "$1"
}

check_links() { # MANUAL
  local target file anchor
  while IFS= read -r target; do
    [[ $target != http*://* ]] || continue
    file=${target%%#*}
    anchor=${target#"$file"}
    file=$([[ -n $file ]] && realpath -m --relative-to=. "$(dirname "$1")/$file" || echo "$1")
    if [[ ! -e $file ]]; then
      echo "$1: the link to $target leads nowhere"
    elif [[ -n $anchor ]] && ! anchors_of "$file" | grep -qxF -- "${anchor#\#}"; then
      echo "$1: there is no heading for $target"
    fi
  done < <(awk '/^```/ {inside = !inside} !inside' "$1" | grep -oE '\]\([^)]+\)' | sed 's/^](//; s/)$//')
}

mapfile -t manuals < <(find . -path ./build -prune -o -path ./.git -prune -o -name node_modules -prune -o \
  -name README.md -print | sed 's,^\./,,' | sort)
violations=$(
  for manual in "${manuals[@]}"; do
    check_length "$manual"
    check_links "$manual"
  done
  while read -r module; do
    [[ -f $module/README.md || -f $(dirname "$module")/README.md ]] ||
      echo "$module: no README.md, nor in the folder above"
  done < <(awk -F ' *[|] *' '!/^#/ && NF >= 5 {print $1}' tests/rules/modules.txt)
)
[[ -z $violations ]] || printf '%s\n' "$violations"
printf '%d manuals, %d violations\n' "${#manuals[@]}" "$(grep -c . <<<"$violations" || true)"
[[ -z $violations && ${#manuals[@]} -gt 0 ]]
