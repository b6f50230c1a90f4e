import { expect, test } from 'vitest';
import { centrelineOf, endOf, footOf, placeAt, stretch } from '../../src/model/centreline';
import { fittedAffine, misfit, type ControlPoint } from '../../src/plan/background';
import { ellipseOf } from '../../src/plan/ellipse';
import { fromGrid, toGrid } from '../../src/editor/survey';

test('a quarter turn to the right has the length of its arc and ends where the next leg begins', () => {
  const line = centrelineOf([[0, 0, 0], [585, 0, 0], [601.75, -16.75, 0], [601.75, -301.75, 0]], [null, -90, null, null]);
  expect(endOf(line)).toBeCloseTo(585 + (Math.PI / 2) * 16.75 + 285, 9);
  const middle = placeAt(line, 585 + (Math.PI / 4) * 16.75).point; // of the arc: 45 degrees round its centre
  expect(Math.hypot(middle[0] - 585, middle[1] + 16.75)).toBeCloseTo(16.75, 1);
  expect(middle[1]).toBeGreaterThan(-16.75 / 2);
});

test('chainage is the length in space, so a slope of 3 in 4 is a quarter longer than its plan', () => {
  expect(endOf(centrelineOf([[0, 0, 0], [400, 0, -300]], [], 100))).toBe(600);
});

test('the foot of a point left of the line has a positive offset', () => {
  const line = centrelineOf([[0, 0, 0], [100, 0, 0]]);
  expect(footOf(line, 30, 2)).toEqual({ chainage: 30, offset: 2, distance: 2 });
  expect(footOf(line, 30, -2).offset).toBe(-2);
  expect(stretch(line, 10, 20, 1)).toEqual([[10, 1], [20, 1]]);
  expect(stretch(line, 20, 10, 1)).toEqual([[20, 1], [10, 1]]);
});

test('the ellipse of a covariance has the axes of its eigenvalues', () => {
  const [c, s] = [Math.cos(0.4), Math.sin(0.4)];
  const [a, b] = [9, 4];
  const ellipse = ellipseOf(c * c * a + s * s * b, c * s * (a - b), s * s * a + c * c * b, 1);
  expect(ellipse.major).toBeCloseTo(3, 12);
  expect(ellipse.minor).toBeCloseTo(2, 12);
  expect(ellipse.angle).toBeCloseTo(0.4, 12);
});

test('control points give back the affine map that made them, and none for points on one line', () => {
  const at = (column: number, row: number): ControlPoint => ({ column, row, x_m: 0.3 * column + 0.02 * row + 5, y_m: 0.02 * column - 0.3 * row + 90 });
  const points = [at(0, 0), at(1000, 10), at(20, 800), at(990, 790)];
  const affine = fittedAffine(points)!;
  expect(misfit(affine, points)).toBeLessThan(1e-9);
  expect([affine.a, affine.b, affine.c, affine.d, affine.e, affine.f].map((value) => Math.round(1e6 * value) / 1e6)).toEqual([0.3, 0.02, 0.02, -0.3, 5, 90]);
  expect(fittedAffine([at(0, 0), at(10, 10), at(20, 20)])).toBeNull();
});

test('the mine grid is turned counter-clockwise from its east to the x axis of the map, and back again', () => {
  const grid = { name: '', easting: 517300, northing: 3794200, elevation: 35, rotation: Math.PI / 2 };
  const there = toGrid(grid, [10, 0, 1]);
  expect(there[0]).toBeCloseTo(517300, 6);
  expect(there[1]).toBeCloseTo(3794210, 6);
  fromGrid(grid, there).forEach((value, axis) => expect(value).toBeCloseTo([10, 0, 1][axis]!, 6));
});
