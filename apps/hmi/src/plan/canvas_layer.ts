/** An OpenLayers layer with one canvas that a function paints anew for every frame. */

import Layer from 'ol/layer/Layer';
import type { FrameState } from 'ol/Map';
import type { Window } from './track_painter';

export type Painter = (context: CanvasRenderingContext2D, window: Window) => void;

export class CanvasLayer extends Layer {
  private readonly canvas = document.createElement('canvas');

  constructor(
    private readonly painter: Painter,
    zIndex: number,
  ) {
    super({ zIndex });
    this.canvas.className = 'ol-layer';
    this.canvas.style.position = 'absolute';
    this.canvas.style.pointerEvents = 'none';
  }

  override getSourceState(): 'ready' {
    return 'ready';
  }

  override render(frame: FrameState): HTMLElement {
    const ratio = frame.pixelRatio;
    const [width, height] = [frame.size[0]!, frame.size[1]!];
    const [columns, rows] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.canvas.width !== columns || this.canvas.height !== rows) {
      this.canvas.width = columns;
      this.canvas.height = rows;
      this.canvas.style.width = `${width}px`;
      this.canvas.style.height = `${height}px`;
    }
    const context = this.canvas.getContext('2d');
    if (!context) return this.canvas;
    const { center, resolution } = frame.viewState;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, columns, rows);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.painter(context, {
      left: center[0]! - (width / 2) * resolution,
      top: center[1]! + (height / 2) * resolution,
      width,
      height,
      resolution,
    });
    return this.canvas;
  }
}
