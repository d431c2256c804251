// Whether the scenario an overlay names has a fit place for each of its vehicles.
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { basename, join } from 'node:path';

const BODY_RADIUS_M = 0.25;  // the P3-DX, which these scenarios drive
const GROUND_A_VEHICLE_M2 = 4;

function read(fleet) {
  const name = basename(fleet.environment.GIVEWAY_SCENARIO ?? '');
  const text = readFileSync(join(fleet.root, 'config/scenarios', name), 'utf8');
  const place = /^(?:spawn|vehicle)\b.*?start \{ x_m: (-?[0-9.]+) y_m: (-?[0-9.]+)/gm;
  return {
    name,
    text,
    places: [...text.matchAll(place)].map((found) => [Number(found[1]), Number(found[2])]),
    startWith: Number(/^start_with: ([0-9]+)/m.exec(text)?.[1] ?? 1),
  };
}

export function everyVehicleHasAPlace(fleet) {
  const { name, places, startWith } = read(fleet);
  const { replicas } = fleet.workload('vehicle');
  const complaints = [];
  if (places.length < replicas) complaints.push(`${name} has ${places.length} places for ${replicas} vehicles`);
  if (startWith > replicas) complaints.push(`${name} waits for ${startWith} of ${replicas} vehicles`);
  places.forEach(([x, y], index) => {
    const near = places.slice(0, index).find(([a, b]) => Math.hypot(x - a, y - b) <= 2 * BODY_RADIUS_M);
    if (near) complaints.push(`${name}: two places touch at ${x} ${y}`);
  });
  const span = (axis) => Math.max(...places.map((one) => one[axis])) - Math.min(...places.map((one) => one[axis]));
  if (places.length > 1 && span(0) * span(1) < GROUND_A_VEHICLE_M2 * places.length) complaints.push(`${name}: less than 4 m² a vehicle`);
  return complaints;
}

// The file is what the command in its second line prints.
export function scenarioIsAsWritten(fleet) {
  const { name, text } = read(fleet);
  const command = /^# Written by (tests\/deploy\/fleet_scenario\.sh) ([0-9 ]+)$/m.exec(text);
  if (!command) return [`${name} does not say how it was written`];
  const printed = execFileSync('bash', [join(fleet.root, command[1]), ...command[2].split(' ')], { encoding: 'utf8' });
  return printed === text ? [] : [`${name} is not what ${command[0].slice('# Written by '.length)} prints`];
}
