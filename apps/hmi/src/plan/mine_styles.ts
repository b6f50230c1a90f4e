/** How the mine looks. Every state has a colour, a line or a shape of its own, and a word. */

import Feature from 'ol/Feature';
import type { Geometry } from 'ol/geom';
import { Circle, Fill, RegularShape, Stroke, Style, Text } from 'ol/style';
import type { Translate } from '../i18n/translate';
import { lockWords } from '../model/words';
import type { AnchorNow, LockState } from '../protocol/messages';
import type { Paint } from '../ui/theme';

/** Everything outside the map that the look depends on. */
export interface Look {
  paint: Paint;
  t: Translate;
  anchors: Map<string, AnchorNow['seen']>;
  locks: Map<string, LockState>;
}

const kFont = '12px system-ui, sans-serif';

export function mineStyle(feature: Feature<Geometry>, resolution: number, look: Look): Style[] {
  switch (feature.get('kind')) {
    case 'roadway':
      return roadwayStyle(feature, resolution, look.paint);
    case 'chamber':
      return chamberStyle(feature, resolution, look.paint);
    case 'interval':
      return intervalStyle(feature, resolution, look);
    case 'anchor':
      return anchorStyle(feature, resolution, look);
    default:
      return placeStyle(feature, resolution, look.paint);
  }
}

function label(text: string, paint: Paint, offsetY: number, line = false): Text {
  return new Text({
    text,
    font: kFont,
    offsetY,
    placement: line ? 'line' : 'point',
    overflow: !line,
    fill: new Fill({ color: paint.text }),
    stroke: new Stroke({ color: paint.surface, width: 3 }),
  });
}

export function roadwayStyle(feature: Feature<Geometry>, resolution: number, paint: Paint): Style[] {
  const width = Math.max(3, (feature.get('width') as number) / resolution);
  const name = label(String(feature.get('name')), paint, -width / 2 - 9, true);
  return [
    new Style({ zIndex: 0, stroke: new Stroke({ color: paint.roadEdge, width: width + 2, lineCap: 'butt' }) }),
    new Style({ zIndex: 1, stroke: new Stroke({ color: paint.road, width, lineCap: 'butt' }), text: name }),
  ];
}

export function chamberStyle(feature: Feature<Geometry>, resolution: number, paint: Paint): Style[] {
  const style = new Style({
    zIndex: 1,
    fill: new Fill({ color: paint.road }),
    stroke: new Stroke({ color: paint.roadEdge, width: 1.5 }),
  });
  if (resolution < 1.2) style.setText(label(String(feature.get('name')), paint, 0));
  if (feature.getGeometry()?.getType() === 'Point')
    style.setImage(new RegularShape({ points: 4, radius: 6, angle: Math.PI / 4, stroke: new Stroke({ color: paint.roadEdge, width: 2 }) }));
  return [style];
}

function intervalStyle(feature: Feature<Geometry>, resolution: number, look: Look): Style[] {
  const state = look.locks.get(String(feature.get('name'))) ?? null;
  if (state === null) return [];
  const { paint } = look;
  const strokes: Record<LockState, Stroke> = {
    held: new Stroke({ color: paint.locked, width: 6, lineCap: 'butt' }),
    doubtful: new Stroke({ color: paint.warning, width: 5, lineDash: [10, 5], lineCap: 'butt' }),
    free: new Stroke({ color: paint.free, width: 1.5, lineDash: [2, 6] }),
    unknown: new Stroke({ color: paint.faint, width: 2.5, lineDash: [9, 4, 2, 4] }),
  };
  const style = new Style({ zIndex: state === 'free' ? 2 : 3, stroke: strokes[state] });
  const close = resolution < (state === 'held' || state === 'doubtful' ? 3 : 0.8);
  if (close) {
    const short = String(feature.get('label'));
    style.setText(label(state === 'free' ? short : `${short}: ${lockWords(look.t, state)}`, paint, state === 'free' ? 0 : 16));
  }
  return [style];
}

function anchorStyle(feature: Feature<Geometry>, resolution: number, look: Look): Style[] {
  const { paint } = look;
  const seen = look.anchors.get(String(feature.get('name'))) ?? null;
  const style = new Style({ zIndex: 5, image: anchorSign(seen, paint) });
  if (resolution < 0.5 || (seen !== null && seen !== 'not_seen' && resolution < 1.5))
    style.setText(label(String(feature.get('name')), paint, -13));
  if (seen !== 'rejected') return [style];
  const cross = new RegularShape({ points: 4, radius: 9, radius2: 0, angle: Math.PI / 4, stroke: new Stroke({ color: paint.bad, width: 2.5 }) });
  return [style, new Style({ zIndex: 6, image: cross })];
}

/** Filled triangle: seen. Filled with a cross over it: rejected. Hollow: not seen. Small dot: nothing is known (no live data). */
function anchorSign(seen: AnchorNow['seen'] | null, paint: Paint): RegularShape | Circle {
  if (seen === null) return new Circle({ radius: 3.5, fill: new Fill({ color: paint.accent }), stroke: new Stroke({ color: paint.surface, width: 1 }) });
  const colour = seen === 'seen' ? paint.good : seen === 'rejected' ? paint.bad : paint.faint;
  const fill = new Fill({ color: seen === 'not_seen' ? paint.surface : colour });
  return new RegularShape({ points: 3, radius: 8, fill, stroke: new Stroke({ color: colour, width: 2 }) });
}

function placeStyle(feature: Feature<Geometry>, resolution: number, paint: Paint): Style[] {
  const kind = String(feature.get('kind'));
  if (kind === 'junction' && resolution > 2) return [];
  const stroke = new Stroke({ color: paint.faint, width: 1.5 });
  const fill = new Fill({ color: paint.surface });
  const images: Record<string, RegularShape | Circle> = {
    junction: new RegularShape({ points: 4, radius: 5, fill, stroke }),
    portal: new RegularShape({ points: 6, radius: 8, fill, stroke: new Stroke({ color: paint.accent, width: 2 }) }),
    light: new Circle({ radius: 4, fill, stroke }),
    stop_line: new RegularShape({ points: 2, radius: 6, stroke: new Stroke({ color: paint.bad, width: 2 }) }),
  };
  const style = new Style({ zIndex: 4 });
  const image = images[kind];
  if (image) style.setImage(image);
  if (resolution < 1) style.setText(label(String(feature.get('name')), paint, 14));
  return [style];
}
