import { expect, test } from 'vitest';
import { greatest, latest } from '../../src/charts/bins';
import { texts } from '../../src/i18n/texts';
import { translator } from '../../src/i18n/translate';
import { clock, placeWords } from '../../src/model/words';
import { bearing } from '../../src/panels/position_panel';
import { covers } from '../../src/plan/kept_picture';
import { partsOf } from '../../src/plan/track_parts';
import { sceneState } from '../support/scene';

test('both languages fill in the same names in every text', () => {
  const names = (pattern: string): string => [...pattern.matchAll(/\{(\w+)\}/g)].map((match) => match[1]).sort().join();
  for (const [key, [english, chinese]] of Object.entries(texts)) {
    expect(`${key} ${names(chinese)}`).toBe(`${key} ${names(english)}`);
    expect(chinese.length, key).toBeGreaterThan(0);
  }
});

test('a place is told in words in both languages', () => {
  const place = { ...sceneState('run', 20).estimators[0]!.place!, roadway: 'R12', chainage_m: 345.21, interval: 'j_2' };
  expect(placeWords(translator('en'), place)).toBe('R12, 345.2 m, interval j_2, lock held');
  expect(placeWords(translator('zh'), place)).toBe('R12，345.2 米，区间 j_2，已持锁');
});

test('clock and bearing are those that people use', () => {
  expect([0, 61.04, 3725.25, 59.96].map(clock)).toEqual(['0:00.0', '1:01.0', '1:02:05.3', '1:00.0']);
  expect([0, Math.PI / 2, Math.PI, -Math.PI / 2].map((yaw) => Math.round(bearing(yaw)))).toEqual([90, 0, 270, 180]);
});

test('a bin keeps its greatest value, so a short peak is never lost', () => {
  const stamp = Float64Array.from([0, 1, 2, 3, 4, 5, 6, 7]);
  const values = [1, 9, 2, 2, NaN, 3, 1, 1];
  const value = (row: number): number | null => (Number.isNaN(values[row]) ? null : values[row]!);
  expect(greatest(stamp, value, { from: 0, to: 8, count: 4 })).toEqual([9, 2, 3, 1]);
  expect(latest(stamp, value, { from: 0, to: 8, count: 2 })).toEqual([2, 1]);
});

test('the parts of a long track are all of it, and only its moving ends are painted in each frame', () => {
  for (const end of [1, 2048, 30000, 99999, 100000]) {
    const parts = partsOf(100000, 0, end, true);
    const steps = new Set<number>(); // step i is the line from row i to the next
    for (const part of parts) for (let row = part.first; row + 1 < part.end; ++row) steps.add(row);
    let missing = 0;
    for (let row = 0; row < 99999; ++row) if (!steps.has(row)) ++missing;
    expect(parts.filter((part) => !part.kept).reduce((sum, part) => sum + part.end - part.first, 0)).toBeLessThan(3 * 2048);
    expect(missing).toBe(0);
  }
});

test('a kept picture serves as long as it has the window and is not too coarse', () => {
  const picture = { left: -100, top: 100, width: 400, height: 400, resolution: 0.5 };
  const window = { left: 0, top: 0, width: 100, height: 100, resolution: 0.5 };
  expect(covers(picture, window)).toBe(true);
  expect(covers(picture, { ...window, left: -110 })).toBe(false);
  expect(covers(picture, { ...window, resolution: 0.2 })).toBe(false);
});
