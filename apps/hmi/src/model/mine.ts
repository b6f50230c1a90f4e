/** What the plan, the words and the diagrams need of a map: objects with geometry worked out. */

import { centrelineOf, placeAt, shifted, stretch, type Centreline, type Point3 } from './centreline';
import { idOf, numberOf, pointOf, textOf, type Feature, type MapDocument } from './map_document';
import type { LockInterval } from '../protocol/messages';

export interface Roadway {
  id: string;
  line: Centreline;
  width: number;
  lanes: number;
}

export interface Chamber {
  id: string;
  roadway: string;
  chainage: number;
  outline: [number, number][];
  place: [number, number];
}

export interface Anchor {
  id: string;
  name: string;
  x: number;
  y: number;
}

export interface NamedPlace {
  kind: 'junction' | 'portal' | 'light' | 'stop_line';
  id: string;
  x: number;
  y: number;
}

export interface IntervalShape {
  id: string;
  label: string;
  lines: [number, number][][];
}

export interface Mine {
  roadways: Map<string, Roadway>;
  chambers: Chamber[];
  anchors: Anchor[];
  places: NamedPlace[];
  intervals: IntervalShape[];
  drivesLeft: boolean;
}

const kChamberDepth = 3;
const kChamberLength = 8;

export function mineOf(map: MapDocument, intervals: LockInterval[]): Mine {
  const of = (kind: string): Feature[] => map.features.filter((feature) => feature.properties.object === kind);
  const roadways = new Map(of('roadway').map((feature) => [idOf(feature), roadwayOf(feature)]));
  const drivesLeft = of('map').some((feature) => textOf(feature, 'driving_side') === 'left');
  return {
    roadways,
    drivesLeft,
    chambers: of('chamber').flatMap((feature) => chamberOf(feature, roadways)),
    anchors: of('anchor').flatMap(anchorOf),
    places: (['junction', 'portal', 'light', 'stop_line'] as const).flatMap((kind) =>
      of(kind).flatMap((feature) => placeOf(feature, kind, roadways)),
    ),
    intervals: intervals.map((interval) => shapeOf(interval, roadways, drivesLeft)),
  };
}

export function roadwayOf(feature: Feature): Roadway {
  const coordinates = feature.geometry?.type === 'LineString' ? feature.geometry.coordinates : [];
  const corners = coordinates.map((c): Point3 => [c[0] ?? 0, c[1] ?? 0, c[2] ?? 0]);
  const arcs = feature.properties['arc_deg'];
  const sweeps = Array.isArray(arcs) ? arcs.map((arc) => (typeof arc === 'number' ? arc : null)) : [];
  return {
    id: idOf(feature),
    line: centrelineOf(corners, sweeps, numberOf(feature, 'chainage_start_m', 0)),
    width: numberOf(feature, 'width_m', 4),
    lanes: numberOf(feature, 'lanes', 1),
  };
}

/** A niche in the wall: `length_m` along it, `depth_m` into the rock. */
export function chamberOf(feature: Feature, roadways: Map<string, Roadway>): Chamber[] {
  const roadway = roadways.get(textOf(feature, 'roadway'));
  const point = pointOf(feature);
  const chainage = feature.properties['chainage_m'];
  if (!roadway || typeof chainage !== 'number' || roadway.line.points.length < 2) {
    if (!point) return [];
    return [{ id: idOf(feature), roadway: textOf(feature, 'roadway'), chainage: NaN, outline: [], place: [point[0], point[1]] }];
  }
  const side = textOf(feature, 'side') === 'left' ? 1 : -1;
  const half = numberOf(feature, 'length_m', kChamberLength) / 2;
  const near = (side * roadway.width) / 2;
  const far = near + side * numberOf(feature, 'depth_m', kChamberDepth);
  const inner = stretch(roadway.line, chainage - half, chainage + half, near);
  const outer = stretch(roadway.line, chainage + half, chainage - half, far);
  const place = shifted(placeAt(roadway.line, chainage), (near + far) / 2);
  return [{ id: idOf(feature), roadway: roadway.id, chainage, outline: [...inner, ...outer], place }];
}

function anchorOf(feature: Feature): Anchor[] {
  const point = pointOf(feature);
  return point ? [{ id: idOf(feature), name: textOf(feature, 'name'), x: point[0], y: point[1] }] : [];
}

/** Chainage counts; the point of the feature where there is none. */
function placeOf(feature: Feature, kind: NamedPlace['kind'], roadways: Map<string, Roadway>): NamedPlace[] {
  const named = hungOn(feature);
  const line = roadways.get(named?.roadway ?? '')?.line;
  if (named && line && line.points.length > 1) {
    const { point } = placeAt(line, named.chainage);
    return [{ kind, id: idOf(feature), x: point[0], y: point[1] }];
  }
  const point = pointOf(feature);
  return point ? [{ kind, id: idOf(feature), x: point[0], y: point[1] }] : [];
}

/** Roadway and chainage of an object; of the first of its places for a junction. */
function hungOn(feature: Feature): { roadway: string; chainage: number } | null {
  const places = feature.properties['places'];
  const keys: unknown = Array.isArray(places) ? places[0] : feature.properties;
  if (typeof keys !== 'object' || keys === null) return null;
  const { roadway, chainage_m: chainage } = keys as Record<string, unknown>;
  return typeof roadway === 'string' && typeof chainage === 'number' ? { roadway, chainage } : null;
}

/** On two lanes an interval lies in its own lane, a quarter of the width off the centreline. */
function shapeOf(interval: LockInterval, roadways: Map<string, Roadway>, drivesLeft: boolean): IntervalShape {
  const lines = interval.spans.flatMap((span): [number, number][][] => {
    const roadway = roadways.get(span.roadway);
    if (!roadway || roadway.line.points.length < 2) return [];
    const direction = span.lane === 'forward' ? 1 : span.lane === 'backward' ? -1 : 0;
    const offset = (direction * (drivesLeft ? 1 : -1) * roadway.width) / 4;
    return [stretch(roadway.line, span.from_m, span.to_m, roadway.lanes > 1 ? offset : 0)];
  });
  return { id: interval.id, label: interval.label, lines };
}

/** minX, minY, maxX, maxY of everything drawn; null for an empty map. */
export function extentOf(mine: Mine): [number, number, number, number] | null {
  const points: (readonly number[])[] = [...mine.roadways.values()].flatMap((roadway): (readonly number[])[] => roadway.line.points);
  for (const anchor of mine.anchors) points.push([anchor.x, anchor.y]);
  if (points.length === 0) return null;
  const extent: [number, number, number, number] = [Infinity, Infinity, -Infinity, -Infinity];
  for (const point of points) {
    extent[0] = Math.min(extent[0], point[0]!);
    extent[1] = Math.min(extent[1], point[1]!);
    extent[2] = Math.max(extent[2], point[0]!);
    extent[3] = Math.max(extent[3], point[1]!);
  }
  return extent;
}
