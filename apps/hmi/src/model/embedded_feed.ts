/** The feed of a run that lies in the page itself: what `/api/` would answer, put together by `pos report` (README.md). */

import { list, number, oneOf, orNull, shape, text } from '../protocol/check';
import type { Command } from '../protocol/client';
import {
  readEvent,
  readInfo,
  readIntervals,
  readLockState,
  type EstimatorNow,
  type Info,
  type LockInterval,
  type LockState,
  type RunEvent,
  type State,
} from '../protocol/messages';
import { trackRows, type TrackRows } from '../protocol/track_bytes';
import { ellipseOf } from '../plan/ellipse';
import type { Feed, FeedListener } from './feed';
import { lowerBound } from './levels';
import { readDocument, type MapDocument } from './map_document';
import { rowAt, trackOf, valueAt, type Column, type Track } from './track';

const kPeriodMs = 50;

/** State of every interval from a moment on, in the order of `intervals`. */
const readLockChange = shape({ stamp_s: number, states: list(readLockState) });

const readEmbedded = shape({
  format: oneOf('pos.viewer/1'),
  info: readInfo,
  map: orNull(readDocument),
  intervals: (value: unknown, path: string) => readIntervals({ intervals: value ?? [] }, path).intervals,
  events: list(readEvent),
  tracks: list(shape({ name: text, columns: list(text), base64: text })),
  locks: (value: unknown, path: string) => list(readLockChange)(value ?? [], path),
  background: orNull(text),
});

export function embeddedFeed(json: string): Feed {
  return new EmbeddedFeed(readEmbedded(JSON.parse(json), 'run'));
}

class EmbeddedFeed implements Feed {
  readonly info: Info;
  readonly map: MapDocument | null;
  readonly intervals: LockInterval[];
  readonly background: string | null;
  private readonly rows: Map<string, TrackRows>;
  private readonly tracks: Map<string, Track>;
  private readonly told: RunEvent[];
  private readonly lockChanges: { stamp_s: number; states: LockState[] }[];
  private readonly lockStamps: number[];
  private stamp: number;
  private playing = false;
  private speed = 1;
  private seq = 0;
  private tell: () => void = () => undefined;

  constructor(run: ReturnType<typeof readEmbedded>) {
    this.rows = new Map(run.tracks.map((track) => [track.name, trackRows(bytesOf(track.base64), track.columns)]));
    this.tracks = new Map([...this.rows].map(([name, rows]) => [name, trackOf(name, rows)]));
    const stamps = [...this.tracks.values()].flatMap((track) => [track.stamp[0], track.stamp.at(-1)]).filter((stamp) => stamp !== undefined);
    const [first, last] = [run.info.first_s ?? Math.min(...stamps), run.info.last_s ?? Math.max(...stamps)];
    this.info = { ...run.info, mode: 'run', map_editable: false, first_s: first, last_s: last };
    this.map = run.map;
    this.intervals = run.intervals;
    this.told = run.events;
    this.lockChanges = run.locks;
    this.lockStamps = run.locks.map((change) => change.stamp_s);
    this.background = run.background;
    this.stamp = first;
  }

  async track(name: string): Promise<TrackRows> {
    return this.rows.get(name) ?? { stamp: new Float64Array(), columns: new Map(), total: 0 };
  }

  async events(after: number): Promise<RunEvent[]> {
    return this.told.filter((event) => event.n >= after);
  }

  async command(command: Command): Promise<void> {
    if (command.do === 'play') {
      if (this.stamp >= this.info.last_s!) this.stamp = this.info.first_s!;
      this.playing = true;
    } else if (command.do === 'pause') this.playing = false;
    else if (command.do === 'seek') this.stamp = command.stamp_s;
    else if (command.do === 'speed') this.speed = command.speed;
    this.tell();
  }

