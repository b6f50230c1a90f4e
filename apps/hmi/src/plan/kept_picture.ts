/** A picture of what seldom changes, larger than the window, moved and scaled while the reader pans and zooms, painted anew at rest. */

import type { Pixels } from './track_pixels';
import type { Window } from './track_painter';

const kMargin = 0.5; // on each side, in shares of the window
const kRestMs = 200;

export class KeptPicture {
  private bitmap: ImageBitmap | null = null;
  private window: Window | null = null;
  private key = '';
  private rest: ReturnType<typeof setTimeout> | null = null;

  /** `atRest` is called when the picture was shown scaled and should be painted sharp. */
  constructor(private readonly atRest: () => void) {}

  /** Draws the picture for this window; `plot` is asked only when key or window call for another one. */
  draw(context: CanvasRenderingContext2D, window: Window, key: string, plot: (pixels: Pixels) => void): void {
    if (this.window === null || this.bitmap === null || key !== this.key || !covers(this.window, window)) this.renew(window, key, plot);
    if (this.window === null || this.bitmap === null) return;
    const { left, top, width, height, resolution } = this.window;
    const scale = resolution / window.resolution;
    const [x, y] = [(left - window.left) / window.resolution, (window.top - top) / window.resolution];
    const moving = scale !== 1;
    const snap = (value: number): number => (moving ? value : Math.round(value * devicePixelRatio) / devicePixelRatio);
    context.imageSmoothingEnabled = false; // a copy of pixels: a third of the time, and at rest it is exact anyway
    context.drawImage(this.bitmap, snap(x), snap(y), width * scale, height * scale);
    if (moving) this.sharpenLater();
  }

  private renew(window: Window, key: string, plot: (pixels: Pixels) => void): void {
    const ratio = devicePixelRatio;
    const columns = Math.round(window.width * (1 + 2 * kMargin) * ratio);
    const rows = Math.round(window.height * (1 + 2 * kMargin) * ratio);
    const left = window.left - kMargin * window.width * window.resolution;
    const top = window.top + kMargin * window.height * window.resolution;
    const image = new ImageData(columns, rows);
    const inPixels = { left, top, width: columns, height: rows, resolution: window.resolution / ratio };
    plot({ window: inPixels, data: new Uint32Array(image.data.buffer) });
    const canvas = new OffscreenCanvas(columns, rows);
    canvas.getContext('2d', { willReadFrequently: true })?.putImageData(image, 0, 0);
    this.bitmap?.close();
    this.bitmap = canvas.transferToImageBitmap();
    this.key = key;
    this.window = { left, top, width: columns / ratio, height: rows / ratio, resolution: window.resolution };
  }

  private sharpenLater(): void {
    if (this.rest !== null) clearTimeout(this.rest);
    this.rest = setTimeout(() => {
      this.window = null;
      this.atRest();
    }, kRestMs);
  }
}

/** Whether the picture has all of the window, and is neither too coarse nor too fine for it. */
export function covers(picture: Window, window: Window): boolean {
  const ratio = picture.resolution / window.resolution;
  if (ratio < 0.5 || ratio > 2) return false;
  const right = (one: Window): number => one.left + one.width * one.resolution;
  const bottom = (one: Window): number => one.top - one.height * one.resolution;
  const slack = window.resolution;
  return (
    picture.left <= window.left + slack &&
    picture.top >= window.top - slack &&
    right(picture) >= right(window) - slack &&
    bottom(picture) <= bottom(window) + slack
  );
}
