/** Classes of track points, one colour each. */

import type { Track } from '../model/track';
import type { ColourBy } from '../model/view_options';

/** Upper limits of the error classes, m; the last class has none. */
export const kErrorLimits = [0.3, 0.5, 1, 2, 5] as const;

export function classesOf(track: Track, colourBy: ColourBy, colours: number): Uint8Array | null {
  if (colourBy === 'estimator') return null;
  const values = track.columns.get(colourBy === 'error' ? 'error_m' : 'interval');
  if (!values) return null;
  const classes = new Uint8Array(values.length);
  for (let i = 0; i < values.length; ++i) classes[i] = colourBy === 'error' ? errorClass(values[i]!) : zoneClass(values[i]!, colours);
  return classes;
}

function errorClass(error: number): number {
  const found = kErrorLimits.findIndex((limit) => error < limit);
  return found < 0 ? kErrorLimits.length : found;
}

/** Neighbouring intervals get different colours; points outside every interval the last one. */
function zoneClass(interval: number, colours: number): number {
  return Number.isNaN(interval) || interval < 0 ? colours - 1 : interval % (colours - 1);
}
