/** A row of tabs; left and right arrow go from one to the next. */

import { h } from './dom';

export function tabs(label: string, names: string[], onChoose: (index: number) => void): HTMLElement {
  const buttons = names.map((name, index) =>
    h('button', { type: 'button', role: 'tab', 'aria-selected': index === 0 ? 'true' : 'false', onclick: () => choose(index) }, name),
  );
  function choose(index: number): void {
    buttons.forEach((button, at) => {
      button.setAttribute('aria-selected', String(at === index));
      button.tabIndex = at === index ? 0 : -1;
    });
    onChoose(index);
  }
  const list = h('div', { role: 'tablist', class: 'tabs', 'aria-label': label }, ...buttons);
  list.addEventListener('keydown', (event) => {
    const step = event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0;
    if (step === 0) return;
    event.stopPropagation();
    const at = buttons.findIndex((button) => button === document.activeElement);
    const next = (at + step + buttons.length) % buttons.length;
    buttons[next]!.focus();
    choose(next);
  });
  buttons.forEach((button, at) => (button.tabIndex = at === 0 ? 0 : -1));
  return list;
}
