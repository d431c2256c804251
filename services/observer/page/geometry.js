// Metres to pixels and back, and the colours of the theme.
const mapCanvas = document.getElementById("map");
// Centre, world frame; pixels a metre; pixels of the map, for to ask the page costs a layout.
const view = { x: 0, y: 0, scale: 40, isSet: false, width: 0, height: 0 };
function measureMap() {
  view.width = mapCanvas.clientWidth;
  view.height = mapCanvas.clientHeight;
}
measureMap();
new ResizeObserver(measureMap).observe(mapCanvas);

function toScreen(x, y) {
  return [view.width / 2 + (x - view.x) * view.scale,
          view.height / 2 - (y - view.y) * view.scale];
}
function toWorld(px, py) {
  return [view.x + (px - view.width / 2) / view.scale,
          view.y - (py - view.height / 2) / view.scale];
}
function zoomAt(px, py, factor) {
  const [x, y] = toWorld(px, py);
  view.scale = Math.min(600, Math.max(0.5, view.scale * factor));
  const [nx, ny] = toWorld(px, py);
  view.x += x - nx;
  view.y += y - ny;
}

function extent(frame) {
  const box = { left: Infinity, right: -Infinity, low: Infinity, high: -Infinity };
  const add = (x, y) => {
    box.left = Math.min(box.left, x); box.right = Math.max(box.right, x);
    box.low = Math.min(box.low, y); box.high = Math.max(box.high, y);
  };
  for (const vehicle of frame.vehicles.values()) if (vehicle.has_body) add(vehicle.x, vehicle.y);
  for (const wall of state.scene.walls ?? []) { add(wall[0], wall[1]); add(wall[2], wall[3]); }
  for (const vehicle of state.scene.fleet ?? []) if (vehicle.goal) add(...vehicle.goal);
  return box;
}
function fitAll(frame) {
  const box = extent(frame);
  if (!isFinite(box.left)) return;
  const margin = 1.2;
  view.x = (box.left + box.right) / 2;
  view.y = (box.low + box.high) / 2;
  view.scale = Math.min(140, view.width / (box.right - box.left + 2 * margin),
                        view.height / (box.high - box.low + 2 * margin));
  view.isSet = true;
}

// What a body is: the corners of a box, anticlockwise, or the middle of a disc and its radius.
function outlineOf({ id, x, y, heading, radius }) {
  const box = state.boxes.get(id);
  if (!box) return { corners: [[x, y]], radius };
  const cos = Math.cos(heading), sin = Math.sin(heading);
  const corners = [[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([ahead, left]) => [
    x + ahead * box[0] * cos - left * box[1] * sin, y + ahead * box[0] * sin + left * box[1] * cos]);
  return { corners, radius: 0 };
}
// How far it extends from its middle.
function reachOf({ id, radius }) { return Math.hypot(...state.boxes.get(id) ?? [radius]); }

function toEdge([px, py], [ax, ay], [bx, by]) {
  const dx = bx - ax, dy = by - ay, length = dx * dx + dy * dy;
  const part = length > 0 ? Math.min(1, Math.max(0, ((px - ax) * dx + (py - ay) * dy) / length)) : 0;
  return Math.hypot(px - ax - part * dx, py - ay - part * dy);
}
// Whether all of the other is outside of one edge of a box.
function isBeyondAnEdge(box, other) {
  return box.length > 1 && box.some(([ax, ay], i) => {
    const [bx, by] = box[(i + 1) % box.length];
    return other.every(([x, y]) => (bx - ax) * (y - ay) < (by - ay) * (x - ax));
  });
}
// From hull to hull. Of boxes that overlap it is 0, of discs less.
function gapBetween(one, other) {
  const a = outlineOf(one), b = outlineOf(other);
  const areBoxes = a.corners.length + b.corners.length > 2;
  let gap_m = Infinity;
  if (areBoxes && !isBeyondAnEdge(a.corners, b.corners) && !isBeyondAnEdge(b.corners, a.corners)) gap_m = 0;
  for (const [points, edges] of [[a.corners, b.corners], [b.corners, a.corners]]) {
    for (const point of points) {
      edges.forEach((from, i) => { gap_m = Math.min(gap_m, toEdge(point, from, edges[(i + 1) % edges.length])); });
    }
  }
  return gap_m - a.radius - b.radius;
}

let colours = {};
function readColours() {
  const style = getComputedStyle(document.documentElement);
  for (const name of ["ground", "panel", "ink", "soft", "line", "grid", "wall", "obstacle", "accent",
    "cooperative", "sensor_only", "halt", "leaving", "silent", "ok", "warn", "bad", "cone", "echo",
    "ellipse", "giveway", "one_lane"]) {
    colours[name] = style.getPropertyValue("--" + name).trim();
  }
}
function colourOf(vehicle) {
  return vehicle.hearing === "heard" ? colours[vehicle.mode] ?? colours.ink : colours.silent;
}

// The reason as a mark on the body.
const WAITS = new Set(["give_way", "not_granted", "peer_lost", "deaf", "keep_clear", "signal"]);
function markOf(vehicle) {
  if (vehicle.arrived || vehicle.rule === "arrived") return "square";
  if (WAITS.has(vehicle.rule)) return "pause";
  if (vehicle.rule === "ranges_stale" || vehicle.rule === "lost") return "cross";
  if (vehicle.rule === "unsure") return "ring";
  if (["obstacle", "object"].includes(vehicle.rule)) return "triangle";
  if (["steer_round", "avoid", "make_room"].includes(vehicle.rule)) return "chevron";
  if (vehicle.rule === "not_running" || vehicle.rule === "leaving") return "dot";
  return "arrow";
}

function fitCanvas(canvas, of_width = canvas.clientWidth, of_height = canvas.clientHeight) {
  const ratio = window.devicePixelRatio || 1;
  const width = Math.round(of_width * ratio), height = Math.round(of_height * ratio);
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  const g = canvas.getContext("2d");
  g.setTransform(ratio, 0, 0, ratio, 0, 0);
  return g;
}
