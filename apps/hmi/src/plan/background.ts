/** The background picture: an affine transform from pixels to metres, fitted to its control points by least squares. */

import { fields, list, number, shape } from '../protocol/check';
import type { MapDocument } from '../model/map_document';

export interface ControlPoint {
  column: number;
  row: number;
  x_m: number;
  y_m: number;
}

/** x = a column + c row + e, y = b column + d row + f: the order of a canvas transform. */
export interface Affine {
  a: number;
  b: number;
  c: number;
  d: number;
  e: number;
  f: number;
}

export function controlPointsOf(map: MapDocument): ControlPoint[] {
  const site = map.features.find((feature) => feature.properties.object === 'map');
  const background = site?.properties['background'];
  if (background === undefined || background === null) return [];
  const reader = list(shape<ControlPoint>({ column: number, row: number, x_m: number, y_m: number }));
  return reader(fields(background, 'background')['control_points'] ?? [], 'background.control_points');
}

/** Null for fewer than three points or points on one line. */
export function fittedAffine(points: ControlPoint[]): Affine | null {
  if (points.length < 3) return null;
  const mean = (pick: (point: ControlPoint) => number): number => points.reduce((sum, p) => sum + pick(p), 0) / points.length;
  const [column0, row0, x0, y0] = [mean((p) => p.column), mean((p) => p.row), mean((p) => p.x_m), mean((p) => p.y_m)];
  let [cc, cr, rr, cx, rx, cy, ry] = [0, 0, 0, 0, 0, 0, 0];
  for (const p of points) {
    const [u, v, x, y] = [p.column - column0, p.row - row0, p.x_m - x0, p.y_m - y0];
    cc += u * u;
    cr += u * v;
    rr += v * v;
    cx += u * x;
    rx += v * x;
    cy += u * y;
    ry += v * y;
  }
  const determinant = cc * rr - cr * cr;
  if (determinant < 1e-9 * cc * rr || cc === 0 || rr === 0) return null;
  const a = (cx * rr - rx * cr) / determinant;
  const c = (rx * cc - cx * cr) / determinant;
  const b = (cy * rr - ry * cr) / determinant;
  const d = (ry * cc - cy * cr) / determinant;
  return { a, b, c, d, e: x0 - a * column0 - c * row0, f: y0 - b * column0 - d * row0 };
}

/** Root mean square distance between control points and where the fit puts them, m. */
export function misfit(affine: Affine, points: ControlPoint[]): number {
  const squares = points.map((p) => {
    const x = affine.a * p.column + affine.c * p.row + affine.e;
    const y = affine.b * p.column + affine.d * p.row + affine.f;
    return (x - p.x_m) ** 2 + (y - p.y_m) ** 2;
  });
  return Math.sqrt(squares.reduce((sum, square) => sum + square, 0) / points.length);
}
