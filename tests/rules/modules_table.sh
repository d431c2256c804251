#!/usr/bin/env bash
# Prints modules.txt as the table of services/README.md; with --check, says whether that file contains exactly
# it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

table() {
  echo '| module | what it is | may include |'
  echo '|---|---|---|'
  awk -F ' *[|] *' '!/^#/ && NF >= 5 {
    seen = $3
    gsub(/services\/fleetctl\//, "fleetctl/", seen)
    gsub(/services\//, "", seen)
    gsub(/ /, ", ", seen)
    printf "| `%s/` | %s%s | %s |\n", $1, $5, ($2 == "pure" ? "; pure" : ""), seen == "-" ? "–" : seen
  }' tests/rules/modules.txt
}

if [[ ${1:-} != --check ]]; then
  table
  exit
fi
held=$(sed -n '/^| module | what it is | may include |$/,/^$/p' services/README.md | sed '/^$/d')
diff <(table) <(printf '%s\n' "$held") || {
  echo "services/README.md: the table of modules is not that of tests/rules/modules.txt (left): put the output of tests/rules/modules_table.sh there"
  exit 1
}
