// A crossing of two real vehicles on the live page.
import { join } from "node:path";
import {
  check, domainOf, expect, finish, freePort, openBrowser, openPage, passedOrLate, shots, start, stop, text, until,
  vehicles,
} from "./support.mjs";

const port = await freePort();
const url = `http://127.0.0.1:${port}/`;
const browser = await openBrowser();  // before the run: it may take as long as one
const run = start("fleetctl", "run", "intersection_yield");
const domain = await domainOf(run);
const observe = () => start("giveway-observer", "--domain", domain, "--port", String(port),
  "--scenario", "intersection_yield");
let observer = observe();
await until("the observer serves", () => fetch(url + "livez").then((answer) => answer.ok, () => false));

let { page, complaints } = await openPage(browser, url);

await check("live: both vehicles are shown", () =>
  until("two vehicles", async () => (await vehicles(page)).filter((v) => v.has_body).length === 2));
await check("live: they move", async () => {
  const before = await vehicles(page);
  await until("a metre driven", async () => (await vehicles(page)).some((v, i) =>
    Math.hypot(v.x - before[i].x, v.y - before[i].y) > 0.3));
});
await check("live: ranges come", () =>
  until("ranges", () => page.evaluate(() =>
    Object.keys(JSON.parse(window.giveway.state.frames.at(-1).data).ranges).length === 2)));
