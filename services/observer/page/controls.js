// Mouse, touch, keys and buttons; and the turn that shows the moment.
const byId = (id) => document.getElementById(id);

function pick(id) {
  state.picked = id;
  if (id === null) setFollow(false);
}
function setFollow(on) {
  state.follow = on && state.picked !== null;
  byId("follow").setAttribute("aria-pressed", state.follow);
}
function setView(name) {
  state.view = name;
  for (const view of ["map", "table", "report"]) byId(view + "-view").hidden = view !== name;
  for (const view of ["table", "report"]) byId("show-" + view).setAttribute("aria-pressed", view === name);
}
function toggleView(name) {
  if (name === "report" && !state.isReplay) return;
  setView(state.view === name ? "map" : name);
}
function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  readColours();
}
function toggleTheme() {
  setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark");
}
setTheme(matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");

function pickAt(px, py) {
  const frame = shownFrame();
  let best = null, near = 18;
  for (const vehicle of frame ? frame.vehicles.values() : []) {
    if (!vehicle.has_body) continue;
    const [x, y] = toScreen(vehicle.x, vehicle.y);
    const away = Math.hypot(x - px, y - py) - vehicle.radius * view.scale;
    if (away < near) { near = away; best = vehicle.id; }
  }
  pick(best);
}
function pickNext(step) {
  const frame = shownFrame();
  if (!frame) return;
  const ids = [...frame.vehicles.values()].filter(matches).map((v) => v.id);
  if (!ids.length) return;
  const place = ids.indexOf(state.picked);
  pick(ids[(place < 0 ? (step > 0 ? 0 : ids.length - 1) : place + step + ids.length) % ids.length]);
}

// Time.
function setLive() {
  if (state.isReplay) { seek(state.frames[0]?.at ?? 0); state.playing = true; return; }
  state.cursor = null;
  state.playing = true;
}
function seek(at) {
  const first = state.frames[0], last = state.frames.at(-1);
  if (!first) return;
  state.cursor = Math.min(last.at, Math.max(first.at, at));
}
// At the end of a run it plays it again.
function togglePlay() {
  if (state.isReplay && !state.playing && state.cursor >= state.frames.at(-1)?.at) return setLive();
  if (state.cursor === null) { seek(shownAt()); state.playing = false; return; }
  state.playing = !state.playing;
}
function advance(elapsed_ms) {
  if (state.cursor === null || !state.playing) return;
  const last = state.frames.at(-1);
  if (!last) return;
  seek(state.cursor + elapsed_ms * state.speed);
  if (state.cursor >= last.at) {
    if (state.isReplay) state.playing = false; else setLive();
  }
}

// Pointers: one pans, two zoom, a short one picks.
const pointers = new Map();
let moved = 0;
mapCanvas.addEventListener("pointerdown", (event) => {
  mapCanvas.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
  if (pointers.size === 1) moved = 0;
});
mapCanvas.addEventListener("pointermove", (event) => {
  const before = pointers.get(event.pointerId);
  if (!before) return;
  const dx = event.offsetX - before[0], dy = event.offsetY - before[1];
  moved += Math.hypot(dx, dy);
  if (pointers.size === 1) {
    if (moved > 4) {
      view.x -= dx / view.scale;
      view.y += dy / view.scale;
      setFollow(false);
    }
  } else {
    const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
    const was = Math.hypot(before[0] - other[0], before[1] - other[1]);
    const is = Math.hypot(event.offsetX - other[0], event.offsetY - other[1]);
    if (was > 10) zoomAt((event.offsetX + other[0]) / 2, (event.offsetY + other[1]) / 2, is / was);
  }
  pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
});
mapCanvas.addEventListener("pointerup", (event) => {
  if (pointers.size === 1 && moved <= 4) pickAt(event.offsetX, event.offsetY);
  pointers.delete(event.pointerId);
});
mapCanvas.addEventListener("pointercancel", (event) => pointers.delete(event.pointerId));
mapCanvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  zoomAt(event.offsetX, event.offsetY, Math.exp(-event.deltaY * 0.0015));
}, { passive: false });

addEventListener("resize", () => { if (!state.follow) view.isSet = false; });

byId("show-table").addEventListener("click", () => toggleView("table"));
byId("show-report").addEventListener("click", () => toggleView("report"));
byId("fit").addEventListener("click", () => { setFollow(false); view.isSet = false; });
byId("follow").addEventListener("click", () => setFollow(!state.follow));
byId("theme").addEventListener("click", toggleTheme);
byId("unpick").addEventListener("click", () => pick(null));
byId("filter").addEventListener("input", (event) => { state.filter = event.target.value; });
byId("play").addEventListener("click", togglePlay);
byId("live").addEventListener("click", setLive);
byId("speed").addEventListener("change", (event) => { state.speed = Number(event.target.value); });
byId("scrub").addEventListener("input", (event) => {
  const first = state.frames[0], last = state.frames.at(-1);
  if (!first) return;
  seek(first.at + (last.at - first.at) * event.target.value / 1000);
  state.playing = false;
});
byId("help-open").addEventListener("click", () => byId("help").showModal());
byId("help-close").addEventListener("click", () => byId("help").close());

const KEYS = {
  ArrowLeft: () => { view.x -= 80 / view.scale; setFollow(false); },
  ArrowRight: () => { view.x += 80 / view.scale; setFollow(false); },
  ArrowUp: () => { view.y += 80 / view.scale; setFollow(false); },
  ArrowDown: () => { view.y -= 80 / view.scale; setFollow(false); },
  "+": () => zoomAt(view.width / 2, view.height / 2, 1.25),
  "=": () => KEYS["+"](),
  "-": () => zoomAt(view.width / 2, view.height / 2, 0.8),
  "0": () => { setFollow(false); view.isSet = false; },
  n: () => pickNext(1), p: () => pickNext(-1), f: () => setFollow(!state.follow),
  t: () => toggleView("table"), r: () => toggleView("report"), d: toggleTheme, l: setLive, " ": togglePlay,
  "[": () => { seek(shownAt() - 1000); state.playing = false; },
  "]": () => { seek(shownAt() + 1000); state.playing = false; },
  "/": () => byId("filter").focus(), Escape: () => pick(null), "?": () => byId("help").showModal(),
};
document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || byId("help").open) return;
  if (event.target.matches("input, select") && event.key !== "Escape") return;
  if (event.target.matches("button") && [" ", "Enter"].includes(event.key)) return;
  const action = KEYS[event.key] ?? KEYS[event.key.toLowerCase()];
  if (!action) return;
  event.preventDefault();
  if (event.target.matches("input")) event.target.blur();
  action();
});

const LEGEND = [
  ["cooperative", "cooperative: beacons and ranges are fresh"],
  ["sensor_only", "sensor only: a peer that matters is not heard or not believed"],
  ["halt", "halt: ranges are stale"], ["silent", "grey, dashed: silent, left, or never heard"],
  ["ink", "marks: arrow drives, bars wait, triangle obstacle, chevron steers round, square arrived"],
  ["ink", "cross: lacks ranges, or does not know its place; ring: soon will not know it"],
  ["giveway", "arrow: gives way to"], ["ok", "lines: within beacon range; amber and red: beacons late"],
  ["echo", "arcs: ultrasonic echoes; cones: clear"], ["ellipse", "ellipse: believed position, 2 sigma"],
  ["bad", "ring: contact"],
];
for (const [name, text] of LEGEND) {
  const item = document.createElement("li"), dot = document.createElement("span");
  dot.className = "mode";
  dot.style.background = `var(--${name})`;
  item.append(dot, text);
  byId("legend").append(item);
}
