// Reads an MCAP file of a run with the reference reader, every checksum on, and compares each pose with the run's tables.
//   node check.mjs FILE.mcap RUN_FOLDER
import { readFile, open } from 'node:fs/promises';
import { McapIndexedReader, McapStreamReader } from '@mcap/core';
import { parse } from '@foxglove/rosmsg';
import { MessageReader } from '@foxglove/rosmsg2-serialization';
import { decompress } from 'fzstd';

const [file, folder] = process.argv.slice(2);
const decompressHandlers = { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) };
const fail = (what) => {
  console.error(`FAILED: ${what}`);
  process.exitCode = 1;
};

// Front to back: the checksums of data and chunks.
const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
stream.append(await readFile(file));
let inStream = 0;
for (let record; (record = stream.nextRecord()); ) if (record.type === 'Message') ++inStream;
if (!stream.done()) fail('the file does not end with its mark');

// By the indexes, as viewers do.
const handle = await open(file);
const readable = {
  size: async () => BigInt((await handle.stat()).size),
  read: async (offset, length) => {
    const bytes = new Uint8Array(Number(length));
    await handle.read(bytes, 0, bytes.length, Number(offset));
    return bytes;
  },
};
const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
if (reader.header.profile !== 'ros2') fail('the profile is not ros2');
const readers = new Map();
for (const [id, schema] of reader.schemasById) {
  const definitions = parse(new TextDecoder().decode(schema.data), { ros2: true });
  readers.set(id, new MessageReader(definitions));
}
const topics = new Map();
let before = 0n;
for await (const message of reader.readMessages({ validateCrcs: true })) {
  if (message.logTime < before) fail('messages by index are not in order');
  before = message.logTime;
  const channel = reader.channelsById.get(message.channelId);
  const value = readers.get(channel.schemaId).readMessage(message.data);
  topics.set(channel.topic, [...(topics.get(channel.topic) ?? []), { stamp: message.logTime, value }]);
}
const indexed = [...topics.values()].reduce((sum, list) => sum + list.length, 0);
if (BigInt(indexed) !== reader.statistics.messageCount || indexed !== inStream) {
  fail(`${indexed} messages by index, ${inStream} in the stream, ${reader.statistics.messageCount} in the statistics`);
}
const attachments = [];
for await (const one of reader.readAttachments({ validateCrcs: true })) attachments.push(one.name);
if (!attachments.includes('run.json')) fail('run.json is not attached');

const nanoseconds = (text) => {
  const [whole, rest] = text.split('.');
  return BigInt(whole) * 1_000_000_000n + BigInt(rest.padEnd(9, '0'));
};
/** Rows of <name>.tum and <name>.csv beside the messages. */
async function compare(name, prefix) {
  const rows = (await readFile(`${folder}/${name}.tum`, 'utf8')).split('\n').filter((line) => line && !line.startsWith('#'));
  const [head, ...cells] = (await readFile(`${folder}/${name}.csv`, 'utf8')).trim().split('\n').map((line) => line.split(','));
  const poses = topics.get(`${prefix}/pose`) ?? [];
  const odometry = topics.get(`${prefix}/odometry`) ?? [];
  if (poses.length !== rows.length || odometry.length !== rows.length) return fail(`${name}: ${rows.length} rows, ${poses.length} poses, ${odometry.length} odometries`);
  let worst = 0;
  rows.forEach((row, index) => {
    const [stamp, ...numbers] = row.split(' ');
    const { position: p, orientation: q } = poses[index].value.pose;
    if (nanoseconds(stamp) !== poses[index].stamp) fail(`${name}: stamp of row ${index}`);
    [p.x, p.y, p.z, q.x, q.y, q.z, q.w].forEach((value, at) => (worst = Math.max(worst, Math.abs(value - Number(numbers[at])))));
    const sigma = Number(cells[index][head.indexOf('sigma_x_m')]);
    worst = Math.max(worst, Math.abs(odometry[index].value.pose.covariance[0] - sigma * sigma));
  });
  console.log(`${name}: ${rows.length} poses, largest difference ${worst.toExponential(1)}`);
  if (!(worst < 1e-9)) fail(`${name}: values differ`);
}
const names = [...topics.keys()].filter((topic) => topic.endsWith('/odometry')).map((topic) => topic.slice(1, -'/odometry'.length));
const only = process.env.ESTIMATOR;
for (const name of names) await compare(name === 'estimate' ? only : name, `/${name}`);
if (names.length === 0) fail('no estimator in the file');
console.log(`${indexed} messages on ${topics.size} topics, attached: ${attachments.join(', ')}`);
console.log([...topics].map(([topic, list]) => `  ${topic} ${list.length}`).join('\n'));
const markers = topics.get('/map/markers')?.[0]?.value.markers ?? [];
if (markers.length === 0) fail('no markers of the map');
await handle.close();
