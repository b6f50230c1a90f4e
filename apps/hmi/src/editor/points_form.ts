/** Typed coordinates of an anchor or of the corners of a roadway: in the map, or in the mine's own grid. */

import type { Translate } from '../i18n/translate';
import type { Point3 } from '../model/centreline';
import type { Feature } from '../model/map_document';
import { h } from '../ui/dom';
import { redrawn, replaced, reshaped, type ObjectKey } from './edits';
import type { Editing } from './editing';
import { fromGrid, mineGridOf, rounded, toGrid, type MineGrid } from './survey';

const kAxes = ['E', 'N', 'Z'] as const;

export function pointsForm(editing: Editing, t: Translate, feature: Feature, key: ObjectKey): HTMLElement {
  const grid = mineGridOf(editing.map);
  const corners = cornersOf(feature);
  const isRoadway = key.object === 'roadway';
  const arcs = Array.isArray(feature.properties['arc_deg']) ? (feature.properties['arc_deg'] as unknown[]) : [];
  const head = h('tr', {}, h('th', {}, '#'), ...kAxes.map((axis) => h('th', {}, `${axis}, m`)), isRoadway ? h('th', {}, t('arc')) : null, isRoadway ? h('th', {}) : null);
  const rows = corners.map((corner, index) => {
    const shown = grid ? toGrid(grid, corner) : corner;
    const cells = kAxes.map((axis, at) => cell(`point-${index}-${axis}`, `${axis} ${index + 1}`, shown[at]!, (value) => setAxis(index, at, value)));
    const arc = isRoadway ? cell(`arc-${index}`, `${t('arc')} ${index + 1}`, Number(arcs[index] ?? 0), (value) => setArc(index, value)) : null;
    return h('tr', {}, h('td', {}, String(index + 1)), ...cells, arc, isRoadway ? buttons(index) : null);
  });

  function setAxis(index: number, axis: number, value: number): void {
    const shown = [...(grid ? toGrid(grid, corners[index]!) : corners[index]!)] as [number, number, number];
    shown[axis] = value;
    const next = corners.map((corner, at) => (at === index ? local(grid, shown) : corner));
    store(next);
  }

  function store(points: Point3[]): void {
    const coordinates = points.map((point) => point.map(rounded));
    if (isRoadway) return editing.change(redrawn(editing.map, key, coordinates));
    editing.change(replaced(editing.map, key, (one) => ({ ...one, geometry: { type: 'Point', coordinates: coordinates[0]! } })));
  }

  function setArc(index: number, value: number): void {
    const next = corners.map((_, at) => (at === index ? value : Number(arcs[at] ?? 0))).map((arc) => (arc === 0 ? null : arc));
    const change = next.some((arc) => arc !== null) ? { arc_deg: next } : {};
    const without = ({ arc_deg: _, ...rest }: Feature['properties']): Feature['properties'] => rest as Feature['properties'];
    editing.change(reshaped(editing.map, key, (one) => ({ ...one, properties: { ...without(one.properties), ...change } as Feature['properties'] })));
  }

  function buttons(index: number): HTMLElement {
    const [here, next] = [corners[index]!, corners[index + 1] ?? extrapolated(corners)];
    const middle = here.map((value, axis) => (value + next[axis]!) / 2) as unknown as Point3;
    const insert = index === corners.length - 1 ? next : middle;
    const add = (): void => store([...corners.slice(0, index + 1), insert, ...corners.slice(index + 1)]);
    const drop = (): void => store(corners.filter((_, at) => at !== index));
    return h(
      'td',
      { class: 'number' },
      h('button', { type: 'button', 'aria-label': t('addPointAfter', { n: index + 1 }), onclick: add }, '+'),
      h('button', { type: 'button', 'aria-label': t('dropPoint', { n: index + 1 }), disabled: corners.length <= 2, onclick: drop }, '−'),
    );
  }

  const caption = h('p', { class: 'faint' }, grid ? t('inMineGrid', { name: grid.name || '–' }) : t('inMap'));
  return h('div', { class: 'points' }, caption, h('table', {}, h('thead', {}, head), h('tbody', {}, ...rows)));
}

function cornersOf(feature: Feature): Point3[] {
  const geometry = feature.geometry;
  const lists = geometry?.type === 'LineString' ? geometry.coordinates : geometry?.type === 'Point' ? [geometry.coordinates] : [];
  return lists.map((list) => [list[0] ?? 0, list[1] ?? 0, list[2] ?? 0] as const);
}

function local(grid: MineGrid | null, shown: Point3): Point3 {
  return grid ? fromGrid(grid, shown) : shown;
}

/** 10 m further in the last direction. */
function extrapolated(corners: Point3[]): Point3 {
  const [a, b] = [corners[corners.length - 2] ?? [0, 0, 0], corners[corners.length - 1]!];
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
  return [b[0] + (10 * (b[0] - a[0])) / length, b[1] + (10 * (b[1] - a[1])) / length, b[2]];
}

export function cell(name: string, label: string, value: number, take: (value: number) => void): HTMLElement {
  const input = h('input', { type: 'number', step: 'any', name, 'aria-label': label, value: String(rounded(value)), required: true });
  input.addEventListener('change', () => {
    if (input.checkValidity()) take(Number(input.value));
    else input.reportValidity();
  });
  return h('td', {}, input);
}
