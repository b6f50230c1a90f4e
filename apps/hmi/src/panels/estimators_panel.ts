/** The estimators and the truth: line on the plan, error, which are shown and which is told in words. */

import { lineOf, mainEstimator, trackNames, type Context, type Line, type Panel } from '../model/context';
import { metres, percent } from '../model/words';
import { h, setText, svg } from '../ui/dom';

export function estimatorsPanel(context: Context): Panel {
  const { t, options, session } = context;
  const rows = trackNames(context).map((name) => row(name));
  const head = h('tr', {}, h('th', {}, t('shown')), h('th', {}, t('main')), h('th', {}, t('errorNow')), h('th', {}, t('gated')));
  const table = h('table', {}, h('thead', {}, head), h('tbody', {}, ...rows.map((one) => one.element)));
  const element = h('section', { class: 'card', 'aria-label': t('estimators') }, h('h2', {}, t('estimators')), table);

  function row(name: string) {
    const isTruth = name === 'truth';
    const shownName = isTruth ? t('truth') : name;
    const box = h('input', { type: 'checkbox', onchange: () => options.toggle(name) });
    const radio = h('input', { type: 'radio', name: 'main', 'aria-label': `${t('main')}: ${name}`, onchange: () => options.set({ main: name }) });
    const error = h('td', { class: 'number' });
    const gated = h('td', { class: 'number' });
    const label = h('label', {}, box, sample(lineOf(context, name)), shownName);
    const element = h('tr', {}, h('td', {}, label), h('td', {}, isTruth ? null : radio), error, gated);
    return { name, box, radio, error, gated, element };
  }

  function update(): void {
    const main = mainEstimator(context);
    for (const one of rows) {
      one.box.checked = !options.now.hidden.has(one.name);
      one.radio.checked = main?.name === one.name;
      const now = session.state?.estimators.find((estimator) => estimator.name === one.name);
      if (!now) continue;
      setText(one.error, metres(now.error_m));
      const { applied = 0, gated = 0 } = now.verdicts ?? {};
      setText(one.gated, applied + gated > 0 ? percent(gated / (applied + gated)) : '–');
    }
  }
  return { element, update };
}

/** A piece of the line, with its dashes: the colour is not the only way to tell two estimators apart. */
function sample(line: Line): SVGElement {
  return svg(
    'svg',
    { width: 34, height: 10, 'aria-hidden': 'true' },
    svg('line', { x1: 0, y1: 5, x2: 34, y2: 5, stroke: line.colour, 'stroke-width': 3, 'stroke-dasharray': line.dash.join(' ') }),
  );
}
