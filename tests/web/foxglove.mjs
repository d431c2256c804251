// The Foxglove WebSocket by the field's own client: the same channels as in a recording made at the same
// time, the same bytes, subscriptions heeded; and clients that are slow, too many or malformed.
import { request } from "node:http";
import { createRequire } from "node:module";
import { connect } from "node:net";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { parseIDL } from "@foxglove/omgidl-parser";
import { MessageReader } from "@foxglove/omgidl-serialization";
import { McapIndexedReader } from "@mcap/core";
import lz4 from "lz4js";
import { check, domainOf, expect, finish, freePort, start, stop, until, work } from "./support.mjs";

const required = createRequire(import.meta.url);
const { FoxgloveClient } = required("@foxglove/ws-protocol");
const WebSocket = required("ws");

const port = await freePort();
const pagePort = await freePort();
const url = `ws://127.0.0.1:${port}`;
const run = start("fleetctl", "run", "intersection_yield");
const domain = await domainOf(run);
const file = join(work, "foxglove.mcap");
const recorder = start("fleetctl", "record", file, "--domain", domain);
const listener = start("fleetctl", "listen", "fleet/beacon", "--domain", domain, "--json");
const observer = start("giveway-observer", "--domain", domain, "--port", String(pagePort),
  "--foxglove-port", String(port));
await until("the observer serves",
  () => fetch(`http://127.0.0.1:${pagePort}/livez`).then((answer) => answer.ok, () => false));

// A client that keeps what it is sent.
function open(protocols = [FoxgloveClient.SUPPORTED_SUBPROTOCOL], options = {}) {
  const socket = new WebSocket(url, protocols, options);
  const client = new FoxgloveClient({ ws: socket });
  const seen = { socket, client, info: null, channels: [], messages: [], statuses: [], errors: [], closed: false };
  client.on("serverInfo", (info) => { seen.info = info; });
  client.on("advertise", (channels) => { seen.channels.push(...channels); });
  client.on("message", ({ subscriptionId, timestamp, data }) => {
    seen.messages.push({ id: subscriptionId, timestamp,
      data: new Uint8Array(data.buffer, data.byteOffset, data.byteLength).slice() });
  });
  client.on("status", (status) => { seen.statuses.push(status); });
  client.on("error", (error) => { seen.errors.push(error.message); });
  client.on("close", () => { seen.closed = true; });
  return seen;
}
const channelOf = (seen, topic) => seen.channels.find((channel) => channel.topic === topic);
const of = (seen, id) => seen.messages.filter((message) => message.id === id);

const first = open();
await check("foxglove: the official client is greeted, and channels are advertised", async () => {
  await until("channels", () => first.channels.length > 0);
  expect(first.info.name.includes(`domain ${domain}`), JSON.stringify(first.info));
  expect(first.info.capabilities.length === 0 && first.info.sessionId, JSON.stringify(first.info));
});
await check("foxglove: until a client subscribes the fleet is not read", () => {
  expect(!observer.stderr.includes("reads the fleet's samples"), observer.stderr);
});
const beacons = first.client.subscribe(channelOf(first, "fleet/beacon").id);
const truths = first.client.subscribe(channelOf(first, "world/truth").id);
const roster = first.client.subscribe(channelOf(first, "world/roster").id);
await check("foxglove: what is subscribed to comes, and nothing else", async () => {
  await until("beacons", () => of(first, beacons).length > 40);
  await until("truths", () => of(first, truths).length > 40);
  await until("the roster, written long ago", () => of(first, roster).length >= 2);
  expect(first.messages.every(({ id }) => [beacons, truths, roster].includes(id)), "other subscriptions");
  expect(first.errors.length === 0 && first.statuses.length === 0, JSON.stringify([first.errors, first.statuses]));
});
await check("foxglove: a client that subscribes later has the roster, too", async () => {
  const second = open(["foxglove.sdk.v1"]);
  await until("channels", () => second.channels.length > 0);
  expect(second.socket.protocol === "foxglove.sdk.v1", second.socket.protocol);
  const id = second.client.subscribe(channelOf(second, "world/roster").id);
  await until("the roster", () => of(second, id).length >= 2, 5000);
  second.client.close();
});
await check("foxglove: after unsubscribing nothing more comes", async () => {
  first.client.unsubscribe(truths);
  await new Promise((resolve) => setTimeout(resolve, 300));
  const before = of(first, truths).length, other = of(first, beacons).length;
  await until("twenty more beacons", () => of(first, beacons).length > other + 20);
  expect(of(first, truths).length === before, `${of(first, truths).length - before} more`);
});
await check("foxglove: malformed and unserved messages are answered in words, and the client stays", async () => {
  const other = open();
  await until("channels", () => other.channels.length > 0);
  for (const text of ["", "{", "[]", '{"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]}',
    '{"op":"subscribe","subscriptions":[{"id":1,"channelId":999}]}', '{"op":"unsubscribe","subscriptionIds":[5]}',
    '{"op":"getParameters","parameterNames":[],"id":"a"}']) other.socket.send(text);
  other.client.sendMessage(1, new Uint8Array([1, 2, 3]));
  await until("eight answers", () => other.statuses.length === 8, 5000);
  expect(other.statuses.every(({ level, message }) => level >= 1 && message.length > 10),
    JSON.stringify(other.statuses));
  expect(!other.closed, "closed");
  other.socket.send("x".repeat(100000));  // more than is taken
  await until("closed", () => other.closed, 5000);
});

