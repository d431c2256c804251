#!/usr/bin/env bash
# Injects one mistake at a time into a copy of the manifests: kubernetes.sh must find each, by the checks
# named, and find nothing else.
# The dollar signs in quotes are those of sed and of Kubernetes.
# shellcheck disable=SC2016
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
project=$(cd "$here/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
B=config/deploy/kubernetes/base
O=config/deploy/kubernetes/overlays
injected=0

# lay_out TREE: a copy of what the checks read.
lay_out() {
  mkdir "$1"
  (cd "$project" && cp -r --parents config services/config services/health services/runtime services/link \
    services/fleetctl/plan/plan_costs.h \
    tests/deploy/fleet_scenario.sh CMakeLists.txt "$1")
}

# failed_checks TREE: names of the overlay's checks that failed, in their order.
failed_checks() {
  local report code=0
  report=$(bash "$here/kubernetes.sh" --root "$1" "$overlay") || code=$?
  ((code <= 1)) || echo could_not_check
  sed -n "s/^FAILED *$overlay\.//p" <<<"$report" | paste -sd' '
}

# One mistake in a tree of its own, see expect.
inject() {
  local tree=$1 checks=$2 what=$3 file=$4 script=$5 found
  lay_out "$tree"
  sed -i -E "$script" "$tree/$file"
  if cmp -s "$tree/$file" "$project/$file"; then
    found="nothing was changed"
  else
    found=$(failed_checks "$tree")
  fi
  rm -rf "$tree"
  if [[ $found == "$checks" ]]; then
    printf 'ok      detected: %s\n' "$what"
  else
    printf 'FAILED  detected: %s\n    by: %s\n    expected: %s\n' "$what" "${found:-nothing}" "$checks"
  fi
}

# expect CHECKS WHAT FILE SED: WHAT is done by SED to FILE, and these checks fail. A script that changes
# nothing is reported. As many at a time as there are cores.
expect() {
  injected=$((injected + 1))
  (($(jobs -rp | wc -l) < $(nproc))) || wait -n
  inject "$work/$injected" "$@" >"$work/$injected.said" 2>&1 &
}

lay_out "$work/clean"
for overlay in campaign sealed 20; do
  clean=$(failed_checks "$work/clean")
  if [[ -n $clean ]]; then
    printf 'FAILED  the clean tree is clean\n    by: %s\n' "$clean"
    exit 1
  fi
done
echo "ok      the clean tree is clean"

# What the schemas and kustomize find.
expect schema "a misspelt field" $B/vehicle.yaml 's/readOnlyRootFilesystem: true/&\n            runAsNonRoto: true/'
expect schema "a field a level too high" $B/world.yaml 's/^  replicas: 1/&\n  restartPolicy: Always/'
expect schema "a text for a number" $B/vehicle.yaml 's/failureThreshold: 60/failureThreshold: "60"/'
expect schema "a kind in a version that has none" $B/disruption.yaml '0,/policy\/v1/s//policy\/v9/'
expect schema "a required field that is missing" $B/discovery.yaml 's/topologyKey: .*/nodeTaintsPolicy: Honor/'
expect schema "a field without a value" $B/discovery.yaml 's/^      containers:/      tolerations:\n&/'
expect rendered "a misspelt field of kustomize" $B/kustomization.yaml 's/^images:/imagse:/'
expect rendered "a field that kustomize gives up" $B/kustomization.yaml 's/^labels:/commonLabels: {a: b}\n&/'
expect "rendered" "a file that is not there" $B/kustomization.yaml 's/- world.yaml/- wrold.yaml/'

# References between objects.
expect "selectors_match health_reached" "a Service that selects nothing" $B/world.yaml \
  '/^kind: Service/,$s/selector: \*labels/selector: {app.kubernetes.io\/component: wrold}/'
expect "selectors_narrow references" "a Service that selects all pods" $B/vehicle.yaml \
  '/^kind: Service/,$s/selector: \*labels/selector: {app.kubernetes.io\/part-of: giveway}/'
expect "selectors_match budgets" "a budget that selects nothing" $B/disruption.yaml \
  's/component: discovery-server/component: discovery/'
expect "selectors_match" "pods spread by a label they do not have" $B/discovery.yaml \
  '/labelSelector/,/matchLabels/s/matchLabels: .*/matchLabels: {app: discovery}/'
expect "references files_mounted" "a ConfigMap that is not there" $B/vehicle.yaml 's/configMap: \{name: giveway-qos\}/configMap: {name: giveway-sets}/'
expect references "a key that is missing" $B/world.yaml \
  's/^( *)value: .*checkpoint/\1valueFrom: {configMapKeyRef: {name: giveway-fleet, key: GIVEWAY_CHECKPOINT}}/'
expect "references files_mounted" "a volume that is not there" $B/vehicle.yaml 's/\{name: qos, mountPath/{name: sets, mountPath/'
expect references "a port by another name" $B/world.yaml 's/targetPort: health/targetPort: http/'
expect references "a set without its Service" $B/vehicle.yaml 's/serviceName: .*/serviceName: giveway-vehicles/'
expect "files_mounted places" "a scenario that is not in the ConfigMap" $O/20/kustomization.yaml '/GIVEWAY_SCENARIO/s/fleet_20/fleet_2/'
expect files_mounted "a checkpoint where nothing can be written" $B/world.yaml 's/value: .*checkpoint/value: \/var\/lib\/checkpoint/'
expect files_the_projects "a file of another content" $O/20/kustomization.yaml \
  's/- \.\..*fleet_20.*/- fleet_20.textproto=..\/..\/..\/..\/scenarios\/fleet_2.textproto/'

# The services' configuration.
expect variables_known "a variable no service knows" $B/kustomization.yaml 's/GIVEWAY_LOG_FORMAT/GIVEWAY_LOGFORMAT/'
expect variables_known "the world's variable given to all" $B/kustomization.yaml 's/^( *- )GIVEWAY_LOG_FORMAT=json/&\n\1GIVEWAY_THREADS=2/'
expect variables_known "a flag that goes out of use" services/config/flags.cc 's/"--log-format", "text/"--log-shape", "text/'
expect "variables_agree" "a world in another domain" $B/world.yaml \
  's/^( *)- name: GIVEWAY_CHECKPOINT/\1- {name: GIVEWAY_DOMAIN, value: "9"}\n&/'
expect "arguments_filled" "an argument that stays unfilled" $B/discovery.yaml 's/"0.0.0.0"/"$(ADDRESS)"/'
expect servers_found "a server with a number" $B/discovery.yaml 's/"-l"/"-i", "0", "-l"/'
expect servers_found "a server with the lease of the library" $B/discovery.yaml 's/server.xml"/server.txt"/'

# Network policies.
expect "servers_found" "servers named in the wrong order" $B/kustomization.yaml \
  's/giveway-discovery-0:11811,giveway-discovery-1:11811/giveway-discovery-1:11811,giveway-discovery-0:11811/'
expect servers_found "a server by the name of its pod" $B/kustomization.yaml 's/,giveway-discovery-1:/,giveway-discovery:/'
expect servers_found "one server of two" $B/kustomization.yaml 's/,giveway-discovery-1:11811//'
expect servers_found "a probe that looks for another port" $B/discovery.yaml 's/":2E23 /":2E24 /'
expect "selectors_match servers_found" "a server's address that selects a third pod" $B/discovery.yaml \
  's/pod-name: giveway-discovery-1/pod-name: giveway-discovery-2/'
expect "domain_ports_open other_ports_shut" "another domain, the old ports" $B/kustomization.yaml 's/DOMAIN=7/DOMAIN=8/'
expect domain_ports_open "ports for one participant a pod" $B/network_policy.yaml 's/endPort: 9169/endPort: 9161/'
expect domain_ports_open "samples by TCP" $B/network_policy.yaml 's/protocol: UDP, port: 9160/protocol: TCP, port: 9160/'
expect other_ports_shut "ports of every domain" $B/network_policy.yaml 's/port: 9160, endPort: 9169/port: 7400, endPort: 32767/'
expect denied_by_default "no egress is denied" $B/network_policy.yaml \
  '0,/policyTypes: \[Ingress, Egress\]/s//policyTypes: [Ingress]/'
expect dns_open "no names by TCP" $B/network_policy.yaml '/protocol: TCP, port: 53/d'
expect "health_reached" "health at another port" $B/kustomization.yaml 's/HEALTH_PORT=9101/HEALTH_PORT=9100/'

# What the pods are granted and denied.
expect probed "a pod that is never asked" $B/world.yaml 's/livenessProbe:/lifecycle: \&never/; /lifecycle/,/failureThreshold/d'
expect probed "readiness asked of liveness" $B/vehicle.yaml 's/path: \/readyz/path: \/livez/'
expect bounded "no limits" $B/discovery.yaml '/limits: /d'
expect shut_in "a root file system that can be written" $B/vehicle.yaml '/readOnlyRootFilesystem/d'
expect shut_in "variables of Services" $B/vehicle.yaml '/enableServiceLinks/d'
expect shut_in "a token of the cluster" $B/discovery.yaml '/automountServiceAccountToken/d'
expect images_pinned "the image latest" $B/kustomization.yaml '0,/newTag: .*/s//newTag: latest/'
expect fleet "two worlds at a time" $B/world.yaml 's/type: Recreate/type: RollingUpdate/'
expect fleet "vehicles one after the other" $B/vehicle.yaml 's/Parallel/OrderedReady/'
expect "fleet places" "more vehicles than places" $O/20/kustomization.yaml 's/count: 20/count: 30/'
expect scenario_as_written "a scenario changed by hand" config/scenarios/fleet_20.textproto 's/duration_s: 0/duration_s: 60/'
expect "places scenario_as_written" "a place on top of another" config/scenarios/fleet_20.textproto 's/x_m: 20 y_m: -1 /x_m: -4 y_m: -1.2 /'
overlay=200
expect planned_for "two hundred with what two take" $O/200/kustomization.yaml 's/requests: \{cpu: 150m/requests: {cpu: 20m/'
expect fleet "two hundred on as few nodes as will hold them" $O/200/kustomization.yaml '/topologySpreadConstraints/,/component: vehicle/d'

# Orders.
overlay=sealed
K=config/deploy/kubernetes/admin_key/kustomization.yaml
expect orders_sealed "no key where an operator works" $K '/name: giveway-discovery\}/,$d'
expect orders_sealed "a component that is left out" $O/sealed/kustomization.yaml '/^components:/,$d'
expect files_mounted "a key that is not where it is said to be" $K 's/mountPath: .*admin,/mountPath: \/etc\/giveway\/keys,/'

# Campaigns.
overlay=campaign
C=config/deploy/kubernetes/campaign
expect every_shard_once "pods without a number" $C/job.yaml 's/Indexed/NonIndexed/'
expect every_shard_once "fewer pods than shards" $C/job.yaml 's/completions: 200/completions: 100/'
expect every_shard_once "all pods one shard" $C/job.yaml 's/--jobs, "1"/--index, "0"/'
expect every_shard_once "all pods one shard, in one word" $C/job.yaml 's/--jobs, "1"\]/--jobs, "1", "--index=0"]/'
expect every_shard_once "a number set by hand" $C/job.yaml \
  's/^          image: .*/&\n          env: [{name: JOB_COMPLETION_INDEX, value: "0"}]/'
expect every_shard_once "a Job that waits" $C/job.yaml 's/^  completions: .*/&\n  suspend: true/'
expect every_shard_once "a Job that is content with some shards" $C/job.yaml \
  's/^  completions: .*/&\n  successPolicy: {rules: [{succeededCount: 1}]}/'
expect every_shard_once "a file where nothing can be written" $C/job.yaml 's/--jobs, "1"\]/--jobs, "1", --out, \/results]/'
expect images_pinned "a shard of the vehicle's image" $C/job.yaml 's/image: giveway-tools/image: giveway-vehicle:0.1.0/'
expect tried_again "an eviction that fails its shard" $C/job.yaml '/- action: Ignore/,/status:/d'
expect tried_again "the exit code looked at before the eviction" $C/job.yaml \
  '/- action: Ignore/,/status:/d; s/values: \[1, 2\]/&\n      - action: Ignore\n        onPodConditions: [{type: DisruptionTarget, status: "True"}]/'
expect tried_again "a broken invariant tried again" $C/job.yaml 's/values: \[1, 2\]/values: [2]/'
expect tried_again "a killed shard given up" $C/job.yaml 's/values: \[1, 2\]/values: [1, 2, 137]/'
expect tried_again "a broken invariant ignored before it is looked at" $C/job.yaml \
  's/^      - action: FailIndex/      - action: Ignore\n        onExitCodes: {containerName: shard, operator: NotIn, values: [0]}\n&/'
expect tried_again "pods that are ended after a minute" $C/job.yaml \
  's/^      restartPolicy: Never/&\n      activeDeadlineSeconds: 60/'
expect tried_again "a shard started again before it has ended" $C/job.yaml \
  's/^  completions: .*/&\n  podReplacementPolicy: TerminatingOrFailed/'
expect tried_again "one limit for all shards" $C/job.yaml 's/backoffLimitPerIndex: 3/backoffLimit: 3/'
expect tried_again "a pod that is restarted in its place" $C/job.yaml 's/restartPolicy: Never/restartPolicy: OnFailure/'
expect results_stay "results deleted after a minute" $C/job.yaml 's/ttlSecondsAfterFinished: .*/ttlSecondsAfterFinished: 60/'
expect plan_mounted "a plan that is not in the ConfigMap" $C/job.yaml 's/nightly.textproto/weekly.textproto/'
expect one_core_a_thread "four threads on one core" $C/job.yaml 's/--jobs, "1"/--jobs, "4"/'
expect schema "a field of the Job a level too low" $C/job.yaml 's/^      restartPolicy: Never/&\n      backoffLimitPerIndex: 3/'
expect silent "shards that may speak" $C/job.yaml 's/policyTypes: .*/policyTypes: [Ingress]/'
expect apart "in the namespace of the fleets" $C/kustomization.yaml 's/^namespace: .*/namespace: giveway/'

wait
for ((i = 1; i <= injected; ++i)); do cat "$work/$i.said"; done | tee "$work/said"
# A check that was cut short prints nothing, so the lines are counted.
[[ $(grep -c '^ok ' "$work/said") -eq $injected ]]
