// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0

// Usage: cross_read.js RECORDING.mcap RECORDING.db3 FOLDER
// Reads both recordings with the reference implementations of MCAP and rosbag2, decodes every message (of the .mcap by the
// schemas in the file, of the .db3 by the definitions of ROS 2), compares them, and writes the decoded messages with the
// reference implementations into FOLDER: without chunks, and in chunks that are not compressed, lz4 and zstd.
// Needs a NODE_PATH with the packages named in the script `run`; and the commands lz4 and zstd.
"use strict";

delete globalThis.fetch;  // Else sql.js takes this for a browser and asks for its own file by URL.

const { execFileSync } = require("child_process");
const crypto = require("crypto");
const fs = require("fs");
const path = require("path");
const { McapIndexedReader, McapWriter } = require("@mcap/core");
const { FileHandleReadable, FileHandleWritable } = require("@mcap/nodejs");
const { Rosbag2, SqliteSqljs } = require("@foxglove/rosbag2-web");
const { parse } = require("@foxglove/rosmsg");
const { MessageReader, MessageWriter } = require("@foxglove/rosmsg2-serialization");

const text = (key, value) => {
  if (ArrayBuffer.isView(value)) return Array.from(value, (entry) => String(entry));
  if (typeof value === "bigint") return String(value);
  if (typeof value === "number" && !Number.isFinite(value)) return String(value);
  return value;
};
// A stamp is called {sec, nanosec} by one reader and {sec, nsec} by the other.
const digest = (message) => JSON.stringify(message, text).replaceAll('"nanosec"', '"nsec"');

class Topic {
  constructor(type) {
    this.type = type;
    this.count = 0;
    this.hash = crypto.createHash("sha256");
  }
  add(time, message) {
    this.count += 1;
    this.hash.update(`${time} ${digest(message)}\n`);
  }
  line(name) {
    return `${name} ${this.type} ${this.count} ${this.hash.copy().digest("hex").slice(0, 16)}`;
  }
}

const lines = (topics) => [...topics.keys()].sort().map((name) => topics.get(name).line(name));

async function readMcap(file) {
  const handle = await fs.promises.open(file, "r");
  const reader = await McapIndexedReader.Initialize({
    readable: new FileHandleReadable(handle),
    decompressHandlers: {
      lz4: (data) => execFileSync("lz4", ["-d", "-c"], { input: data, maxBuffer: 2 ** 30 }),
      zstd: (data) => execFileSync("zstd", ["-d", "-c"], { input: data, maxBuffer: 2 ** 30 }),
    },
  });
  const definitions = new Map();
  const readers = new Map();
  for (const [id, channel] of reader.channelsById) {
    const schema = reader.schemasById.get(channel.schemaId);
    if (channel.messageEncoding !== "cdr" || schema.encoding !== "ros2msg") {
      throw new Error(`${channel.topic}: encoding ${channel.messageEncoding}, schema ${schema.encoding}`);
    }
    definitions.set(id, parse(new TextDecoder().decode(schema.data), { ros2: true }));
    readers.set(id, new MessageReader(definitions.get(id)));
  }
  const topics = new Map();
  const messages = [];
  for await (const record of reader.readMessages({ validateCrcs: true })) {
    const channel = reader.channelsById.get(record.channelId);
    const message = readers.get(record.channelId).readMessage(record.data);
    const type = reader.schemasById.get(channel.schemaId).name;
    if (!topics.has(channel.topic)) topics.set(channel.topic, new Topic(type));
    topics.get(channel.topic).add(record.logTime, message);
    messages.push({ channelId: record.channelId, logTime: record.logTime, publishTime: record.publishTime, message });
  }
  const promised = reader.statistics?.messageCount;
  if (promised !== BigInt(messages.length)) {
    throw new Error(`${file}: ${messages.length} messages, statistics promise ${promised}`);
  }
  await handle.close();
  return { reader, definitions, topics, messages };
}

async function readRosbag2(file) {
  const bag = new Rosbag2([new SqliteSqljs(new Uint8Array(fs.readFileSync(file)))]);
  await bag.open();
  const topics = new Map();
  for await (const record of bag.readMessages()) {
    const time = BigInt(record.timestamp.sec) * 1000000000n + BigInt(record.timestamp.nsec);
    if (!topics.has(record.topic.name)) topics.set(record.topic.name, new Topic(record.topic.type));
    topics.get(record.topic.name).add(time, record.value);
  }
  await bag.close();
  return topics;
}

const chunked = (compression, ...command) => ({
  useChunks: true,
  compressChunk: compression && ((data) => ({
    compression,
    compressedData: new Uint8Array(execFileSync(command[0], command.slice(1), { input: data, maxBuffer: 2 ** 30 })),
  })),
});

async function write(recording, file, options) {
  const handle = await fs.promises.open(file, "w");
  const writer = new McapWriter({ writable: new FileHandleWritable(handle), ...options });
  await writer.start({ profile: "ros2", library: "cross_read" });
  const schemas = new Map();
  const channels = new Map();
  const writers = new Map();
  for (const [id, channel] of recording.reader.channelsById) {
    const { name, encoding, data } = recording.reader.schemasById.get(channel.schemaId);
    if (!schemas.has(name)) schemas.set(name, await writer.registerSchema({ name, encoding, data }));
    const { topic, messageEncoding, metadata } = channel;
    channels.set(id, await writer.registerChannel({ schemaId: schemas.get(name), topic, messageEncoding, metadata }));
    writers.set(id, new MessageWriter(recording.definitions.get(id)));
  }
  let sequence = 0;
  for (const { channelId, logTime, publishTime, message } of recording.messages) {
    const data = writers.get(channelId).writeMessage(message);
    await writer.addMessage({ channelId: channels.get(channelId), sequence: sequence++, logTime, publishTime, data });
  }
  await writer.end();
  await handle.close();
}

async function main([mcap, rosbag2, folder]) {
  const recording = await readMcap(mcap);
  const ofMcap = lines(recording.topics);
  const ofRosbag2 = lines(await readRosbag2(rosbag2));
  ofMcap.forEach((line) => console.log(line));
  if (ofMcap.join("\n") !== ofRosbag2.join("\n")) {
    console.error("The db3 holds other messages:");
    ofRosbag2.forEach((line) => console.error(line));
    process.exit(1);
  }
  await write(recording, path.join(folder, "unchunked.mcap"), { useChunks: false });
  await write(recording, path.join(folder, "chunked.mcap"), chunked());
  await write(recording, path.join(folder, "lz4.mcap"), chunked("lz4", "lz4", "-c"));
  await write(recording, path.join(folder, "zstd.mcap"), chunked("zstd", "zstd", "-c"));
}

main(process.argv.slice(2)).catch((error) => {
  console.error(error);
  process.exit(1);
});
