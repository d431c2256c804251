// The whole of a run that is over: figures a vehicle, all paths on one map, who did what when, and plots
// of the fleet. Nothing in it moves; a click on the timeline leads to that moment on the map.
const PLOT_POINTS = 400;
const TABLE_ROWS = 400;
const MOST_PAIRS = 1e8;

// What a vehicle does, as a colour of the theme.
function doingOf(vehicle) {
  if (vehicle.hearing === "left") return "left";
  if (vehicle.hearing !== "heard") return "silent";
  if (vehicle.mode !== "cooperative") return vehicle.mode;
  if (vehicle.arrived || vehicle.rule === "arrived" || vehicle.rule === "not_running") return "line";
  return WAITS.has(vehicle.rule) || vehicle.rule === "lost" ? "giveway" : "cooperative";
}

function noteSpans(frame, spans) {
  for (const vehicle of frame.vehicles.values()) {
    let list = spans.get(vehicle.id);
    if (!list) spans.set(vehicle.id, (list = []));
    const last = list.at(-1), doing = doingOf(vehicle);
    if (last) last.to = frame.at;
    if (!last || last.doing !== doing) list.push({ doing, from: frame.at, to: frame.at });
  }
}

// The nearest two bodies of a frame, if they are nearer than `least`, else that; null where there are not two.
function nearerOf(frame, least, ids) {
  const bodies = [...frame.vehicles.values()].filter((v) => v.has_body && (!ids || ids.includes(v.id)));
  const reach = bodies.map(reachOf);
  for (let i = 0; i < bodies.length; ++i) {
    for (let j = i + 1; j < bodies.length; ++j) {
      const a = bodies[i], b = bodies[j];
      if (least && Math.hypot(a.x - b.x, a.y - b.y) - reach[i] - reach[j] >= least.gap_m) continue;
      const gap_m = gapBetween(a, b);
      if (!least || gap_m < least.gap_m) least = { gap_m, a: a.id, b: b.id, at: frame.at };
    }
  }
  return least;
}

// What the world measured at every tick, not only at those of the frames. It says so at the end of a run.
function closestOfWorld() {
  let closest = null;
  for (const event of state.events.values()) {
    if (event.kind !== "closest" || event.other === undefined || typeof event.value !== "number") continue;
    if (!closest || event.value < closest.value) closest = event;
  }
  return closest;
}

function most(values) {
  let top = NaN;
  for (const value of values) if (!(value <= top) && !isNaN(value)) top = value;
  return top;
}

// Further than a vehicle drives between two frames, which are seconds apart in a long run, is another start.
const FASTEST_M_S = 2, JUMP_M = 2;
function pathOf({ at, x, y }) {
  let path_m = 0;
  for (let i = 1; i < x.length; ++i) {
    const step_m = Math.hypot(x[i] - x[i - 1], y[i] - y[i - 1]);
    if (step_m < JUMP_M + FASTEST_M_S * (at[i] - at[i - 1]) / 1000) path_m += step_m;
  }
  return path_m;
}

function figuresOf(id, series, spans) {
  const spent_s = (doing) => (spans ?? []).filter((span) => span.doing === doing)
    .reduce((sum, span) => sum + span.to - span.from, 0) / 1000;
  return {
    id, path_m: pathOf(series), waits_s: spent_s("giveway"),
    apart_s: spent_s("sensor_only") + spent_s("halt") + spent_s("silent"),
    speed: most(series.speed), nearest: -most(series.nearest.map((m) => -m)),
    beacon_age: most(series.beacon_age), reaction: most(series.reaction),
    contacts: state.contacts.filter((event) => event.vehicle === id || event.other === id).length,
  };
}

let runFigures = null;  // made when the report is first looked at
function figuresOfRun() {
  if (runFigures) return runFigures;
  const ids = [...state.series.keys()].sort((a, b) => a - b);
  // Of a long run of many the gaps of some frames: more than these pairs take seconds.
  const every = Math.ceil(state.frames.length * ids.length * ids.length / MOST_PAIRS);
  const spans = new Map(), closest = closestOfWorld();
  const pair = closest && [closest.vehicle, closest.other];
  let least = null;
  state.frames.forEach((entry, place) => {
    const frame = decode(entry);
    noteSpans(frame, spans);
    if (pair || place % every === 0) least = nearerOf(frame, least, pair);
  });
  if (closest && least) least.gap_m = closest.value;  // when it was, the frames say
  runFigures = { spans, least, ids, from: state.frames[0].at, to: state.frames.at(-1).at,
    vehicles: ids.map((id) => figuresOf(id, state.series.get(id), spans.get(id))) };
  return runFigures;
}

function secondsOf(at) { return (at - state.frames[0].at) / 1000; }

