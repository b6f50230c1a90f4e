/** The mine as OpenLayers features. */

import Feature from 'ol/Feature';
import { LineString, MultiLineString, Point, Polygon, type Geometry } from 'ol/geom';
import type { Mine } from '../model/mine';

export function mineFeatures(mine: Mine): Feature<Geometry>[] {
  const features: Feature<Geometry>[] = [];
  const add = (kind: string, name: string, geometry: Geometry, more: Record<string, unknown> = {}): void => {
    features.push(new Feature({ geometry, kind, name, ...more }));
  };
  for (const roadway of mine.roadways.values())
    add('roadway', roadway.id, new LineString(roadway.line.points.map((p) => [p[0], p[1]])), { width: roadway.width });
  for (const chamber of mine.chambers)
    add('chamber', chamber.id, chamber.outline.length > 0 ? new Polygon([closed(chamber.outline)]) : new Point(chamber.place));
  for (const interval of mine.intervals)
    add('interval', interval.id, new MultiLineString(interval.lines), { label: interval.label });
  for (const place of mine.places) add(place.kind, place.id, new Point([place.x, place.y]));
  for (const anchor of mine.anchors) add('anchor', anchor.id, new Point([anchor.x, anchor.y]));
  return features;
}

function closed(ring: [number, number][]): [number, number][] {
  return ring.length > 0 ? [...ring, ring[0]!] : ring;
}