  listen(listener: FeedListener): () => void {
    this.tell = () => listener.state(this.state());
    this.tell();
    let before = performance.now();
    const timer = setInterval(() => {
      listener.alive();
      const now = performance.now();
      this.advance((now - before) / 1000);
      before = now;
    }, kPeriodMs);
    return () => clearInterval(timer);
  }

  private advance(seconds: number): void {
    if (!this.playing) return;
    this.stamp = Math.min(this.info.last_s!, this.stamp + seconds * this.speed);
    if (this.stamp >= this.info.last_s!) this.playing = false;
    this.tell();
  }

  private state(): State {
    const truth = this.tracks.get('truth');
    const { first_s, last_s } = this.info;
    const locks = this.locksNow();
    return {
      seq: ++this.seq,
      mode: 'run',
      playing: this.playing,
      seeking: false,
      ended: this.stamp >= last_s!,
      speed: this.speed,
      stamp_s: this.stamp,
      first_s,
      last_s,
      truth: truth ? poseAt(truth, rowAt(truth, this.stamp)) : null,
      estimators: this.info.estimators.map(({ name, type }, index) => this.estimator(name, type, index === 0 ? locks : [])),
      sources: [],
      anchors: [],
      locks: this.intervals.map(({ id, label }, index) => ({ id, label, state: locks[index] ?? 'unknown', probability: null })),
      recording: null,
      refused_lines: 0,
    };
  }

  /** Those of the first estimator. */
  private locksNow(): LockState[] {
    return this.lockChanges[lowerBound(this.lockStamps, this.stamp + 1e-6) - 1]?.states ?? [];
  }

  private estimator(name: string, type: string, locks: LockState[]): EstimatorNow {
    const track = this.tracks.get(name);
    const row = track ? rowAt(track, this.stamp) : null;
    const at = (column: Column): number | null => (track && row !== null ? valueAt(track, column, row) : null);
    const [sx, sy, corr] = [at('sigma_x_m'), at('sigma_y_m'), at('corr_x_y')];
    const stamp = track && row !== null ? track.stamp[row]! : null;
    const ellipse = sx === null || sy === null ? null : ellipseOf(sx * sx, (corr ?? 0) * sx * sy, sy * sy, 1);
    return {
      name,
      type,
      stamp_s: stamp,
      age_s: stamp === null ? null : this.stamp - stamp,
      pose: track ? poseAt(track, row) : null,
      sigma: sx === null || sy === null ? null : { x_m: sx, y_m: sy, yaw_rad: null, corr_x_y: corr },
      ellipse: ellipse && { major_m: ellipse.major, minor_m: ellipse.minor, angle_rad: ellipse.angle },
      speed_m_per_s: at('speed_m_per_s'),
      error_m: at('error_m'),
      nis: at('nis'),
      verdicts: null,
      modes: [],
      mode: null,
      place: this.place(at('roadway'), at('chainage_m'), at('interval'), locks),
    };
  }

  private place(roadway: number | null, chainage: number | null, interval: number | null, locks: LockState[]): EstimatorNow['place'] {
    const roadways = this.map?.features.filter((feature) => feature.properties.object === 'roadway') ?? [];
    const id = roadway === null ? undefined : roadways[roadway]?.properties['id'];
    if (id === undefined || chainage === null) return null;
    const named = interval === null ? undefined : this.intervals[interval];
    return {
      state: 'decided',
      roadway: String(id),
      chainage_m: chainage,
      offset_m: null,
      sigma_along_m: null,
      interval: named?.label ?? null,
      interval_id: named?.id ?? null,
      lock: interval === null ? null : (locks[interval] ?? null),
      next: null,
    };
  }
}

function poseAt(track: Track, row: number | null): State['truth'] {
  if (row === null) return null;
  return { x_m: track.x[row]!, y_m: track.y[row]!, z_m: valueAt(track, 'z_m', row), yaw_rad: valueAt(track, 'yaw_rad', row) };
}

function bytesOf(base64: string): ArrayBuffer {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes.buffer;
}
