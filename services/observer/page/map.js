// Draws one moment. Cones only where few vehicles are in view, or of the picked one: all cones of 200
// vehicles cost three quarters of the frame rate.
const MOST_WITH_CONES = 30;
const MOST_WITH_LINKS = 60;
const TRAIL_MS = 12000;

function line(g, points) {
  g.beginPath();
  points.forEach(([x, y], i) => (i ? g.lineTo(x, y) : g.moveTo(x, y)));
  g.stroke();
}

function drawGrid(g, width, height) {
  const step = [0.5, 1, 2, 5, 10, 20, 50, 100].find((s) => s * view.scale >= 36) ?? 200;
  const [left, top] = toWorld(0, 0), [right, low] = toWorld(width, height);
  g.strokeStyle = colours.grid;
  g.lineWidth = 1;
  g.beginPath();
  for (let x = Math.ceil(left / step) * step; x < right; x += step) {
    const px = Math.round(toScreen(x, 0)[0]) + 0.5;
    g.moveTo(px, 0); g.lineTo(px, height);
  }
  for (let y = Math.ceil(low / step) * step; y < top; y += step) {
    const py = Math.round(toScreen(0, y)[1]) + 0.5;
    g.moveTo(0, py); g.lineTo(width, py);
  }
  g.stroke();
  const px = step * view.scale;
  g.strokeStyle = g.fillStyle = colours.soft;
  line(g, [[14, height - 20], [14, height - 14], [14 + px, height - 14], [14 + px, height - 20]]);
  g.font = "12px system-ui, sans-serif";
  g.textAlign = "left";
  g.textBaseline = "alphabetic";
  g.fillText(step + " m", 18, height - 19);
}

// How far a door's leaf has gone from `from` back: 0 closed, 1 open.
function doorShare(door, time_s) {
  const cycle = door.closed_s + door.open_s + 2 * door.move_s;
  let t = (Math.max(0, time_s) + door.offset_s) % cycle;
  if (t < door.closed_s) return 0;
  t -= door.closed_s;
  if (t < door.move_s) return t / door.move_s;
  t -= door.move_s;
  if (t < door.open_s) return 1;
  return 1 - (t - door.open_s) / door.move_s;
}

function drawScene(g, frame) {
  const scene = state.scene;
  g.lineCap = "round";
  g.strokeStyle = colours.one_lane;
  for (const [fromX, fromY, toX, toY, width_m] of scene.one_lanes ?? []) {
    g.lineWidth = width_m * view.scale;
    line(g, [toScreen(fromX, fromY), toScreen(toX, toY)]);
  }
  g.strokeStyle = colours.wall;
  g.lineWidth = 2.5;
  for (const wall of scene.walls ?? []) line(g, [toScreen(wall[0], wall[1]), toScreen(wall[2], wall[3])]);
  g.strokeStyle = colours.sensor_only;
  g.lineWidth = 4;
  for (const door of scene.doors ?? []) {
    const share = doorShare(door, (frame.world.time_ms ?? 0) / 1000);
    const dx = (door.to[0] - door.from[0]) * share, dy = (door.to[1] - door.from[1]) * share;
    line(g, [toScreen(door.from[0] - dx, door.from[1] - dy), toScreen(door.to[0] - dx, door.to[1] - dy)]);
  }
  g.fillStyle = g.strokeStyle = colours.obstacle;
  g.lineWidth = 1;
  for (const obstacle of scene.obstacles ?? []) {
    const [x, y] = toScreen(...obstacle.at);
    g.save();
    g.translate(x, y);
    g.rotate(-obstacle.heading_rad);
    g.beginPath();
    if (obstacle.box_half_m) {
      const [a, b] = obstacle.box_half_m.map((m) => m * view.scale);
      g.rect(-a, -b, 2 * a, 2 * b);
    } else {
      g.arc(0, 0, obstacle.radius_m * view.scale, 0, 7);
    }
    // One that moves is drawn where it starts, as an outline: where it is, no topic carries.
    if (obstacle.waypoints.length) { g.setLineDash([4, 4]); g.stroke(); } else g.fill();
    g.restore();
  }
  g.setLineDash([]);
  g.strokeStyle = colours.soft;
  for (const vehicle of scene.fleet ?? []) {
    if (!vehicle.goal) continue;
    const [x, y] = toScreen(...vehicle.goal);
    line(g, [[x - 4, y - 4], [x + 4, y + 4]]);
    line(g, [[x - 4, y + 4], [x + 4, y - 4]]);
  }
}

