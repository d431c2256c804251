// Whether each pod is watched, bounded and shut in, and is given what the plan says it takes.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { cores, mebibytes } from './fleet.mjs';

const each = (fleet, complain) => fleet.containers.flatMap(({ workload, container }) =>
  complain(container, workload).map((text) => `${workload.name}: ${text}`));

export function probed(fleet) {
  return each(fleet, (container, workload) => {
    const complaints = ['startupProbe', 'livenessProbe', 'readinessProbe']
      .filter((one) => !container[one]).map((one) => `no ${one}`);
    if (workload.labels['app.kubernetes.io/component'] === 'discovery-server') return complaints;
    const paths = { startupProbe: '/livez', livenessProbe: '/livez', readinessProbe: '/readyz' };
    const wrong = Object.entries(paths).filter(([probe, path]) => container[probe] && container[probe].httpGet?.path !== path);
    return [...complaints, ...wrong.map(([probe, path]) => `${probe} does not ask for ${path}`)];
  });
}

export function bounded(fleet) {
  return each(fleet, (container) => {
    const { requests = {}, limits = {} } = container.resources ?? {};
    return [['cpu', cores], ['memory', mebibytes]].flatMap(([name, read]) => {
      if (!(read(requests[name]) > 0) || !(read(limits[name]) > 0)) return [`no request or no limit of ${name}`];
      return read(requests[name]) <= read(limits[name]) ? [] : [`more ${name} is requested than the limit`];
    });
  });
}

// What the level "restricted" of Pod Security asks for, and that nothing can be written or asked of
// the cluster.
export function shutIn(fleet) {
  const pods = fleet.workloads.flatMap(({ name, pod }) => {
    const wanted = [
      [pod.securityContext?.runAsNonRoot === true, 'may run as root'],
      [pod.securityContext?.runAsUser === 10001, 'does not run as the image\'s user, 10001'],
      [pod.securityContext?.seccompProfile?.type === 'RuntimeDefault', 'no seccomp profile RuntimeDefault'],
      [pod.automountServiceAccountToken === false, 'is given a token of the cluster'],
      [pod.enableServiceLinks === false, 'is given variables of Services, with our prefix'],
      [pod.terminationGracePeriodSeconds <= 10, 'is given more than 10 s to stop; it takes one'],
      [!pod.hostNetwork && !pod.hostPID && !pod.hostIPC, 'shares namespaces of its node'],
      [!(pod.volumes ?? []).some((one) => one.hostPath), 'mounts a folder of its node'],
    ];
    return wanted.filter(([holds]) => !holds).map(([, text]) => `${name}: ${text}`);
  });
  const containers = each(fleet, ({ securityContext: context = {} }) => [
    [context.readOnlyRootFilesystem === true, 'its root file system can be written'],
    [context.allowPrivilegeEscalation === false, 'may gain privileges'],
    [context.capabilities?.drop?.includes('ALL') && !context.capabilities.add, 'keeps capabilities'],
    [!context.privileged, 'is privileged'],
  ].filter(([holds]) => !holds).map(([, text]) => text));
  const spaces = fleet.ofKind('Namespace')
    .filter((one) => one.metadata.labels?.['pod-security.kubernetes.io/enforce'] !== 'restricted')
    .map((one) => `Namespace/${one.metadata.name} lets in more than restricted pods`);
  return [...pods, ...containers, ...spaces];
}

// The image of each component.
const IMAGES = {
  world: 'giveway-world',
  vehicle: 'giveway-vehicle',
  observer: 'giveway-observer',
  'discovery-server': 'giveway-tools',
  campaign: 'giveway-tools',
};

export function imagesArePinned(fleet) {
  const cmake = readFileSync(join(fleet.root, 'CMakeLists.txt'), 'utf8');
  const version = /project\(giveway VERSION ([0-9.]+)/.exec(cmake)[1];
  return each(fleet, ({ image }, { labels }) => {
    const [name, tag] = image.split('/').pop().split(':');
    const wanted = IMAGES[labels['app.kubernetes.io/component']];
    if (name !== wanted) return [`the image is ${name}, not ${wanted}`];
    return tag === version ? [] : [`${image} is not of version ${version}`];
  });
}

export function fleetIsPut(fleet) {
  const { document, replicas } = fleet.workload('vehicle');
  const world = fleet.workload('world').document.spec;
  const size = ['observed', 'sealed'].includes(fleet.overlay) ? 2 : Number(fleet.overlay);
  const wanted = [
    [replicas === size, `${replicas} vehicles, and the overlay is ${fleet.overlay}`],
    [document.spec.podManagementPolicy === 'Parallel', 'vehicles start one after the other, and wait for each other'],
    [world.replicas === 1 && world.strategy?.type === 'Recreate', 'there may be two worlds at a time'],
    [replicas < 100 || fleet.workload('vehicle').pod.topologySpreadConstraints, 'nothing spreads the vehicles'],
    [fleet.documents.every((one) => one.kind === 'Namespace' || one.metadata.namespace === 'giveway'), 'not all is in the namespace giveway'],
    [fleet.documents.every((one) => one.metadata.labels?.['app.kubernetes.io/instance'] === `fleet-${size}`), 'not all is labelled with its fleet'],
  ];
  return wanted.filter(([holds]) => !holds).map(([, text]) => text);
}

// The libraries of a process, which the plan leaves out since all of a host share them: the first of
// a node is charged with them. Measured: 38.6 MiB resident of a vehicle among twenty, 19.4 its own.
const SHARED_MIB = 19;

// Milliseconds of processor a second, and MiB, of services/fleetctl/plan/plan_costs.h.
export function plannedForIsRequested(fleet) {
  const text = readFileSync(join(fleet.root, 'services/fleetctl/plan/plan_costs.h'), 'utf8');
  const cost = (name) => Number(new RegExp(`double ${name} = ([0-9.]+);`).exec(text)[1]);
  const vehicles = fleet.workload('vehicle').replicas;
  const plan = {
    vehicle: [cost('vehicle_cpu') + cost('vehicle_cpu_a_peer') * (vehicles - 1),
      SHARED_MIB + cost('vehicle_mib') + cost('vehicle_mib_a_peer') * (vehicles - 1)],
    world: [cost('world_cpu') + cost('world_cpu_a_vehicle') * vehicles,
      SHARED_MIB + cost('world_mib') + cost('world_mib_a_vehicle') * vehicles],
  };
  return Object.entries(plan).flatMap(([component, [milliseconds, mib]]) => {
    const [{ resources }] = fleet.workload(component).pod.containers;
    const { requests = {}, limits = {} } = resources ?? {};
    const wanted = [
      [cores(requests.cpu) * 1000 >= milliseconds, `requests ${requests.cpu} of processor, the plan is ${milliseconds.toFixed(0)}m`],
      [mebibytes(requests.memory) >= mib, `requests ${requests.memory} of memory, the plan is ${mib.toFixed(1)}Mi`],
      // Discovery of all peers takes several times the processor time of driving, and a throttled loop misses ticks.
      [cores(limits.cpu) * 1000 >= 4 * milliseconds, `is limited to ${limits.cpu} of processor, less than four times the plan`],
      [mebibytes(limits.memory) >= 1.5 * mib, `is limited to ${limits.memory} of memory, the plan is ${mib.toFixed(1)}Mi`],
    ];
    return wanted.filter(([holds]) => !holds).map(([, what]) => `${component} ${what}`);
  });
}