// Without a client library: the answer to a handshake, as text.
function answerTo(headers) {
  return new Promise((resolve) => {
    const asked = request({ port, host: "127.0.0.1", headers }, (answer) => {
      let body = "";
      answer.on("data", (bytes) => { body += bytes; });
      answer.on("end", () => resolve({ status: answer.statusCode, body }));
    });
    asked.on("upgrade", (answer, socket) => { socket.destroy(); resolve({ status: 101, body: "" }); });
    asked.on("error", (error) => resolve({ status: 0, body: error.message }));
    asked.end();
  });
}
const upgrade = { Connection: "Upgrade", Upgrade: "websocket", "Sec-WebSocket-Version": "13",
  "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==", "Sec-WebSocket-Protocol": "foxglove.websocket.v1" };
await check("foxglove: other subprotocols, hosts, origins and requests are refused in words", async () => {
  for (const [headers, status, word] of [
    [{ ...upgrade, "Sec-WebSocket-Protocol": "chat" }, 400, "foxglove.websocket.v1"],
    [{ ...upgrade, Host: "evil.example" }, 421, "--host-name"],
    [{ ...upgrade, Origin: "https://evil.example" }, 403, "--host-name"],
    [{ ...upgrade, Origin: "null" }, 403, "--host-name"],
    [{}, 426, "WebSocket"],
    [{ ...upgrade, "X-Long": "x".repeat(9000) }, 0, ""],
    [{ ...upgrade, Origin: "https://app.foxglove.dev" }, 101, ""],
    [{ ...upgrade, Origin: `http://localhost:${port}` }, 101, ""]]) {
    const answer = await answerTo(headers);
    expect(answer.status === status && answer.body.includes(word), JSON.stringify([headers, answer]));
  }
});

// 15 clients that subscribe to everything and then read nothing.
const rssOf = (pid) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]) / 1024;
function neverReading() {
  const socket = connect(port, "127.0.0.1");
  socket.on("error", () => {});
  socket.write(`GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n${Object.entries(upgrade).map(([n, v]) => `${n}: ${v}\r\n`).join("")}\r\n`);
  return new Promise((resolve) => socket.once("data", () => {
    socket.pause();
    const text = JSON.stringify({ op: "subscribe",
      subscriptions: first.channels.map(({ id }) => ({ id, channelId: id })) });
    const head = Buffer.alloc(8);  // masked with zeros, length in 16 bits
    head.writeUInt8(0x81, 0);
    head.writeUInt8(0x80 | 126, 1);
    head.writeUInt16BE(text.length, 2);
    socket.write(Buffer.concat([head, Buffer.from(text)]));
    resolve(socket);
  }));
}
await check("foxglove: clients that never read cost no memory, and delay no other", async () => {
  const before = rssOf(observer.child.pid), had = of(first, beacons).length;
  const sockets = await Promise.all(Array.from({ length: 15 }, neverReading));
  const answer = await answerTo(upgrade);
  expect(answer.status === 503 && answer.body.includes("16 clients"), `a 17th: ${JSON.stringify(answer)}`);
  await until("the other continues", () => of(first, beacons).length > had + 160);
  const grown = rssOf(observer.child.pid) - before;
  console.log(`        ${grown.toFixed(1)} MB more with 15 clients that never read`);
  expect(grown < 12, `${grown} MB`);
  for (const socket of sockets) socket.destroy();
  await until("there is space again", async () => (await answerTo(upgrade)).status === 101, 5000);
});
await run.ended;
first.client.close();
await stop(listener, "SIGINT");
await stop(recorder, "SIGINT");

