// A fleet of 200 from virtual time, replayed on the page.
import { existsSync, statSync } from "node:fs";
import { join } from "node:path";
import {
  check, expect, finish, freePort, openBrowser, openPage, shots, start, stop, text, until, vehicles, work,
} from "./support.mjs";

const file = join(work, "fleet_200.mcap");
await check("replay: a fleet of 200 is recorded in virtual time", async () => {
  const run = start("fleetctl", "virtual", "fleet_200", "--seed", "1", "--duration", "20", "--mcap", file);
  await run.ended;
  expect(existsSync(file) && statSync(file).size > 1e6, run.stderr.slice(-200));
});
const port = await freePort();
const url = `http://127.0.0.1:${port}/`;
const replay = start("fleetctl", "replay", file, "--port", String(port), "--scenario", "fleet_200");
await until("the replay serves", () => fetch(url).then((answer) => answer.ok, () => false), 60000);
const browser = await openBrowser();
const { page, complaints } = await openPage(browser, url);

await check("replay: all 190 vehicles of fleet_200 are shown and move", async () => {
  await until("190 vehicles", async () => (await vehicles(page)).length === 190, 20000);
  const before = new Map((await vehicles(page)).map((v) => [v.id, v]));
  await until("they move", async () => (await vehicles(page)).filter((v) =>
    Math.hypot(v.x - before.get(v.id).x, v.y - before.get(v.id).y) > 0.2).length > 20);
});
const playFromStart = () => page.evaluate(() => {
  window.giveway.seek(window.giveway.state.frames[0].at);
  window.giveway.state.playing = true;
});
const moment = () => page.evaluate(() => ({
  drawn: window.giveway.drawn.frames, at_ms: performance.now(), cursor: window.giveway.state.cursor,
  playing: window.giveway.state.playing, moving: window.giveway.vehicles().filter((v) => v.speed > 0.05).length,
}));
await check("replay: at least 30 frames a second while the fleet drives", async () => {
  let rate = 0;
  for (let window = 0; window < 3 && rate < 30; ++window) {  // drawn in software: one may meet a busy machine
    await playFromStart();
    await until("half of the fleet drives", async () => (await moment()).moving > 95, 10000);
    const from = await moment();
    await page.waitForTimeout(4000);
    const to = await moment();
    rate = (to.drawn - from.drawn) / (to.at_ms - from.at_ms) * 1000;
    console.log(`        ${rate.toFixed(1)} frames/s, ${to.moving} vehicles drive`);
    expect(to.playing && to.cursor - from.cursor > 3000, `shown: ${from.cursor} to ${to.cursor} ms`);
    expect(to.moving > 50, `only ${to.moving} drive`);
  }
  expect(rate >= 30, `${rate.toFixed(1)} frames/s`);
});
await check("replay: Play at the end starts again", async () => {
  await page.evaluate(() => window.giveway.seek(window.giveway.state.frames.at(-1).at));
  await until("it has ended", async () => !(await moment()).playing, 3000);
  await page.locator("#play").click();
  await page.waitForTimeout(500);
  const { playing, cursor } = await moment();
  const first = await page.evaluate(() => window.giveway.state.frames[0].at);
  expect(playing && cursor - first < 3000, `playing ${playing}, ${cursor - first} ms after the start`);
});
await check("replay: the events of the whole run are there", async () => {
  const [start, known] = await page.evaluate(() => [
    [...window.giveway.state.events.values()].some((event) => event.kind === "started"),
    window.giveway.state.events.size]);
  console.log(`        ${known} events`);
  expect(start, "no start signal");
});
await check("replay: pause, seek and speed", async () => {
  await playFromStart();
  await page.locator("#play").click();
  await page.waitForTimeout(200); // what was drawn before the click is shown until the next frame
  const paused = await text(page, "when");
  await page.waitForTimeout(500);
  expect(paused === await text(page, "when"), "it continues while paused");
  await page.evaluate(() => window.giveway.seek(window.giveway.state.frames[0].at + 5000));
  await until("5.0 s", async () => (await text(page, "when")).startsWith("5.0"), 3000);
  await page.selectOption("#speed", "4");
  await page.locator("#play").click();
  await page.waitForTimeout(1000);
  const at = parseFloat(await text(page, "when"));
  expect(at > 7.5, `at ${at} s after a second at 4x`);
});
await check("replay: picking, following, dark", async () => {
  await page.keyboard.press("n");
  await page.keyboard.press("f");
  await until("picked", () => page.locator("#picked").isVisible(), 3000);
  await page.screenshot({ path: join(shots, "fleet-light.png") });
  await page.keyboard.press("Escape");
  await page.keyboard.press("0");
  await page.keyboard.press("d");
  await page.waitForTimeout(400);
  await page.screenshot({ path: join(shots, "fleet-dark.png") });
});
await check("replay: no complaint in the console", async () =>
  expect(complaints.length === 0, complaints.join("; ")));
await check("replay: ends at SIGTERM", async () => {
  const code = await stop(replay);
  expect(code === 0, `exit code ${code}`);
});
await browser.close();
finish();
