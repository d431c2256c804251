// The page with runs that are made up for it: states that a run of a minute seldom has.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { check, expect, finish, openBrowser, openPage, start, text, until, vehicles, work } from "./support.mjs";

const RUN = /(<script type="application\/json" id="run">)([^]*?)(<\/script>)/;
const recording = join(work, "virtual.mcap"), empty = join(work, "virtual.html");
let base = "", scene = null;  // a page with its run, and what its vehicles' columns are
await check("page: a run of virtual time is a page", async () => {
  await start("fleetctl", "virtual", "intersection_yield", "--seed", "1", "--mcap", recording).ended;
  const replay = start("fleetctl", "replay", recording, "--html", empty);
  expect(await replay.ended === 0, replay.stderr);
  base = readFileSync(empty, "utf8");
  scene = JSON.parse(RUN.exec(base)[2]).scene;
});

// By the wire's numbers, which the names in the scene stand for.
const HEARD = 1, SILENT = 2, LEFT = 3, UNSURE = 16, LOST = 17;
function row(vehicle) {
  const usual = { id: 1, hearing: HEARD, mode: 0, beacon_age: 40, nearest: -1, radius: 250, reaction: -1,
    peers_heard: 1, has_body: 1, ...vehicle };
  return scene.columns.map((name) => usual[name] ?? 0);
}
function frame(at_ms, vehicles, world = {}) {
  const usual = { epoch: 1, state: "running", time_ms: at_ms, fleet_size: 1, age_ms: 0, heard: true };
  return { at_ms, world: { ...usual, ...world },
    vehicles: vehicles.map(row), ranges: {}, signals: [], events: [] };
}
// Frames a tenth of a second apart, of what `at` says of each.
function framesOf(count, at) { return Array.from({ length: count }, (_, i) => frame(100 * i, at(i))); }

const browser = await openBrowser();
async function openRun(frames, opens = "map", events = [], more = {}) {
  const file = join(work, `made-${Math.random()}.html`);
  const run = JSON.stringify({ opens, scene: { ...scene, ...more }, events, frames });
  writeFileSync(file, base.replace(RUN, (_, before, __, after) => before + run + after));
  return openPage(browser, `file://${file}`);
}
const drawn = (page) => page.evaluate(() => window.giveway.drawn.frames);
async function goesOn(page) {
  const before = await drawn(page);
  await until("frames are drawn", async () => await drawn(page) > before + 3, 3000);
}

