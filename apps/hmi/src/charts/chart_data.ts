/** What each chart shows, taken from the tracks. */

import { lineOf, trackNames, type Context } from '../model/context';
import { valueAt, type Column, type Track } from '../model/track';
import { binCentres, greatest, latest, type Binned, type TimeBins } from './bins';
import type { ChartData, Level, Series } from './chart';

export type ChartKind = 'error' | 'sigma' | 'nis' | 'distance';
const kBins = 1000;
const kDrawnChambers = 40;

export interface Range {
  /** Seconds since the beginning. */
  from: number;
  to: number;
}

export function dataOf(context: Context, kind: ChartKind, origin: number, range: Range, roadway: number): ChartData {
  const bins: TimeBins = { from: origin + range.from, to: origin + range.to, count: kBins };
  const series = shownTracks(context, kind).flatMap((track): Series[] => {
    const values = kind === 'distance' ? chainages(track, bins, roadway) : figures(track, bins, kind);
    return values.some((value) => typeof value === 'number') ? [{ name: track.name, line: lineOf(context, track.name), values }] : [];
  });
  return { x: binCentres(bins).map((centre) => centre - origin), series, levels: levelsOf(context, kind, roadway) };
}

function shownTracks(context: Context, kind: ChartKind): Track[] {
  return trackNames(context)
    .filter((name) => !context.options.now.hidden.has(name) && (kind === 'distance' || name !== 'truth'))
    .flatMap((name) => context.session.tracks.get(name) ?? []);
}

function figures(track: Track, bins: TimeBins, kind: 'error' | 'sigma' | 'nis'): Binned {
  if (kind === 'sigma') {
    return greatest(track.stamp, (row) => length(valueAt(track, 'sigma_x_m', row), valueAt(track, 'sigma_y_m', row)), bins);
  }
  const column: Column = kind === 'error' ? 'error_m' : 'nis';
  return greatest(track.stamp, (row) => valueAt(track, column, row), bins);
}

function length(x: number | null, y: number | null): number | null {
  return x === null || y === null ? null : Math.hypot(x, y);
}

function chainages(track: Track, bins: TimeBins, roadway: number): Binned {
  const value = (row: number): number | null =>
    valueAt(track, 'roadway', row) === roadway ? valueAt(track, 'chainage_m', row) : null;
  return latest(track.stamp, value, bins);
}

function levelsOf(context: Context, kind: ChartKind, roadway: number): Level[] {
  if (kind === 'nis') return [{ value: 1, label: '1', dash: [6, 4] }];
  if (kind !== 'distance') return [];
  const id = roadwayIds(context)[roadway];
  const chambers = context.session.mine.chambers.filter((chamber) => chamber.roadway === id && Number.isFinite(chamber.chainage));
  if (chambers.length > kDrawnChambers) return [];
  return [...chambers].sort((a, b) => a.chainage - b.chainage).map((chamber) => ({ value: chamber.chainage, label: chamber.id, dash: [2, 4] }));
}

export function roadwayIds(context: Context): string[] {
  return [...context.session.mine.roadways.keys()];
}
