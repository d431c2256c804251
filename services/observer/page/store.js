// What came, and which moment of it is shown. Frames are kept as text for five minutes, decoded again
// when they are looked at; what trails and plots need is kept as numbers.
const KEEP_MS = 300000;
const MOST_BYTES = 96 * 1024 * 1024;
const MOST_EVENTS = 600;  // of a live fleet; of a run its file limits them

const state = {
  scene: null, frames: [], bytes: 0, series: new Map(), events: new Map(),
  contacts: [],       // those of the events
  boxes: new Map(),   // half lengths of the scenario's boxes by id
  cursor: null,       // ms of the observer's clock; null: the newest
  playing: true, speed: 1, isReplay: false,
  arrivedAt: 0,       // performance.now() of the newest frame
  connected: false, refusal: "",  // the observer's words where it takes no further viewer
  picked: null, follow: false, filter: "", view: "map",
};

const decoded = new Map();  // of the last few frames that were looked at

function column(name) { return state.scene.columns.indexOf(name); }

function asVehicle(row) {
  const vehicle = {};
  state.scene.columns.forEach((name, i) => { vehicle[name] = row[i]; });
  for (const name of ["x", "y", "speed", "estimate_x", "estimate_y", "radius", "toward_x", "toward_y"]) {
    vehicle[name] /= 1000;
  }
  vehicle.heading /= 1000;
  vehicle.hearing = state.scene.hearings[vehicle.hearing];
  vehicle.mode = state.scene.modes[vehicle.mode];
  vehicle.rule = state.scene.rules[vehicle.rule];
  vehicle.nearest = vehicle.nearest < 0 ? null : vehicle.nearest / 1000;
  return vehicle;
}

function setScene(scene) {
  state.scene = scene;
  state.boxes = new Map((scene.fleet ?? []).filter((one) => one.box_half_m).map((one) => [one.id, one.box_half_m]));
}

// `raw` is what the entry's data say, where that is known.
function decode(entry, raw) {
  let frame = decoded.get(entry);
  if (frame) return frame;
  raw ??= typeof entry.data === "string" ? JSON.parse(entry.data) : entry.data;
  frame = { at: raw.at_ms, world: raw.world, ranges: raw.ranges, signals: raw.signals, vehicles: new Map() };
  for (const row of raw.vehicles) {
    const vehicle = asVehicle(row);
    frame.vehicles.set(vehicle.id, vehicle);
  }
  if (decoded.size > 8) decoded.delete(decoded.keys().next().value);
  decoded.set(entry, frame);
  return frame;
}

function noteSeries(raw) {
  const at = raw.at_ms;
  const of = ["id", "x", "y", "speed", "nearest", "beacon_age", "reaction"].map(column);
  const body = column("has_body"), hearing = column("hearing");
  for (const row of raw.vehicles) {
    let series = state.series.get(row[of[0]]);
    if (!series) {
      series = { at: [], x: [], y: [], speed: [], nearest: [], beacon_age: [], reaction: [] };
      state.series.set(row[of[0]], series);
    }
    series.at.push(at);
    // One without a body is nowhere: its path ends where it was last.
    series.x.push(row[body] ? row[of[1]] / 1000 : series.x.at(-1) ?? NaN);
    series.y.push(row[body] ? row[of[2]] / 1000 : series.y.at(-1) ?? NaN);
    series.speed.push(row[of[3]] / 1000);
    series.nearest.push(row[of[4]] < 0 ? NaN : row[of[4]] / 1000);
    // Of one that is not heard it only says for how long.
    const isHeard = state.scene.hearings[row[hearing]] === "heard";
    series.beacon_age.push(!isHeard || row[of[5]] < 0 ? NaN : row[of[5]]);
    series.reaction.push(row[of[6]] < 0 ? NaN : row[of[6]]);
    if (!state.isReplay && series.at.length > 3600) {
      for (const list of Object.values(series)) list.splice(0, 600);
    }
  }
}

function noteEvents(at_ms, events) {
  for (const event of events) {
    const key = event.world_epoch + "." + event.seq;
    if (state.events.has(key)) continue;
    const noted = { at: at_ms, ...event };
    state.events.set(key, noted);
    if (event.kind === "contact") state.contacts.push(noted);
  }
  if (state.isReplay) return;
  while (state.events.size > MOST_EVENTS) state.events.delete(state.events.keys().next().value);
  if (state.contacts.length > MOST_EVENTS) state.contacts.shift();
}

