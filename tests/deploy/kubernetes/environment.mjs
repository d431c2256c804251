// Whether the services know the variables they are given.
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';

const upper = (flag) => `GIVEWAY_${flag.toUpperCase().replaceAll('-', '_')}`;

// The twins of the flags as flags.cc has them, and what the services read from the environment
// besides; and which of them only a vehicle or only the world takes.
function known(root) {
  const services = join(root, 'services');
  const flags = readFileSync(join(services, 'config/flags.cc'), 'utf8');
  const added = /Add(?:Optional|Switch)?\(\s*"--([a-z-]+)"/g;
  const all = new Set([...flags.matchAll(added)].map((found) => upper(found[1])));
  for (const file of readdirSync(services, { recursive: true }).filter((name) => name.endsWith('.cc'))) {
    const text = readFileSync(join(services, file), 'utf8');
    for (const found of text.matchAll(/getenv\("(GIVEWAY_[A-Z_]+)"\)/g)) all.add(found[1]);
  }
  const [vehicle, world] = /kVehicle\) \{(.*?)\n {2}\} else \{(.*?)\n {2}\}/s.exec(flags).slice(1)
    .map((part) => new Set([...part.matchAll(added)].map((found) => upper(found[1]))));
  return { all, vehicle, world };
}

export function variablesAreKnown(fleet) {
  const { all, vehicle, world } = known(fleet.root);
  const foreign = { vehicle: world, world: vehicle, 'discovery-server': new Set() };
  return fleet.containers.flatMap(({ workload, container }) => {
    const component = workload.labels['app.kubernetes.io/component'];
    return Object.keys(fleet.environmentOf(container))
      .filter((name) => name.startsWith('GIVEWAY_'))
      .flatMap((name) => {
        if (!all.has(name)) return [`${workload.name}: no service knows ${name}`];
        return foreign[component]?.has(name) ? [`${workload.name}: ${name} is not a flag of giveway-${component}`] : [];
      });
  });
}

const REQUIRED = ['GIVEWAY_SCENARIO', 'GIVEWAY_DOMAIN', 'GIVEWAY_INTERFACE', 'GIVEWAY_QOS',
  'GIVEWAY_DISCOVERY_SERVER', 'GIVEWAY_HEALTH_PORT', 'GIVEWAY_HEALTH_ADDRESS'];

// All processes of a fleet get the same configuration of it, and nothing required is missing.
export function variablesAgree(fleet) {
  const vehicle = fleet.environment;
  const world = fleet.environmentOf(fleet.workload('world').pod.containers[0]);
  return REQUIRED.flatMap((name) => {
    if (!vehicle[name] || !world[name]) return [`${name} is not given to vehicles and world`];
    return vehicle[name] === world[name] ? [] : [`${name} is ${vehicle[name]} for vehicles, ${world[name]} for the world`];
  });
}

// The key of orders is given to all that take them and to those pods in which an operator gives them,
// or to none.
export function ordersCanBeSealed(fleet) {
  const keyOf = (component) => fleet.environmentOf(fleet.workload(component).pod.containers[0]).GIVEWAY_ADMIN_KEY;
  const key = keyOf('vehicle');
  if (fleet.overlay === 'sealed' && !key) return ['the vehicles have no key'];
  return ['world', 'discovery-server'].filter((one) => keyOf(one) !== key)
    .map((one) => `the key of ${one} is ${keyOf(one) ?? 'none'}, that of the vehicles ${key ?? 'none'}`);
}

// $(NAME) in a command is replaced by Kubernetes where there is such a variable, and else stays.
export function argumentsAreFilled(fleet) {
  return fleet.containers.flatMap(({ workload, container }) => {
    const names = new Set((container.env ?? []).map((one) => one.name));
    return [...(container.command ?? []), ...(container.args ?? [])]
      .flatMap((text) => [...String(text).matchAll(/\$\(([A-Za-z_]+)\)/g)].map((found) => found[1]))
      .filter((name) => !names.has(name))
      .map((name) => `${workload.name}: $(${name}) is not a variable of the container`);
  });
}
