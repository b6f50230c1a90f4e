// The whole of an MCAP file by the format's reference reader, every checksum on.
import { readFile, open } from 'node:fs/promises';
import { McapIndexedReader, McapStreamReader } from '@mcap/core';
import { parse } from '@foxglove/rosmsg';
import { MessageReader } from '@foxglove/rosmsg2-serialization';
import { decompress } from 'fzstd';

const decompressHandlers = { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) };

export const fail = (what) => {
  console.error(`FAILED: ${what}`);
  process.exitCode = 1;
};

/** Messages by topic, each with its stamp (ns) and its decoded value; and the names of the attachments. */
export async function wholeFile(file) {
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
  await handle.close();
  console.log(`${indexed} messages on ${topics.size} topics, attached: ${attachments.join(', ') || 'nothing'}`);
  console.log([...topics].map(([topic, list]) => `  ${topic} ${list.length}`).join('\n'));
  return { topics, attachments };
}

export const nanoseconds = (text) => {
  const [whole, rest] = text.split('.');
  return BigInt(whole) * 1_000_000_000n + BigInt(rest.padEnd(9, '0'));
};
