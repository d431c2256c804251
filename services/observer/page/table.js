// The same as the map, as a table; and the list of events.
const COLUMNS = [
  { name: "id", title: "vehicle", of: (v) => v.id },
  { name: "mode", title: "mode", text: true, of: (v) => v.mode },
  { name: "rule", title: "reason", text: true, of: (v) => v.rule + (v.peer ? " " + v.peer : "") },
  { name: "gives_way_to", title: "gives way to", of: (v) => v.gives_way_to || "" },
  { name: "hearing", title: "heard", text: true, of: (v) => v.hearing },
  { name: "speed", title: "m/s", of: (v) => v.speed.toFixed(2) },
  { name: "nearest", title: "echo, m", of: (v) => (v.nearest === null ? "" : v.nearest.toFixed(2)) },
  { name: "beacon_age", title: "beacon, ms", of: (v) => (v.beacon_age < 0 ? "" : v.beacon_age) },
  { name: "reaction", title: "reaction, ms", wide: true, of: (v) => (v.reaction < 0 ? "" : v.reaction) },
  { name: "peers_heard", title: "peers", wide: true, of: (v) => (v.peers_heard < 0 ? "" : v.peers_heard) },
  { name: "x", title: "x, m", wide: true, of: (v) => (v.has_body ? v.x.toFixed(2) : "") },
  { name: "y", title: "y, m", wide: true, of: (v) => (v.has_body ? v.y.toFixed(2) : "") },
];
const sorting = { name: "id", down: false };
const tableRows = new Map();

function buildHead() {
  const row = document.createElement("tr");
  for (const column of COLUMNS) {
    const cell = document.createElement("th"), button = document.createElement("button");
    cell.className = (column.text ? "text " : "") + (column.wide ? "wide" : "");
    button.textContent = column.title;
    button.addEventListener("click", () => {
      sorting.down = sorting.name === column.name && !sorting.down;
      sorting.name = column.name;
    });
    cell.append(button);
    row.append(cell);
  }
  document.querySelector("#table thead").append(row);
}
buildHead();

function compared(a, b) {
  const x = a[sorting.name], y = b[sorting.name];
  const order = x === y ? a.id - b.id : (x ?? -1) < (y ?? -1) ? -1 : 1;
  return sorting.down ? -order : order;
}

function rowOf(id) {
  let row = tableRows.get(id);
  if (row) return row;
  row = document.createElement("tr");
  row.dataset.vehicle = id;
  for (const column of COLUMNS) {
    const cell = document.createElement("td");
    cell.className = (column.text ? "text " : "") + (column.wide ? "wide" : "");
    if (column.name === "mode") {
      const dot = document.createElement("span");
      dot.className = "mode";
      cell.append(dot, document.createElement("span"));
    }
    row.append(cell);
  }
  row.addEventListener("click", () => pick(id));
  tableRows.set(id, row);
  return row;
}

function showTable(frame) {
  const body = document.querySelector("#table tbody");
  const vehicles = frame ? [...frame.vehicles.values()].filter(matches).sort(compared) : [];
  vehicles.forEach((vehicle, place) => {
    const row = rowOf(vehicle.id);
    COLUMNS.forEach((column, i) => {
      const cell = row.children[i];
      setText(column.name === "mode" ? cell.lastChild : cell, String(column.of(vehicle)));
      if (column.name === "mode") cell.firstChild.style.background = colourOf(vehicle);
    });
    row.className = vehicle.id === state.picked ? "picked" : "";
    if (body.children[place] !== row) body.insertBefore(row, body.children[place] ?? null);
  });
  while (body.children.length > vehicles.length) body.lastChild.remove();
}

function eventText(event) {
  const both = event.other && event.kind !== "halted" ? ` and ${event.other}` : "";
  const who = event.vehicle ? event.vehicle + both : "";
  const forWhom = event.other && event.kind === "halted" ? ` for ${event.other}` : "";
  const what = { closest: "closest to each other", contact: "in contact" }[event.kind] ??
    event.kind.replaceAll("_", " ");
  return `${who} ${what}${forWhom}${event.text ? ": " + event.text : ""}`.trim();
}

let eventsShown = "";
function showEvents(frame) {
  const list = document.getElementById("events");
  const at = frame && state.view !== "report" ? frame.at : Infinity;  // a report is of the whole run
  const events = [...state.events.values()].filter((event) => event.at <= at + 200).slice(-80).reverse();
  const key = events.map((event) => event.world_epoch + "." + event.seq).join();
  if (key === eventsShown) return;
  eventsShown = key;
  list.replaceChildren(...events.map((event) => {
    const item = document.createElement("li"), time = document.createElement("time");
    time.textContent = event.time_s.toFixed(2) + " s";
    item.className = event.kind;
    item.append(time, eventText(event));
    if (event.vehicle) item.addEventListener("click", () => pick(event.vehicle));
    return item;
  }));
}
