// Whether packets of the fleet get where they must: ports of the domain, addresses of the servers,
// and what the network policies let through.
import { matches, selected } from './fleet.mjs';

// RTPS 2.2, 9.6.1: port base 7400, 250 a domain, 2 a participant; offsets d1 = 10 and d3 = 11.
const OTHERS_IN_A_POD = 4;  // fleetctl next to a service, and one that has just left
function unicastPorts(domain) {
  const base = 7400 + 250 * domain;
  const numbers = Array.from({ length: OTHERS_IN_A_POD + 1 }, (_, participant) => participant);
  return numbers.flatMap((participant) => [base + 10 + 2 * participant, base + 11 + 2 * participant]);
}

function portAllows(allowed, protocol, port, workload) {
  if ((allowed.protocol ?? 'TCP') !== protocol) return false;
  if (allowed.port === undefined) return true;
  const from = typeof allowed.port === 'string' ? workload.portNamed(allowed.port)?.containerPort : allowed.port;
  return port >= from && port <= (allowed.endPort ?? from);
}

// `peer` speaks to or hears `workload`; no list of peers or ports means all of them.
function ruleAllows(rule, direction, workload, peer, protocol, port) {
  const peers = direction === 'Ingress' ? rule.from : rule.to;
  const receiver = direction === 'Ingress' ? workload : peer;
  const isPeer = !peers || peers.some((one) =>
    !one.ipBlock && !one.namespaceSelector && matches(one.podSelector ?? {}, peer.labels));
  return isPeer && (!rule.ports || rule.ports.some((one) => portAllows(one, protocol, port, receiver)));
}

function allows(fleet, direction, workload, peer, protocol, port) {
  return fleet.ofKind('NetworkPolicy')
    .filter((one) => one.spec.policyTypes.includes(direction) && matches(one.spec.podSelector, workload.labels))
    .flatMap((one) => one.spec[direction.toLowerCase()] ?? [])
    .some((rule) => ruleAllows(rule, direction, workload, peer, protocol, port));
}

// Complaints about a connection that must be open, from one workload's pods to another's port.
function closed(fleet, from, to, protocol, port) {
  const complaints = [];
  if (!allows(fleet, 'Egress', from, to, protocol, port)) complaints.push(`${from.name} may not send to ${to.name}, ${protocol} ${port}`);
  if (!allows(fleet, 'Ingress', to, from, protocol, port)) complaints.push(`${to.name} may not hear ${from.name}, ${protocol} ${port}`);
  return complaints;
}

export function domainPortsAreOpen(fleet) {
  const ports = unicastPorts(Number(fleet.environment.GIVEWAY_DOMAIN));
  const participants = fleet.workloads.filter((one) => one.labels['app.kubernetes.io/component'] !== 'discovery-server');
  return fleet.workloads.flatMap((from) => participants.flatMap((to) =>
    ports.flatMap((port) => closed(fleet, from, to, 'UDP', port))));
}

// The ports of the neighbouring domains and of everything else stay shut.
export function otherPortsAreShut(fleet) {
  const domain = Number(fleet.environment.GIVEWAY_DOMAIN);
  const vehicle = fleet.workload('vehicle');
  const others = [...unicastPorts(domain - 1), ...unicastPorts(domain + 1), 22, 7400 + 250 * domain + 10 + 2 * 119];
  const open = others.filter((port) => allows(fleet, 'Ingress', vehicle, vehicle, 'UDP', port));
  return open.map((port) => `vehicles may hear each other on UDP ${port}, which is not their domain's`);
}

export function deniedByDefault(fleet) {
  const complaints = ['Ingress', 'Egress'].flatMap((direction) => {
    const denies = fleet.ofKind('NetworkPolicy').some((one) =>
      Object.keys(one.spec.podSelector).length === 0 && one.spec.policyTypes.includes(direction) &&
      !one.spec[direction.toLowerCase()]);
    return denies ? [] : [`${direction} is not denied to every pod that no other policy speaks of`];
  });
  const everyone = fleet.ofKind('NetworkPolicy').filter((one) =>
    [...(one.spec.ingress ?? []), ...(one.spec.egress ?? [])].some((rule) => !(rule.from ?? rule.to) || !rule.ports));
  return [...complaints, ...everyone.map((one) => `NetworkPolicy/${one.metadata.name} lets every pod in, or every port`)];
}

