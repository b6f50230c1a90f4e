/** The feed of a running `pos serve`. */

import { Client, Refusal, type Command } from '../protocol/client';
import { readEvent, readState, type Info, type LockInterval, type RunEvent } from '../protocol/messages';
import type { Feed, FeedListener } from './feed';
import type { MapDocument } from './map_document';
import { kColumns } from './track';

const kPoints = 2_000_000;

export async function serverFeed(client: Client): Promise<Feed> {
  const info = await client.info();
  const map = await orNull(client.map().then((answer) => answer.map));
  const intervals = map ? await orNull(client.intervals().then((answer) => answer.intervals)) : null;
  return new ServerFeed(client, info, map, intervals ?? []);
}

/** What the server does not have is null; other refusals are errors. */
async function orNull<T>(answer: Promise<T>): Promise<T | null> {
  try {
    return await answer;
  } catch (error) {
    if (error instanceof Refusal && (error.failure.status === 404 || error.failure.status === 409)) return null;
    throw error;
  }
}

class ServerFeed implements Feed {
  readonly background: string | null;

  constructor(
    private readonly client: Client,
    readonly info: Info,
    readonly map: MapDocument | null,
    readonly intervals: LockInterval[],
  ) {
    const site = map?.features.find((feature) => feature.properties.object === 'map');
    this.background = site?.properties['background'] ? client.backgroundAddress() : null;
  }

  track(name: string, from_s: number | null) {
    const columns = kColumns.filter((column) => this.info.columns.includes(column));
    return this.client.track(name, { points: kPoints, columns, ...(from_s === null ? {} : { from_s }) });
  }

  async events(after: number): Promise<RunEvent[]> {
    return (await this.client.events(after)).events;
  }

  async command(command: Command): Promise<void> {
    await this.client.command(command);
  }

  listen(listener: FeedListener): () => void {
    const stream = new EventSource(this.client.streamAddress());
    const on = (name: string, take: (data: unknown) => void): void => {
      stream.addEventListener(name, (message) => {
        listener.alive();
        take(JSON.parse((message as MessageEvent<string>).data));
      });
    };
    on('state', (data) => listener.state(readState(data, 'state')));
    on('event', (data) => listener.event(readEvent(data, 'event')));
    on('reset', () => listener.reset());
    on('heartbeat', () => undefined);
    return () => stream.close();
  }
}
