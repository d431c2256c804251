#!/usr/bin/env bash
# What a vehicle keeps in /dev/shm is deleted while it waits for its first place: it starts again without shared
# memory, and a world that comes later finds it. Regressions: it waited for ever, and received nothing; and the text
# of its set, held for the case that its memory is full, stayed open after each restart.
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
take_domain
SAME_HOST=$REPOSITORY/config/qos/same_host.xml

# The files of a process's own segments that are still there.
segments_of() { # NAME
  find "/proc/${PID[$1]}/fd" "/proc/${PID[$1]}/map_files" -lname '/dev/shm/fast*' -printf '%l\n' 2>/dev/null |
    grep -v port | sort -u
}

start waits giveway-vehicle --qos "$SAME_HOST"
await "it waits" 15 waits 'no answer from a world'
mapfile -t segments < <(segments_of waits)
[[ ${#segments[@]} -gt 0 ]] || fail "it has no segment in /dev/shm"
rm -f -- "${segments[@]}"
await "it notices" 5 waits 'shared memory'
start world giveway-world --qos "$SAME_HOST"
await "it drives" 15 waits 'cruise'

# Texts in memory that its next process image would still have: over UDP it holds none.
held_texts() { # NAME
  local fd flags
  for fd in "/proc/${PID[$1]}"/fd/*; do
    [[ $(readlink "$fd") == /memfd:* ]] || continue
    flags=$(sed -n 's/^flags:[[:space:]]*//p' "/proc/${PID[$1]}/fdinfo/${fd##*/}")
    ((flags & 02000000)) || readlink "$fd" # O_CLOEXEC; both are octal
  done
}
held=$(held_texts waits)
[[ -z $held ]] || fail "it holds: $held"
no_contact
((failures == 0))
