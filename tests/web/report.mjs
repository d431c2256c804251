// The report of a recorded run: one file, opened without a server.
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { check, expect, finish, openBrowser, openPage, shots, start, text, until, work } from "./support.mjs";

const recording = join(work, "topics.mcap");  // of recording.mjs
const file = join(work, "topics.html");
await check("report: a recording becomes a page", async () => {
  const report = start("fleetctl", "report", recording, "--scenario", "intersection_yield");
  const code = await report.ended;
  expect(code === 0 && report.stdout.trim() === file && existsSync(file), `exit code ${code}: ${report.stderr}`);
  expect(!/src=|href="(?!data:)/.test(readFileSync(file, "utf8").replace(/<script[^]*?<\/script>/g, "")), "resources");
});
await check("report: flags of soaks are refused for a recording", async () => {
  const report = start("fleetctl", "report", recording, "--json");
  expect(await report.ended === 2, "exit code");
  expect(report.stderr.includes("leave out --json"), report.stderr);
});
await check("report: what holds nothing of a fleet is said", async () => {
  const report = start("fleetctl", "report", join(work, "absent.mcap"));
  expect(await report.ended === 2 && report.stderr.includes("cannot be read"), report.stderr);
});
const browser = await openBrowser();
const { page, complaints } = await openPage(browser, `file://${file}`);
// Whether anything but the ground was drawn.
const isDrawn = (selector) => page.evaluate((which) => [...document.querySelectorAll(which)].every((canvas) => {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  const colours = new Set();
  for (let i = 0; i < data.length; i += 4) if (data[i + 3]) colours.add(`${data[i]},${data[i + 1]},${data[i + 2]}`);
  return colours.size > 2;
}), selector);
await check("report: the page opens with figures, map, timeline and plots", async () => {
  await until("two vehicles", async () => (await page.locator("#report-table tr").count()) === 3);
  expect((await text(page, "report-title")).includes("topics.mcap"), "its title");
  const facts = await text(page, "report-facts");
  expect(/\b[12] halted/.test(facts) && facts.includes("between 1 and 2"), facts);
  for (const canvas of ["#report-map", "#report-timeline", "#report-plots canvas"]) {
    expect(await isDrawn(canvas), `${canvas} is empty`);
  }
  const ways = await page.locator("#report-table tr td:nth-child(2)").allTextContents();
  expect(ways.every((way) => parseFloat(way) > 3), `ways: ${ways}`);
  const waits = await page.locator("#report-table tr td:nth-child(3)").allTextContents();
  expect(waits.some((wait) => parseFloat(wait) > 1), `waits: ${waits}`);
  await page.screenshot({ path: join(shots, "report-light.png") });
});
await check("report: a click on the timeline shows the moment on the map", async () => {
  const timeline = page.locator("#report-timeline");
  await timeline.scrollIntoViewIfNeeded();
  const box = await timeline.boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + 8);
  await until("the map", () => page.locator("#map-view").isVisible(), 3000);
  const at_s = parseFloat(await page.evaluate(() => {
    const { cursor, frames } = window.giveway.state;
    return (cursor - frames[0].at) / (frames.at(-1).at - frames[0].at);
  }));
  expect(at_s > 0.4 && at_s < 0.55, `at ${at_s} of the run`);
  await page.keyboard.press("r");
  await until("the report", () => page.locator("#report-view").isVisible(), 3000);
});
await check("report: no complaint in the console", async () =>
  expect(complaints.length === 0, complaints.join("; ")));
await browser.close();
finish();
