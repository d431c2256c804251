#!/usr/bin/env bash
# check_unit.sh COMPILER ARGUMENTS...: in the preset tidy ccache runs this in place of the compiler:
# clang-tidy over the file of the command, the list of what it includes, and an empty object. Unless it
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

# What it prints is a finding: on success it says how many it suppressed.
findings=$(clang-tidy --quiet "$source" -- "${flags[@]}" 2>&1) || {
  printf '%s\n' "$findings" >&2
  exit 1
}
"${command[0]}" "${flags[@]}" -E -o /dev/null "$source"
: >"$object"
