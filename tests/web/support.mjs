// What the parts of the stage share: test cases, processes, the browser.
import { spawn } from "node:child_process";
import { mkdtempSync } from "node:fs";
import { createServer } from "node:net";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

export const programs = process.env.GIVEWAY_BIN_DIR;
export const work = process.env.WORK;
export const shots = dirname(fileURLToPath(import.meta.url));

let failed = 0;
export function report(name, ok, why = "") {
  console.log(`${ok ? "ok     " : "FAILED "} ${name}${ok || !why ? "" : `: ${why}`}`);
  if (!ok) ++failed;
}
export async function check(name, body) {
  try {
    await body();
    report(name, true);
  } catch (error) {
    report(name, false, String(error.message ?? error).split("\n")[0]);
  }
}
export function expect(condition, why) {
  if (!condition) throw new Error(why);
}
export async function until(what, condition, limit_ms = 15000) {
  const end = Date.now() + limit_ms;
  for (;;) {
    const value = await condition();
    if (value) return value;
    if (Date.now() > end) throw new Error(`not within ${limit_ms} ms: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

const children = new Set();
// A program of ours; its output is kept, `ended` is its exit code.
export function start(program, ...args) {
  const child = spawn(join(programs, program), args, { stdio: ["ignore", "pipe", "pipe"] });
  const started = { child, stdout: "", stderr: "" };
  child.stdout.on("data", (bytes) => { started.stdout += bytes; });
  child.stderr.on("data", (bytes) => { started.stderr += bytes; });
  started.ended = new Promise((resolve) => child.on("close", (code) => {
    children.delete(child);
    resolve(code);
  }));
  children.add(child);
  return started;
}
// As tests/support/only_late.sh: the run passed, or failed only by which vehicles halted while the machine stalled.
export function passedOrLate(run, code) {
  const reason = /^FAILED +[^ :]*: (.*)$/m.exec(run.stdout)?.[1] ?? "";
  const ticks = Number(/^overruns +(\d+) ticks$/m.exec(run.stdout)?.[1] ?? 0);
  return code === 0 || (/^halted: [^;]*$/.test(reason) && ticks >= 2);
}
export async function stop(started, signal = "SIGTERM") {
  started.child.kill(signal);
  return started.ended;
}
export function finish() {
  process.exit(failed ? 1 : 0);
}
// However a part ends, also by a fault of its own or its time limit, it leaves no process behind:
// those of fleetctl end with it.
process.on("exit", () => { for (const child of children) child.kill("SIGKILL"); });
for (const signal of ["SIGTERM", "SIGINT", "SIGHUP"]) {
  process.on(signal, () => {
    report(`${process.argv[1].split("/").at(-1)}: ends by itself`, false, signal);
    process.exit(1);
  });
}
for (const fault of ["uncaughtException", "unhandledRejection"]) {
  process.on(fault, (error) => {
    report(`${process.argv[1].split("/").at(-1)}: continues`, false, String(error?.message ?? error).split("\n")[0]);
    process.exit(1);
  });
}

export function freePort() {
  return new Promise((resolve) => {
    const server = createServer().listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });
}

// The domain that fleetctl took, from what it says first.
export async function domainOf(run) {
  const found = await until("fleetctl says its domain", () => /on domain (\d+)/.exec(run.stderr));
  return found[1];
}

export async function openBrowser() {
  return chromium.launchPersistentContext(mkdtempSync(join(work, "browser-")), {
    executablePath: "/usr/bin/chromium", headless: true,
    args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
      "--disable-background-networking", "--disable-component-update", "--disable-sync"],
    viewport: { width: 1280, height: 800 }, colorScheme: "light",
  });
}

// A page whose complaints are kept: what the browser reports of lost connections is left out.
export async function openPage(browser, url) {
  const page = await browser.newPage();
  const complaints = [];
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error" && !/ERR_CONNECTION|ERR_INCOMPLETE|ERR_EMPTY_RESPONSE/.test(message.text())) {
      complaints.push(message.text());
    }
  });
  // The connections of the page, to end one as a network does.
  await page.addInitScript(() => {
    window.sources = [];
    window.EventSource = class extends EventSource {
      constructor(...words) { super(...words); window.sources.push(this); }
    };
  });
  await page.goto(url);
  return { page, complaints };
}

export function vehicles(page) {
  return page.evaluate(() => window.giveway.vehicles());
}
export function text(page, id) {
  return page.evaluate((name) => document.getElementById(name).textContent, id);
}
