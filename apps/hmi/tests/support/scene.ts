/** A small mine and a drive through it, made by formulas: what the fake server tells. */

import { centrelineOf, placeAt } from '../../src/model/centreline';
import type { MapDocument } from '../../src/model/map_document';
import type { Info, LockInterval, State } from '../../src/protocol/messages';

export const kEnd = 120;
export const kRows = 1201;

const corners: [number, number, number][] = [[0, 0, 0], [300, 0, 0], [320, -20, 0], [320, -220, 0]];
export const mainLine = centrelineOf(corners, [null, -90, null, null]);

export function sceneMap(): MapDocument {
  const feature = (geometry: unknown, properties: Record<string, unknown>) => ({ type: 'Feature', geometry, properties });
  const chamber = (id: string, chainage: number) => {
    const { point } = placeAt(mainLine, chainage);
    return feature(
      { type: 'Point', coordinates: [...point] },
      { object: 'chamber', id, roadway: 'main', chainage_m: chainage, side: 'right', length_m: 10, depth_m: 3 },
    );
  };
  const anchor = (id: number, x: number, y: number) =>
    feature({ type: 'Point', coordinates: [x, y, 2] }, { object: 'anchor', id, survey_sigma_m: 0.02, wall: 'left' });
  const features = [
    feature(null, { object: 'map', schema: 2, name: 'scene', requirements: { anchors_visible: 2, range_limit_m: 80 } }),
    feature({ type: 'LineString', coordinates: corners }, { object: 'roadway', id: 'main', width_m: 5, height_m: 3.2, locked: true, arc_deg: [null, -90, null, null] }),
    feature({ type: 'LineString', coordinates: [[150, 0, 0], [210, 104, 0]] }, { object: 'roadway', id: 'branch', width_m: 5, height_m: 3.2 }),
    feature({ type: 'Point', coordinates: [150, 0, 0] }, { object: 'junction', id: 'J1', places: [{ roadway: 'main', chainage_m: 150 }, { roadway: 'branch', chainage_m: 0 }] }),
    chamber('c1', 100),
    chamber('c2', 220),
    chamber('c3', 400),
    anchor(1, 20, 2.5),
    anchor(2, 80, -2.5),
    anchor(3, 140, 2.5),
    anchor(4, 200, -2.5),
    anchor(5, 260, 2.5),
    anchor(6, 322, -60),
  ];
  return { type: 'FeatureCollection', features } as MapDocument;
}

export function sceneIntervals(): LockInterval[] {
  const ends = [0, 100, 220, 400, mainLine.chainage.at(-1)!];
  return ends.slice(1).map((to, index) => {
    const span = { roadway: 'main', from_m: ends[index]!, to_m: to, lane: null };
    return { id: `main-${index}`, label: `i_${index + 1}`, length_m: to - ends[index]!, spans: [span] };
  });
}

export type SceneMode = Info['mode'];

export function sceneInfo(mode: SceneMode, editable = true): Info {
  const timed = mode === 'run' || mode === 'replay';
  return {
    protocol: 1,
    pos_version: '0.1.0',
    mode,
    name: mode === 'map' ? '' : 'test drive',
    map: 'scene',
    map_editable: editable,
    first_s: timed ? 0 : null,
    last_s: timed ? kEnd : null,
    truth: true,
    estimators: mode === 'map' ? [] : [{ name: 'imm', type: 'seamless' }, { name: 'encoders', type: 'dead_reckoning' }],
    tracks: mode === 'map' ? [] : ['truth', 'imm', 'encoders'],
    columns: ['x_m', 'y_m', 'z_m', 'yaw_rad', 'sigma_x_m', 'sigma_y_m', 'corr_x_y', 'speed_m_per_s', 'error_m', 'nis', 'roadway', 'chainage_m', 'interval'],
    stale_after_s: 0.8,
    lost_after_s: 2,
  };
}

const kNoise: Record<string, number> = { truth: 0, imm: 0.15, encoders: 1.2 };

export interface Row {
  stamp: number;
  x: number;
  y: number;
  yaw: number;
  chainage: number;
  interval: number;
  error: number;
}