// Without names there are no servers.
export function namesCanBeAsked(fleet) {
  return fleet.workloads.flatMap((workload) => ['UDP', 'TCP'].flatMap((protocol) => {
    const open = fleet.ofKind('NetworkPolicy')
      .filter((one) => one.spec.policyTypes.includes('Egress') && matches(one.spec.podSelector, workload.labels))
      .flatMap((one) => one.spec.egress ?? [])
      .some((rule) => rule.ports?.some((port) => portAllows(port, protocol, 53, workload)));
    return open ? [] : [`${workload.name} may not ask for names, ${protocol} 53`];
  }));
}

// Server number I of the variable is the pod number I, by a stable address, on its own port; and a
// restarted server is a new one to its clients, which keep the old one for no longer than the lease in
// the mounted file.
export function serversAreFound(fleet) {
  const servers = fleet.workload('discovery-server');
  const [container] = servers.pod.containers;
  const listens = container.args[container.args.indexOf('-p') + 1];
  const settings = container.args[container.args.indexOf('-x') + 1];
  const addresses = (fleet.environment.GIVEWAY_DISCOVERY_SERVER ?? '').split(',');
  const complaints = [];
  if (container.args.some((one) => one === '-i' || one === '-b')) {
    complaints.push(`${servers.name}: a server with a number or a backup is not found again`);
  }
  if (!settings.endsWith('/discovery_server.xml')) complaints.push(`${servers.name} keeps the library's lease`);
  if (addresses.length !== servers.replicas) complaints.push(`${servers.replicas} servers run, ${addresses.length} are named`);
  if (String(servers.portNamed('discovery')?.containerPort) !== listens) complaints.push(`${servers.name} listens on ${listens}, which is not its port`);
  const word = `:${Number(listens).toString(16).toUpperCase().padStart(4, '0')} `;
  for (const probe of ['startupProbe', 'livenessProbe', 'readinessProbe']) {
    if (!container[probe].exec.command.some((one) => one.includes(word))) complaints.push(`${probe} does not look for port ${listens}`);
  }
  addresses.forEach((address, index) => {
    const [name, port] = address.split(':');
    const service = fleet.named('Service', name);
    const pod = service?.spec.selector['statefulset.kubernetes.io/pod-name'];
    if (!service) complaints.push(`there is no Service ${name}`);
    else if (service.spec.clusterIP === 'None') complaints.push(`Service/${name} has no address of its own`);
    else if (pod !== `${servers.document.metadata.name}-${index}`) complaints.push(`Service/${name} is ${pod}, and named as number ${index}`);
    else if (!service.spec.ports.some((one) => String(one.port) === port && one.protocol === 'UDP')) complaints.push(`Service/${name} has no UDP port ${port}`);
  });
  return [...complaints, ...fleet.workloads.filter((one) => one !== servers)
    .flatMap((one) => closed(fleet, one, servers, 'UDP', Number(listens)))];
}

// Probes, scrapes, Services and policies mean the port on which the services answer.
export function healthIsReached(fleet) {
  const { GIVEWAY_HEALTH_PORT: configured, GIVEWAY_HEALTH_ADDRESS: address } = fleet.environment;
  const complaints = address === '0.0.0.0' ? [] : [`health is served at ${address} alone`];
  for (const workload of ['vehicle', 'world'].map((one) => fleet.workload(one))) {
    const port = workload.portNamed('health')?.containerPort;
    if (String(port) !== configured) complaints.push(`${workload.name}: the port health is ${port}, served is ${configured}`);
    if (workload.annotations['prometheus.io/scrape'] !== 'true') complaints.push(`${workload.name} is not scraped`);
    if (workload.annotations['prometheus.io/port'] !== configured) complaints.push(`${workload.name}: scraped at another port than ${configured}`);
    if (workload.annotations['prometheus.io/path'] !== '/metrics') complaints.push(`${workload.name}: scraped at another path than /metrics`);
    const open = fleet.ofKind('NetworkPolicy')
      .filter((one) => matches(one.spec.podSelector, workload.labels))
      .flatMap((one) => one.spec.ingress ?? [])
      .some((rule) => rule.from?.some((one) => one.namespaceSelector) &&
        rule.ports?.some((one) => portAllows(one, 'TCP', Number(configured), workload)));
    if (!open) complaints.push(`${workload.name}: no other namespace may ask for its metrics`);
    const served = fleet.ofKind('Service').some((service) =>
      selected(fleet, { matchLabels: service.spec.selector }).includes(workload) &&
      service.spec.ports.some((one) => String(one.port) === configured));
    if (!served) complaints.push(`${workload.name}: no Service has its port ${configured}`);
  }
  return complaints;
}
