#!/usr/bin/env bash
# check_unit.sh COMPILER ARGUMENTS...: in the preset tidy ccache runs this in place of the compiler:
# clang-tidy over the file of the command, the list of what it includes, and an object without code. Unless it
# succeeded before for the same text, checks and compiler, which is for ccache to know.
set -euo pipefail
command=("$@")
flags=() object='' source=''
shift
while [[ $# -gt 0 ]]; do
  case $1 in
    -o) object=$2 && shift ;;
    -c) ;;
    *.cc | *.cxx) source=$1 ;;
    *) flags+=("$1") ;;
  esac
  shift
done
# Generated code, and what CMake compiles to learn of the compiler.
[[ $object =~ ^(services|sim_world)/ && $source != *.pb.cc ]] || exec "${command[@]}"

# The analyzer looks into what a file includes only where this is in the file's name.
checked=$source
if [[ $source == */unity_*_cxx.cxx ]]; then
  checked=$(dirname "$source")/UnifiedSource-$(basename "$source")
  cp "$source" "$checked"
fi
# What it prints is a finding: on success it says how many it suppressed.
findings=$(clang-tidy --quiet "$checked" -- "${flags[@]}" 2>&1) || {
  printf '%s\n' "$findings" >&2
  exit 1
}
"${command[0]}" "${flags[@]}" -E -o /dev/null "$source"
echo "no code: clang-tidy found nothing" >"$object" # ccache does not keep an empty one
