/** The properties of the selected object as a form; each finished entry is one step of undo. */

import type { Translate } from '../i18n/translate';
import { idOf, type Feature } from '../model/map_document';
import { h, replaceChildren } from '../ui/dom';
import { controlPointsForm } from './control_points';
import { choiceWords, keyWords } from './key_words';
import { found, renamed, reshaped, withProperty, type ObjectKey } from './edits';
import type { Editing } from './editing';
import { pointsForm } from './points_form';
import { kFields, kKinds, type Field } from './schema';

export function propertyPanel(editing: Editing, t: Translate, misfit: () => number | null): HTMLElement {
  const choice = h('select', { 'aria-label': t('object'), 'data-testid': 'object', onchange: () => editing.select(parsed(choice.value)) });
  const form = h('div', { class: 'form', 'data-testid': 'properties' });
  editing.on('map', () => show());
  editing.on('selection', () => show());

  function show(): void {
    const focused = document.activeElement?.getAttribute('name') ?? null;
    replaceChildren(choice, h('option', { value: '' }, t('nothingSelected')), ...groups(editing, t));
    const feature = found(editing.map, editing.selection);
    if (!feature || !editing.selection) {
      choice.value = '';
      replaceChildren(form, h('p', { class: 'faint' }, t('selectHint')));
      return;
    }
    const key = editing.selection;
    choice.value = valueOf(key);
    const fields = (kFields[key.object] ?? scalars(feature)).map((field) => row(editing, t, feature, key, field));
    const points = feature.geometry && ['roadway', 'anchor'].includes(key.object) ? pointsForm(editing, t, feature, key) : null;
    const controls = key.object === 'map' ? controlPointsForm(editing, t, feature, key, misfit()) : null;
    replaceChildren(form, ...fields, points, controls);
    if (focused) form.querySelector<HTMLElement>(`[name="${CSS.escape(focused)}"]`)?.focus();
  }
  show();
  return h('section', { class: 'card', 'aria-label': t('properties') }, h('h2', {}, t('properties')), choice, form);
}

const valueOf = (key: ObjectKey): string => `${key.object} ${key.id}`;

function parsed(value: string): ObjectKey | null {
  const space = value.indexOf(' ');
  return space < 0 ? null : { object: value.slice(0, space), id: value.slice(space + 1) };
}

function groups(editing: Editing, t: Translate): HTMLElement[] {
  return kKinds.flatMap((kind) => {
    const of = editing.map.features.filter((feature) => feature.properties.object === kind);
    if (of.length === 0) return [];
    const options = of.map((feature) => h('option', { value: valueOf({ object: kind, id: idOf(feature) }) }, `${t(kindKey(kind))} ${idOf(feature)}`));
    return [h('optgroup', { label: t(kindKey(kind)) }, ...options)];
  });
}

export function kindKey(kind: string) {
  const keys = {
    roadway: 'kindRoadway',
    chamber: 'kindChamber',
    anchor: 'kindAnchor',
    junction: 'kindJunction',
    portal: 'kindPortal',
    light: 'kindLight',
    stop_line: 'kindStopLine',
    bend: 'kindBend',
    zone: 'kindZone',
    crossing: 'kindCrossing',
    route: 'kindRoute',
    map: 'kindMap',
  } as const;
  return keys[kind as keyof typeof keys] ?? 'object';
}

/** What a kind without a list of fields has by way of numbers, texts and flags. */
function scalars(feature: Feature): Field[] {
  return Object.entries(feature.properties).flatMap(([key, value]): Field[] => {
    if (key === 'object') return [];
    if (typeof value === 'number') return [{ key, type: 'number', unit: '' }];
    if (typeof value === 'boolean') return [{ key, type: 'flag' }];
    return typeof value === 'string' ? [{ key, type: 'text' }] : [];
  });
}

function row(editing: Editing, t: Translate, feature: Feature, key: ObjectKey, field: Field): HTMLElement {
  const value = feature.properties[field.key];
  const take = (next: unknown): void => {
    if (next === value) return;
    const target = { object: key.object, id: field.key === 'id' ? String(next) : key.id };
    editing.change(changed(editing, key, field.key, next), target);
  };
  const words = keyWords(t, field.key) + (field.type === 'number' && field.unit ? `, ${field.unit}` : '');
  return h('label', { class: 'field' }, h('span', {}, words), control(field, value, t, take));
}

function changed(editing: Editing, key: ObjectKey, name: string, value: unknown) {
  if (name === 'id') return renamed(editing.map, key, value as string | number);
  if (name !== 'chainage_start_m') return withProperty(editing.map, key, name, value);
  return reshaped(editing.map, key, (feature) => ({ ...feature, properties: { ...feature.properties, [name]: value ?? 0 } }));
}

function control(field: Field, value: unknown, t: Translate, take: (value: unknown) => void): HTMLElement {
  const common = { name: field.key };
  if (field.type === 'flag') {
    const box = h('input', { ...common, type: 'checkbox', onchange: () => take(box.checked) });
    box.checked = value === true;
    return box;
  }
  const needed = 'needed' in field && field.needed === true;
  if (field.type === 'choice') {
    const select = h('select', { ...common, onchange: () => take(select.value === '' ? undefined : select.value) });
    const none = needed ? [] : [h('option', { value: '' }, t('byDefault'))];
    replaceChildren(select, ...none, ...field.choices.map((one) => h('option', { value: one }, choiceWords(t, one))));
    select.value = typeof value === 'string' ? value : '';
    return select;
  }
  const isNumber = field.type === 'number';
  const text = typeof value === 'number' || typeof value === 'string' ? String(value) : '';
  const input = h('input', { ...common, type: isNumber ? 'number' : 'text', step: 'any', value: text, required: needed });
  input.addEventListener('change', () => {
    if (!input.checkValidity()) return void input.reportValidity();
    take(input.value === '' ? undefined : isNumber ? Number(input.value) : input.value);
  });
  return input;
}
