#!/usr/bin/env bash
# Every command that README.md and the manuals show: those of blocks marked "bash" are run, in order, in
# a folder of their own, and in network and process namespaces of their own where the system allows it;
# those of blocks with needs=WHAT are checked: their verbs, flags, scripts and files exist.
# Usage: commands.sh [MANUAL ...]; needs GIVEWAY_BIN_DIR. A line "ok" or "FAILED" for each command.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
cd "$root"
: "${GIVEWAY_BIN_DIR:=$root/build/release/bin}"
export PATH=$GIVEWAY_BIN_DIR:$PATH
SCRATCH=$(mktemp -d)
trap 'rm -rf "$SCRATCH"' EXIT

if [[ $# -gt 0 ]]; then
  manuals=("$@")
else
  mapfile -t manuals < <(git ls-files 'README.md' '*/README.md')
fi
awk -f "$here/blocks.awk" "${manuals[@]}" >"$SCRATCH/commands"

# Manuals that run fleets must not see each other's. Without namespaces they run one after the other.
isolate=() at_once=1
for user in '' --map-root-user; do
  # shellcheck disable=SC2086
  if unshare $user --net --pid --fork --mount-proc true 2>/dev/null; then
    # shellcheck disable=SC2206
    isolate=(unshare $user --net --pid --fork --mount-proc)
    at_once=4
    break
  fi
done

run_manual() { # MANUAL
  local folder
  folder=$SCRATCH/run/$(tr '/' '-' <<<"$1")
  mkdir -p "$folder"
  cd "$folder"
  # Where fleetctl run keeps the keys of its fleets, by domain.
  XDG_RUNTIME_DIR=$(mktemp -d -p "$SCRATCH")
  export XDG_RUNTIME_DIR
  awk -F '\t' -v file="$1" '$1 == file && $3 == "-" {print $2 "\t" $4 "\t" $5}' "$SCRATCH/commands" |
    timeout --kill-after 5 180 "${isolate[@]}" bash "$here/one_manual.sh" "$1" ||
    echo "FAILED  $1: did not end in 180 s"
}

# Flags that a text must know: "--flag" as a word of its own.
knows() { # TEXT FLAG
  grep -qE -- "(^|[^a-z-])$2([^a-z-]|$)" <<<"$1"
}

# Problems of one simple command that is not run; nothing if there are none.
wrong_with() { # WORD...
  local help word verbs=()
  while [[ ${1:-} == *=* ]]; do shift; done
  case ${1##*/} in
    fleetctl)
      shift
      for word in "$@"; do
        [[ ${#verbs[@]} -lt 2 && $word =~ ^[a-z]+$ ]] || break
        help=$(fleetctl help "${verbs[@]}" "$word" 2>/dev/null) || break
        verbs+=("$word")
      done
      [[ ${#verbs[@]} -gt 0 ]] || { echo "no verb in '$*'"; return; }
      help=$(fleetctl help "${verbs[@]}")
      ;;
    giveway-observer | giveway-vehicle | giveway-world) help=$("${1##*/}" --help) && shift ;;
    bash)
      [[ -f ${2:-} ]] || { echo "there is no ${2:-script}"; return; }
      help=$(<"$2")
      shift 2
      ;;
    docker-compose | kubectl | seq | parallel | sbatch | cd | kill) return ;;
    *) command -v "${1:-}" >/dev/null || echo "unknown program '${1:-}'"; return ;;
  esac
  for word in "$@"; do
    [[ $word == --* ]] || continue
    word=${word%%=*}
    knows "$help" "$word" || echo "'$word' is not known"
  done
}

check_command() { # MANUAL LINE COMMAND
  local part words wrong=
  while IFS= read -r part; do
    read -r -a words <<<"$part"
    [[ ${#words[@]} -gt 0 ]] || continue
    wrong+=$(wrong_with "${words[@]}")
  done < <(sed -E 's/(\|\||&&|[|;&])/\n/g' <<<"$3")
  if [[ -z $wrong ]]; then echo "ok      $1:$2: $3: checked"; else echo "FAILED  $1:$2: $3: $wrong"; fi
}

while IFS=$'\t' read -r manual line needs _ command; do
  case $needs in
    -) ;;
    unmarked) echo "FAILED  $manual:$line: a block without an info string: bash, console or text" ;;
    *) check_command "$manual" "$line" "$command" ;;
  esac
done <"$SCRATCH/commands" | tee "$SCRATCH/checked"

: >"$SCRATCH/said." # there may be none
mapfile -t running < <(awk -F '\t' '$3 == "-" && !seen[$1]++ {print $1}' "$SCRATCH/commands")
for manual in "${running[@]}"; do
  while [[ $(jobs -rp | wc -l) -ge $at_once ]]; do wait -n || true; done
  run_manual "$manual" >"$SCRATCH/said.$(tr '/' '-' <<<"$manual")" &
done
wait
cat "$SCRATCH"/said.* | tee "$SCRATCH/ran"
printf '%d commands run, %d checked\n' "$(grep -c '^ok' "$SCRATCH/ran")" "$(grep -c '^ok' "$SCRATCH/checked")"
! grep -q '^FAILED' "$SCRATCH/ran" "$SCRATCH/checked"