// Where two touched, x and y; with a wall, an obstacle or a door the other place is that point itself.
function contactPlace({ other, position_world: one, other_position_world: touched }) {
  if (other === undefined) return [touched.x_m, touched.y_m];
  return [(one.x_m + touched.x_m) / 2, (one.y_m + touched.y_m) / 2];
}

function clearStore() {
  state.frames = []; state.bytes = 0; state.series.clear(); state.events.clear(); decoded.clear();
  state.contacts = [];
  state.cursor = null;
  if (!state.isReplay) state.playing = true;  // the moment that it stood at is gone
}

function addFrame(data, raw) {
  const newest = state.frames.at(-1);
  if (newest && raw.at_ms < newest.at) clearStore();  // another machine's clock, or a new observer
  const size = typeof data === "string" ? data.length : 0;
  const entry = { at: raw.at_ms, data, size };
  state.frames.push(entry);
  state.bytes += size;
  noteSeries(raw);
  noteEvents(raw.at_ms, raw.events);
  if (state.isReplay) return;
  decode(entry, raw);  // it is looked at next
  let drop = 0;
  while (drop < state.frames.length - 2 &&
         (state.frames[drop].at < raw.at_ms - KEEP_MS || state.bytes > MOST_BYTES)) {
    state.bytes -= state.frames[drop++].size;
  }
  if (drop > 0) state.frames.splice(0, drop);
  for (const [id, series] of state.series) {
    if (series.at.at(-1) < raw.at_ms - KEEP_MS) state.series.delete(id);
  }
}

// The place of the last entry not after `at`; -1 if none is.
function lastBefore(list, at, of) {
  let low = 0, high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (of(list[middle]) <= at) low = middle + 1; else high = middle;
  }
  return low - 1;
}

// The time that is shown.
function shownAt() {
  const newest = state.frames.at(-1);
  if (!newest) return 0;
  if (state.cursor !== null) return state.cursor;
  // A little behind, so that there is a frame on either side to draw between.
  return Math.min(newest.at, newest.at + performance.now() - state.arrivedAt - 120);
}

function turned(from, to, share) {
  let angle = to - from;
  while (angle > Math.PI) angle -= 2 * Math.PI;
  while (angle < -Math.PI) angle += 2 * Math.PI;
  return from + angle * share;
}

// The vehicles of a frame that move on to a later one: made once, and moved at each turn.
let between = { frame: null, later: null, vehicles: new Map(), moving: [] };
function vehiclesBetween(frame, later) {
  if (between.frame === frame && between.later === later) return between;
  between = { frame, later, vehicles: new Map(), moving: [] };
  for (const [id, vehicle] of frame.vehicles) {
    const then = later.vehicles.get(id);
    const moves = then && vehicle.has_body && then.has_body && Math.hypot(then.x - vehicle.x, then.y - vehicle.y) <= 2;
    const shown = moves ? { ...vehicle } : vehicle;
    between.vehicles.set(id, shown);
    if (moves) between.moving.push([shown, vehicle, then]);
  }
  return between;
}

// What is drawn: the frame at the time shown, its vehicles moved on towards the next.
function shownFrame() {
  if (!state.scene || state.frames.length === 0) return null;
  const at = shownAt();
  const place = Math.max(0, lastBefore(state.frames, at, (entry) => entry.at));
  const frame = decode(state.frames[place]);
  const next = state.frames[place + 1];
  if (!next || next.at - frame.at > 1000 || at <= frame.at) return frame;
  const later = decode(next);
  const share = (at - frame.at) / (later.at - frame.at);
  const { vehicles, moving } = vehiclesBetween(frame, later);
  for (const [shown, vehicle, then] of moving) {
    shown.x = vehicle.x + (then.x - vehicle.x) * share;
    shown.y = vehicle.y + (then.y - vehicle.y) * share;
    shown.heading = turned(vehicle.heading, then.heading, share);
  }
  return { ...frame, at, vehicles };
}

function matches(vehicle) {
  const filter = state.filter.trim().toLowerCase();
  if (!filter) return true;
  return filter.split(/[\s,]+/).filter(Boolean).some((part) => String(vehicle.id) === part ||
    vehicle.mode === part || vehicle.hearing === part || (isNaN(part) && vehicle.rule.includes(part)));
}
