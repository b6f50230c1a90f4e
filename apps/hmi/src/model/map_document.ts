/** The map as the server hands it out: GeoJSON in local metres, one feature an object (docs/formats/maps.md). */

import { fields, list, number, oneOf, orNull, ProtocolError, text, type Fields, type Reader } from '../protocol/check';

export type Geometry =
  | { type: 'Point'; coordinates: number[] }
  | { type: 'LineString'; coordinates: number[][] }
  | { type: 'MultiLineString'; coordinates: number[][][] };

export interface Feature {
  type: 'Feature';
  geometry: Geometry | null;
  properties: Fields & { object: string };
}

export interface MapDocument {
  type: 'FeatureCollection';
  features: Feature[];
}

const readGeometry: Reader<Geometry> = (value, path) => {
  const object = fields(value, path);
  const type = oneOf('Point', 'LineString', 'MultiLineString')(object['type'], `${path}.type`);
  const at = `${path}.coordinates`;
  if (type === 'Point') return { type, coordinates: list(number)(object['coordinates'], at) };
  if (type === 'LineString') return { type, coordinates: list(list(number))(object['coordinates'], at) };
  return { type, coordinates: list(list(list(number)))(object['coordinates'], at) };
};

const readFeature: Reader<Feature> = (value, path) => {
  const object = fields(value, path);
  const properties = fields(object['properties'], `${path}.properties`);
  const kind = text(properties['object'], `${path}.properties.object`);
  const geometry = orNull(readGeometry)(object['geometry'], `${path}.geometry`);
  return { type: 'Feature', geometry, properties: { ...properties, object: kind } };
};

export const readDocument: Reader<MapDocument> = (value, path) => {
  const object = fields(value, path);
  if (object['type'] !== 'FeatureCollection') throw new ProtocolError(`${path}.type`, object['type'], 'FeatureCollection');
  return { type: 'FeatureCollection', features: list(readFeature)(object['features'], `${path}.features`) };
};

/** Name of an object among those of its kind: anchors have numbers. */
export function idOf(feature: Feature): string {
  const id = feature.properties['id'];
  return typeof id === 'number' || typeof id === 'string' ? String(id) : '';
}

export function numberOf(feature: Feature, key: string, otherwise: number): number {
  const value = feature.properties[key];
  return typeof value === 'number' ? value : otherwise;
}

export function textOf(feature: Feature, key: string): string {
  const value = feature.properties[key];
  return typeof value === 'string' ? value : '';
}

export function pointOf(feature: Feature): [number, number, number] | null {
  const geometry = feature.geometry;
  if (geometry?.type !== 'Point') return null;
  return [geometry.coordinates[0] ?? 0, geometry.coordinates[1] ?? 0, geometry.coordinates[2] ?? 0];
}
