/** Speaks docs/formats/serve.md from a made-up scene, and does what a test tells it: cut a source, reject an anchor, save in between. */

import { createServer, type IncomingMessage, type Server, type ServerResponse } from 'node:http';
import { readFile } from 'node:fs/promises';
import { extname, join, normalize } from 'node:path';
import type { AddressInfo } from 'node:net';
import type { MapDocument } from '../../src/model/map_document';
import type { RunEvent, State } from '../../src/protocol/messages';
import { trackBytes } from '../../src/protocol/track_bytes';
import { kEnd, sceneInfo, sceneIntervals, sceneMap, sceneState, trackColumns, type SceneMode } from './scene';

const kTypes: Record<string, string> = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css' };

export class FakeServer {
  stamp = 0;
  playing = false;
  speed = 1;
  recording = false;
  /** Seconds since each source sent something; grows while it is cut. */
  cut = new Map<string, number>();
  rejected = new Set<number>();
  map: MapDocument = sceneMap();
  version = 1;
  events: RunEvent[] = [];
  commands: unknown[] = [];
  bigTrack: ArrayBuffer | null = null;
  /** The background picture, as SVG. */
  background: string | null = null;

  private readonly streams = new Set<ServerResponse>();
  private readonly server: Server;
  private timers: NodeJS.Timeout[] = [];
  private seq = 0;
  private told = '';

  constructor(
    readonly mode: SceneMode,
    private readonly pages: string,
  ) {
    this.server = createServer((request, response) => {
      this.answer(request, response).catch((error: unknown) => refuse(response, 500, 'internal', String(error)));
    });
  }

  async start(): Promise<string> {
    await new Promise<void>((done) => this.server.listen(0, '127.0.0.1', done));
    this.timers = [setInterval(() => this.tick(0.05), 50), setInterval(() => this.send('heartbeat', { n: ++this.seq }), 1000)];
    return `http://127.0.0.1:${(this.server.address() as AddressInfo).port}/`;
  }

  async stop(): Promise<void> {
    this.timers.forEach(clearInterval);
    this.streams.forEach((stream) => stream.destroy());
    this.server.closeAllConnections();
    await new Promise((done) => this.server.close(done));
  }

  tell(kind: string, sensor = '', detail = ''): void {
    const event: RunEvent = { n: this.events.length, stamp_s: this.stamp, estimator: '', kind, sensor, detail };
    this.events.push(event);
    this.send('event', event);
  }

  private tick(seconds: number): void {
    const moving = this.mode === 'live' || (this.playing && this.mode !== 'map');
    if (moving) this.stamp = Math.min(kEnd, this.stamp + seconds * (this.mode === 'live' ? 1 : this.speed));
    for (const [name, age] of this.cut) this.cut.set(name, age + seconds);
    const state = this.state();
    const told = JSON.stringify({ ...state, seq: 0 });
    if (told !== this.told) this.send('state', state);
    this.told = told;
  }

  state(): State {
    const state = sceneState(this.mode, this.stamp);
    Object.assign(state, { seq: ++this.seq, playing: this.playing, speed: this.speed });
    if (this.mode !== 'live' && this.mode !== 'replay') return state;
    state.sources = ['uwb', 'imu', 'gnss'].map((name) => this.source(name));
    state.anchors = [1, 2, 3, 4, 5, 6].map((id) => this.anchor(id));
    if (state.recording) Object.assign(state.recording, { on: this.recording, file: this.recording ? 'log.rawlog' : null });
    return state;
  }

  private source(name: string): State['sources'][number] {
    const age = this.cut.get(name) ?? 0.02;
    const state = age < 0.8 ? 'connected' : age < 2 ? 'stale' : 'lost';
    return { name, kind: name, state, age_s: age, period_s: 0.02, count: 100, gated_ratio: 0.02, refused: 0, why: '' };
  }