await check("page: a vehicle that is lost, and one that soon is, have a reason and a mark", async () => {
  const { page, complaints } = await openRun(
    framesOf(50, () => [{ id: 1, rule: LOST }, { id: 2, rule: UNSURE, x: 4000 }]));
  await page.fill("#filter", "lost");
  await goesOn(page);
  await page.evaluate(() => toggleView("table"));
  await until("one row", async () => (await page.locator("#table tbody tr").count()) === 1, 3000);
  expect((await text(page, "table")).includes("lost"), await text(page, "table"));
  const shown = await vehicles(page);
  const marks = await page.evaluate((all) => all.map(markOf), shown);
  expect(marks.join() === "cross,ring", `marks: ${marks}`);
  const doing = await page.evaluate((all) => all.map(doingOf), shown);
  expect(doing.join() === "giveway,cooperative", `they do: ${doing}`);
  expect(complaints.length === 0, complaints.join("; "));
  await page.close();
});
await check("page: what cannot be drawn does not end the turns", async () => {
  const { page } = await openRun(framesOf(50, () => [{ id: 1, rule: 99 }]));
  await page.fill("#filter", "give");
  await page.waitForTimeout(300);
  await page.fill("#filter", "");
  await goesOn(page);
  await page.close();
});
await check("page: a world without vehicles is there, and one that is silent is not", async () => {
  const words = async (world) => {
    const { page } = await openRun([frame(0, [], world), frame(100, [], world)]);
    const found = await until("words", async () => {
      const said = await text(page, "world");
      return said !== "no world" && said;
    }, 3000);
    await page.close();
    return found;
  };
  expect(await words({ age_ms: -1, time_ms: 0 }) === "world without vehicles", "one that never had any");
  expect(await words({ age_ms: 9000, time_ms: 5000 }) === "running 5.0 s", "one whose last has left");
  expect(await words({ age_ms: 9000, time_ms: 5000, heard: false }) === "running 5.0 s, silent", "a silent one");
  expect(await words({ age_ms: -1, time_ms: 0, heard: false }) === "no world heard", "none");
});
// What the report says of each vehicle; columns as REPORT_COLUMNS.
async function reportOf(frames, events, more) {
  const { page, complaints } = await openRun(frames, "report", events, more);
  await until("the report", async () => (await page.locator("#report-table tr").count()) > 1, 5000);
  const rows = await page.locator("#report-table tr").allInnerTexts();
  const facts = await text(page, "report-facts");
  const run = await page.evaluate(() => ({
    vehicles: figuresOfRun().vehicles, least: figuresOfRun().least,
    contacts: window.giveway.state.contacts.map(contactPlace), last_x: window.giveway.state.series.get(1)?.x.at(-1),
  }));
  await page.close();
  expect(complaints.length === 0, complaints.join("; "));
  return { rows, facts, ...run };
}
await check("report: the path of a body that was taken out ends where it was", async () => {
  const { vehicles: [one], last_x } = await reportOf(framesOf(100, (i) =>
    [i < 50 ? { id: 1, x: 1500 + 10 * i } : { id: 1, has_body: 0 }]));
  expect(Math.abs(one.path_m - 0.49) < 0.01 && last_x === 1.99, `${one.path_m} m, to ${last_x}`);
});
await check("report: a vehicle that leaves in good order is not silent, and its beacons are not old", async () => {
  const { vehicles: [one], rows } = await reportOf(framesOf(100, (i) =>
    [{ id: 1, ...(i < 50 ? {} : { hearing: LEFT, beacon_age: 100 * (i - 50) }) }]));
  expect(one.apart_s === 0 && one.beacon_age === 40, rows[1]);
});
await check("report: a vehicle that falls silent is counted as such", async () => {
  const { vehicles: [one], rows } = await reportOf(framesOf(100, (i) =>
    [{ id: 1, ...(i < 50 ? {} : { hearing: SILENT, beacon_age: 1000 + 100 * (i - 50) }) }]));
  expect(Math.abs(one.apart_s - 4.9) < 0.11 && one.beacon_age === 40, rows[1]);
});
await check("report: the distance of a long run, whose frames are seconds apart, is all of it", async () => {
  const drive = (i) => [{ id: 1, x: 4000 * i }];
  const { vehicles: [one] } = await reportOf(Array.from({ length: 20 }, (_, i) => frame(8000 * i, drive(i))));
  expect(Math.abs(one.path_m - 76) < 0.01, `${one.path_m} m`);
});
await check("report: another start is not driven to", async () => {
  const { vehicles: [one] } = await reportOf(framesOf(20, (i) => [{ id: 1, x: i < 10 ? 0 : 5000 }]));
  expect(one.path_m === 0, `${one.path_m} m`);
});
// By half lengths: 1 is 2 m long and 0.5 m wide.
const BOXES = { fleet: [{ id: 1, box_half_m: [1, 0.25] }, { id: 2, box_half_m: [1, 0.25] }] };
await check("report: the nearest two are so by their outlines, which may be boxes", async () => {
  const near = async (one, other) => {
    const { least } = await reportOf(framesOf(3, () => [one, other]), [], BOXES);
    return least.gap_m;
  };
  const is = (gap_m, wanted, which) => expect(Math.abs(gap_m - wanted) < 2e-3, `${which}: ${gap_m} m`);
  const turned = Math.round(1000 * Math.PI / 2);  // thousandths, as all that a frame holds
  is(await near({ id: 1 }, { id: 2, y: 1000 }), 0.5, "abreast");
  is(await near({ id: 1 }, { id: 2, x: 2500 }), 0.5, "one behind the other");
  is(await near({ id: 1 }, { id: 2, x: 1500, heading: turned }), 0.25, "across its way");
  is(await near({ id: 1 }, { id: 2, heading: turned }), 0, "crossed");
  is(await near({ id: 1 }, { id: 2, x: 2300, y: 900 }), 0.5, "corner to corner");
  is(await near({ id: 1 }, { id: 3, x: 1500 }), 0.25, "a disc ahead");
  is(await near({ id: 1 }, { id: 3, y: 1000 }), 0.5, "a disc abreast");
  is(await near({ id: 3 }, { id: 4, x: 400 }), -0.1, "two discs");
});
await check("report: what the world measured between frames is nearer than they show", async () => {
  const closest = { seq: 1, world_epoch: 1, time_s: 2, kind: "closest", vehicle: 1, other: 3, value: 0.2 };
  const { least } = await reportOf(
    framesOf(20, (i) => [{ id: 1 }, { id: 2, x: 1500 }, { id: 3, x: 3000 + 100 * Math.abs(i - 9) }]), [[2000, closest]]);
  expect(least.gap_m === 0.2 && least.a === 1 && least.b === 3 && least.at === 900, JSON.stringify(least));
});
await check("report: a contact with a wall counts, and is at the point that was touched", async () => {
  const contact = { seq: 1, world_epoch: 1, time_s: 0.5, kind: "contact", vehicle: 1, text: "wall",
    position_world: { x_m: 1, y_m: 0 }, other_position_world: { x_m: 1.25, y_m: 0 } };
  const { vehicles: [one], contacts } = await reportOf(framesOf(20, () => [{ id: 1 }, { id: 2, x: 1500 }]),
    [[500, contact], [900, { ...contact, seq: 2, other: 2, other_position_world: { x_m: 2, y_m: 0 } }]]);
  expect(one.contacts === 2 && JSON.stringify(contacts) === "[[1.25,0],[1.5,0]]", JSON.stringify(contacts));
});
await browser.close();
finish();
