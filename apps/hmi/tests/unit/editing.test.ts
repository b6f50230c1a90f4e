import { expect, test } from 'vitest';
import { added, found, keyOf, moved, newChamber, redrawn, removed, renamed, withRoadway } from '../../src/editor/edits';
import { History } from '../../src/editor/history';
import { sceneMap } from '../support/scene';

const chamber = { object: 'chamber', id: 'c2' };
const main = { object: 'roadway', id: 'main' };

test('what hangs on a roadway stays in its place when the roadway is drawn 30 m longer at its beginning', () => {
  const map = sceneMap();
  const before = found(map, main)!.geometry!.coordinates as number[][];
  const next = redrawn(map, main, [[-30, 0, 0], ...before.slice(1)]);
  expect(found(next, chamber)!.properties['chainage_m']).toBeCloseTo(250, 3);
  const junction = found(next, { object: 'junction', id: 'J1' })!.properties['places'] as { chainage_m: number }[];
  expect(junction.map((place) => place.chainage_m)).toEqual([180, 0]);
  expect(found(map, chamber)!.properties['chainage_m']).toBe(220); // the old map is as it was
});

test('a roadway that begins on another one is joined to it', () => {
  const { map, key } = withRoadway(sceneMap(), [[50, 0, 0], [50, -80, 0]]);
  const junctions = map.features.filter((feature) => feature.properties.object === 'junction');
  expect(junctions.at(-1)!.properties['places']).toEqual([{ roadway: 'main', chainage_m: 50 }, { roadway: key.id, chainage_m: 0 }]);
});

test('a chamber goes to the wall that it was put beside', () => {
  const map = sceneMap();
  const left = newChamber(map, 60, 3)!;
  expect([left.properties['side'], left.properties['chainage_m']]).toEqual(['left', 60]);
  const across = moved(added(map, left), keyOf(left), 70, -4);
  expect(found(across, keyOf(left))!.properties).toMatchObject({ side: 'right', chainage_m: 70 });
  expect(newChamber(map, 60, 300)).toBeNull();
});

test('a roadway that is taken away takes with it what hangs on it', () => {
  const next = removed(sceneMap(), main);
  const left = next.features.map((feature) => feature.properties.object);
  expect(left.filter((object) => object === 'chamber' || object === 'junction')).toEqual([]);
  expect(left.filter((object) => object === 'anchor').length).toBe(6);
});

test('what names a roadway follows its new name', () => {
  const next = renamed(sceneMap(), main, 'R12');
  expect(found(next, chamber)!.properties['roadway']).toBe('R12');
  expect(JSON.stringify(next)).not.toContain('"roadway":"main"');
});

test('undo and redo go back and forth, and a new change ends what could be redone', () => {
  const history = new History(1);
  [2, 3, 4].forEach((value) => history.push(value));
  history.undo();
  history.undo();
  expect(history.now).toBe(2);
  history.redo();
  expect(history.now).toBe(3);
  history.push(9);
  expect([history.now, history.canRedo]).toEqual([9, false]);
});