  private anchor(id: number): State['anchors'][number] {
    const near = Math.abs(id - 1 - this.stamp / 17) < 2;
    const seen = !near ? 'not_seen' : this.rejected.has(id) ? 'rejected' : 'seen';
    const state = near ? 'connected' : 'waiting';
    return { id, state, age_s: near ? 0.05 : null, period_s: near ? 0.1 : null, count: 10, gated_ratio: seen === 'rejected' ? 0.9 : 0.01, seen };
  }

  private send(name: string, data: unknown): void {
    for (const stream of this.streams) stream.write(`event: ${name}\ndata: ${JSON.stringify(data)}\n\n`);
  }

  private async answer(request: IncomingMessage, response: ServerResponse): Promise<void> {
    const url = new URL(request.url ?? '/', 'http://127.0.0.1');
    const path = url.pathname;
    if (!path.startsWith('/api/')) return this.file(path, response);
    if (path === '/api/stream') return this.stream(response);
    if (path.startsWith('/api/tracks/')) return this.track(path.slice(12), url.searchParams, response);
    const body = request.method === 'GET' ? '' : await bodyOf(request);
    if (path === '/api/info') return json(response, { ...sceneInfo(this.mode) });
    if (path === '/api/state') return json(response, this.state());
    if (path === '/api/events') return json(response, { events: this.events, total: this.events.length });
    if (path === '/api/intervals' || path === '/api/map/intervals') return json(response, { intervals: sceneIntervals() });
    if (path === '/api/command') return this.command(JSON.parse(body) as Record<string, unknown>, response);
    if (path === '/api/map' && request.method === 'PUT') return this.save(request, body, response);
    if (path === '/api/map') return json(response, this.map, { ETag: this.tag() });
    if (path === '/api/map/check') return json(response, findingsOf(JSON.parse(body) as MapDocument));
    if (path === '/api/map/coverage') return json(response, coverageOf(JSON.parse(body) as MapDocument, url.searchParams));
    if (path === '/api/map/diff') return json(response, diffOf(this.map, JSON.parse(body) as MapDocument));
    if (path === '/api/map/background' && this.background !== null) {
      response.writeHead(200, { 'Content-Type': 'image/svg+xml' });
      response.end(this.background);
      return;
    }
    refuse(response, 404, 'not_found', `there is no ${path}`);
  }

  private tag(): string {
    return `"v${this.version}"`;
  }

  private stream(response: ServerResponse): void {
    response.writeHead(200, { 'Content-Type': 'text/event-stream', 'Cache-Control': 'no-store' });
    this.streams.add(response);
    response.on('close', () => this.streams.delete(response));
    response.write(`event: state\ndata: ${JSON.stringify(this.state())}\n\n`);
  }

  private track(name: string, query: URLSearchParams, response: ServerResponse): void {
    const columns = (query.get('columns') ?? 'x_m,y_m').split(',');
    if (this.bigTrack && name === 'imm') return binary(response, this.bigTrack, ['x_m', 'y_m', 'error_m']);
    const known = this.mode === 'run' ? kEnd : this.stamp;
    const rows = trackColumns(name, columns, Number(query.get('from_s') ?? -1), Math.min(known, Number(query.get('to_s') ?? 1e9)));
    binary(response, trackBytes(rows.stamp, rows.columns), columns);
  }

  private command(command: Record<string, unknown>, response: ServerResponse): void {
    this.commands.push(command);
    if (command['do'] === 'play') this.playing = true;
    if (command['do'] === 'pause') this.playing = false;
    if (command['do'] === 'seek') this.stamp = Number(command['stamp_s']);
    if (command['do'] === 'speed') this.speed = Number(command['speed']);
    if (command['do'] === 'record') {
      this.recording = command['on'] === true;
      this.tell(this.recording ? 'recording_on' : 'recording_off');
    }
    json(response, this.state());
  }

