/** A track in memory: columns as they came, places as doubles, levels of detail for drawing. */

import type { TrackRows } from '../protocol/track_bytes';
import { levelsOf, lowerBound, type Level, type PlanarTrack } from './levels';

export interface Track extends PlanarTrack {
  name: string;
  stamp: Float64Array;
  columns: Map<string, Float32Array>;
  levels: Level[];
}

/** What the interface asks for; a track that lacks one just has no such column. */
export const kColumns = [
  'x_m', 'y_m', 'z_m', 'yaw_rad', 'sigma_x_m', 'sigma_y_m', 'corr_x_y', 'speed_m_per_s', 'error_m', 'nis', 'roadway', 'chainage_m',
  'interval',
] as const; // prettier-ignore
export type Column = (typeof kColumns)[number];

export function trackOf(name: string, rows: TrackRows): Track {
  const x = new Float64Array(rows.columns.get('x_m') ?? []);
  const y = new Float64Array(rows.columns.get('y_m') ?? []);
  return { name, stamp: rows.stamp, columns: rows.columns, x, y, levels: levelsOf({ x, y }) };
}

export function lastStamp(track: Track): number | null {
  return track.stamp.length > 0 ? track.stamp[track.stamp.length - 1]! : null;
}

/** The track with the rows that are newer than its last one. */
export function appended(track: Track, rows: TrackRows): Track {
  const after = lastStamp(track);
  let first = 0;
  while (after !== null && first < rows.stamp.length && rows.stamp[first]! <= after) ++first;
  if (first === rows.stamp.length) return track;
  const columns = new Map<string, Float32Array>();
  for (const [name, values] of track.columns) {
    columns.set(name, joined(values, rows.columns.get(name)?.subarray(first), rows.stamp.length - first));
  }
  const stamp = new Float64Array(track.stamp.length + rows.stamp.length - first);
  stamp.set(track.stamp);
  stamp.set(rows.stamp.subarray(first), track.stamp.length);
  return trackOf(track.name, { stamp, columns, total: stamp.length });
}

function joined(before: Float32Array, after: Float32Array | undefined, count: number): Float32Array {
  const all = new Float32Array(before.length + count).fill(NaN);
  all.set(before);
  if (after) all.set(after, before.length);
  return all;
}

/** Row at or before a stamp; null before the first. Stamps since 1970 are doubles with steps of 0.2 us. */
export function rowAt(track: Track, stamp: number): number | null {
  const after = lowerBound(track.stamp, stamp + 1e-6);
  return after > 0 ? after - 1 : null;
}

/** A value of a row, null where it is not known. */
export function valueAt(track: Track, column: Column, row: number): number | null {
  const value = track.columns.get(column)?.[row];
  return value === undefined || Number.isNaN(value) ? null : value;
}
