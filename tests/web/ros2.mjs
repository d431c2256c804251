// ROS 2 recordings in the field's own readers: every message decoded by the definition within the file and
// compared with the beacons, scans and commands of the same file; definitions and IDL compared field by field with
// the public ones.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { parseIDL } from "@foxglove/omgidl-parser";
import { MessageReader as IdlReader } from "@foxglove/omgidl-serialization";
import { parse } from "@foxglove/rosmsg";
import { ros2humble, ros2jazzy } from "@foxglove/rosmsg-msgs-common";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader } from "@mcap/core";
import lz4 from "lz4js";
import { check, domainOf, expect, finish, start, stop, work } from "./support.mjs";

class Bytes {
  constructor(file) { this.bytes = readFileSync(file); }
  async size() { return BigInt(this.bytes.length); }
  async read(offset, size) {
    return new Uint8Array(this.bytes.subarray(Number(offset), Number(offset + size)));
  }
}

const text = (schema) => new TextDecoder().decode(schema.data);
const readers = new Map();
function decoded(schema, data) {
  if (!readers.has(schema.name)) {
    readers.set(schema.name, schema.encoding === "ros2msg"
      ? new MessageReader(parse(text(schema), { ros2: true }))
      : new IdlReader(schema.name, parseIDL(text(schema))));
  }
  return readers.get(schema.name).readMessage(data);
}

async function read(file) {
  const reader = await McapIndexedReader.Initialize({ readable: new Bytes(file),
    decompressHandlers: { lz4: (bytes) => lz4.decompress(bytes) } });
  const messages = [];
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    messages.push({ topic: channel.topic, type: schema.name, value: decoded(schema, message.data), ...message });
  }
  return { reader, messages };
}

// Both lists as lines "type[array] name = value", of the type as it is called in both.
function lines(definitions) {
  return definitions.map(({ type, name, isArray, arrayLength, isConstant, value, defaultValue }) => {
    const called = { time: "builtin_interfaces/Time", duration: "builtin_interfaces/Duration" }[type] ?? type;
    return `${called.replace("/msg/", "/")}${isArray ? `[${arrayLength ?? ""}]` : ""} ${name}` +
      (isConstant ? ` = ${value}` : defaultValue !== undefined ? ` default ${defaultValue}` : "");
  });
}
function same(what, ours, theirs) {
  for (let i = 0; i < Math.max(ours.length, theirs.length); ++i) {
    expect(ours[i] === theirs[i], `${what}: "${ours[i]}", the public definition has "${theirs[i]}"`);
  }
}

const file = join(work, "ros2.mcap");
const last = join(work, "ros2_last.mcap");
const run = start("fleetctl", "run", "intersection_yield");
const domain = await domainOf(run);
const recorder = start("fleetctl", "record", file, "--domain", domain, "--ros2", "--duration", "11s");
const ring = start("fleetctl", "record", last, "--domain", domain, "--ros2", "--last", "3s", "--ros2-rate", "20",
  "--duration", "11s");
const codes = await Promise.all([recorder.ended, ring.ended]);
await stop(run, "SIGINT");
let reader, messages = [];
const of = (topic) => messages.filter((message) => message.topic === topic);
const stampOf = ({ sec, nsec, nanosec }) => BigInt(sec) * 1000000000n + BigInt(nsec ?? nanosec);
const near = (a, b, tiny = 1e-9) => Math.abs(a - b) <= tiny;

