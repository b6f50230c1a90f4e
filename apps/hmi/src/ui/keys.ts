/** Keys that work anywhere on the page, except while something is typed. */

import { h } from './dom';
import type { TextKey, Translate } from '../i18n/translate';

export interface KeyBinding {
  keys: string[];
  /** As printed in the list of keys. */
  shown: string;
  text: TextKey;
  run(event: KeyboardEvent): void;
}

/** Listens until the returned function is called. */
export function bindKeys(bindings: KeyBinding[]): () => void {
  const listen = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.metaKey || event.altKey || isTyping(event)) return;
    const binding = bindings.find((candidate) => candidate.keys.includes(event.key));
    if (!binding) return;
    event.preventDefault();
    binding.run(event);
  };
  window.addEventListener('keydown', listen);
  return () => window.removeEventListener('keydown', listen);
}

/** Controls keep the keys that they use themselves. */
function isTyping(event: KeyboardEvent): boolean {
  const target = event.target;
  if (!(target instanceof HTMLElement)) return false;
  if (target.closest('dialog')) return true;
  if (target instanceof HTMLInputElement && ['checkbox', 'radio'].includes(target.type)) return event.key === ' ';
  if (target.matches('input[type=range]')) return /^(Arrow|Page|Home|End)/.test(event.key);
  if (target.matches('input, select, textarea')) return true;
  const pressesButton = target.matches('button, a, summary') && (event.key === ' ' || event.key === 'Enter');
  const movesPlan = target.classList.contains('plan') && event.key.startsWith('Arrow');
  return pressesButton || movesPlan;
}

export function keysDialog(t: Translate, bindings: KeyBinding[], extra: { shown: string; text: TextKey }[]): HTMLDialogElement {
  const rows = [...bindings, ...extra].map((one) => h('tr', {}, h('td', {}, h('kbd', {}, one.shown)), h('td', {}, t(one.text))));
  const dialog = h('dialog', { 'aria-label': t('keysTitle') }, h('h2', {}, t('keysTitle')), h('table', {}, h('tbody', {}, ...rows)));
  dialog.append(h('form', { method: 'dialog' }, h('button', { class: 'primary' }, t('close'))));
  return dialog;
}