await check("live: picking on the map shows the vehicle", async () => {
  const [x, y] = await page.evaluate(() => window.giveway.screenOf(1));
  const box = await page.locator("#map").boundingBox();
  await page.mouse.click(box.x + x, box.y + y);
  await until("its title", async () => (await text(page, "picked-title")) === "Vehicle 1", 5000);
});
await check("live: one gives way to the other and halts", async () => {
  await until("gives way", async () => (await vehicles(page)).some((v) => v.gives_way_to), 30000);
  await page.screenshot({ path: join(shots, "live-light.png") });
  await until("the event halted", async () => (await text(page, "events")).includes("halted"), 30000);
});
await check("live: the table says the same", async () => {
  await page.keyboard.press("t");
  await until("two rows", async () => (await page.locator("#table tbody tr").count()) === 2);
  const row = await page.locator("#table tbody tr").first().textContent();
  expect(row.includes("cooperative"), `row "${row}"`);
  await page.fill("#filter", "2");
  await until("one row", async () => (await page.locator("#table tbody tr").count()) === 1);
  await page.screenshot({ path: join(shots, "table-light.png") });
  await page.fill("#filter", "");
  await page.locator("#show-table").click();
});
await check("live: the API speaks the names of fleet.idl", async () => {
  const fleet = await (await fetch(url + "api/v1/fleet")).json();
  expect(fleet.vehicles.length === 2 && fleet.vehicles[0].vehicle === 1, "fleet");
  const vehicle = await (await fetch(url + "api/v1/vehicles/1")).json();
  expect(vehicle.beacon.world_from_body.x_m !== undefined, "beacon");
  const events = await (await fetch(url + "api/v1/events")).json();
  expect(events.events.some((event) => event.kind === "started"), "events");
  const metrics = await (await fetch(url + "metrics")).text();
  expect(metrics.includes('giveway_vehicle_beacon_age_seconds_bucket{vehicle="1"'), "metrics");
  expect((await fetch(url + "api/v1/vehicles/99")).status === 404, "unknown vehicle");
});
await check("live: other methods, hosts and paths are refused", async () => {
  expect((await fetch(url, { method: "POST", body: "x" })).status === 405, "POST");
  for (const path of ["..%2f..%2fetc/passwd", "api/v1/vehicles/1/../../..", "%00"]) {
    expect((await fetch(url + path)).status === 404, path);
  }
  const { request } = await import("node:http");
  const status = await new Promise((resolve) => {
    request({ port, host: "127.0.0.1", headers: { Host: "evil.example" } }, (answer) => {
      answer.resume();
      resolve(answer.statusCode);
    }).end();
  });
  expect(status === 421, `foreign Host: ${status}`);
});
await check("live: at most 16 follow, and what none reads costs nothing", async () => {
  const aborts = [], answers = [];
  for (let i = 0; i < 20; ++i) {
    const abort = new AbortController();
    aborts.push(abort);
    answers.push(await fetch(url + "api/v1/stream", { signal: abort.signal }));
  }
  const busy = answers.filter((answer) => answer.status === 503).length;
  expect((await fetch(url + "api/v1/fleet")).ok, "the API still answers");
  // A page that comes now says why it shows nothing, and shows the fleet as soon as it may.
  const late = (await openPage(browser, url)).page;
  await until("why it is refused", async () => (await text(late, "link")).includes("follow already"), 5000);
  aborts.forEach((abort) => abort.abort());
  expect(busy === 5, `${busy} of 20 in addition to one page were refused`);
  await until("the late page is live", async () => (await text(late, "link")) === "live", 8000);
  await late.close();
});
await check("live: looking back and on", async () => {
  await page.keyboard.press("[");
  await page.keyboard.press("[");
  await until("looking back", async () => (await text(page, "link")).includes("back"), 3000);
  await page.keyboard.press("l");
  await until("live", async () => (await text(page, "link")) === "live", 3000);
});
await check("live: a connection that was lost costs neither the history nor the moment that is shown", async () => {
  await page.locator("#play").click();
  await until("paused", async () => (await text(page, "play")) === "Play", 3000);
  const kept = () => page.evaluate(() => {
    const { frames, cursor, events, connected } = window.giveway.state;
    return { first: frames[0].at, last: frames.at(-1).at, cursor, events: events.size, connected };
  });
  const before = await kept();
  await page.evaluate(() => window.sources.at(-1).dispatchEvent(new Event("error")));
  await until("connected again", async () => (await kept()).connected && (await kept()).last > before.last, 8000);
  const after = await kept();
  expect(after.first === before.first && after.cursor === before.cursor && after.events >= before.events,
    JSON.stringify([before, after]));
  expect((await text(page, "play")) === "Play", "it plays on");
  await page.keyboard.press("l");
});
await check("live: says that data is stale, and reconnects", async () => {
  await page.locator("#play").click();
  await until("paused", async () => (await text(page, "play")) === "Play", 3000);
  await stop(observer);
  await until("the banner", async () => (await page.locator("#banner").isVisible()), 8000);
  expect((await text(page, "banner")).includes("stale"), "its words");
  await page.screenshot({ path: join(shots, "stale-light.png") });
  observer = observe();
  await until("no banner", async () => !(await page.locator("#banner").isVisible()), 15000);
  await until("live again, as its button says", async () =>
    (await text(page, "link")) === "live" && (await text(page, "play")) === "Pause", 3000);
});
await check("live: dark, and on a phone", async () => {
  await page.keyboard.press("d");
  await page.setViewportSize({ width: 390, height: 800 });
  await page.waitForTimeout(400);
  await page.screenshot({ path: join(shots, "phone-dark.png") });
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  expect(wide <= 390, `${wide} pixels wide`);
  await page.setViewportSize({ width: 1280, height: 800 });
});
await check("live: the page takes at most 300 kB and nothing from elsewhere", async () => {
  const body = await (await fetch(url)).text();
  expect(body.length <= 300000, `${body.length} bytes`);
  const names = await page.evaluate(() => performance.getEntriesByType("resource").map((one) => one.name));
  expect(names.every((name) => name.startsWith(url) || name.startsWith("data:")), names.join());
});
await check("live: no complaint in the console", async () =>
  expect(complaints.length === 0, complaints.join("; ")));
await check("live: the observed run passes", async () => {
  const code = await run.ended;
  expect(passedOrLate(run, code), `exit code ${code}: ${run.stdout.slice(-400)} ${run.stderr.slice(-200)}`);
});
await check("live: the observer ends in good order", async () => {
  const code = await stop(observer);
  expect(code === 0, `exit code ${code}`);
});
await browser.close();
finish();
