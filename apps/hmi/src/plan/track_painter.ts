/** Draws one long track into a canvas: right level of detail, chunks in the window only, no pixel painted twice over. */

import { kChunk, levelFor, lowerBound, type Level, type PlanarTrack } from '../model/levels';

/** From map metres to canvas pixels: column = (x - left) / resolution, row = (top - y) / resolution. */
export interface Window {
  left: number;
  top: number;
  width: number;
  height: number;
  /** Metres a pixel. */
  resolution: number;
}

export interface TrackStyle {
  /** Colour of each class; `classOf` says which class a point has. Without it everything has the first colour. */
  colours: string[];
  classOf?: Uint8Array;
  widthPx: number;
  dash: number[];
}

export interface Span {
  first: number;
  end: number;
}

/** Draws the points `span.first` to `span.end` (indices of the track). */
export function paintTrack(
  context: CanvasRenderingContext2D,
  track: PlanarTrack,
  levels: Level[],
  span: Span,
  window: Window,
  style: TrackStyle,
): void {
  const level = levelFor(levels, window.resolution);
  const paths = style.colours.map(() => new Path2D());
  const seen = new Seen(window);
  const from = lowerBound(level.index, span.first);
  const to = lowerBound(level.index, span.end);
  for (let chunk = Math.floor(from / kChunk); chunk * kChunk < to; ++chunk) {
    if (outside(level.boxes, chunk, window)) continue;
    const end = Math.min(to, (chunk + 1) * kChunk + 1);
    addChunk(paths, seen, track, level.index, Math.max(from, chunk * kChunk), end, window, style.classOf);
  }
  context.lineWidth = style.widthPx;
  context.lineJoin = 'bevel';
  context.setLineDash(style.dash);
  style.colours.forEach((colour, index) => {
    context.strokeStyle = colour;
    context.stroke(paths[index]!);
  });
  context.setLineDash([]);
}

export function outside(boxes: Float64Array, chunk: number, window: Window): boolean {
  const right = window.left + window.width * window.resolution;
  const bottom = window.top - window.height * window.resolution;
  const at = 4 * chunk;
  return boxes[at]! > right || boxes[at + 2]! < window.left || boxes[at + 1]! > window.top || boxes[at + 3]! < bottom;
}

function addChunk(
  paths: Path2D[],
  seen: Seen,
  track: PlanarTrack,
  index: Uint32Array,
  from: number,
  end: number,
  window: Window,
  classOf: Uint8Array | undefined,
): void {
  let pen = -1; // class whose path stands at the last point
  let lastX = 0;
  let lastY = 0;
  let lastCell = -1;
  for (let i = from; i < end; ++i) {
    const at = index[i]!;
    const x = (track.x[at]! - window.left) / window.resolution;
    const y = (window.top - track.y[at]!) / window.resolution;
    const cell = seen.cell(x, y);
    if (i > from && !seen.repeats(lastCell, cell)) {
      const kind = classOf ? classOf[at]! : 0;
      const path = paths[kind]!;
      if (pen !== kind) path.moveTo(lastX, lastY);
      path.lineTo(x, y);
      pen = kind;
    } else {
      pen = -1;
    }
    lastX = x;
    lastY = y;
    lastCell = cell;
  }
}

/** Which pixels already have a line end in them: a step between two of them shows nothing new, as on the hundredth round of a track. */
class Seen {
  private readonly cells: Uint8Array;
  private readonly columns: number;
  private readonly rows: number;

  constructor(window: Window) {
    this.columns = Math.ceil(window.width) + 1;
    this.rows = Math.ceil(window.height) + 1;
    this.cells = new Uint8Array(this.columns * this.rows);
  }

  cell(x: number, y: number): number {
    if (x < 0 || y < 0 || x >= this.columns || y >= this.rows) return -1;
    return Math.floor(y) * this.columns + Math.floor(x);
  }

  /** Whether a step from cell to cell was painted already; marks it as painted. Long steps are always painted. */
  repeats(from: number, to: number): boolean {
    if (from < 0 || to < 0) return false;
    const both = this.cells[from] === 1 && this.cells[to] === 1;
    this.cells[from] = 1;
    this.cells[to] = 1;
    const rowsApart = Math.abs(Math.floor(from / this.columns) - Math.floor(to / this.columns));
    const columnsApart = Math.abs((from % this.columns) - (to % this.columns));
    return both && rowsApart <= 2 && columnsApart <= 2;
  }
}
