// Recordings in the field's own readers: every beacon decoded from its CDR by the IDL within the file,
// and equal to what fleetctl listen says; and what is left of a recorder that was killed.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { monitorEventLoopDelay } from "node:perf_hooks";
import { parseIDL } from "@foxglove/omgidl-parser";
import { MessageReader } from "@foxglove/omgidl-serialization";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import lz4 from "lz4js";
import { check, domainOf, expect, finish, passedOrLate, start, stop, until, work } from "./support.mjs";

const decompressHandlers = { lz4: (bytes) => lz4.decompress(bytes) };

class Bytes {
  constructor(file) { this.bytes = readFileSync(file); }
  async size() { return BigInt(this.bytes.length); }
  async read(offset, size) {
    return new Uint8Array(this.bytes.subarray(Number(offset), Number(offset + size)));
  }
}

const readers = new Map();
function decoded(schema, data) {
  if (!readers.has(schema.name)) {
    readers.set(schema.name,
      new MessageReader(schema.name, parseIDL(new TextDecoder().decode(schema.data))));
  }
  return readers.get(schema.name).readMessage(data);
}

// Every message of an indexed file, decoded.
async function readIndexed(file) {
  const reader = await McapIndexedReader.Initialize({ readable: new Bytes(file), decompressHandlers });
  const messages = [];
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    messages.push({ topic: channel.topic, value: decoded(schema, message.data), ...message });
  }
  return messages;
}

// Of a file without its end.
function readStream(file) {
  const reader = new McapStreamReader({ decompressHandlers, noMagicPrefix: false });
  reader.append(new Uint8Array(readFileSync(file)));
  const channels = new Map(), schemas = new Map(), messages = [];
  for (let record; (record = reader.nextRecord());) {
    if (record.type === "Schema") schemas.set(record.id, record);
    if (record.type === "Channel") channels.set(record.id, record);
    if (record.type !== "Message") continue;
    const channel = channels.get(record.channelId);
    messages.push({ topic: channel.topic, logTime: record.logTime,
      value: decoded(schemas.get(channel.schemaId), record.data) });
  }
  return messages;
}

const topicsFile = join(work, "topics.mcap");  // report.mjs looks at it, too
const run = start("fleetctl", "run", "intersection_yield", "--record-topics", topicsFile,
  "--record", join(work, "tapes"));
const domain = await domainOf(run);
const whole = join(work, "whole.mcap");
const recorder = start("fleetctl", "record", whole, "--domain", domain);
const listener = start("fleetctl", "listen", "fleet/beacon", "--domain", domain, "--json");
const killed = [];
// At 20 moments between two flushes, five recorders at a time.
async function killAt(i) {
  const file = join(work, `killed-${i}.mcap`);
  const recorder = start("fleetctl", "record", file, "--domain", domain);
  await new Promise((resolve) => setTimeout(resolve, 2200 + 53 * i));
  const at_ms = Date.now();
  await stop(recorder, "SIGKILL");
  killed.push({ file, at_ms });
}
await until("the fleet speaks", () => listener.stdout.length > 0);
const stalls = monitorEventLoopDelay({ resolution: 10 });  // of the machine, while this process does nothing
stalls.enable();
for (let i = 0; i < 20; i += 5) await Promise.all([0, 1, 2, 3, 4].map((more) => killAt(i + more)));
stalls.disable();
await run.ended;
await stop(listener, "SIGINT");

