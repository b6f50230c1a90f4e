/** The plan with its buttons and its legend. */

import { lineOf, type Context, type Panel } from '../model/context';
import type { ColourBy } from '../model/view_options';
import { zoomBy } from '../plan/base_map';
import { PlanView } from '../plan/plan_view';
import { kErrorLimits } from '../plan/track_classes';
import { h, replaceChildren, setText } from '../ui/dom';

export interface PlanPanel extends Panel {
  fit(): void;
  zoom(factor: number): void;
  view: PlanView;
}

export function planPanel(context: Context): PlanPanel {
  const { t, options } = context;
  const host = h('div', { class: 'plan', tabindex: 0, role: 'application', 'aria-label': t('plan') });
  const cursor = h('output', { class: 'cursor' });
  const legend = h('div', { class: 'legend', role: 'note', 'aria-label': t('legend') });
  const follow = h('button', { type: 'button', 'data-testid': 'follow', onclick: () => options.set({ follow: !options.now.follow }) });
  const bar = h(
    'div',
    { class: 'plan-bar', role: 'toolbar', 'aria-label': t('plan') },
    h('button', { type: 'button', 'aria-label': t('zoomIn'), title: `${t('zoomIn')} (+)`, onclick: () => zoomBy(view.map, 1.6) }, '+'),
    h('button', { type: 'button', 'aria-label': t('zoomOut'), title: `${t('zoomOut')} (−)`, onclick: () => zoomBy(view.map, 1 / 1.6) }, '−'),
    h('button', { type: 'button', onclick: () => fit() }, t('fit')),
    follow,
    colourSelect(context),
    trailSelect(context),
  );
  const element = h('section', { class: 'plan-host', 'aria-label': t('plan') }, host, bar, legend, cursor);
  const view = new PlanView(host, context);
  view.map.on('pointermove', (event) => {
    const [x, y] = [event.coordinate[0]!, event.coordinate[1]!];
    setText(cursor, t('cursor', { x: x.toFixed(2), y: y.toFixed(2) }));
  });

  function fit(): void {
    options.set({ follow: false });
    view.showAll();
  }

  function update(): void {
    const { follow: follows } = options.now;
    follow.setAttribute('aria-pressed', String(follows));
    setText(follow, `${follows ? '✓ ' : ''}${t('follow')}`);
    showLegend(context, legend);
    view.update();
  }
  return { element, update, fit, zoom: (factor) => zoomBy(view.map, factor), view };
}

function colourSelect(context: Context): HTMLElement {
  const { t, options } = context;
  const choices: [ColourBy, string][] = [['estimator', t('colourEstimator')], ['error', t('colourError')], ['zone', t('colourZone')]];
  const select = h('select', { onchange: () => options.set({ colourBy: select.value as ColourBy }) });
  replaceChildren(select, ...choices.map(([value, name]) => h('option', { value, selected: value === options.now.colourBy }, name)));
  return h('label', {}, t('colourBy'), ' ', select);
}

function trailSelect(context: Context): HTMLElement {
  const { t, options } = context;
  const select = h('select', {
    onchange: () => options.set({ trailMinutes: select.value === '' ? null : Number(select.value) }),
  });
  const minutes = [1, 5, 10, 60];
  const kept = options.now.trailMinutes;
  replaceChildren(
    select,
    h('option', { value: '', selected: kept === null }, t('trailAll')),
    ...minutes.map((value) => h('option', { value, selected: value === kept }, t('trailMinutes', { minutes: value }))),
  );
  return h('label', {}, t('trail'), ' ', select);
}

function showLegend(context: Context, legend: HTMLElement): void {
  const { t, paint, options, session } = context;
  const key = `${options.now.colourBy}${session.state?.mode}${[...options.now.hidden].join()}`;
  if (legend.dataset['key'] === key) return;
  legend.dataset['key'] = key;
  replaceChildren(legend, ...lineEntries(context), ...signEntries());

  function lineEntries(one: Context): HTMLElement[] {
    if (options.now.colourBy === 'error') {
      const limits = ['0', ...kErrorLimits.map(String)];
      const words = limits.map((limit, index) => (index < kErrorLimits.length ? `${limit}–${kErrorLimits[index]!}` : `> ${limit}`));
      return [h('span', {}, t('legendError')), ...words.map((word, index) => entry('━', paint.scale[index]!, word))];
    }
    if (options.now.colourBy === 'zone') return [h('span', {}, t('legendZone'))];
    const shown = session.feed.info.tracks.filter((name) => !options.now.hidden.has(name));
    return shown.map((name) => entry(name === 'truth' ? '┼' : '━', lineOf(one, name).colour, name === 'truth' ? t('legendTruth') : name));
  }

  function signEntries(): HTMLElement[] {
    const entries: HTMLElement[] = [];
    if (session.mine.intervals.length > 0)
      entries.push(entry('▬', paint.locked, t('legendHeld')), entry('╍', paint.warning, t('legendDoubtful')));
    if (session.mine.anchors.length > 0 && (session.state?.mode === 'live' || session.state?.mode === 'replay'))
      entries.push(entry('▲', paint.good, t('legendSeen')), entry('⊗', paint.bad, t('legendRejected')), entry('△', paint.faint, t('legendSilent')));
    return entries;
  }
}

function entry(sign: string, colour: string, words: string): HTMLElement {
  const mark = h('span', { class: 'sign', 'aria-hidden': 'true' }, sign);
  mark.style.color = colour;
  return h('span', { class: 'entry' }, mark, words);
}