const bytes = readFileSync(file);
const reader = await McapIndexedReader.Initialize({
  readable: { size: async () => BigInt(bytes.length),
    read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size))) },
  decompressHandlers: { lz4: (compressed) => lz4.decompress(compressed) } });
await check("foxglove: channels are those of a recording", () => {
  expect(reader.channelsById.size >= 8, `${reader.channelsById.size} channels`);
  for (const channel of reader.channelsById.values()) {
    const live = channelOf(first, channel.topic), schema = reader.schemasById.get(channel.schemaId);
    expect(live, `${channel.topic} is not advertised`);
    expect(live.encoding === channel.messageEncoding, `${channel.topic}: ${live.encoding}`);
    expect(live.schemaName === schema.name && live.schemaEncoding === schema.encoding, live.schemaName);
    expect(live.schema === new TextDecoder().decode(schema.data), `${channel.topic}: another schema`);
  }
});
await check("foxglove: every beacon has the bytes of the recording, and the values of fleetctl listen", async () => {
  const channel = channelOf(first, "fleet/beacon");
  const decoder = new MessageReader(channel.schemaName, parseIDL(channel.schema));
  const keyOf = (beacon) => `${beacon.vehicle}.${beacon.boot_epoch}.${beacon.seq}`;
  const recorded = new Map();
  for await (const message of reader.readMessages({ topics: ["fleet/beacon"] })) {
    recorded.set(keyOf(decoder.readMessage(message.data)), message);
  }
  const heard = new Map(listener.stdout.trim().split("\n").map((line) => JSON.parse(line))
    .map((beacon) => [keyOf(beacon), beacon]));
  let compared = 0, listened = 0;
  const live = of(first, beacons);
  for (const { data, timestamp } of live) {
    const beacon = decoder.readMessage(data), message = recorded.get(keyOf(beacon)), other = heard.get(keyOf(beacon));
    if (message) {
      ++compared;
      expect(Buffer.compare(Buffer.from(message.data), Buffer.from(data)) === 0, `${keyOf(beacon)}: other bytes`);
      const apart_ms = Math.abs(Number(timestamp - message.logTime)) / 1e6;
      expect(apart_ms < 1000, `${keyOf(beacon)}: received ${apart_ms} ms apart`);
    }
    if (!other) continue;
    ++listened;
    for (const name of ["tick", "left_rad_s", "right_rad_s", "cruise_m_s", "order_speed_bucket"]) {
      expect(beacon[name] === other[name], `${name}: ${beacon[name]} and ${other[name]}`);
    }
    expect(beacon.world_from_body.x_m === other.world_from_body.x_m, "x_m");
  }
  console.log(`        ${live.length} beacons live, ${compared} of ${recorded.size} recorded ones and ${listened} heard ones equal`);
  expect(compared > 200 && compared > 0.95 * live.length, `${compared} of ${live.length} are in the recording`);
  expect(listened > 0.95 * live.length, `${listened} of ${live.length} heard`);
  const seqs = live.map(({ data }) => decoder.readMessage(data)).filter(({ vehicle }) => vehicle === 1)
    .map(({ seq }) => seq);
  const missed = seqs.at(-1) - seqs[0] + 1 - seqs.length;
  expect(missed <= 0.1 * seqs.length, `${missed} of ${seqs.length} skipped`);
});
await check("foxglove: the observer ends in good order", async () => {
  const code = await stop(observer);
  expect(code === 0, `exit code ${code}: ${observer.stderr}`);
});
finish();
