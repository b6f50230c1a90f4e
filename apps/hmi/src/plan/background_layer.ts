/** The background picture under the mine, placed by its control points; these may change while one looks. */

import { controlPointsOf, fittedAffine, misfit, type Affine } from './background';
import { CanvasLayer } from './canvas_layer';
import type { MapDocument } from '../model/map_document';

export class Background {
  readonly layer: CanvasLayer;
  /** Root mean square misfit of the control points, m; null while they do not suffice. */
  misfit: number | null = null;
  private readonly picture = new Image();
  private affine: Affine | null = null;

  constructor(map: MapDocument, address: string) {
    this.layer = new CanvasLayer((context, window) => {
      if (!this.affine || this.picture.naturalWidth === 0) return;
      const { a, b, c, d, e, f } = this.affine;
      const scale = 1 / window.resolution;
      context.save();
      context.transform(scale, 0, 0, -scale, -window.left * scale, window.top * scale); // metres, north up
      context.transform(a, b, c, d, e, f); // pixels of the picture
      context.globalAlpha = 0.6;
      context.drawImage(this.picture, 0, 0);
      context.restore();
    }, 0);
    this.picture.addEventListener('load', () => this.layer.changed());
    this.show(map);
    if (controlPointsOf(map).length > 0) this.picture.src = address;
  }

  show(map: MapDocument): void {
    const points = controlPointsOf(map);
    this.affine = fittedAffine(points);
    this.misfit = this.affine ? misfit(this.affine, points) : null;
    this.layer.changed();
  }

  /** Pixel of the picture that lies at a place of the map. */
  pixelAt(x: number, y: number): { column: number; row: number } | null {
    if (!this.affine) return null;
    const { a, b, c, d, e, f } = this.affine;
    const determinant = a * d - b * c;
    const [u, v] = [x - e, y - f];
    return { column: (d * u - c * v) / determinant, row: (a * v - b * u) / determinant };
  }
}