function showFacts(run) {
  const kinds = new Map();
  for (const event of state.events.values()) kinds.set(event.kind, (kinds.get(event.kind) ?? 0) + 1);
  const facts = {
    "length": `${secondsOf(run.to).toFixed(1)} s`, "vehicles": run.ids.length,
    "distance of all": `${run.vehicles.reduce((sum, v) => sum + v.path_m, 0).toFixed(1)} m`,
    "waits of all": `${run.vehicles.reduce((sum, v) => sum + v.waits_s, 0).toFixed(1)} s`,
    "nearest two": run.least ? `${run.least.gap_m.toFixed(2)} m between ${run.least.a} and ${run.least.b}, at ` +
      `${secondsOf(run.least.at).toFixed(1)} s` : "-",
    "events": [...kinds].map(([kind, count]) => `${count} ${kind.replaceAll("_", " ")}`).join(", ") || "none",
  };
  byId("report-facts").replaceChildren(...Object.entries(facts).flatMap(([name, value]) => {
    const term = document.createElement("dt"), cell = document.createElement("dd");
    term.textContent = name;
    cell.textContent = value;
    return [term, cell];
  }));
}

const REPORT_COLUMNS = [
  ["vehicle", (v) => v.id], ["distance, m", (v) => v.path_m.toFixed(1)], ["waits, s", (v) => v.waits_s.toFixed(1)],
  ["not cooperative, s", (v) => v.apart_s.toFixed(1)], ["fastest, m/s", (v) => shown(v.speed, 2)],
  ["nearest echo, m", (v) => shown(v.nearest, 2)], ["oldest beacon, ms", (v) => shown(v.beacon_age, 0)],
  ["slowest reaction, ms", (v) => shown(v.reaction, 0)], ["contacts", (v) => v.contacts],
];
function shown(value, digits) { return isNaN(value) ? "-" : value.toFixed(digits); }

function showFigures(run) {
  const row = (texts, kind) => {
    const line = document.createElement("tr");
    line.append(...texts.map((text) => {
      const cell = document.createElement(kind);
      cell.textContent = text;
      return cell;
    }));
    return line;
  };
  const rows = run.vehicles.slice(0, TABLE_ROWS).map((v) => row(REPORT_COLUMNS.map(([, of]) => String(of(v))), "td"));
  byId("report-table").replaceChildren(row(REPORT_COLUMNS.map(([title]) => title), "th"), ...rows);
}

function pathColour(place, count) { return `hsl(${Math.round(place / Math.max(1, count) * 330)} 65% 50%)`; }

function drawPaths(run) {
  const canvas = byId("report-map"), g = fitCanvas(canvas);
  const width = canvas.clientWidth, height = canvas.clientHeight;
  const box = extent({ vehicles: new Map() });
  const add = (x, y) => {
    if (isNaN(x)) return;
    box.left = Math.min(box.left, x); box.right = Math.max(box.right, x);
    box.low = Math.min(box.low, y); box.high = Math.max(box.high, y);
  };
  for (const id of run.ids) state.series.get(id).x.forEach((x, i) => add(x, state.series.get(id).y[i]));
  const scale = Math.min((width - 40) / Math.max(1, box.right - box.left), (height - 40) / Math.max(1, box.high - box.low));
  const at = (x, y) => [width / 2 + (x - (box.left + box.right) / 2) * scale,
    height / 2 - (y - (box.low + box.high) / 2) * scale];
  g.clearRect(0, 0, width, height);
  g.strokeStyle = colours.wall;
  g.lineWidth = 2;
  for (const wall of state.scene.walls ?? []) line(g, [at(wall[0], wall[1]), at(wall[2], wall[3])]);
  g.lineWidth = 1.5;
  g.font = "12px system-ui, sans-serif";
  run.ids.forEach((id, place) => {
    const series = state.series.get(id);
    g.strokeStyle = g.fillStyle = pathColour(place, run.ids.length);
    line(g, series.x.map((x, i) => at(x, series.y[i])));
    const [x, y] = at(series.x.at(-1), series.y.at(-1));
    g.beginPath();
    g.arc(x, y, 4, 0, 7);
    g.fill();
    if (run.ids.length <= 60) g.fillText(id, x + 6, y - 4);
  });
  g.strokeStyle = colours.bad;
  g.lineWidth = 3;
  for (const event of state.contacts) {
    const [x, y] = at(...contactPlace(event));
    g.beginPath();
    g.arc(x, y, 10, 0, 7);
    g.stroke();
  }
}

