#!/usr/bin/env bash
# Each contradiction that exposure.sh looks for, written into a small file, a changelog or a list of versions
# of the test's own: it must be named.
set -euo pipefail
rules=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failed=0

sound() { # a file without contradictions, and packages that it fits
  mkdir -p "$tree/docs/libdds"
  cat >"$tree/file" <<'TEXT'
library { debian: 12 package: "libdds" version: "2.9-1+deb12u2" }
vulnerability {
  id: "CVE-2023-1" what: "a" affected: "b" fixed_upstream: ["2.9.2"]
  debian12 { state: PATCHED version: "2.9-1+deb12u1" } debian13 { state: RELEASED }
}
vulnerability {
  id: "CVE-2024-2" what: "a" affected: "b"
  debian12 { state: OPEN } debian13 { state: RELEASED }
  shield { packet_filter: "malformed" }
}
vulnerability {
  id: "GHSA-8g7x-c9fg-g6mh" what: "a" affected: "b"
  debian12 { state: OPEN } debian13 { state: OPEN }
  residual: "all of it"
}
TEXT
  printf '%s\n' 'dds (2.9-1+deb12u2) bookworm; urgency=low' '  * Something else' \
    'dds (2.9-1+deb12u1) bookworm-security; urgency=medium' '    - CVE-2023-1 Bad-free (Closes: #1)' >"$tree/changelog"
  echo 'libdds 2.9-1+deb12u2' >"$tree/versions"
}

expect() { # EXIT CODE, WHAT IT SAYS, [FILE, SED COMMAND that changes it]
  local said code=0
  sound
  [[ $# -lt 4 ]] || sed -i "$4" "$tree/$3"
  rm -f "$tree/docs/libdds/changelog.Debian.gz"
  [[ ! -s $tree/changelog ]] || gzip -c "$tree/changelog" >"$tree/docs/libdds/changelog.Debian.gz"
  said=$(bash "$rules/exposure.sh" --all-changelogs --debian 12 --docs "$tree/docs" --versions "$tree/versions" "$tree/file") || code=$?
  if [[ $code -eq $1 ]] && grep -qF -- "$2" <<<"$said"; then return; fi
  echo "wanted '$2' and exit code $1, got $code: $said"
  failed=1
}

expect 0 '3 vulnerabilities; Debian 12: 1 patched, 0 released, 0 absent, 2 open or unknown, 1 of these without a shield'
expect 1 'does not follow idl/exposure.proto' file 's/affected/afflicted/'
expect 1 'does not follow idl/exposure.proto' file 's/state: OPEN/state: FIXED/'
expect 1 'CVE-2024-2 stands twice' file 's/CVE-2023-1/CVE-2024-2/'
expect 1 'GHSA-8g7x-c9fg-g6mh: lacks or contradicts: residual' file '/residual/d'
expect 1 'CVE-2023-1: lacks or contradicts: debian12.version' file 's/state: PATCHED version: "[^"]*"/state: PATCHED/'
expect 1 'CVE-2024-2: lacks or contradicts: debian13' file '/CVE-2024-2/,$ s/debian13 { state: RELEASED }//'
expect 1 'the packet filter has no reason "misshapen"' file 's/malformed/misshapen/'
expect 1 'CVE-2024-2: said to be patched in Debian 12, but no installed changelog names it' \
  file '/CVE-2024-2/,$ s/debian12 { state: OPEN }/debian12 { state: PATCHED version: "2.9-1+deb12u2" }/'
expect 1 'CVE-2023-1: patched in 2.9-1+deb12u1 by the changelog, not in 2.9-1+deb12u2' \
  file 's/PATCHED version: "2.9-1+deb12u1"/PATCHED version: "2.9-1+deb12u2"/'
expect 1 'CVE-2024-2: the changelog names it in 2.9-1+deb12u2, the file says OPEN of Debian 12' \
  changelog 's/Something else/Fix CVE-2024-2/'
expect 1 'CVE-2026-3: the changelog names it in 2.9-1+deb12u2, the file lacks it' \
  changelog 's/Something else/CVE-2024-9999x, CVE-2026-3/'
expect 1 'the file was written for 2.9-1+deb12u2. Read what its changelog says' versions 's/u2/u3/'
expect 1 'libdds is not installed' versions d
expect 1 'libdds/changelog.Debian.gz cannot be read' changelog d
exit "$failed"
