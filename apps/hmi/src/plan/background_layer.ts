/** The background picture under the mine, placed by its control points. */

import { controlPointsOf, fittedAffine } from './background';
import { CanvasLayer } from './canvas_layer';
import type { MapDocument } from '../model/map_document';

export function backgroundLayer(map: MapDocument, address: string): CanvasLayer {
  const affine = fittedAffine(controlPointsOf(map));
  const picture = new Image();
  const layer = new CanvasLayer((context, window) => {
    if (!affine || !picture.complete || picture.naturalWidth === 0) return;
    const scale = 1 / window.resolution;
    context.save();
    context.transform(scale, 0, 0, -scale, -window.left * scale, window.top * scale); // metres, north up
    context.transform(affine.a, affine.b, affine.c, affine.d, affine.e, affine.f); // pixels of the picture
    context.globalAlpha = 0.6;
    context.drawImage(picture, 0, 0);
    context.restore();
  }, 0);
  picture.addEventListener('load', () => layer.changed());
  picture.src = address;
  return layer;
}
