/**
 * Which rows of a track are drawn how. Of a long track all but the ends that move with time go into a picture that is kept from frame to
 * frame; the ends, at most two blocks, are drawn anew.
 */

import type { Span } from './track_painter';

export interface Part extends Span {
  /** Drawn faintly: what the vehicle has yet to drive. */
  future: boolean;
  kept: boolean;
}

const kBlock = 2048;
const kLong = 20000;

/** `first` and `end` bound what is shown up to now; with `showFuture` the rest follows faintly. */
export function partsOf(rows: number, first: number, end: number, showFuture: boolean): Part[] {
  const from = Math.max(0, first);
  const joint = Math.max(from, end - 1); // the future begins at the last row of the past
  if (rows < kLong) {
    const past = { first: from, end, future: false, kept: false };
    return showFuture && joint < rows ? [{ first: joint, end: rows, future: true, kept: false }, past] : [past];
  }
  const low = Math.min(end, Math.ceil(from / kBlock) * kBlock);
  const high = Math.max(low, Math.floor(end / kBlock) * kBlock);
  const ahead = Math.min(rows, Math.max(joint, high + kBlock));
  const parts: Part[] = [
    { first: ahead, end: showFuture ? rows : ahead, future: true, kept: true },
    { first: joint, end: showFuture ? ahead + 1 : joint, future: true, kept: false },
    { first: low, end: high, future: false, kept: true },
    { first: from, end: low + 1, future: false, kept: false },
    { first: Math.max(from, high - 1), end, future: false, kept: false },
  ];
  return parts.filter((part) => part.end - part.first > 1);
}
