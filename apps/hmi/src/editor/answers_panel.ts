/** What the server says about the map: findings of the check, and what differs from the saved version. */

import { errorWords, serverWords } from '../i18n/server_words';
import type { Translate } from '../i18n/translate';
import type { Change, Finding } from '../protocol/messages';
import { h, replaceChildren, setText } from '../ui/dom';
import type { Editing } from './editing';

const kSigns = { error: '✕', warning: '▲', note: 'ⓘ' } as const;
const kOrder = { error: 0, warning: 1, note: 2 } as const;

export function findingsPanel(editing: Editing, t: Translate, go: (x: number, y: number) => void): HTMLElement {
  const count = h('p', { class: 'faint', role: 'status', 'data-testid': 'finding-count' });
  const list = h('ol', { class: 'findings', 'data-testid': 'findings' });
  const scroll = h('div', { class: 'scroll', tabindex: 0, role: 'group', 'aria-label': t('findings') }, list);
  editing.on('answers', () => show());

  function show(): void {
    const { findings, refusal, remarks } = editing;
    setText(count, refusal !== null ? `✕ ${t('noMap', { why: errorWords(t, refusal) })}` : countWords(findings));
    count.className = refusal === null ? 'faint' : 'bad';
    const sorted = [...findings].sort((a, b) => kOrder[a.severity] - kOrder[b.severity]);
    const notes = remarks.map((remark) => h('li', { class: 'finding-note' }, h('span', {}, `ⓘ ${remark}`)));
    replaceChildren(list, ...sorted.map(item), ...notes);
  }

  function countWords(findings: Finding[]): string {
    if (findings.length === 0) return `✓ ${t('noFindings')}`;
    const of = (severity: Finding['severity']): number => findings.filter((one) => one.severity === severity).length;
    return t('findingCounts', { errors: of('error'), warnings: of('warning'), notes: of('note') });
  }

  function item(finding: Finding): HTMLElement {
    const place = finding.place;
    const words = `${kSigns[finding.severity]} ${serverWords(t, 'check', finding.check, finding.what)}`;
    const head = place ? h('button', { type: 'button', onclick: () => go(place.x_m, place.y_m) }, words) : h('span', {}, words);
    return h('li', { class: `finding-${finding.severity}` }, head, h('span', { class: 'faint' }, finding.remedy));
  }
  return h('section', { class: 'card', 'aria-label': t('findings') }, h('h2', {}, t('findings')), count, scroll);
}

const kChangeSigns: Record<string, string> = { added: '+', removed: '−', changed: '~' };

/** The diff against the saved file, and saving. */
export function savingPanel(editing: Editing, t: Translate, editable: boolean): HTMLElement {
  const words = h('p', { role: 'status', 'data-testid': 'saving' });
  const save = h('button', { type: 'button', class: 'primary', 'data-testid': 'save', onclick: () => void editing.save() }, t('save'));
  const reload = h('button', { type: 'button', 'data-testid': 'reload', onclick: () => void editing.reload() }, t('takeSaved'));
  const rebase = h('button', { type: 'button', 'data-testid': 'rebase', onclick: () => void editing.rebase() }, t('keepMine'));
  const list = h('ul', { class: 'changes', 'data-testid': 'changes' });
  const scroll = h('div', { class: 'scroll', tabindex: 0, role: 'group', 'aria-label': t('changes') }, list);
  editing.on('answers', () => show());
  editing.on('saving', () => show());

  function show(): void {
    const { saving, changes } = editing;
    const conflict = saving.state === 'conflict';
    setText(words, editable ? savingWords(t, editing) : t('readOnly'));
    words.className = conflict || saving.state === 'refused' ? 'bad' : 'faint';
    save.disabled = !editable || saving.state === 'saving' || saving.state === 'clean' || conflict;
    reload.disabled = saving.state === 'saving';
    rebase.hidden = !conflict;
    replaceChildren(list, ...(changes.length > 0 ? changes.map(item) : [h('li', { class: 'faint' }, t('noChanges'))]));
  }

  const item = (change: Change): HTMLElement => h('li', {}, `${kChangeSigns[change.kind] ?? '·'} ${change.words || `${change.object} ${change.key}`}`);
  show();
  return h(
    'section',
    { class: 'card', 'aria-label': t('changes') },
    h('h2', {}, t('changes')),
    words,
    h('div', { class: 'row' }, save, reload, rebase),
    scroll,
  );
}

function savingWords(t: Translate, editing: Editing): string {
  const { state, why, version } = editing.saving;
  const short = version.replaceAll('"', '').slice(0, 8);
  switch (state) {
    case 'clean':
      return t('savedClean', { version: short });
    case 'changed':
      return t('savedChanged', { version: short });
    case 'saving':
      return t('savedBusy');
    case 'saved':
      return `✓ ${t('savedDone', { version: short })}`;
    case 'conflict':
      return `✕ ${t('savedConflict')}`;
    case 'refused':
      return `✕ ${t('failed', { why: errorWords(t, why) })}`;
  }
}
