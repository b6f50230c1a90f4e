/**
 * Levels of detail of a long track, for drawing a million points in a few milliseconds.
 *
 * Level 0 has every point. A coarser level keeps those points of the one before that are at least its spacing from the last one kept.
 * Spacings double, so a point that is left out lies within two spacings of a kept one: under two pixels, the width of the line, in a
 * drawing that takes the coarsest level with a spacing of at most a pixel. Points lie in chunks with bounding boxes; a drawing skips the
 * chunks outside the window.
 */

export const kChunk = 512;

export interface Level {
  /** Smallest distance between kept neighbours, m; 0 for all points. */
  spacing: number;
  /** Indices into the track's arrays, growing. */
  index: Uint32Array;
  /** minX, minY, maxX, maxY of each chunk (with the first point of the next one, so that lines across are inside). */
  boxes: Float64Array;
}

export interface PlanarTrack {
  x: Float64Array;
  y: Float64Array;
}

export function levelsOf(track: PlanarTrack, step = 0.05): Level[] {
  const all = new Uint32Array(track.x.length);
  for (let i = 0; i < all.length; ++i) all[i] = i;
  const levels = [level(track, all, 0)];
  for (let spacing = step; ; spacing *= 2) {
    const finer = levels[levels.length - 1]!;
    const kept = thinned(track, finer.index, spacing);
    if (kept.length > finer.index.length * 0.8) {
      if (kept.length <= 2 * kChunk || spacing > 1e4) return levels;
      continue; // hardly coarser: not worth its memory
    }
    levels.push(level(track, kept, spacing));
    if (kept.length <= 2 * kChunk) return levels;
  }
}

function level(track: PlanarTrack, index: Uint32Array, spacing: number): Level {
  return { spacing, index, boxes: boxesOf(track, index) };
}

function thinned(track: PlanarTrack, index: Uint32Array, spacing: number): Uint32Array {
  const kept = new Uint32Array(index.length);
  const limit = spacing * spacing;
  let count = 0;
  let lastX = NaN;
  let lastY = NaN;
  for (let i = 0; i < index.length; ++i) {
    const at = index[i]!;
    const x = track.x[at]!;
    const y = track.y[at]!;
    const dx = x - lastX;
    const dy = y - lastY;
    const near = dx * dx + dy * dy < limit; // false for the first point: NaN
    if (near && i !== index.length - 1) continue;
    kept[count++] = at;
    lastX = x;
    lastY = y;
  }
  return kept.slice(0, count);
}

function boxesOf(track: PlanarTrack, index: Uint32Array): Float64Array {
  const chunks = Math.ceil(index.length / kChunk);
  const boxes = new Float64Array(4 * chunks);
  for (let chunk = 0; chunk < chunks; ++chunk) {
    const end = Math.min(index.length, (chunk + 1) * kChunk + 1);
    let [minX, minY, maxX, maxY] = [Infinity, Infinity, -Infinity, -Infinity];
    for (let i = chunk * kChunk; i < end; ++i) {
      const x = track.x[index[i]!]!;
      const y = track.y[index[i]!]!;
      if (x < minX) minX = x;
      if (x > maxX) maxX = x;
      if (y < minY) minY = y;
      if (y > maxY) maxY = y;
    }
    boxes.set([minX, minY, maxX, maxY], 4 * chunk);
  }
  return boxes;
}

/** The coarsest level whose spacing is not more than a pixel. */
export function levelFor(levels: Level[], metresPerPixel: number): Level {
  let best = levels[0]!;
  for (const candidate of levels) if (candidate.spacing <= metresPerPixel) best = candidate;
  return best;
}

/** First position in a growing array whose value is not below `value`. */
export function lowerBound(values: ArrayLike<number>, value: number): number {
  let low = 0;
  let high = values.length;
  while (low < high) {
    const middle = (low + high) >>> 1;
    if (values[middle]! < value) low = middle + 1;
    else high = middle;
  }
  return low;
}
