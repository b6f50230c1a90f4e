/** Changes of a map, each from a map to a new map. Objects that hang on a roadway by chainage stay where they are when it is redrawn. */

import { endOf, footOf, placeAt, startOf, type Centreline, type Point3 } from '../model/centreline';
import { idOf, pointOf, type Feature, type MapDocument } from '../model/map_document';
import { roadwayOf, type Roadway } from '../model/mine';
import { rounded } from './survey';

/** An object of the map, by kind and id: "anchor 12". */
export interface ObjectKey {
  object: string;
  id: string;
}

export function keyOf(feature: Feature): ObjectKey {
  return { object: feature.properties.object, id: idOf(feature) };
}

export function sameKey(a: ObjectKey | null, b: ObjectKey | null): boolean {
  return a !== null && b !== null && a.object === b.object && a.id === b.id;
}

export function found(map: MapDocument, key: ObjectKey | null): Feature | null {
  return map.features.find((feature) => sameKey(keyOf(feature), key)) ?? null;
}

export function roadwaysOf(map: MapDocument): Map<string, Roadway> {
  const roadways = map.features.filter((feature) => feature.properties.object === 'roadway').map(roadwayOf);
  return new Map(roadways.map((roadway) => [roadway.id, roadway]));
}

/** The nearest roadway to a point in plan, within reach of its walls. */
export function roadwayNear(map: MapDocument, x: number, y: number, reach = 25): { roadway: Roadway; chainage: number; offset: number } | null {
  let best: { roadway: Roadway; chainage: number; offset: number } | null = null;
  let nearest = reach;
  for (const roadway of roadwaysOf(map).values()) {
    const foot = footOf(roadway.line, x, y);
    if (foot.distance >= nearest) continue;
    nearest = foot.distance;
    best = { roadway, chainage: foot.chainage, offset: foot.offset };
  }
  return best;
}

/** New objects stand behind the last one of their kind, so that the file keeps its order. */
export function added(map: MapDocument, feature: Feature): MapDocument {
  const kinds = ['map', 'roadway', 'junction', 'crossing', 'bend', 'chamber', 'anchor', 'portal', 'light', 'stop_line', 'zone', 'route'];
  const rank = (one: Feature): number => kinds.indexOf(one.properties.object);
  const at = map.features.findIndex((one) => rank(one) > rank(feature));
  const features = [...map.features];
  features.splice(at < 0 ? features.length : at, 0, feature);
  return { ...map, features };
}

export function replaced(map: MapDocument, key: ObjectKey, change: (feature: Feature) => Feature): MapDocument {
  return { ...map, features: map.features.map((feature) => (sameKey(keyOf(feature), key) ? change(feature) : feature)) };
}

/** Without the object, and without what cannot be there without it. */
export function removed(map: MapDocument, key: ObjectKey): MapDocument {
  const stays = (feature: Feature): boolean => !sameKey(keyOf(feature), key) && !(key.object === 'roadway' && hangsOn(feature, key.id));
  return { ...map, features: map.features.filter(stays) };
}

function hangsOn(feature: Feature, roadway: string): boolean {
  return hangersOf(feature).some((hanger) => hanger['roadway'] === roadway);
}

/** The tables of an object that name a roadway: itself, or its places, legs, upper and lower. */
function hangersOf(feature: Feature): Record<string, unknown>[] {
  const { properties } = feature;
  const lists = [properties['places'], properties['legs']].filter(Array.isArray).flat() as unknown[];
  const tables = [properties, properties['upper'], properties['lower'], ...lists];
  return tables.filter((table): table is Record<string, unknown> => typeof table === 'object' && table !== null && 'roadway' in table);
}

/** A free id: the prefix with the next number, or the next number alone for anchors. */
export function freeId(map: MapDocument, object: string, prefix: string): string | number {
  const used = map.features.filter((feature) => feature.properties.object === object).map(idOf);
  if (object === 'anchor') return Math.max(0, ...used.map(Number).filter(Number.isFinite)) + 1;
  for (let n = 1; ; ++n) if (!used.includes(`${prefix}${n}`)) return `${prefix}${n}`;
}

export function newRoadway(map: MapDocument, points: Point3[]): Feature {
  const coordinates = points.map((point) => point.map(rounded));
  const properties = { object: 'roadway', id: freeId(map, 'roadway', 'R'), width_m: 5, height_m: 3.5 };
  return { type: 'Feature', geometry: { type: 'LineString', coordinates }, properties };
}

/** Adds a roadway and joins it to those its ends lie on. */
export function withRoadway(map: MapDocument, points: Point3[]): { map: MapDocument; key: ObjectKey } {
  const feature = newRoadway(map, points);
  const line = roadwayOf(feature).line;
  let next = added(map, feature);
  for (const [end, chainage] of [[points[0]!, startOf(line)], [points[points.length - 1]!, endOf(line)]] as const) {
    const other = roadwayNear(map, end[0], end[1], 0.2);
    if (!other) continue;
    const places = [
      { roadway: other.roadway.id, chainage_m: rounded(other.chainage) },
      { roadway: idOf(feature), chainage_m: rounded(chainage) },
    ];
    next = added(next, { type: 'Feature', geometry: null, properties: { object: 'junction', id: freeId(next, 'junction', 'J'), places } });
  }
  return { map: next, key: keyOf(feature) };
}

