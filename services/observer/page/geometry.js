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
  if (vehicle.rule === "ranges_stale") return "cross";
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
