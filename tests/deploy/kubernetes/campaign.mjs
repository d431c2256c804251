// Whether the Job of a campaign runs every shard, retries only what may succeed the next time, and
// keeps the results until they are fetched.
import { basename, dirname } from 'node:path';

const wrong = (wanted) => wanted.filter(([holds]) => !holds).map(([, text]) => text);
const same = (one, other) => JSON.stringify(one) === JSON.stringify(other);

function jobOf(fleet) {
  const { document, pod } = fleet.workload('campaign');
  return { spec: document.spec, kind: document.kind, pod, container: pod.containers[0] };
}

function argumentAfter(container, name) {
  const at = container.args.indexOf(name);
  return at < 0 ? undefined : container.args[at + 1];
}

// The number of the shard comes from the Job alone, and there are as many pods as shards.
export function everyShardOnce(fleet) {
  const { spec, kind, container } = jobOf(fleet);
  const variables = Object.keys(fleet.environmentOf(container));
  return wrong([
    [kind === 'Job' && spec.completionMode === 'Indexed', 'its pods are given no number'],
    [String(spec.completions) === argumentAfter(container, '--of'), `${spec.completions} completions, and --of ${argumentAfter(container, '--of')}`],
    [spec.parallelism >= 1 && spec.parallelism <= spec.completions, `${spec.parallelism} at a time of ${spec.completions}`],
    [spec.completions <= 100000, 'more than a Job can count with a limit for each index'],
    [container.args[0] === 'campaign' && container.args[1] === 'shard' && !container.command, 'does not run fleetctl campaign shard'],
    [!container.args.includes('--index'), '--index makes all pods one shard'],
    [!variables.includes('SLURM_ARRAY_TASK_ID') && !variables.includes('PARALLEL_SEQ'), 'the number of a shard comes from two engines'],
  ]);
}

// Kubernetes takes the first rule that fits: one who is evicted may well end with 1.
export function triedAgain(fleet) {
  const { spec, pod, container } = jobOf(fleet);
  const rules = spec.podFailurePolicy?.rules ?? [];
  const [first, ...others] = rules;
  const fails = others.find((one) => one.action === 'FailIndex')?.onExitCodes;
  return wrong([
    [pod.restartPolicy === 'Never', 'restartPolicy must be Never for a podFailurePolicy'],
    [spec.backoffLimitPerIndex === 3, `backoffLimitPerIndex is ${spec.backoffLimitPerIndex}, not 3`],
    [spec.backoffLimit === undefined && spec.maxFailedIndexes === undefined, 'failing shards end the others'],
    [first?.action === 'Ignore' && first.onPodConditions?.some((one) => one.type === 'DisruptionTarget' && one.status === 'True'), 'the first rule does not ignore disruptions'],
    [fails?.operator === 'In' && same([...fails.values].sort(), [1, 2]), `an index fails at once by ${fails?.operator} ${JSON.stringify(fails?.values)}, not by 1 and 2`],
    [(fails?.containerName ?? container.name) === container.name, `the rule is about a container ${fails?.containerName}`],
    [rules.every((one) => one.action !== 'FailJob'), 'one shard ends the Job'],
    [spec.activeDeadlineSeconds === undefined, 'the Job ends whatever is left'],
  ]);
}

const DAY_S = 86400;

export function resultsStay(fleet) {
  const { spec } = jobOf(fleet);
  const kept = spec.ttlSecondsAfterFinished;
  return kept === undefined || kept >= DAY_S ? [] : [`the logs, which are the results, are deleted after ${kept} s`];
}

export function planIsMounted(fleet) {
  const { pod, container } = jobOf(fleet);
  const plan = container.args[2];
  const mount = (container.volumeMounts ?? []).find((one) => one.mountPath === dirname(plan));
  const volume = (pod.volumes ?? []).find((one) => one.name === mount?.name);
  const map = fleet.named('ConfigMap', volume?.configMap?.name);
  if (!map) return [`no ConfigMap is mounted at ${dirname(plan)}`];
  if (!(basename(plan) in (map.data ?? {}))) return [`${basename(plan)} is not in ${map.metadata.name}`];
  // Without --of the plan's number of shards applies: run elsewhere, the plan gives the same shards.
  const shards = /^shards: *([0-9]+)$/m.exec(map.data[basename(plan)])?.[1];
  return shards === argumentAfter(container, '--of') ? [] : [`the plan has ${shards} shards, --of is ${argumentAfter(container, '--of')}`];
}

// A thread computes all the time.
export function oneCoreAThread(fleet) {
  const { container } = jobOf(fleet);
  const jobs = Number(argumentAfter(container, '--jobs') ?? 1);
  const { requests = {}, limits = {} } = container.resources ?? {};
  return wrong([
    [Number(requests.cpu) === jobs, `${jobs} at a time, and ${requests.cpu} of processor`],
    [requests.cpu === limits.cpu, 'is promised another share of processor than it may use'],
  ]);
}

export function isApart(fleet) {
  const fleets = fleet.documents.filter((one) => one.kind !== 'Namespace' && one.metadata.namespace !== 'giveway-campaign');
  return fleets.map((one) => `${one.kind}/${one.metadata.name} is not in the namespace giveway-campaign`);
}