let messages = [];
await check("recording: ends in good order at Ctrl-C", async () => {
  const code = await stop(recorder, "SIGINT");
  expect(code === 0, `exit code ${code}: ${recorder.stderr}`);
});
await check("recording: the official reader opens it by its index", async () => {
  messages = await readIndexed(whole);
  expect(messages.length > 1000, `${messages.length} messages`);
  const topics = new Set(messages.map((message) => message.topic));
  for (const topic of ["fleet/beacon", "fleet/motor_command", "fleet/status", "world/ranges", "world/truth",
    "world/event", "world/roster", "world/figures"]) {
    expect(topics.has(topic), `nothing of ${topic}`);
  }
});
await check("recording: every beacon is what fleetctl listen heard", () => {
  const heard = new Map(listener.stdout.trim().split("\n").map((line) => JSON.parse(line))
    .map((beacon) => [`${beacon.vehicle}.${beacon.boot_epoch}.${beacon.seq}`, beacon]));
  const beacons = messages.filter((message) => message.topic === "fleet/beacon").map((message) => message.value);
  let compared = 0;
  for (const beacon of beacons) {
    const other = heard.get(`${beacon.vehicle}.${beacon.boot_epoch}.${beacon.seq}`);
    if (!other) continue;  // the two joined at different moments
    ++compared;
    for (const name of ["world_epoch", "tick", "left_rad_s", "right_rad_s", "cruise_m_s", "toward_x_m",
      "toward_y_m", "body_radius_m", "axle_m", "order_speed_bucket"]) {
      expect(beacon[name] === other[name], `${name}: ${beacon[name]} and ${other[name]}`);
    }
    for (const name of ["x_m", "y_m", "heading_rad"]) {
      expect(beacon.world_from_body[name] === other.world_from_body[name], name);
    }
    expect((other.gives_way_to ?? 0) === beacon.gives_way_to, "gives_way_to");
  }
  expect(compared > 200 && compared > 0.9 * Math.min(beacons.length, heard.size),
    `${compared} of ${beacons.length} and ${heard.size} compared`);
});
await check("recording: times are the writers' and ours", () => {
  for (const message of messages) {
    const late_ms = Number(message.logTime - message.publishTime) / 1e6;
    expect(late_ms > -5 && late_ms < 60000, `${message.topic} ${late_ms} ms`);
  }
});
await check("recording: after kill -9 all but the last second is there", () => {
  const lost = killed.map(({ file, at_ms }) => {
    const left = readStream(file);
    expect(left.length > 0, `${file}: nothing`);
    return at_ms - Number(left.at(-1).logTime / 1000000n);
  });
  console.log(`        ${lost.length} kills, ${Math.min(...lost)} to ${Math.max(...lost)} ms lost`);
  const stall_ms = stalls.max / 1e6;
  // How late a recorder can be: the one that ran all the time hears a fleet that speaks every 50 ms.
  const [from_ms, to_ms] = [Math.min, Math.max].map((of) => of(...killed.map(({ at_ms }) => at_ms)));
  const heard_ms = messages.map((message) => Number(message.logTime / 1000000n))
    .filter((ms) => ms > from_ms - 2000 && ms < to_ms);
  const gap_ms = heard_ms.slice(1).reduce((most, ms, i) => Math.max(most, ms - heard_ms[i]), 0);
  expect(lost.length === 20 && Math.max(...lost) <= 1000 + stall_ms + gap_ms,
    `ms lost: ${lost}; stalls of ${stall_ms} ms, and of ${gap_ms} ms between what a recorder heard`);
});
await check("recording: run --record-topics gives the same, with the brains' recordings within", async () => {
  const code = await run.ended;
  expect(passedOrLate(run, code), `exit code ${code}: ${run.stdout.slice(-400)} ${run.stderr}`);
  const beacons = new Set((await readIndexed(topicsFile)).filter((m) => m.topic === "fleet/beacon")
    .map(({ value }) => `${value.vehicle}.${value.boot_epoch}.${value.seq}`));
  const others = messages.filter((m) => m.topic === "fleet/beacon");
  const known = others.filter(({ value }) => beacons.has(`${value.vehicle}.${value.boot_epoch}.${value.seq}`));
  expect(beacons.size > 200 && known.length > 0.95 * others.length, `${known.length} of ${others.length}`);
  const reader = await McapIndexedReader.Initialize({ readable: new Bytes(topicsFile), decompressHandlers });
  const names = reader.attachmentIndexes.map((attachment) => attachment.name).sort().join();
  expect(names === "vehicle-1.recording,vehicle-2.recording", `attached: ${names}`);
});
await check("recording: export gives the same as CSV and JSON", async () => {
  const beacons = messages.filter((message) => message.topic === "fleet/beacon");
  const csv = start("fleetctl", "export", whole, "--topic", "fleet/beacon", "--csv");
  expect(await csv.ended === 0, csv.stderr);
  expect(csv.stdout.trim().split("\n").length === beacons.length + 1, "lines of CSV");
  const events = start("fleetctl", "export", whole, "--topic", "world/event", "--csv");
  expect(await events.ended === 0, events.stderr);
  const names = events.stdout.split("\n")[0].split(",");
  for (const name of ["vehicle", "other", "text"]) expect(names.includes(name), `no column ${name}: ${names}`);
  const json = start("fleetctl", "export", whole, "--topic", "world/event", "--json");
  expect(await json.ended === 0, json.stderr);
  expect(json.stdout.trim().split("\n").map((line) => JSON.parse(line)).some((e) => e.kind === "halted"), "halted");
});
await check("recording: export of a damaged file says so, as CSV and as JSON", async () => {
  const damaged = `${whole}.damaged`;
  const bytes = readFileSync(whole);
  const middle = Math.floor(bytes.length * 0.6);  // wherever that is: in a chunk, or in an index
  bytes.fill(0xff, middle, middle + 64);
  writeFileSync(damaged, bytes);
  for (const format of ["--csv", "--json"]) {
    const exported = start("fleetctl", "export", damaged, "--topic", "fleet/beacon", format);
    expect(await exported.ended === 1, `${format}: exit code ${await exported.ended}`);
    expect(exported.stderr.includes("damaged"), `${format}: ${exported.stderr}`);
  }
});
await check("recording: export to a reader that ends early is no failure", async () => {
  const exported = start("fleetctl", "export", whole, "--topic", "fleet/beacon", "--csv");
  exported.child.stdout.destroy();
  expect(await exported.ended === 0, `exit code ${await exported.ended}: ${exported.stderr}`);
});
await check("recording: a file that is there already is not overwritten", async () => {
  const again = start("fleetctl", "record", whole, "--domain", domain, "--duration", "60s", "--last", "1s");
  const late = setTimeout(() => again.child.kill("SIGKILL"), 10000);
  const code = await again.ended;
  clearTimeout(late);
  expect(code === 2, `exit code ${code}, of the start`);
  expect(again.stderr.includes("File exists"), again.stderr);
});
finish();
