#!/usr/bin/env bash
# Checks config/security/exposure.textproto against its schema, the reasons of the packet filter, and the
# installed packages of Debian 12 or 13: their versions, and every vulnerability that their changelogs name. A
# line for each contradiction; exit code 1 if there is one. No build is needed.
# Usage: exposure.sh [--debian N] [--docs FOLDER] [--versions FILE] [--all-changelogs] [FILE]
#   --debian N       as on that release (default: this host's)
#   --docs FOLDER    where the changelogs are (default /usr/share/doc)
#   --versions FILE  "package version" lines instead of what dpkg says
#   --all-changelogs one that is missing is a contradiction even where dpkg is set to leave them out
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
# shellcheck source=/dev/null
debian=$(. /etc/os-release 2>/dev/null && printf '%s' "${VERSION_ID:-0}")
docs=/usr/share/doc
versions=''
may_lack=true
file=$root/config/security/exposure.textproto
while [[ $# -gt 0 ]]; do
  case $1 in
    --debian) debian=$2 && shift 2 ;;
    --docs) docs=$2 && shift 2 ;;
    --versions) versions=$2 && shift 2 ;;
    --all-changelogs) may_lack=false && shift ;;
    *) file=$1 && shift ;;
  esac
done
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failed=0
fail() {
  printf '%s\n' "$*"
  failed=1
}

# One field a line, whatever the layout of the file.
if ! protoc -I "$root/idl" --encode=giveway.schema.Exposure exposure.proto <"$file" >"$scratch/bytes" 2>"$scratch/why"; then
  printf '%s does not follow idl/exposure.proto:\n%s\n' "${file##*/}" "$(cat "$scratch/why")"
  exit 1
fi
protoc -I "$root/idl" --decode=giveway.schema.Exposure exposure.proto <"$scratch/bytes" >"$scratch/text"

# Lines "library|debian|package|version" and "vulnerability|id|state here|version|shielded|reasons|gaps",
# where gaps are the required fields that are missing.
awk -v debian="$debian" '
  function value() { sub(/^[^:]*: /, ""); gsub(/^"|"$/, ""); return $0 }
  function missing(name) { if (!(name in seen)) gaps = gaps " " name }
  function check_package(name) {
    missing(name)
    if ((state[name] == "PATCHED") != (version[name] != "")) gaps = gaps " " name ".version"
    if ((state[name] == "" || state[name] == "OPEN" || state[name] == "UNKNOWN") && !shielded) missing("residual")
  }
  function end_vulnerability() {
    missing("id"); missing("what"); missing("affected")
    check_package("debian12"); check_package("debian13")
    here = "debian" debian
    print "vulnerability|" id "|" (state[here] == "" ? "UNKNOWN" : state[here]) "|" version[here] "|" shielded "|" reasons "|" gaps
  }
  /^[a-z_0-9]+ \{/ { kind = $1; split("", seen); split("", state); split("", version)
                     id = reasons = gaps = package = release = ""; shielded = 0; inner = ""; next }
  /^\}/ { if (kind == "library") print "library|" of "|" package "|" release
          if (kind == "vulnerability") end_vulnerability()
          kind = ""; next }
  /^  [a-z_0-9]+ \{/ { inner = $1; seen[inner] = 1; next }
  /^  \}/ { inner = ""; next }
  { field = $1; sub(/:$/, "", field) }
  kind == "library" && field == "debian" { of = value(); next }
  kind == "library" && field == "package" { package = value(); next }
  kind == "library" && field == "version" { release = value(); next }
  kind == "vulnerability" && inner == "" { seen[field] = 1; if (field == "id") id = value(); next }
  inner == "shield" { shielded = 1; if (field == "packet_filter") reasons = reasons " " value(); next }
  field == "state" { state[inner] = value(); next }
  field == "version" { version[inner] = value(); next }
' "$scratch/text" >"$scratch/table"

