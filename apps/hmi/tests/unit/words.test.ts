import { readFileSync } from 'node:fs';
import { expect, test } from 'vitest';
import { greatest, latest } from '../../src/charts/bins';
import { errorWords, serverWords } from '../../src/i18n/server_words';
import { texts } from '../../src/i18n/texts';
import { translator } from '../../src/i18n/translate';
import { clock, placeWords } from '../../src/model/words';
import { eventWords } from '../../src/panels/event_words';
import { bearing } from '../../src/panels/position_panel';
import { covers } from '../../src/plan/kept_picture';
import { partsOf } from '../../src/plan/track_parts';
import { Refusal } from '../../src/protocol/client';
import { sceneState } from '../support/scene';

test('both languages fill in the same names in every text', () => {
  const names = (pattern: string): string => [...pattern.matchAll(/\{(\w+)\}/g)].map((match) => match[1]).sort().join();
  for (const [key, [english, chinese]] of Object.entries(texts)) {
    expect(`${key} ${names(chinese)}`).toBe(`${key} ${names(english)}`);
    expect(chinese.length, key).toBeGreaterThan(0);
  }
});

test('what the server says is told in the reader\'s language by its code, with its own words', () => {
  const failure = { status: 412, code: 'conflict', what: 'the file has another version', place: '', key: '', got: '', expected: '', suggestion: '' };
  expect(errorWords(translator('en'), new Refusal(failure))).toBe('the file has another version');
  expect(errorWords(translator('zh'), new Refusal(failure))).toBe('其他人已保存了该地图（the file has another version）');
  expect(errorWords(translator('zh'), new Refusal({ ...failure, code: 'brand_new' }))).toBe('the file has another version');
  expect(serverWords(translator('zh'), 'check', 'few_anchors', 'anchor 3 is alone')).toBe('可见基站不足（anchor 3 is alone）');
});

test('every code of the server has Chinese words', () => {
  const read = (path: string): string => readFileSync(new URL(`../../../../${path}`, import.meta.url), 'utf8');
  const errors = /Codes: ([^.]*)\./s.exec(read('docs/formats/serve.md'))![1]!;
  const codes = [...errors.matchAll(/`([a-z_]+)`/g)].map((match) => `error_${match[1]!}`);
  const checks = /kNames = \{([^}]*)\}/s.exec(read('libpos/src/map/checks.cpp'))![1]!;
  codes.push(...[...checks.matchAll(/"([a-z_]+)"/g)].map((match) => `check_${match[1]!}`));
  expect(codes.length).toBeGreaterThan(35);
  expect(codes.filter((code) => !(code in texts))).toEqual([]);
});

test('an event is told without the figures that belong into the table', () => {
  const event = { n: 0, stamp_s: 1, estimator: '', kind: 'source_stale', sensor: 'uwb', detail: 'silent for 0.812345 s' };
  expect(eventWords(translator('en'), event)).toBe('source is stale · uwb · silent for 0.8 s');
  expect(eventWords(translator('zh'), event)).toBe('数据源陈旧 · uwb · 已静默 0.8 秒');
  expect(eventWords(translator('en'), { ...event, kind: 'interval_entry', sensor: '', detail: 'j_3 k3>main at 17.2 s' })).toBe('enters interval · j_3');
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
