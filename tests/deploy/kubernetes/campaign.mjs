// Whether the Job of a campaign runs every shard, retries only what may succeed the next time, and
// keeps the results until they are fetched.
import { basename, dirname } from 'node:path';
import { isDeepStrictEqual } from 'node:util';

const wrong = (wanted) => wanted.filter(([holds]) => !holds).map(([, text]) => text);

// Of a Job there is nothing else: what is not here may stop it (suspend), end it early (successPolicy)
// or leave it to another controller (managedBy).
const JOB_FIELDS = ['completionMode', 'completions', 'parallelism', 'backoffLimitPerIndex', 'podFailurePolicy',
  'ttlSecondsAfterFinished', 'template'];
// Those about trying again, of which triedAgain complains.
const RETRY_FIELDS = ['backoffLimit', 'maxFailedIndexes', 'activeDeadlineSeconds', 'podReplacementPolicy'];

// Kubernetes takes the first rule that fits: a pod that is evicted may well end with 1. Any other rule
// would give up what may succeed, or try again what will not.
const RULES = [
  { action: 'Ignore', onPodConditions: [{ type: 'DisruptionTarget', status: 'True' }] },
  { action: 'FailIndex', onExitCodes: { containerName: 'shard', operator: 'In', values: [1, 2] } },
];

function jobOf(fleet) {
  const { document, pod } = fleet.workload('campaign');
  return { spec: document.spec, kind: document.kind, pod, container: pod.containers[0] };
}

function argumentAfter(container, name) {
  const at = container.args.indexOf(name);
  return at < 0 ? undefined : container.args[at + 1];
}

// The number of the shard comes from the Job alone, there are as many pods as shards, and nothing else
// is asked of fleetctl: it has no folder for --out, and --index would make all pods one shard.
export function everyShardOnce(fleet) {
  const { spec, kind, pod, container } = jobOf(fleet);
  const [campaign, shard, plan, of, shards, jobs, threads, ...others] = container.args;
  const given = Object.keys(spec).filter((name) => !JOB_FIELDS.includes(name) && !RETRY_FIELDS.includes(name));
  return wrong([
    [kind === 'Job' && spec.completionMode === 'Indexed', 'its pods are given no number'],
    [spec.parallelism >= 1 && spec.parallelism <= spec.completions, `${spec.parallelism} at a time of ${spec.completions}`],
    [spec.completions <= 100000, 'more than a Job can count with a limit for each index'],
    [campaign === 'campaign' && shard === 'shard' && !container.command, 'does not run fleetctl campaign shard'],
    [of === '--of' && shards === String(spec.completions), `${spec.completions} completions, and ${of} ${shards}`],
    [plan?.startsWith('/') && jobs === '--jobs' && /^[1-9][0-9]*$/.test(threads) && others.length === 0,
      `the arguments are ${container.args.join(' ')}, not campaign shard PLAN --of K --jobs N`],
    [!container.env && !container.envFrom, 'is given variables; the number of the shard is set by the Job alone'],
    [pod.containers.length === 1 && !pod.initContainers, 'is not the only container of its pod'],
    [given.length === 0, `the Job has ${given.join(', ')}`],
  ]);
}

export function triedAgain(fleet) {
  const { spec, pod } = jobOf(fleet);
  const rules = spec.podFailurePolicy?.rules;
  const given = RETRY_FIELDS.filter((name) => spec[name] !== undefined);
  return wrong([
    [pod.restartPolicy === 'Never', 'restartPolicy must be Never for a podFailurePolicy'],
    [spec.backoffLimitPerIndex === 3, `backoffLimitPerIndex is ${spec.backoffLimitPerIndex}, not 3`],
    [isDeepStrictEqual(rules, RULES), `the rules are ${JSON.stringify(rules)}, not ${JSON.stringify(RULES)}`],
    [given.length === 0, `the Job has ${given.join(', ')}: it ends what is left, or starts a shard that still runs`],
    [pod.activeDeadlineSeconds === undefined, 'a pod that takes long is ended, and its shard run again'],
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
