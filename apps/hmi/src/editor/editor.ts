/** The editing half of the page. What was drawn outlives a change of language or theme, because `Editing` does. */

import type { Context } from '../model/context';
import type { View } from '../panels/viewer';
import { zoomBy } from '../plan/base_map';
import type { KeyBinding } from '../ui/keys';
import { h, replaceChildren, setText } from '../ui/dom';
import { findingsPanel, savingPanel } from './answers_panel';
import { coverageStrip } from './coverage_strip';
import { EditPlan } from './edit_plan';
import { removed, withRoadway } from './edits';
import type { Editing, Tool } from './editing';
import { propertyPanel } from './property_panel';

export function editor(context: Context, editing: Editing, backgroundAddress: string): View {
  const { t, paint, session } = context;
  editing.forget();
  const host = h('div', { class: 'plan', tabindex: 0, role: 'application', 'aria-label': t('plan') });
  const cursor = h('output', { class: 'cursor' });
  const hint = h('p', { class: 'hint', role: 'status', 'data-testid': 'hint' });
  const plan = new EditPlan(host, editing, paint, t, backgroundAddress);
  const bar = toolbar(context, editing, plan);
  const coverage = coverageStrip(editing, t, paint);
  const side = h(
    'div',
    { class: 'side' },
    propertyPanel(editing, t, () => plan.background.misfit),
    findingsPanel(editing, t, (x, y) => plan.showPlace(x, y)),
    savingPanel(editing, t, session.feed.info.map_editable),
  );
  const planHost = h('section', { class: 'plan-host', 'aria-label': t('plan') }, host, bar, hint, cursor);
  const element = h('div', { class: 'viewer editor' }, h('div', { class: 'left' }, planHost, coverage.element), side);

  plan.map.on('pointermove', (event) => {
    setText(cursor, t('cursor', { x: event.coordinate[0]!.toFixed(2), y: event.coordinate[1]!.toFixed(2) }));
  });
  const showHint = (): void => setText(hint, editing.tool === 'select' ? '' : t(`hint_${editing.tool}`));
  editing.on('tool', showHint);
  showHint();
  requestAnimationFrame(() => (plan.showAll(), editing.check()));

  return { element, keys: keysOf(editing, plan), close: () => plan.map.setTarget() };
}

function toolbar(context: Context, editing: Editing, plan: EditPlan): HTMLElement {
  const { t } = context;
  const tools: [Tool, string][] = [['select', t('toolSelect')], ['roadway', t('kindRoadway')], ['chamber', t('kindChamber')], ['anchor', t('kindAnchor')]];
  const toolButtons = tools.map(([tool, words]) =>
    h('button', { type: 'button', 'data-tool': tool, onclick: () => editing.setTool(tool) }, tool === 'select' ? words : `+ ${words}`),
  );
  const undo = h('button', { type: 'button', 'data-testid': 'undo', onclick: () => editing.undo() }, t('undo'));
  const redo = h('button', { type: 'button', 'data-testid': 'redo', onclick: () => editing.redo() }, t('redo'));
  const drop = h('button', { type: 'button', 'data-testid': 'delete', onclick: () => dropSelected(editing) }, t('delete'));
  const typed = h('select', { 'aria-label': t('addTyped'), 'data-testid': 'add-typed' });
  replaceChildren(typed, h('option', { value: '' }, t('addTyped')), ...tools.slice(1).map(([tool, words]) => h('option', { value: tool }, words)));
  typed.addEventListener('change', () => {
    addTyped(editing, plan, typed.value as Tool | '');
    typed.value = '';
  });
  const update = (): void => {
    toolButtons.forEach((button) => button.setAttribute('aria-pressed', String(button.dataset['tool'] === editing.tool)));
    undo.disabled = !editing.canUndo;
    redo.disabled = !editing.canRedo;
    drop.disabled = editing.selection === null || editing.selection.object === 'map';
  };
  for (const topic of ['map', 'selection', 'tool'] as const) editing.on(topic, update);
  update();
  const zoom = [
    h('button', { type: 'button', 'aria-label': t('zoomIn'), onclick: () => zoomBy(plan.map, 1.6) }, '+'),
    h('button', { type: 'button', 'aria-label': t('zoomOut'), onclick: () => zoomBy(plan.map, 1 / 1.6) }, '−'),
    h('button', { type: 'button', onclick: () => plan.showAll() }, t('fit')),
  ];
  return h('div', { class: 'plan-bar', role: 'toolbar', 'aria-label': t('editMap') }, ...zoom, ...toolButtons, typed, undo, redo, drop);
}

/** Adds an object in the middle of the plan, for typing its coordinates: no mouse is needed. */
function addTyped(editing: Editing, plan: EditPlan, tool: Tool | ''): void {
  const [x, y] = plan.centre();
  if (tool === 'roadway') {
    const { map, key } = withRoadway(editing.map, [[x - 10, y, 0], [x + 10, y, 0]]);
    editing.change(map, key);
  } else if (tool === 'anchor' || tool === 'chamber') {
    if (!plan.addPoint(tool, x, y)) plan.addPointOnFirstRoadway();
  }
  document.querySelector<HTMLElement>('[data-testid=properties] input')?.focus();
}

function dropSelected(editing: Editing): void {
  if (editing.selection && editing.selection.object !== 'map') editing.change(removed(editing.map, editing.selection), null);
}

function keysOf(editing: Editing, plan: EditPlan): KeyBinding[] {
  const tool = (key: string, which: Tool, text: KeyBinding['text']): KeyBinding => ({
    keys: [key],
    shown: key.toUpperCase(),
    text,
    run: () => editing.setTool(which),
  });
  return [
    tool('s', 'select', 'toolSelect'),
    tool('r', 'roadway', 'keyRoadway'),
    tool('c', 'chamber', 'keyChamber'),
    tool('a', 'anchor', 'keyAnchor'),
    { keys: ['u'], shown: 'U', text: 'undo', run: () => editing.undo() },
    { keys: ['y'], shown: 'Y', text: 'redo', run: () => editing.redo() },
    { keys: ['Delete'], shown: 'Del', text: 'delete', run: () => dropSelected(editing) },
    {
      keys: ['Escape'],
      shown: 'Esc',
      text: 'keyEscape',
      run: () => {
        plan.abortDrawing();
        editing.setTool('select');
      },
    },
    { keys: ['0', 'Home'], shown: '0', text: 'keyFit', run: () => plan.showAll() },
    { keys: ['+', '='], shown: '+', text: 'zoomIn', run: () => zoomBy(plan.map, 1.6) },
    { keys: ['-'], shown: '−', text: 'zoomOut', run: () => zoomBy(plan.map, 1 / 1.6) },
  ];
}