function drawSignals(g, frame) {
  const shown = { red: colours.bad, yellow: colours.warn, green: colours.ok, dark: colours.silent };
  for (const [, x1, y1, x2, y2, phase] of frame.signals) {
    g.strokeStyle = shown[state.scene.phases[phase]] ?? colours.silent;
    g.lineWidth = 4;
    line(g, [toScreen(x1 / 1000, y1 / 1000), toScreen(x2 / 1000, y2 / 1000)]);
  }
}

function drawTrail(g, vehicle, at) {
  const series = state.series.get(vehicle.id);
  if (!series) return;
  const from = lastBefore(series.at, at - TRAIL_MS, (t) => t) + 1;
  const to = lastBefore(series.at, at, (t) => t);
  if (to <= from) return;
  const step = Math.max(1, Math.floor((to - from) / 60));
  const left = view.width / 2 - view.x * view.scale, low = view.height / 2 + view.y * view.scale;
  const near = 1.5 / view.scale;  // a step of less shows nothing
  let x = series.x[from], y = series.y[from], steps = 0;
  g.beginPath();
  g.moveTo(left + x * view.scale, low - y * view.scale);
  for (let i = from + step; i <= to; i += step) {
    if (Math.abs(series.x[i] - x) + Math.abs(series.y[i] - y) < near) continue;
    x = series.x[i];
    y = series.y[i];
    g.lineTo(left + x * view.scale, low - y * view.scale);
    ++steps;
  }
  if (steps === 0) return;  // it stands
  g.lineTo(...toScreen(vehicle.x, vehicle.y));
  g.strokeStyle = colourOf(vehicle);
  g.globalAlpha = 0.35;
  g.lineWidth = 1.5;
  g.stroke();
  g.globalAlpha = 1;
}

function drawCones(g, vehicle, ranges, strong) {
  const sonar = state.scene.sonar;
  const cos = Math.cos(vehicle.heading), sin = Math.sin(vehicle.heading);
  sonar.mounts.forEach(([mx, my, bearing], i) => {
    const range = ranges[i];
    if (range === -2 || range === undefined) return;
    const reach = (range >= 0 ? range / 1000 : Math.min(sonar.max_range_m, 1.5)) * view.scale;
    const [x, y] = toScreen(vehicle.x + mx * cos - my * sin, vehicle.y + mx * sin + my * cos);
    const axis = -(vehicle.heading + bearing);
    g.beginPath();
    g.moveTo(x, y);
    g.arc(x, y, reach, axis - sonar.half_angle_rad, axis + sonar.half_angle_rad);
    g.closePath();
    g.fillStyle = colours.cone;
    g.globalAlpha = range >= 0 || strong ? 1 : 0.45;
    g.fill();
    g.globalAlpha = 1;
    if (range < 0) return;
    g.beginPath();
    g.arc(x, y, reach, axis - sonar.half_angle_rad, axis + sonar.half_angle_rad);
    g.strokeStyle = colours.echo;
    g.lineWidth = strong ? 3 : 2;
    g.stroke();
  });
}

// Two standard deviations of where the vehicle believes to be.
function drawEllipse(g, vehicle) {
  const { xx, xy, yy } = vehicle;
  if (!(xx > 0) || !(yy > 0)) return;
  const mean = (xx + yy) / 2, spread = Math.hypot((xx - yy) / 2, xy);
  const long = 2 * Math.sqrt(mean + spread) / 1000, short = 2 * Math.sqrt(Math.max(0, mean - spread)) / 1000;
  const [x, y] = toScreen(vehicle.estimate_x, vehicle.estimate_y);
  g.beginPath();
  g.ellipse(x, y, long * view.scale, short * view.scale, -Math.atan2(2 * xy, xx - yy) / 2, 0, 7);
  g.strokeStyle = colours.ellipse;
  g.lineWidth = 1.5;
  g.setLineDash([3, 3]);
  g.stroke();
  g.setLineDash([]);
}

