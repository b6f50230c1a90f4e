/** Control points of the background picture: pixels tied to places, with the misfit of the fit through them. */

import type { Translate } from '../i18n/translate';
import type { Feature } from '../model/map_document';
import { controlPointsOf, type ControlPoint } from '../plan/background';
import { h } from '../ui/dom';
import { withProperty, type ObjectKey } from './edits';
import type { Editing } from './editing';
import { cell } from './points_form';
import { rounded } from './survey';

const kColumns = ['column', 'row', 'x_m', 'y_m'] as const;

export function controlPointsForm(editing: Editing, t: Translate, feature: Feature, key: ObjectKey, misfit: number | null): HTMLElement {
  const points = controlPointsOf(editing.map);
  const background = feature.properties['background'];
  const file = typeof background === 'object' && background !== null ? String((background as Record<string, unknown>)['file'] ?? '') : '';

  function store(nextFile: string, next: ControlPoint[]): void {
    const value = nextFile === '' ? undefined : { file: nextFile, control_points: next };
    editing.change(withProperty(editing.map, key, 'background', value));
  }

  const name = h('input', { type: 'text', name: 'background-file', value: file });
  name.addEventListener('change', () => store(name.value, points));
  const rows = points.map((point, index) => {
    const set = (column: (typeof kColumns)[number], value: number): void =>
      store(file, points.map((one, at) => (at === index ? { ...one, [column]: value } : one)));
    const cells = kColumns.map((column) => cell(`control-${index}-${column}`, `${column} ${index + 1}`, point[column], (value) => set(column, value)));
    const drop = h('button', { type: 'button', 'aria-label': t('dropPoint', { n: index + 1 }), onclick: () => store(file, points.filter((_, at) => at !== index)) }, '−');
    return h('tr', {}, ...cells, h('td', {}, drop));
  });
  const head = h('tr', {}, ...['column', 'row', 'E, m', 'N, m', ''].map((word) => h('th', {}, word)));
  const pick = h('button', { type: 'button', disabled: points.length < 3, onclick: () => editing.setTool('control') }, t('pickPixel'));
  const add = h('button', { type: 'button', disabled: file === '', onclick: () => store(file, [...points, { column: 0, row: 0, x_m: 0, y_m: 0 }]) }, t('addPoint'));
  return h(
    'div',
    { class: 'points' },
    h('h2', {}, t('background')),
    h('label', { class: 'field' }, h('span', {}, t('pictureFile')), name),
    h('table', {}, h('thead', {}, head), h('tbody', {}, ...rows)),
    h('div', { class: 'row' }, add, pick),
    h('p', { class: 'faint' }, misfit === null ? t('misfitNone') : t('misfit', { metres: misfit.toFixed(2) })),
  );
}

/** A new control point at a pixel that was picked on the plan; its place is where the fit so far puts it, to be typed over. */
export function withPickedPixel(editing: Editing, column: number, row: number, x: number, y: number): void {
  const site = editing.map.features.find((feature) => feature.properties.object === 'map');
  const background = site?.properties['background'];
  if (!site || typeof background !== 'object' || background === null) return;
  const points = [...controlPointsOf(editing.map), { column: Math.round(column), row: Math.round(row), x_m: rounded(x), y_m: rounded(y) }];
  const key = { object: 'map', id: '' };
  editing.change(withProperty(editing.map, key, 'background', { ...background, control_points: points }), key);
}
