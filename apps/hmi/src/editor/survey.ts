/** The mine's own grid: what a surveyor types and reads. */

import type { Point3 } from '../model/centreline';
import type { MapDocument } from '../model/map_document';

export interface MineGrid {
  name: string;
  easting: number;
  northing: number;
  elevation: number;
  /** From the grid's east counter-clockwise to the map's x axis, rad. */
  rotation: number;
}

export function mineGridOf(map: MapDocument): MineGrid | null {
  const grid = map.features.find((feature) => feature.properties.object === 'map')?.properties['mine_grid'];
  if (typeof grid !== 'object' || grid === null) return null;
  const keys = grid as Record<string, unknown>;
  const value = (key: string): number => (typeof keys[key] === 'number' ? (keys[key] as number) : 0);
  return {
    name: typeof keys['name'] === 'string' ? keys['name'] : '',
    easting: value('easting_m'),
    northing: value('northing_m'),
    elevation: value('elevation_m'),
    rotation: (value('rotation_deg') * Math.PI) / 180,
  };
}

export function toGrid(grid: MineGrid, point: Point3): Point3 {
  const [c, s] = [Math.cos(grid.rotation), Math.sin(grid.rotation)];
  return [grid.easting + c * point[0] - s * point[1], grid.northing + s * point[0] + c * point[1], grid.elevation + point[2]];
}

export function fromGrid(grid: MineGrid, point: Point3): Point3 {
  const [c, s] = [Math.cos(grid.rotation), Math.sin(grid.rotation)];
  const [e, n] = [point[0] - grid.easting, point[1] - grid.northing];
  return [c * e + s * n, -s * e + c * n, point[2] - grid.elevation];
}

/** Tenths of a millimetre: finer than any survey, short in the file. */
export function rounded(value: number): number {
  return Math.round(value * 1e4) / 1e4 + 0;
}