function drawLink(g, a, b) {
  const age = Math.max(a.beacon_age, b.beacon_age);
  const old = age < 0 || age > 200;
  g.strokeStyle = old ? colours.bad : age > 150 ? colours.warn : colours.ok;
  g.globalAlpha = old ? 0.6 : 0.28;
  g.lineWidth = 1;
  g.setLineDash(old ? [5, 5] : []);
  line(g, [toScreen(a.x, a.y), toScreen(b.x, b.y)]);
  g.setLineDash([]);
  g.globalAlpha = 1;
}
function drawLinks(g, vehicles) {
  const reach = state.scene.emission_radius_m;
  const bodies = vehicles.filter((v) => v.has_body && v.hearing !== "left");
  const link = (a, b) => { if (Math.hypot(a.x - b.x, a.y - b.y) <= reach) drawLink(g, a, b); };
  if (bodies.length > MOST_WITH_LINKS) {
    const picked = bodies.find((v) => v.id === state.picked);
    for (const other of picked ? bodies : []) if (other !== picked) link(picked, other);
    return;
  }
  for (let i = 0; i < bodies.length; ++i) for (let j = i + 1; j < bodies.length; ++j) link(bodies[i], bodies[j]);
}

function drawGivesWay(g, vehicle, peer) {
  const [x1, y1] = toScreen(vehicle.x, vehicle.y), [x2, y2] = toScreen(peer.x, peer.y);
  const length = Math.hypot(x2 - x1, y2 - y1);
  if (length < 8) return;
  const ux = (x2 - x1) / length, uy = (y2 - y1) / length;
  const from = vehicle.radius * view.scale + 2, to = length - peer.radius * view.scale - 4;
  if (to <= from) return;
  g.strokeStyle = g.fillStyle = colours.giveway;
  g.lineWidth = 2;
  line(g, [[x1 + ux * from, y1 + uy * from], [x1 + ux * to, y1 + uy * to]]);
  const tx = x1 + ux * to, ty = y1 + uy * to;
  g.beginPath();
  g.moveTo(tx + ux * 4, ty + uy * 4);
  g.lineTo(tx - ux * 6 - uy * 5, ty - uy * 6 + ux * 5);
  g.lineTo(tx - ux * 6 + uy * 5, ty - uy * 6 - ux * 5);
  g.fill();
}

function drawMark(g, mark, size) {
  g.beginPath();
  if (mark === "arrow") {
    g.moveTo(size, 0); g.lineTo(-size * 0.6, size * 0.65); g.lineTo(-size * 0.3, 0); g.lineTo(-size * 0.6, -size * 0.65);
  } else if (mark === "square") {
    g.rect(-size * 0.55, -size * 0.55, size * 1.1, size * 1.1);
  } else if (mark === "pause") {
    g.rect(-size * 0.6, -size * 0.62, size * 1.24, size * 0.42);
    g.rect(-size * 0.6, size * 0.2, size * 1.24, size * 0.42);
  } else if (mark === "triangle") {
    g.moveTo(-size * 0.6, -size * 0.75); g.lineTo(-size * 0.6, size * 0.75); g.lineTo(size * 0.8, 0);
  } else if (mark === "chevron") {
    g.moveTo(-size * 0.7, -size * 0.7); g.lineTo(size * 0.7, 0); g.lineTo(-size * 0.7, size * 0.7); g.lineTo(0, 0);
  } else if (mark === "cross") {
    g.rect(-size * 0.75, -size * 0.17, size * 1.5, size * 0.34);
    g.rect(-size * 0.17, -size * 0.75, size * 0.34, size * 1.5);
  } else if (mark === "ring") {
    g.arc(0, 0, size * 0.7, 0, 2 * Math.PI);
    g.arc(0, 0, size * 0.4, 0, 2 * Math.PI, true);
  } else {
    g.arc(0, 0, size * 0.35, 0, 7);
  }
  g.fill();
}

