/** Rows of a track put into bins of time, so that a chart draws a thousand points whatever the track's length. */

import { lowerBound } from '../model/levels';

/** undefined: no row in this bin, the line goes on; null: the line is interrupted. */
export type Binned = (number | null | undefined)[];

export interface TimeBins {
  from: number;
  to: number;
  count: number;
}

export function binCentres(bins: TimeBins): number[] {
  const width = (bins.to - bins.from) / bins.count;
  return Array.from({ length: bins.count }, (_, index) => bins.from + (index + 0.5) * width);
}

/** The greatest value of each bin: a short peak is never lost. */
export function greatest(stamp: Float64Array, value: (row: number) => number | null, bins: TimeBins): Binned {
  return binned(stamp, bins, value, (before, now) => (before === null || before === undefined || now > before ? now : before));
}

/** The last value of each bin. */
export function latest(stamp: Float64Array, value: (row: number) => number | null, bins: TimeBins): Binned {
  return binned(stamp, bins, value, (_, now) => now);
}

function binned(
  stamp: Float64Array,
  bins: TimeBins,
  value: (row: number) => number | null,
  joined: (before: number | null | undefined, now: number) => number,
): Binned {
  const result: Binned = new Array<number | null | undefined>(bins.count).fill(undefined);
  const scale = bins.count / (bins.to - bins.from);
  for (let row = lowerBound(stamp, bins.from); row < stamp.length && stamp[row]! <= bins.to; ++row) {
    const bin = Math.min(bins.count - 1, Math.floor((stamp[row]! - bins.from) * scale));
    const now = value(row);
    if (now !== null) result[bin] = joined(result[bin], now);
    else if (result[bin] === undefined) result[bin] = null;
  }
  return result;
}
