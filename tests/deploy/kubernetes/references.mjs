// Whether what is called by a name is there.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { selected } from './fleet.mjs';

function missingMaps(fleet, workload) {
  const complaints = [];
  const ask = (name, key, where) => {
    const map = fleet.named('ConfigMap', name);
    if (!map) complaints.push(`${workload.name}: ${where}: there is no ConfigMap ${name}`);
    else if (key && !(key in (map.data ?? {}))) complaints.push(`${workload.name}: ${where}: ${name} has no key ${key}`);
  };
  for (const container of workload.pod.containers) {
    for (const from of container.envFrom ?? []) ask(from.configMapRef?.name, null, 'envFrom');
    for (const one of container.env ?? []) {
      const key = one.valueFrom?.configMapKeyRef;
      if (key) ask(key.name, key.key, one.name);
    }
  }
  for (const volume of workload.pod.volumes ?? []) {
    if (!volume.configMap) continue;
    ask(volume.configMap.name, null, `volume ${volume.name}`);
    for (const item of volume.configMap.items ?? []) ask(volume.configMap.name, item.key, `volume ${volume.name}`);
  }
  return complaints;
}

function missingVolumes(workload) {
  const there = new Set((workload.pod.volumes ?? []).map((one) => one.name));
  const mounted = workload.pod.containers.flatMap((one) => one.volumeMounts ?? []).map((one) => one.name);
  return [
    ...mounted.filter((name) => !there.has(name)).map((name) => `${workload.name}: there is no volume ${name}`),
    ...[...there].filter((name) => !mounted.includes(name)).map((name) => `${workload.name}: no container mounts the volume ${name}`),
  ];
}

function missingPorts(fleet) {
  const complaints = [];
  const ask = (workload, name, where) => {
    if (typeof name === 'string' && !workload.portNamed(name)) {
      complaints.push(`${where}: ${workload.name} has no port named ${name}`);
    }
  };
  for (const { workload, container } of fleet.containers) {
    for (const probe of ['startupProbe', 'livenessProbe', 'readinessProbe']) {
      ask(workload, container[probe]?.httpGet?.port, probe);
    }
  }
  for (const service of fleet.ofKind('Service')) {
    for (const port of service.spec.ports) {
      for (const workload of selected(fleet, { matchLabels: service.spec.selector })) {
        ask(workload, port.targetPort, `Service/${service.metadata.name}`);
        const target = workload.portNamed(port.targetPort);
        if (target && (target.protocol ?? 'TCP') !== (port.protocol ?? 'TCP')) {
          complaints.push(`Service/${service.metadata.name}: ${port.name} is another protocol than ${workload.name}'s`);
        }
      }
    }
  }
  for (const policy of fleet.ofKind('NetworkPolicy')) {
    for (const port of (policy.spec.ingress ?? []).flatMap((rule) => rule.ports ?? [])) {
      for (const workload of selected(fleet, policy.spec.podSelector)) {
        ask(workload, port.port, `NetworkPolicy/${policy.metadata.name}`);
      }
    }
  }
  return complaints;
}

// A StatefulSet gives its pods names by a Service of their own, which has no address.
function missingHeadless(fleet) {
  return fleet.ofKind('StatefulSet').flatMap((set) => {
    const service = fleet.named('Service', set.spec.serviceName);
    if (!service) return [`StatefulSet/${set.metadata.name}: there is no Service ${set.spec.serviceName}`];
    return service.spec.clusterIP === 'None' ? [] : [`Service/${service.metadata.name} is not headless`];
  });
}

export function referencesExist(fleet) {
  return [
    ...fleet.workloads.flatMap((one) => [...missingMaps(fleet, one), ...missingVolumes(one)]),
    ...missingPorts(fleet),
    ...missingHeadless(fleet),
  ];
}

// Every path a variable names lies in a volume, and where that is a ConfigMap the file is in it.
export function filesAreMounted(fleet) {
  return fleet.containers.flatMap(({ workload, container }) => {
    const complaints = [];
    for (const [name, value] of Object.entries(fleet.environmentOf(container))) {
      if (!value?.startsWith('/')) continue;
      const folder = value.slice(0, value.lastIndexOf('/'));
      const file = value.slice(folder.length + 1);
      const mount = (container.volumeMounts ?? []).find((one) => one.mountPath === folder);
      const volume = (workload.pod.volumes ?? []).find((one) => one.name === mount?.name);
      const map = volume?.configMap && fleet.named('ConfigMap', volume.configMap.name);
      if (!volume) complaints.push(`${workload.name}: ${name}: nothing is mounted at ${folder}`);
      else if (map && !(file in (map.data ?? {}))) complaints.push(`${workload.name}: ${name}: ${file} is not in ${map.metadata.name}`);
      else if (!map && !volume.secret && mount.readOnly) complaints.push(`${workload.name}: ${name}: ${folder} cannot be written`);
    }
    return complaints;
  });
}

// The files in the ConfigMaps are the project's, byte for byte.
export function filesAreTheProjects(fleet) {
  const complaints = [];
  for (const map of fleet.ofKind('ConfigMap')) {
    for (const [key, value] of Object.entries(map.data ?? {})) {
      // That of the servers is no set of a service's profiles, and lies next to the manifests.
      const folder = key === 'discovery_server.xml' ? 'deploy' : { '.xml': 'qos', '.textproto': map.metadata.name.startsWith('giveway-campaigns') ? 'campaigns' : 'scenarios' }[/\.[a-z]+$/.exec(key)?.[0]];
      if (!folder) continue;
      let file = null;
      try {
        file = readFileSync(join(fleet.root, 'config', folder, key), 'utf8');
      } catch {
        complaints.push(`${map.metadata.name}: there is no config/${folder}/${key}`);
      }
      if (file !== null && file !== value) complaints.push(`${map.metadata.name}: ${key} is not config/${folder}/${key}`);
    }
  }
  return complaints;
}