function drawVehicle(g, vehicle, labels) {
  const [x, y] = toScreen(vehicle.x, vehicle.y);
  const radius = Math.max(4, vehicle.radius * view.scale);
  const box = state.boxes.get(vehicle.id);
  const heard = vehicle.hearing === "heard";
  g.globalAlpha = matches(vehicle) ? 1 : 0.18;
  g.save();
  g.translate(x, y);
  g.rotate(-vehicle.heading);
  g.beginPath();
  if (box) g.rect(-box[0] * view.scale, -box[1] * view.scale, 2 * box[0] * view.scale, 2 * box[1] * view.scale);
  else g.arc(0, 0, radius, 0, 7);
  g.fillStyle = heard ? colourOf(vehicle) : colours.panel;
  g.fill();
  g.lineWidth = vehicle.id === state.picked ? 3 : 1.5;
  g.strokeStyle = vehicle.id === state.picked ? colours.ink : heard ? colours.panel : colours.silent;
  if (!heard) g.setLineDash([3, 3]);
  g.stroke();
  g.setLineDash([]);
  g.fillStyle = heard ? colours.panel : colours.silent;
  drawMark(g, heard ? markOf(vehicle) : "dot", radius * 0.78);
  // Ahead, where the mark does not point.
  g.strokeStyle = heard ? colourOf(vehicle) : colours.silent;
  g.lineWidth = 2;
  line(g, [[radius, 0], [radius + Math.max(3, radius * 0.35), 0]]);
  g.restore();
  if (labels || vehicle.id === state.picked) {
    g.fillStyle = colours.ink;
    g.font = (vehicle.id === state.picked ? "bold " : "") + "12px system-ui, sans-serif";
    g.textAlign = "center";
    g.textBaseline = "bottom";
    g.fillText(vehicle.id, x, y - radius - 3);
  }
  g.globalAlpha = 1;
}

function drawContacts(g, frame) {
  const now_s = (frame.world.time_ms ?? 0) / 1000;
  g.strokeStyle = colours.bad;
  g.lineWidth = 3;
  for (const event of state.contacts) {
    if (event.world_epoch !== frame.world.epoch) continue;
    if (event.time_s > now_s || event.time_s < now_s - 15) continue;
    const [x, y] = toScreen(...contactPlace(event));
    g.beginPath();
    g.arc(x, y, 13, 0, 7);
    g.stroke();
  }
}

function inView(vehicle, width, height) {
  const [x, y] = toScreen(vehicle.x, vehicle.y);
  return vehicle.has_body && x > -50 && y > -50 && x < width + 50 && y < height + 50;
}

function drawMap(frame) {
  const { width, height } = view;
  if (width === 0 || height === 0) return;  // not laid out yet
  const g = fitCanvas(mapCanvas, width, height);
  g.fillStyle = colours.ground;
  g.fillRect(0, 0, width, height);
  if (!frame) return;
  if (!view.isSet && frame.vehicles.size) fitAll(frame);
  const picked = frame.vehicles.get(state.picked);
  if (state.follow && picked?.has_body) { view.x = picked.x; view.y = picked.y; }
  drawGrid(g, width, height);
  drawScene(g, frame);
  drawSignals(g, frame);
  const seen = [...frame.vehicles.values()].filter((v) => inView(v, width, height));
  drawLinks(g, seen);
  for (const vehicle of seen) drawTrail(g, vehicle, frame.at);
  const few = seen.length <= MOST_WITH_CONES;
  for (const vehicle of seen) {
    const ranges = frame.ranges[vehicle.id];
    if (ranges && (few || vehicle.id === state.picked)) drawCones(g, vehicle, ranges, vehicle.id === state.picked);
  }
  const labels = seen.length <= 60 || view.scale > 25;
  for (const vehicle of seen) {
    if (few || vehicle.id === state.picked) drawEllipse(g, vehicle);
    drawVehicle(g, vehicle, labels);
  }
  for (const vehicle of seen) {
    const peer = frame.vehicles.get(vehicle.gives_way_to);
    if (peer && peer.has_body) drawGivesWay(g, vehicle, peer);
  }
  drawContacts(g, frame);
}
