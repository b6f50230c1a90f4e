/** Talks to `pos serve`. Every answer is read by its reader; every refusal becomes a `Refusal` that says what the server said. */

import type { MapDocument } from '../model/map_document';
import { readDocument } from '../model/map_document';
import type { Reader } from './check';
import {
  readCoverage,
  readDiff,
  readEvents,
  readFailure,
  readFindings,
  readInfo,
  readIntervals,
  readSaved,
  readState,
  type Failure,
} from './messages';
import { trackRows, type TrackRows } from './track_bytes';

export class Refusal extends Error {
  constructor(readonly failure: Failure) {
    super([failure.what, failure.key, failure.got && `got ${failure.got}`, failure.suggestion].filter(Boolean).join('; '));
    this.name = 'Refusal';
  }
}

export type Command =
  | { do: 'play' }
  | { do: 'pause' }
  | { do: 'seek'; stamp_s: number }
  | { do: 'speed'; speed: number }
  | { do: 'record'; on: boolean };

export interface TrackQuery {
  from_s?: number;
  points?: number;
  columns?: readonly string[];
}

export class Client {
  constructor(private readonly base: string) {}

  info = () => this.json('/api/info', readInfo);
  state = () => this.json('/api/state', readState);
  events = (after: number) => this.json(`/api/events?after=${after}&limit=10000`, readEvents);
  intervals = () => this.json('/api/intervals', readIntervals);
  command = (command: Command) => this.json('/api/command', readState, post(command));
  check = (map: MapDocument) => this.json('/api/map/check', readFindings, post(map));
  diff = (map: MapDocument) => this.json('/api/map/diff', readDiff, post(map));
  intervalsOf = (map: MapDocument) => this.json('/api/map/intervals', readIntervals, post(map));
  coverage = (map: MapDocument, roadway: string) =>
    this.json(`/api/map/coverage?roadway=${encodeURIComponent(roadway)}`, readCoverage, post(map));

  streamAddress(): string {
    return `${this.base}/api/stream`;
  }

  backgroundAddress(): string {
    return `${this.base}/api/map/background`;
  }

  async track(name: string, query: TrackQuery = {}): Promise<TrackRows> {
    const parameters = new URLSearchParams();
    if (query.from_s !== undefined) parameters.set('from_s', String(query.from_s));
    if (query.points !== undefined) parameters.set('points', String(query.points));
    if (query.columns !== undefined) parameters.set('columns', query.columns.join(','));
    const answer = await this.answer(`/api/tracks/${encodeURIComponent(name)}?${parameters}`);
    const names = (answer.headers.get('X-Pos-Columns') ?? '').split(',').map((column) => column.trim());
    return trackRows(await answer.arrayBuffer(), names.filter(Boolean));
  }

  async map(): Promise<{ map: MapDocument; version: string }> {
    const answer = await this.answer('/api/map');
    return { map: readDocument(await answer.json(), 'map'), version: answer.headers.get('ETag') ?? '' };
  }

  /** Saves; gives the new version. Throws a Refusal with status 412 when somebody else saved in between. */
  async save(map: MapDocument, version: string): Promise<string> {
    const answer = await this.answer('/api/map', {
      method: 'PUT',
      body: JSON.stringify(map),
      headers: { 'Content-Type': 'application/geo+json', 'If-Match': version },
    });
    const saved = readSaved(await answer.json(), 'saved');
    return answer.headers.get('ETag') ?? saved.version;
  }

  private async json<T>(path: string, reader: Reader<T>, init?: RequestInit): Promise<T> {
    return reader(await (await this.answer(path, init)).json(), '');
  }

  private async answer(path: string, init: RequestInit = {}): Promise<Response> {
    const answer = await fetch(this.base + path, { cache: 'no-store', ...init });
    if (answer.ok) return answer;
    throw new Refusal(failureOf(answer.status, await answer.text()));
  }
}

function post(body: unknown): RequestInit {
  return { method: 'POST', body: JSON.stringify(body), headers: { 'Content-Type': 'application/json' } };
}

function failureOf(status: number, body: string): Failure {
  try {
    return readFailure(JSON.parse(body), '').error;
  } catch {
    return { status, code: '', what: `HTTP ${status}`, place: '', key: '', got: '', expected: '', suggestion: '' };
  }
}