/** Where a track is at a moment: 3.6 m/s along the roadway, sideways by a slow wave as large as its error. */
export function rowAt(name: string, stamp: number): Row {
  const chainage = Math.min(3.6 * stamp, mainLine.chainage.at(-1)! - 1);
  const { point, along } = placeAt(mainLine, chainage);
  const grown = name === 'encoders' ? stamp / kEnd : 1;
  const error = (kNoise[name] ?? 0) * grown * Math.sin(0.7 * stamp + (name === 'imm' ? 0 : 1));
  const interval = sceneIntervals().findIndex((one) => chainage <= one.spans[0]!.to_m);
  return { stamp, x: point[0] - error * along[1], y: point[1] + error * along[0], yaw: Math.atan2(along[1], along[0]), chainage, interval, error: Math.abs(error) };
}

export function trackColumns(name: string, columns: string[], from: number, to: number): { stamp: number[]; columns: number[][] } {
  const rows: Row[] = [];
  for (let index = 0; index < kRows; ++index) {
    const stamp = (index * kEnd) / (kRows - 1);
    if (stamp >= from && stamp <= to) rows.push(rowAt(name, stamp));
  }
  const sigma = kNoise[name] || NaN;
  const value: Record<string, (row: Row) => number> = {
    x_m: (row) => row.x,
    y_m: (row) => row.y,
    z_m: () => 0,
    yaw_rad: (row) => row.yaw,
    sigma_x_m: () => sigma,
    sigma_y_m: () => sigma,
    corr_x_y: () => 0.2,
    speed_m_per_s: () => 3.6,
    error_m: (row) => row.error,
    nis: (row) => (name === 'truth' ? NaN : 1 + 0.5 * Math.sin(row.stamp)),
    roadway: () => 0,
    chainage_m: (row) => row.chainage,
    interval: (row) => row.interval,
  };
  return { stamp: rows.map((row) => row.stamp), columns: columns.map((column) => rows.map(value[column] ?? (() => NaN))) };
}

/** The state at a moment, without sources and anchors. */
export function sceneState(mode: SceneMode, stamp: number): State {
  const estimators = mode === 'map' ? [] : ['imm', 'encoders'].map((name) => estimatorState(name, stamp));
  const truth = rowAt('truth', stamp);
  const inside = rowAt('imm', stamp).interval;
  return {
    seq: 0,
    mode,
    playing: false,
    seeking: false,
    ended: false,
    speed: 1,
    stamp_s: mode === 'map' ? null : stamp,
    first_s: mode === 'map' ? null : 0,
    last_s: mode === 'live' || mode === 'map' ? null : kEnd,
    truth: mode === 'map' ? null : { x_m: truth.x, y_m: truth.y, z_m: 0, yaw_rad: truth.yaw },
    estimators,
    sources: [],
    anchors: [],
    locks: sceneIntervals().map((one, index) => ({
      id: one.id,
      label: one.label,
      state: index === inside ? 'held' : index === inside + 1 ? 'doubtful' : 'free',
      probability: index === inside ? 0.98 : 0,
    })),
    recording: mode === 'live' ? { on: false, file: null, measurements: 0, bytes: 0 } : null,
    refused_lines: 0,
  };
}

function estimatorState(name: string, stamp: number): State['estimators'][number] {
  const row = rowAt(name, stamp);
  const sigma = kNoise[name]!;
  const next = sceneIntervals()[row.interval + 1];
  const gnss = name === 'imm' ? 1 / (1 + Math.exp((stamp - 40) / 3)) : 0;
  return {
    name,
    type: name === 'imm' ? 'seamless' : 'dead_reckoning',
    stamp_s: stamp,
    age_s: 0.01,
    pose: { x_m: row.x, y_m: row.y, z_m: 0, yaw_rad: row.yaw },
    sigma: { x_m: sigma, y_m: sigma, yaw_rad: 0.02, corr_x_y: 0.2 },
    ellipse: { major_m: 1.1 * sigma, minor_m: 0.9 * sigma, angle_rad: row.yaw },
    speed_m_per_s: 3.6,
    error_m: row.error,
    nis: 1.1,
    verdicts: { applied: Math.round(50 * stamp), gated: Math.round(stamp) },
    modes: name === 'imm' ? [{ name: 'gnss', probability: gnss }, { name: 'uwb', probability: 1 - gnss }] : [],
    mode: name === 'imm' ? (gnss > 0.5 ? 'gnss' : 'uwb') : null,
    place: {
      state: 'decided',
      roadway: 'main',
      chainage_m: row.chainage,
      offset_m: 0.4,
      sigma_along_m: sigma,
      interval: sceneIntervals()[row.interval]!.label,
      interval_id: sceneIntervals()[row.interval]!.id,
      lock: 'held',
      next: next ? { id: next.id, label: next.label, entry: true, distance_m: 20, in_s: 6 } : null,
    },
  };
}
