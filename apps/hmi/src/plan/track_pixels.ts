/** Sets the pixels of a very long track one by one: a path of a hundred thousand strokes takes twenty times as long. */

import { kChunk, levelFor, lowerBound, type Level, type PlanarTrack } from '../model/levels';
import { outside, type Span, type Window } from './track_painter';

/** A picture; `window.width` and `height` are its columns and rows. */
export interface Pixels {
  window: Window;
  data: Uint32Array;
}

export interface PixelStyle {
  /** Colour of each class as the memory has it: alpha, blue, green, red from the highest byte down. */
  colours: Uint32Array;
  classOf: Uint8Array | null;
}

export function plotTrack(pixels: Pixels, track: PlanarTrack, levels: Level[], span: Span, style: PixelStyle): void {
  const { window } = pixels;
  const level = levelFor(levels, window.resolution);
  const from = lowerBound(level.index, span.first);
  const to = lowerBound(level.index, span.end);
  for (let chunk = Math.floor(from / kChunk); chunk * kChunk < to; ++chunk) {
    if (outside(level.boxes, chunk, window)) continue;
    plotRows(pixels, track, level.index, Math.max(from, chunk * kChunk), Math.min(to, (chunk + 1) * kChunk + 1), style);
  }
}

function plotRows(pixels: Pixels, track: PlanarTrack, index: Uint32Array, from: number, end: number, style: PixelStyle): void {
  const { left, top, resolution } = pixels.window;
  let x0 = NaN;
  let y0 = NaN;
  for (let i = from; i < end; ++i) {
    const at = index[i]!;
    const x1 = (track.x[at]! - left) / resolution;
    const y1 = (top - track.y[at]!) / resolution;
    if (i > from) plotLine(pixels, x0, y0, x1, y1, style.colours[style.classOf ? style.classOf[at]! : 0]!);
    x0 = x1;
    y0 = y1;
  }
}

/** A line two pixels wide, from middle to middle in steps of at most one pixel. */
function plotLine({ window, data }: Pixels, x0: number, y0: number, x1: number, y1: number, colour: number): void {
  const { width, height } = window;
  const far = Math.max(Math.abs(x1 - x0), Math.abs(y1 - y0));
  if (Math.max(x0, x1) < 0 || Math.min(x0, x1) >= width || Math.max(y0, y1) < 0 || Math.min(y0, y1) >= height) return;
  const steps = Math.max(1, Math.ceil(far));
  const dx = (x1 - x0) / steps;
  const dy = (y1 - y0) / steps;
  for (let step = 1; step <= steps; ++step) {
    const column = Math.round(x0 + step * dx);
    const row = Math.round(y0 + step * dy);
    if (column < 1 || row < 1 || column >= width || row >= height) continue;
    const at = row * width + column;
    data[at] = colour;
    data[at - 1] = colour;
    data[at - width] = colour;
    data[at - width - 1] = colour;
  }
}

/** A colour of the style sheet, "#1b7837", with an opacity from 0 to 1. */
export function pixelColour(hex: string, opacity: number): number {
  const digits = /^#([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})$/i.exec(hex);
  const [red, green, blue] = digits ? digits.slice(1).map((two) => parseInt(two, 16)) : [0, 0, 0];
  return ((Math.round(255 * opacity) << 24) | (blue! << 16) | (green! << 8) | red!) >>> 0;
}
