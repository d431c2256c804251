// Facts and plots of the picked vehicle, the minute before the time shown.
const PLOTS = [
  { name: "speed", title: "speed, m/s", least: 0.5 },
  { name: "nearest", title: "nearest echo, m", least: 1 },
  { name: "beacon_age", title: "beacon age, ms", least: 100, limit: 200 },
  { name: "reaction", title: "last reaction, ms", least: 100 },
];
const PLOT_MS = 60000;
const plotCanvases = new Map();

for (const plot of PLOTS) {
  const canvas = document.createElement("canvas");
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", plot.title);
  document.getElementById("plots").append(canvas);
  plotCanvases.set(plot.name, canvas);
}

function drawPlot(plot, series, at) {
  const canvas = plotCanvases.get(plot.name);
  const g = fitCanvas(canvas);
  const width = canvas.clientWidth, height = canvas.clientHeight;
  g.clearRect(0, 0, width, height);
  const from = Math.max(0, lastBefore(series.at, at - PLOT_MS, (t) => t));
  const to = lastBefore(series.at, at, (t) => t);
  const values = series[plot.name];
  let top = plot.least, bottom = 0;
  for (let i = from; i <= to; ++i) {
    if (values[i] > top) top = values[i];
    if (values[i] < bottom) bottom = values[i];
  }
  const px = (t) => width - (at - t) / PLOT_MS * width;
  const py = (v) => height - 4 - (v - bottom) / (top - bottom) * (height - 20);
  g.strokeStyle = colours.grid;
  g.lineWidth = 1;
  line(g, [[0, py(0)], [width, py(0)]]);
  if (plot.limit && plot.limit < top) {
    g.strokeStyle = colours.bad;
    line(g, [[0, py(plot.limit)], [width, py(plot.limit)]]);
  }
  g.strokeStyle = colours.accent;
  g.lineWidth = 1.5;
  g.beginPath();
  let pen = false;
  for (let i = from; i <= to; ++i) {
    if (isNaN(values[i])) { pen = false; continue; }
    if (pen) g.lineTo(px(series.at[i]), py(values[i])); else g.moveTo(px(series.at[i]), py(values[i]));
    pen = true;
  }
  g.stroke();
  g.fillStyle = colours.soft;
  g.font = "11px system-ui, sans-serif";
  g.textBaseline = "top";
  g.textAlign = "left";
  g.fillText(plot.title, 2, 1);
  g.textAlign = "right";
  const last = to >= 0 ? values[to] : NaN;
  g.fillStyle = colours.ink;
  g.fillText(isNaN(last) ? "-" : last.toFixed(plot.least >= 100 ? 0 : 2), width - 2, 1);
}

function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

function factsOf(vehicle) {
  const facts = {
    "mode": vehicle.mode, "reason": vehicle.rule + (vehicle.peer ? " " + vehicle.peer : ""),
    "heard": vehicle.hearing,
    "gives way to": vehicle.gives_way_to || "-", "blocked by": vehicle.blocked_by || "-",
    "position": vehicle.has_body ? `${vehicle.x.toFixed(2)}, ${vehicle.y.toFixed(2)} m` : "-",
    "heading": vehicle.has_body ? `${(vehicle.heading * 180 / Math.PI).toFixed(0)} deg` : "-",
    "speed": `${vehicle.speed.toFixed(2)} m/s`,
    "nearest echo": vehicle.nearest === null ? "-" : `${vehicle.nearest.toFixed(2)} m`,
    "peers heard": vehicle.peers_heard < 0 ? "-" : vehicle.peers_heard,
  };
  return facts;
}

const factCells = new Map();
function showPicked(frame) {
  const section = document.getElementById("picked");
  const vehicle = frame && state.picked !== null ? frame.vehicles.get(state.picked) : null;
  section.hidden = !vehicle;
  if (!vehicle) return;
  setText(document.getElementById("picked-title"), "Vehicle " + vehicle.id);
  const list = document.getElementById("picked-facts");
  for (const [name, value] of Object.entries(factsOf(vehicle))) {
    if (!factCells.has(name)) {
      const term = document.createElement("dt"), cell = document.createElement("dd");
      term.textContent = name;
      list.append(term, cell);
      factCells.set(name, cell);
    }
    setText(factCells.get(name), String(value));
  }
  const series = state.series.get(vehicle.id);
  if (series) for (const plot of PLOTS) drawPlot(plot, series, frame.at);
}
