import { expect, test } from 'vitest';
import { levelFor, levelsOf, lowerBound } from '../../src/model/levels';

const circle = (rounds: number, points: number) => {
  const angle = Float64Array.from({ length: points }, (_, i) => (2 * Math.PI * rounds * i) / points);
  return { x: angle.map((a) => 50 * Math.cos(a)), y: angle.map((a) => 50 * Math.sin(a)) };
};

test('a point that a level leaves out lies within two spacings of one that it keeps', () => {
  const track = circle(10, 50000);
  for (const level of levelsOf(track).slice(1)) {
    let farthest = 0;
    for (let at = 0, kept = 0; at < track.x.length; ++at) {
      while (kept + 1 < level.index.length && level.index[kept + 1]! <= at) ++kept;
      const from = level.index[kept]!;
      farthest = Math.max(farthest, Math.hypot(track.x[at]! - track.x[from]!, track.y[at]! - track.y[from]!));
    }
    expect(farthest).toBeLessThan(2 * level.spacing);
  }
});

test('a million points of a hundred rounds come down to fewer points than a screen has', () => {
  const levels = levelsOf(circle(100, 1_000_000));
  expect(levelFor(levels, 0.01).index.length).toBe(1_000_000);
  expect(levelFor(levels, 1).index.length).toBeLessThan(70000); // 31.4 km of track in steps of 0.5 m or more
  expect(levels.at(-1)!.index.at(-1)).toBe(999_999);
});

test('the lower bound of a value is the first place that is not below it', () => {
  const values = [1, 3, 3, 7];
  expect([0, 1, 2, 3, 4, 7, 8].map((value) => lowerBound(values, value))).toEqual([0, 0, 1, 1, 3, 3, 4]);
});
