#!/usr/bin/env bash
# Man pages of the programs and of every verb, made of their --help by help2man.
# Usage: man_pages.sh FOLDER_OF_PROGRAMS OUTPUT_FOLDER
set -euo pipefail
programs=$1 output=$2
mkdir -p "$output"
version=$("$programs/fleetctl" --version | sed "s/^fleetctl \([^,]*\),.*/\1/")

# page COMMAND...: its name is that of the command, with "-" between the words.
page() {
  local name=${*// /-} first
  name=${name//"$programs/"/}
  name=${name// /-}
  first=$("$@" --help | sed -n 1p)
  help2man --no-info --no-discard-stderr --section 1 --source Giveway --version-string "$name $version" \
    --name "$first" --output "$output/$name.1" "$*"
}

# verbs COMMAND...: those its help lists.
verbs() { "$@" --help | sed -n '/^Verbs:/,/^$/s/^  \([a-z]\+\) .*/\1/p'; }

page "$programs/giveway-observer"
page "$programs/giveway-vehicle"
page "$programs/giveway-world"
for verb in $(verbs "$programs/fleetctl"); do
  page "$programs/fleetctl" "$verb"
  for part in $(verbs "$programs/fleetctl" "$verb"); do page "$programs/fleetctl" "$verb" "$part"; done
done
page "$programs/fleetctl" # the last: what is made from it is complete