installed() { # PACKAGE: the version of its source, or nothing
  if [[ -n $versions ]]; then
    awk -v package="$1" '$1 == package {print $2}' "$versions"
  else
    # shellcheck disable=SC2016 # a format of dpkg-query
    dpkg-query -W -f '${db:Status-Abbrev} ${source:Version}\n' "$1" 2>/dev/null | awk '$1 == "ii" {print $2; exit}'
  fi
}

# Lines "id|changelog entry that names it" of a changelog on stdin.
named() {
  awk '/^[a-z0-9+.-]+ \(/ { entry = $2; gsub(/[()]/, "", entry) }
    /CVE-[0-9]|GHSA-/ {
      while (match($0, /CVE-[0-9]+-[0-9]+|GHSA(-[0-9a-z]+)+/)) {
        print substr($0, RSTART, RLENGTH) "|" entry
        $0 = substr($0, RSTART + RLENGTH)
      }
    }'
}

while IFS='|' read -r id; do fail "$id stands twice"; done < <(
  awk -F '|' '$1 == "vulnerability" {print $2}' "$scratch/table" | sort | uniq -d)

header=$root/services/types/figures/packet_counters.h
reasons=$(sed -n 's/^ *return "\(.*\)";$/\1/p' "$header" | grep -vxE 'none|unknown')
while IFS='|' read -r kind id _ _ _ shields gaps; do
  [[ $kind == vulnerability ]] || continue
  [[ -z $gaps ]] || fail "${id:-a vulnerability without id}: lacks or contradicts:$gaps"
  for reason in $shields; do
    grep -qxF "$reason" <<<"$reasons" || fail "$id: the packet filter has no reason \"$reason\"; see ${header#"$root"/}"
  done
done <"$scratch/table"

held=0
: >"$scratch/named"
while IFS='|' read -r kind of package written; do
  [[ $kind == library && $of == "$debian" ]] || continue
  now=$(installed "$package")
  if [[ -z $now ]]; then
    fail "$package is not installed: there is nothing to hold the file against"
    continue
  fi
  if [[ $now != "$written" ]]; then
    fail "$package is $now; the file was written for $written. Read what its changelog says since then, enter what" \
      "is fixed or new, and write the version into its library line"
  fi
  if [[ -r $docs/$package/changelog.Debian.gz ]]; then
    gzip -dc "$docs/$package/changelog.Debian.gz" | named >>"$scratch/named"
    held=$((held + 1))
  elif ! $may_lack || ! grep -qsF "path-exclude /usr/share/doc" /etc/dpkg/dpkg.cfg.d/* /etc/dpkg/dpkg.cfg; then
    fail "$docs/$package/changelog.Debian.gz cannot be read: install $package again"
  fi
done <"$scratch/table"

if ((held > 0)); then
  while read -r line; do fail "$line"; done < <(awk -F '|' -v debian="$debian" '
    FNR == NR { named[$1] = $2; next }
    $1 != "vulnerability" { next }
    { known[$2] = 1 }
    $3 == "PATCHED" && !($2 in named) { print $2 ": said to be patched in Debian " debian ", but no installed changelog names it" }
    $3 == "PATCHED" && ($2 in named) && named[$2] != $4 { print $2 ": patched in " named[$2] " by the changelog, not in " $4 }
    $3 != "PATCHED" && ($2 in named) { print $2 ": the changelog names it in " named[$2] ", the file says " $3 " of Debian " debian }
    END { for (id in named) if (!(id in known)) print id ": the changelog names it in " named[id] ", the file lacks it" }
  ' "$scratch/named" "$scratch/table")
fi

awk -F '|' -v held="$held" -v debian="$debian" '$1 == "vulnerability" { 
    ++n; ++of[$3]; if ($3 ~ /OPEN|UNKNOWN/ && !$5) ++bare }
  END { printf "%d vulnerabilities; Debian %s: %d patched, %d released, %d absent, %d open or unknown, ", n, debian,
    of["PATCHED"], of["RELEASED"], of["ABSENT"], of["OPEN"] + of["UNKNOWN"]
    printf "%d of these without a shield; %d changelogs read\n", bare, held }' "$scratch/table"
exit "$failed"
