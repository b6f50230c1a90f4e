/** What is known now, and who wants to hear of it. One session for the whole life of the page. */

import type { Command } from '../protocol/client';
import type { RunEvent, State } from '../protocol/messages';
import type { Feed } from './feed';
import { mineOf, type Mine } from './mine';
import { appended, lastStamp, trackOf, type Track } from './track';

export type Topic = 'state' | 'tracks' | 'events' | 'mine' | 'link' | 'failure';

const kTrackPeriodMs = 500;
const kSilentAfterMs = 2500;

export class Session {
  state: State | null = null;
  tracks = new Map<string, Track>();
  events: RunEvent[] = [];
  mine: Mine;
  /** Seconds without a sign of life; null while everything is well. */
  silentFor: number | null = null;
  /** What was refused last, null while all is well. */
  failure: unknown = null;

  private readonly listeners = new Map<Topic, Set<() => void>>();
  private lastSign = performance.now();
  private loading = false;

  constructor(readonly feed: Feed) {
    this.mine = feed.map ? mineOf(feed.map, feed.intervals) : emptyMine();
  }

  on(topic: Topic, listener: () => void): () => void {
    const set = this.listeners.get(topic) ?? new Set();
    this.listeners.set(topic, set.add(listener));
    return () => set.delete(listener);
  }

  async start(): Promise<void> {
    this.feed.listen({
      state: (state) => this.take(state),
      event: (event) => this.note(event),
      reset: () => void this.reload(),
      alive: () => this.sign(),
    });
    await this.reload();
    setInterval(() => this.watch(), 500);
    if (this.feed.info.mode === 'replay' || this.feed.info.mode === 'live') setInterval(() => void this.grow(), kTrackPeriodMs);
  }

  async command(command: Command): Promise<void> {
    try {
      await this.feed.command(command);
      this.fail(null);
    } catch (error) {
      this.fail(error);
    }
  }

  fail(error: unknown): void {
    this.failure = error;
    this.tell('failure');
  }

  private take(state: State): void {
    this.state = state;
    this.tell('state');
  }

  private note(event: RunEvent): void {
    const last = this.events[this.events.length - 1];
    if (last && event.n <= last.n) return;
    this.events.push(event);
    this.tell('events');
  }

  private sign(): void {
    this.lastSign = performance.now();
    if (this.silentFor === null) return;
    this.silentFor = null;
    this.tell('link');
  }

  private watch(): void {
    if (this.feed.info.mode === 'run' && this.feed.info.columns.length === 0) return;
    const silence = performance.now() - this.lastSign;
    if (silence < kSilentAfterMs) return;
    this.silentFor = Math.round(silence / 1000);
    this.tell('link');
  }

  private async reload(): Promise<void> {
    try {
      this.events = await this.feed.events(0);
      this.tell('events');
      for (const name of this.feed.info.tracks) this.tracks.set(name, trackOf(name, await this.feed.track(name, null)));
      this.tell('tracks');
    } catch (error) {
      this.fail(error);
    }
  }

  /** Asks for what was added to the tracks. */
  private async grow(): Promise<void> {
    if (this.loading) return;
    this.loading = true;
    try {
      for (const [name, track] of this.tracks) {
        const longer = appended(track, await this.feed.track(name, lastStamp(track)));
        if (longer === track) continue;
        this.tracks.set(name, longer);
        this.tell('tracks');
      }
    } catch (error) {
      if (this.silentFor === null) this.fail(error);
    } finally {
      this.loading = false;
    }
  }

  private tell(topic: Topic): void {
    this.listeners.get(topic)?.forEach((listener) => listener());
  }
}

function emptyMine(): Mine {
  return mineOf({ type: 'FeatureCollection', features: [] }, []);
}
