// Where frames come from, what is said about them, and the turn that draws.
const STALE_MS = 2000;

const STREAM = "api/v1/stream";

// An EventSource does not say why it was refused; asked once more, the observer does.
async function askWhyRefused() {
  const question = new AbortController();
  try {
    const answer = await fetch(STREAM, { signal: question.signal });
    state.refusal = answer.ok ? "" : (await answer.text()).trim();
  } catch {
    state.refusal = "";  // there is no observer
  }
  question.abort();
}

function follow() {
  const source = new EventSource(STREAM);
  let came = false;
  source.addEventListener("scene", (event) => {
    came = true;
    const scene = JSON.parse(event.data), before = state.scene?.observer;
    setScene(scene);
    if (before !== scene.observer) clearStore();  // else the connection alone was lost
    state.connected = true;
    state.refusal = "";
    document.title = "Giveway " + state.scene.title;
  });
  source.addEventListener("frame", (event) => {
    state.connected = true;
    const raw = JSON.parse(event.data);
    addFrame(event.data, raw);
    state.arrivedAt = performance.now();
  });
  source.addEventListener("error", async () => {
    state.connected = false;
    source.close();
    if (!came) await askWhyRefused();
    setTimeout(follow, 1000);
  });
}

function loadRun(text) {
  const run = JSON.parse(text);
  state.isReplay = true;
  setScene(run.scene);
  for (const [at_ms, event] of run.events ?? []) noteEvents(at_ms, [event]);
  for (const frame of run.frames) addFrame(frame, frame);
  state.connected = true;
  document.title = "Giveway " + state.scene.title;
  byId("live").textContent = "Restart";
  byId("live").title = "From the start (L)";
  byId("show-report").hidden = false;
  setLive();
  if (run.opens === "report") { setView("report"); state.playing = false; }
}

function setChip(id, text, kind) {
  const chip = byId(id);
  setText(chip, text);
  const name = "chip" + (kind ? " " + kind : "");
  if (chip.className !== name) chip.className = name;
}

function linkWords(silence_ms) {
  if (state.isReplay) return ["replay", "ok"];
  if (!state.frames.length && state.refusal) return [state.refusal, "bad"];
  if (!state.frames.length) return [state.connected ? "no frame yet" : "connecting", "warn"];
  if (!state.connected) return ["disconnected", "bad"];
  if (silence_ms > STALE_MS) return ["stale", "bad"];
  return state.cursor === null ? ["live", "ok"] : ["live, looking back", "warn"];
}

// A world without vehicles is there, and says nothing.
function worldWords(world) {
  if (world.age_ms < 0) return world.heard ? ["world without vehicles", ""] : ["no world heard", "warn"];
  const silent = !world.heard && world.state !== "ended";
  const words = `${world.state ?? "world"} ${(world.time_ms / 1000).toFixed(1)} s`;
  return silent ? [words + ", silent", "warn"] : [words, ""];
}

function showStatus(frame) {
  const silence_ms = state.frames.length ? performance.now() - state.arrivedAt : 0;
  setChip("link", ...linkWords(silence_ms));
  const stale = !state.isReplay && state.frames.length > 0 && (silence_ms > STALE_MS || !state.connected);
  const banner = byId("banner");
  banner.hidden = !stale;
  if (stale) {
    setText(banner, `The data is stale: nothing new for ${Math.round(silence_ms / 1000)} s` +
      (state.connected ? "." : "; connecting to the observer again."));
  }
  if (!frame) return;
  setText(byId("title"), state.scene.scenario ? `${state.scene.title}, ${state.scene.scenario}` : state.scene.title);
  setChip("world", ...worldWords(frame.world));
  const all = [...frame.vehicles.values()];
  const silentCount = all.filter((v) => v.hearing === "silent").length;
  const waiting = all.filter((v) => v.hearing === "heard" && v.gives_way_to).length;
  setChip("counts", `${all.length} vehicles, ${waiting} give way` + (silentCount ? `, ${silentCount} silent` : ""),
    silentCount ? "bad" : "");
}

function showTime() {
  const first = state.frames[0], last = state.frames.at(-1);
  setText(byId("play"), state.playing ? "Pause" : "Play");
  if (!first) return;
  const at = shownAt(), scrub = byId("scrub");
  const place = last.at > first.at ? Math.round((at - first.at) / (last.at - first.at) * 1000) : 1000;
  if (document.activeElement !== scrub || state.playing) scrub.value = place;
  setText(byId("when"), state.isReplay
    ? `${((at - first.at) / 1000).toFixed(1)} of ${((last.at - first.at) / 1000).toFixed(1)} s`
    : state.cursor === null ? "now" : `${((at - last.at) / 1000).toFixed(1)} s`);
}

let lastTurn = performance.now(), lastWords = 0;
const drawn = { frames: 0 };
function turn(now) {
  requestAnimationFrame(turn);  // first: what cannot be drawn must not end the turns
  advance(now - lastTurn);
  lastTurn = now;
  const frame = shownFrame();
  if (state.view === "map") drawMap(frame);
  if (now - lastWords > 150) {
    lastWords = now;
    if (state.view === "table") showTable(frame);
    if (state.view === "report") showReport();
    showPicked(frame);
    showEvents(frame);
    showStatus(frame);
    showTime();
  }
  ++drawn.frames;
}

// For tests and the curious.
window.giveway = {
  state, drawn,
  vehicles: () => [...(shownFrame()?.vehicles.values() ?? [])],
  screenOf: (id) => { const v = shownFrame().vehicles.get(id); return toScreen(v.x, v.y); },
  seek, pick,
};

const run = byId("run").textContent.trim();
if (run) loadRun(run); else follow();
requestAnimationFrame(turn);
