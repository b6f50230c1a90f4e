/** Which model is active, and how probable each one is. */

import { mainEstimator, type Context, type Panel } from '../model/context';
import { percent } from '../model/words';
import { h, replaceChildren } from '../ui/dom';

export function modelsPanel(context: Context): Panel {
  const { t } = context;
  const list = h('ul', { class: 'bars', 'data-testid': 'models' });
  const element = h('section', { class: 'card', 'aria-label': t('models') }, h('h2', {}, t('models')), list);

  function update(): void {
    const now = mainEstimator(context);
    const modes = now?.modes ?? [];
    element.hidden = modes.length === 0;
    replaceChildren(list, ...modes.map((mode) => bar(mode.name, mode.probability, mode.name === now?.mode)));
  }

  function bar(name: string, probability: number, active: boolean): HTMLElement {
    const fill = h('span', { class: 'fill' });
    fill.style.width = `${100 * probability}%`;
    return h(
      'li',
      { class: active ? 'active' : '' },
      h('span', { class: 'name' }, active ? `▶ ${name} (${t('active')})` : name),
      h('span', { class: 'bar', 'aria-hidden': 'true' }, fill),
      h('span', { class: 'value' }, percent(probability)),
    );
  }
  return { element, update };
}
