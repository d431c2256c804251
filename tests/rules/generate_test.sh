#!/usr/bin/env bash
# fastddsgen's preprocessor output goes to the build folder, and not to /tmp, where the file of the host's
# first user would block all others; and it is removed afterwards.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# Stands in for the preprocessor: writes to the build folder only.
mkdir "$scratch/bin"
cat >"$scratch/bin/cpp" <<TEXT
#!/usr/bin/env bash
case \${!#} in
  "$scratch"/out/*) exec $(command -v cpp) "\$@" ;;
  *) echo "\${!#}" >>"$scratch/outside"; exit 1 ;;
esac
TEXT
chmod +x "$scratch/bin/cpp"

code=0
PATH="$scratch/bin:$PATH" cmake -DGENERATOR="$(command -v fastddsgen)" -DOPTIONS= \
  -DIDL="$root/idl/fleet.idl" -DFOLDER="$scratch/out" \
  -DEXPECTED="$scratch/out/fleetPubSubTypes.cxx" -P "$root/idl/generate.cmake" || code=$?
left=$(find "$scratch/out" -name 'fleet.idl*')
[[ -z $left ]] || echo "left behind: $left" >&2
[[ ! -e $scratch/outside ]] || echo "written outside the build: $(cat "$scratch/outside")" >&2
[[ $code -eq 0 && -z $left && ! -e $scratch/outside ]]