const LABEL_PX = 44;
function drawTimeline(run) {
  const canvas = byId("report-timeline");
  const lane = run.ids.length > 60 ? 6 : 16;
  canvas.style.height = `${run.ids.length * lane + 20}px`;
  const g = fitCanvas(canvas), width = canvas.clientWidth, height = canvas.clientHeight;
  const px = (at) => LABEL_PX + (at - run.from) / Math.max(1, run.to - run.from) * (width - LABEL_PX - 4);
  g.clearRect(0, 0, width, height);
  g.font = "11px system-ui, sans-serif";
  g.textBaseline = "middle";
  run.ids.forEach((id, place) => {
    for (const span of run.spans.get(id) ?? []) {
      g.fillStyle = colours[span.doing] ?? colours.soft;
      g.fillRect(px(span.from), place * lane + 1, Math.max(1, px(span.to) - px(span.from)), lane - 2);
    }
    g.fillStyle = colours.soft;
    g.textAlign = "right";
    if (lane > 10 || place % 5 === 0) g.fillText(id, LABEL_PX - 6, place * lane + lane / 2);
  });
  g.fillStyle = colours.ink;
  for (const event of state.events.values()) {
    const place = run.ids.indexOf(event.vehicle);
    if (place >= 0) g.fillRect(px(event.at) - 1, place * lane, event.kind === "contact" ? 4 : 2, lane);
  }
  g.textAlign = "center";
  for (let part = 0; part <= 4; ++part) {
    const at = run.from + (run.to - run.from) * part / 4;
    g.fillText(`${secondsOf(at).toFixed(0)} s`, Math.min(width - 16, px(at)), height - 8);
  }
}

// Of every moment the median and the largest of all vehicles.
function drawFleetPlot(canvas, plot, run) {
  const g = fitCanvas(canvas), width = canvas.clientWidth, height = canvas.clientHeight;
  const slots = Array.from({ length: PLOT_POINTS }, () => []);
  for (const id of run.ids) {
    const series = state.series.get(id);
    series[plot.name].forEach((value, i) => {
      if (isNaN(value)) return;
      const share = (series.at[i] - run.from) / Math.max(1, run.to - run.from);
      slots[Math.min(PLOT_POINTS - 1, Math.floor(share * PLOT_POINTS))].push(value);
    });
  }
  for (const slot of slots) slot.sort((a, b) => a - b);
  const least = plot.name === "nearest";  // there the smallest is what matters
  const top = Math.max(plot.least, ...slots.map((slot) => slot.at(-1) ?? 0));
  const draw = (colour, of) => {
    g.strokeStyle = colour;
    const points = slots.flatMap((slot, i) => (slot.length ? [[i / PLOT_POINTS * width,
      height - 4 - of(slot) / top * (height - 24)]] : []));
    line(g, points);
  };
  g.clearRect(0, 0, width, height);
  g.lineWidth = 1;
  if (plot.limit && plot.limit < top) {
    g.strokeStyle = colours.bad;
    line(g, [[0, height - 4 - plot.limit / top * (height - 24)], [width, height - 4 - plot.limit / top * (height - 24)]]);
  }
  draw(colours.soft, (slot) => (least ? slot[0] : slot.at(-1)));
  g.lineWidth = 1.5;
  draw(colours.accent, (slot) => slot[slot.length >> 1]);
  g.fillStyle = colours.ink;
  g.font = "12px system-ui, sans-serif";
  g.textBaseline = "top";
  g.textAlign = "left";
  g.fillText(`${plot.title}: median, and ${least ? "least" : "most"} of all; up to ${top.toFixed(top < 10 ? 2 : 0)}`, 2, 2);
}

for (const plot of PLOTS) {
  const canvas = document.createElement("canvas");
  canvas.dataset.plot = plot.name;
  document.getElementById("report-plots").append(canvas);
}

let reportDrawn = "";  // for which width and colours
function showReport() {
  const view = document.getElementById("report-view");
  const key = `${view.clientWidth} ${document.documentElement.dataset.theme}`;
  if (key === reportDrawn || !state.isReplay || !state.frames.length) return;
  reportDrawn = key;
  const run = figuresOfRun();
  setText(document.getElementById("report-title"), `Report: ${state.scene.title}`);
  showFacts(run);
  showFigures(run);
  drawPaths(run);
  drawTimeline(run);
  for (const canvas of document.querySelectorAll("#report-plots canvas")) {
    drawFleetPlot(canvas, PLOTS.find((plot) => plot.name === canvas.dataset.plot), run);
  }
}

document.getElementById("report-timeline").addEventListener("click", (event) => {
  const run = figuresOfRun(), width = event.target.clientWidth;
  seek(run.from + (event.offsetX - LABEL_PX) / (width - LABEL_PX - 4) * (run.to - run.from));
  state.playing = false;
  setView("map");
});