/** A chamber in the wall nearest to the point; null when no roadway is near. */
export function newChamber(map: MapDocument, x: number, y: number): Feature | null {
  const near = roadwayNear(map, x, y);
  if (!near) return null;
  const properties = {
    object: 'chamber',
    id: freeId(map, 'chamber', 'C'),
    roadway: near.roadway.id,
    chainage_m: rounded(near.chainage),
    side: near.offset >= 0 ? 'left' : 'right',
    length_m: 10,
    depth_m: 3,
  };
  return { type: 'Feature', geometry: null, properties };
}

export function newAnchor(map: MapDocument, x: number, y: number): Feature {
  const near = roadwayNear(map, x, y);
  const floor = near ? placeAt(near.roadway.line, near.chainage).point[2] : 0;
  const wall = near ? { wall: near.offset >= 0 ? 'left' : 'right' } : {};
  const coordinates = [x, y, floor + 2].map(rounded);
  const properties = { object: 'anchor', id: freeId(map, 'anchor', ''), survey_sigma_m: 0.05, ...wall };
  return { type: 'Feature', geometry: { type: 'Point', coordinates }, properties };
}

/** An anchor goes to the point and keeps its height; a chamber goes to the roadway and side nearest to it. */
export function moved(map: MapDocument, key: ObjectKey, x: number, y: number): MapDocument {
  return replaced(map, key, (feature) => {
    if (key.object === 'anchor') {
      const z = pointOf(feature)?.[2] ?? 0;
      return { ...feature, geometry: { type: 'Point', coordinates: [rounded(x), rounded(y), z] } };
    }
    const near = roadwayNear(map, x, y);
    if (!near) return feature;
    const place = { roadway: near.roadway.id, chainage_m: rounded(near.chainage) };
    const side = key.object === 'chamber' ? { side: near.offset >= 0 ? 'left' : 'right' } : {};
    return { ...feature, geometry: null, properties: { ...feature.properties, ...place, ...side } };
  });
}

/** A roadway with other corners. Its arcs stay with their corners as long as the number of corners is the same. */
export function redrawn(map: MapDocument, key: ObjectKey, coordinates: number[][]): MapDocument {
  return reshaped(map, key, (feature) => {
    const same = feature.geometry?.type === 'LineString' && feature.geometry.coordinates.length === coordinates.length;
    const { arc_deg: arcs, station_m: stations, ...rest } = feature.properties;
    const kept = same ? { ...(arcs === undefined ? {} : { arc_deg: arcs }), ...(stations === undefined ? {} : { station_m: stations }) } : {};
    const geometry = { type: 'LineString' as const, coordinates: coordinates.map((point) => point.map(rounded)) };
    return { ...feature, geometry, properties: { ...rest, ...kept } as Feature['properties'] };
  });
}

/** Any change of a roadway's line: what hangs on it gets the chainage of the place where it was. */
export function reshaped(map: MapDocument, key: ObjectKey, change: (feature: Feature) => Feature): MapDocument {
  const before = found(map, key);
  if (!before) return map;
  const next = replaced(map, key, change);
  const after = found(next, key);
  if (!after) return next;
  const [oldLine, newLine] = [roadwayOf(before).line, roadwayOf(after).line];
  return { ...next, features: next.features.map((feature) => rehung(feature, key.id, oldLine, newLine)) };
}

const kChainages = ['chainage_m', 'from_m', 'to_m', 'handover_from_m', 'handover_to_m'];

function rehung(feature: Feature, roadway: string, before: Centreline, after: Centreline): Feature {
  if (feature.properties.object === 'roadway' || !hangsOn(feature, roadway)) return feature;
  const table = <T>(value: T): T => {
    if (Array.isArray(value)) return value.map(table) as T;
    if (typeof value !== 'object' || value === null) return value;
    const result: Record<string, unknown> = {};
    for (const [name, inner] of Object.entries(value)) {
      const here = kChainages.includes(name) && (value as Record<string, unknown>)['roadway'] === roadway;
      result[name] = here && typeof inner === 'number' ? chainageNow(inner, before, after) : table(inner);
    }
    return result as T;
  };
  return { ...feature, geometry: null, properties: table(feature.properties) };
}

function chainageNow(chainage: number, before: Centreline, after: Centreline): number {
  const { point } = placeAt(before, chainage);
  return rounded(footOf(after, point[0], point[1]).chainage);
}

/** Renames or sets one property; a value of undefined takes the key out. */
export function withProperty(map: MapDocument, key: ObjectKey, name: string, value: unknown): MapDocument {
  return replaced(map, key, (feature) => {
    const { [name]: _, ...rest } = feature.properties;
    const properties = (value === undefined ? rest : { ...feature.properties, [name]: value }) as Feature['properties'];
    const free = ['chainage_m', 'side', 'roadway', 'length_m', 'depth_m'].includes(name) && feature.properties.object !== 'roadway';
    return { ...feature, geometry: free ? null : feature.geometry, properties };
  });
}

/** Another id; what names a roadway by its old one follows. */
export function renamed(map: MapDocument, key: ObjectKey, id: string | number): MapDocument {
  const next = withProperty(map, key, 'id', id);
  if (key.object !== 'roadway') return next;
  const follow = <T>(value: T): T => {
    if (Array.isArray(value)) return value.map(follow) as T;
    if (typeof value !== 'object' || value === null) return value;
    const entries = Object.entries(value).map(([name, inner]) => [name, name === 'roadway' && inner === key.id ? id : follow(inner as unknown)]);
    return Object.fromEntries(entries) as T;
  };
  return { ...next, features: next.features.map((feature) => ({ ...feature, properties: follow(feature.properties) })) };
}