await check("ros2: a recording with ROS 2 messages ends in good order", async () => {
  expect(codes.every((code) => code === 0), `exit codes ${codes}: ${recorder.stderr} ${ring.stderr}`);
  ({ reader, messages } = await read(file));
  expect(reader.header.profile === "ros2", `profile ${reader.header.profile}`);
});
await check("ros2: all five types are there, in CDR, with the QoS they were offered with", () => {
  const wanted = { "/giveway/v1/odom": "nav_msgs/msg/Odometry", "/giveway/v2/odom": "nav_msgs/msg/Odometry",
    "/giveway/v1/ultrasonics": "sensor_msgs/msg/Range", "/giveway/v1/cmd_vel": "geometry_msgs/msg/Twist",
    "/tf": "tf2_msgs/msg/TFMessage", "/tf_static": "tf2_msgs/msg/TFMessage",
    "/giveway/markers": "visualization_msgs/msg/MarkerArray" };
  const channels = [...reader.channelsById.values()];
  for (const [topic, type] of Object.entries(wanted)) {
    const channel = channels.find((one) => one.topic === topic);
    expect(channel, `nothing of ${topic}`);
    const schema = reader.schemasById.get(channel.schemaId);
    expect(schema.name === type && schema.encoding === "ros2msg", `${topic}: ${schema.name} ${schema.encoding}`);
    expect(channel.messageEncoding === "cdr", channel.messageEncoding);
    const qos = channel.metadata.get("offered_qos_profiles");
    const durability = topic === "/tf_static" ? 1 : 2;
    expect(qos?.includes("reliability: 1\n") && qos.includes(`durability: ${durability}\n`), `${topic}: ${qos}`);
  }
  for (const message of messages.filter((one) => one.topic.startsWith("/"))) {
    expect(message.data[0] === 0 && message.data[1] === 1, "the CDR is little-endian");
  }
});
await check("ros2: definitions are the public ones, field by field", () => {
  const compared = new Set();
  for (const schema of reader.schemasById.values()) {
    if (schema.encoding !== "ros2msg") continue;
    for (const { name, definitions } of parse(text(schema), { ros2: true })) {
      const called = (name ?? schema.name).replace("/msg/", "/");
      // The parser has types of its own for these two.
      if (called === "builtin_interfaces/Time" || called === "builtin_interfaces/Duration") continue;
      expect(ros2jazzy[called], `no public ${called}`);
      same(called, lines(definitions), lines(ros2jazzy[called].definitions));
      compared.add(called);
    }
    for (const [time, name] of [["sec", "Time"], ["sec", "Duration"]]) {
      if (text(schema).includes(`MSG: builtin_interfaces/${name}\n`)) {
        expect(text(schema).includes(`MSG: builtin_interfaces/${name}\nint32 ${time}\nuint32 nanosec\n`), name);
      }
    }
  }
  expect(compared.size === 19, `compared ${[...compared].join()}`);
});
await check("ros2: what Humble reads is what the newer definitions start with", () => {
  for (const name of ["nav_msgs/Odometry", "sensor_msgs/Range", "tf2_msgs/TFMessage", "geometry_msgs/Twist",
    "visualization_msgs/MarkerArray", "visualization_msgs/Marker"]) {
    const fields = (all) => lines(all[name].definitions.filter((one) => !one.isConstant));
    const older = fields(ros2humble);
    same(name, fields(ros2jazzy).slice(0, older.length), older);
  }
});
await check("ros2: the IDL is the public definitions, field by field", () => {
  const short = { int32: "int32", uint32: "uint32", octet: "uint8", bool: "bool", float32: "float32" };
  const structs = parseIDL(readFileSync(process.env.ROS2_IDL, "utf8")).filter((one) => one.aggregatedKind === "struct");
  for (const struct of structs) {
    const [, pack, name] = /^(\w+)::msg::dds_::(\w+)_$/.exec(struct.name) ?? [];
    const called = `${pack}/${name}`;
    expect(ros2jazzy[called], `${struct.name}: no public ${called}`);
    const ours = struct.definitions.map((one) => ({ name: one.name, isArray: one.isArray || one.arrayLengths,
      arrayLength: one.arrayLengths?.[0],
      type: one.isComplex ? one.type.replace(/^(\w+)::msg::dds_::(\w+)_$/, "$1/$2") : short[one.type] ?? one.type }));
    const theirs = ros2jazzy[called].definitions.filter((one) => !one.isConstant)
      .map((one) => ({ ...one, defaultValue: undefined }));
    same(called, lines(ours), lines(theirs));
  }
  expect(structs.length === 21, `${structs.length} structs`);
});
await check("ros2: odometry is what the beacons of the same file say", () => {
  const beacons = new Map(of("fleet/beacon").map((one) => [`${one.value.vehicle}.${one.publishTime}`, one.value]));
  let compared = 0;
  for (const vehicle of [1, 2]) {
    const odometry = of(`/giveway/v${vehicle}/odom`);
    const seconds = Number(odometry.at(-1).publishTime - odometry[0].publishTime) / 1e9;
    const rate = (odometry.length - 1) / seconds;
    expect(rate > 8 && rate < 11, `${rate} messages a second`);
    for (const { value, publishTime } of odometry) {
      const beacon = beacons.get(`${vehicle}.${publishTime}`);
      expect(beacon && stampOf(value.header.stamp) === publishTime, `no beacon of ${publishTime}`);
      const { position, orientation } = value.pose.pose;
      const { x_m, y_m, heading_rad } = beacon.world_from_body;
      expect(position.x === x_m && position.y === y_m && position.z === 0, `at ${position.x}, ${x_m}`);
      expect(near(Math.sin(2 * Math.atan2(orientation.z, orientation.w) - heading_rad), 0), "heading");
      expect(value.header.frame_id === "map" && value.child_frame_id === `giveway_v${vehicle}/base_link`, "frames");
      expect(near(value.twist.twist.linear.x,
        beacon.wheel_radius_m / 2 * (beacon.left_rad_s + beacon.right_rad_s)), "speed");
      const { xx_m2, xy_m2, yy_m2, xh_m_rad, yh_m_rad, hh_rad2 } = beacon.covariance;
      const rows = value.pose.covariance;
      [[0, xx_m2], [1, xy_m2], [6, xy_m2], [7, yy_m2], [5, xh_m_rad], [30, xh_m_rad], [11, yh_m_rad],
        [31, yh_m_rad], [35, hh_rad2], [14, 0], [21, 0], [28, 0]].forEach(([at, wanted]) =>
        expect(rows[at] === wanted, `covariance ${at}: ${rows[at]}, ${wanted}`));
      ++compared;
    }
  }
  expect(compared > 100, `${compared} compared`);
});
await check("ros2: ranges are echoes of the scans, and infinite where nothing answered", () => {
  const echoes = new Set();
  for (const { value } of of("world/ranges").filter((one) => one.value.vehicle === 1)) {
    value.echo.forEach((echo, i) => { if (echo === 2) echoes.add(`${i}.${Math.fround(value.range_m[i])}`); });
  }
  const ranges = of("/giveway/v1/ultrasonics").map((one) => one.value);
  let heard = 0;
  for (const { header, range, field_of_view, min_range, max_range, variance } of ranges) {
    const sensor = /^giveway_v1\/ultrasonic_(\d+)$/.exec(header.frame_id)?.[1];
    expect(sensor, header.frame_id);
    expect(near(field_of_view, Math.PI / 6, 1e-6) && min_range === 0 && max_range === 5 && variance === 0, "limits");
    if (range === Infinity) continue;
    ++heard;
    expect(echoes.has(`${sensor}.${range}`), `sensor ${sensor}: no echo at ${range}`);
  }
  expect(heard > 5 && heard < ranges.length, `${heard} of ${ranges.length} are echoes`);
});
await check("ros2: commands are those of the brains", () => {
  const commands = new Map(of("fleet/motor_command").map((one) => [`${one.value.vehicle}.${one.publishTime}`, one.value]));
  const twists = of("/giveway/v1/cmd_vel");
  const { wheel_radius_m, axle_m } = of("fleet/beacon")[0].value;
  for (const { value, publishTime } of twists) {
    const { left_rad_s, right_rad_s } = commands.get(`1.${publishTime}`);
    expect(near(value.linear.x, wheel_radius_m / 2 * (left_rad_s + right_rad_s)), "forward");
    expect(near(value.angular.z, wheel_radius_m / axle_m * (right_rad_s - left_rad_s)), "turn");
  }
  expect(twists.length > 50, `${twists.length} commands`);
});
await check("ros2: transforms join map, bodies and sensors; markers have the ids of the vehicles", () => {
  const children = new Set(of("/tf").flatMap((one) => one.value.transforms.map((t) => t.child_frame_id)));
  expect([...children].sort().join() === "giveway_v1/base_link,giveway_v2/base_link", [...children].join());
  const fixed = of("/tf_static").at(-1).value.transforms;
  expect(fixed.length === 32 && fixed.every((t) => t.header.frame_id === t.child_frame_id.replace(/ultra.*/, "base_link")), "static");
  const markers = of("/giveway/markers").flatMap((one) => one.value.markers);
  expect(markers.every((one) => one.ns === "giveway" && (one.id === 1 || one.id === 2)), "markers");
});
await check("ros2: the ring of --last has them too, with the transforms that do not change", async () => {
  ({ reader, messages } = await read(last));
  expect(of("/tf_static").length >= 1 && of("/giveway/v1/odom").length > 20, `${of("/giveway/v1/odom").length}`);
});
finish();
