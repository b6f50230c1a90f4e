import { expect, test } from 'vitest';
import { readState } from '../../src/protocol/messages';
import { trackBytes, trackRows } from '../../src/protocol/track_bytes';
import { sceneState } from '../support/scene';

const asSent = (): Record<string, unknown> => JSON.parse(JSON.stringify(sceneState('live', 12))) as Record<string, unknown>;

test('a state is read as it was sent, and keys that are new are let through', () => {
  const state = readState({ ...asSent(), brand_new: 1 }, 'state');
  expect(state.stamp_s).toBe(12);
  expect(state.estimators[0]!.place!.roadway).toBe('main');
});

test('a value of the wrong kind is refused with its path', () => {
  const sent = asSent();
  (sent['estimators'] as { pose: { x_m: unknown } }[])[1]!.pose.x_m = 'far away';
  expect(() => readState(sent, 'state')).toThrow('state.estimators[1].pose.x_m: got "far away", expected a number');
  expect(() => readState({ ...asSent(), mode: 'dream' }, 'state')).toThrow('one of run, replay, live, map');
});

test('the bytes of a track give back its rows', () => {
  const rows = trackRows(trackBytes([1.7e9 + 0.25, 1.7e9 + 0.5], [[1, 2], [3, NaN]]), ['x_m', 'nis']);
  expect(Array.from(rows.stamp)).toEqual([1.7e9 + 0.25, 1.7e9 + 0.5]);
  expect(Array.from(rows.columns.get('x_m')!)).toEqual([1, 2]);
  expect(Array.from(rows.columns.get('nis')!)).toEqual([3, NaN]);
});

test('bytes that were cut off, or that are something else, are refused', () => {
  const bytes = trackBytes([1, 2], [[1, 2]]);
  expect(() => trackRows(bytes.slice(0, bytes.byteLength - 4), ['x_m'])).toThrow('44 bytes');
  expect(() => trackRows(new TextEncoder().encode('<!doctype html><html></html>').buffer as ArrayBuffer, [])).toThrow('POSTRK01');
});