  private save(request: IncomingMessage, body: string, response: ServerResponse): void {
    if (request.headers['if-match'] !== this.tag()) return refuse(response, 412, 'conflict', 'the file is no longer that version');
    this.map = JSON.parse(body) as MapDocument;
    this.version += 1;
    json(response, { version: `v${this.version}` }, { ETag: this.tag() });
  }

  private async file(path: string, response: ServerResponse): Promise<void> {
    const name = normalize(path === '/' ? '/index.html' : path);
    const bytes = await readFile(join(this.pages, name)).catch(() => null);
    if (bytes === null) return refuse(response, 404, 'not_found', path);
    response.writeHead(200, { 'Content-Type': kTypes[extname(name)] ?? 'application/octet-stream' });
    response.end(bytes);
  }
}

function json(response: ServerResponse, value: unknown, headers: Record<string, string> = {}): void {
  response.writeHead(200, { 'Content-Type': 'application/json', ...headers });
  response.end(JSON.stringify(value));
}

function binary(response: ServerResponse, bytes: ArrayBuffer, columns: string[]): void {
  response.writeHead(200, { 'Content-Type': 'application/octet-stream', 'X-Pos-Columns': columns.join(',') });
  response.end(new Uint8Array(bytes));
}

function refuse(response: ServerResponse, status: number, code: string, what: string): void {
  response.writeHead(status, { 'Content-Type': 'application/json' });
  response.end(JSON.stringify({ error: { status, code, what, place: '', key: '', got: '', expected: '', suggestion: '' } }));
}

async function bodyOf(request: IncomingMessage): Promise<string> {
  const parts: Buffer[] = [];
  for await (const part of request) parts.push(part as Buffer);
  return Buffer.concat(parts).toString('utf8');
}

function findingsOf(map: MapDocument): unknown {
  const far = map.features.filter((feature) => feature.properties.object === 'anchor' && Math.abs(Number((feature.geometry?.coordinates as number[])[1])) > 400);
  const findings = far.map((feature) => {
    const [x, y] = feature.geometry!.coordinates as number[];
    const place = { x_m: x, y_m: y, z_m: 0 };
    return { severity: 'error', check: 'anchor_outside', what: `anchor ${String(feature.properties['id'])} is in the rock`, remedy: 'move it', objects: [String(feature.properties['id'])], place };
  });
  return { findings, remarks: [] };
}

function coverageOf(map: MapDocument, query: URLSearchParams): unknown {
  const anchors = map.features.filter((feature) => feature.properties.object === 'anchor').map((feature) => feature.geometry!.coordinates as number[]);
  const chainage = Array.from({ length: 150 }, (_, index) => 2 * index);
  const count = chainage.map((at) => anchors.filter((anchor) => Math.hypot(anchor[0]! - at, anchor[1]!) < 80).length);
  const along = count.map((seen) => (seen > 0 ? 0.1 / seen : null));
  const across = count.map((seen) => (seen > 1 ? 0.3 / seen : null));
  return { roadways: [{ roadway: query.get('roadway') ?? 'main', chainage_m: chainage, anchors: count, along_m: along, across_m: across }] };
}

function diffOf(before: MapDocument, after: MapDocument): unknown {
  const names = (map: MapDocument): Map<string, string> =>
    new Map(map.features.map((feature) => [`${feature.properties.object} ${String(feature.properties['id'] ?? '')}`.trim(), JSON.stringify(feature)]));
  const [old, now] = [names(before), names(after)];
  const change = (kind: string, name: string) => ({ kind, object: name, key: '', before: '', after: '', words: `${kind} ${name}` });
  const added = [...now.keys()].filter((name) => !old.has(name)).map((name) => change('added', name));
  const removed = [...old.keys()].filter((name) => !now.has(name)).map((name) => change('removed', name));
  const changed = [...now.keys()].filter((name) => old.has(name) && old.get(name) !== now.get(name)).map((name) => change('changed', name));
  return { changes: [...added, ...removed, ...changed] };
}
