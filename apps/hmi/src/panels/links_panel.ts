/** Connection of every source and anchor: a sign, a word, age, rate and share of rejected readings. */

import type { Context, Panel } from '../model/context';
import { age, linkWords, percent } from '../model/words';
import type { AnchorNow, LinkState, SourceNow } from '../protocol/messages';
import { h, replaceChildren, setText } from '../ui/dom';

const kSigns: Record<LinkState, string> = { waiting: '○', connected: '●', stale: '◐', lost: '✕', invalid: '!', event: '◇' };

export function linksPanel(context: Context): Panel {
  const { t, session } = context;
  const sourceBody = h('tbody', { 'data-testid': 'sources' });
  const anchorBody = h('tbody', { 'data-testid': 'anchors' });
  const counts = h('p', { class: 'faint', 'data-testid': 'anchor-counts' });
  const head = (first: string) =>
    h('thead', {}, h('tr', {}, ...[first, t('state'), t('age'), t('rate'), t('gated')].map((name) => h('th', {}, name))));
  const sources = h('section', { class: 'card', 'aria-label': t('sources') }, h('h2', {}, t('sources')), h('table', {}, head(t('source')), sourceBody));
  const scroll = h('div', { class: 'scroll', tabindex: 0, role: 'group', 'aria-label': t('anchors') }, h('table', {}, head(t('anchor')), anchorBody));
  const anchors = h('section', { class: 'card', 'aria-label': t('anchors') }, h('h2', {}, t('anchors')), counts, scroll);
  const element = h('div', { class: 'links' }, sources, anchors);

  function update(): void {
    const state = session.state;
    const live = state !== null && (state.mode === 'live' || state.mode === 'replay');
    element.hidden = !live;
    if (!live) return;
    if (state.sources.length === 0) replaceChildren(sourceBody, h('tr', {}, h('td', { colspan: 5 }, t('noSources'))));
    else syncRows(sourceBody, state.sources.map(sourceCells));
    const lastSeen = [...state.anchors].sort(byInterest);
    syncRows(anchorBody, lastSeen.map(anchorCells));
    const count = (seen: AnchorNow['seen']): number => state.anchors.filter((anchor) => anchor.seen === seen).length;
    setText(counts, t('anchorCounts', { seen: count('seen'), rejected: count('rejected'), lost: count('not_seen') }));
    anchors.hidden = state.anchors.length === 0;
  }

  function sourceCells(source: SourceNow): Row {
    const word = `${kSigns[source.state]} ${linkWords(t, source.state)}${source.why ? `: ${source.why}` : ''}`;
    return { state: source.state, cells: [source.name, word, age(source.age_s), rate(source.period_s), percent(source.gated_ratio)] };
  }

  function anchorCells(anchor: AnchorNow): Row {
    const rejected = anchor.seen === 'rejected';
    const word = rejected ? `⊘ ${t('rejected')}` : `${kSigns[anchor.state]} ${linkWords(t, anchor.state)}`;
    const state = rejected ? 'rejected' : anchor.state;
    return { state, cells: [String(anchor.id), word, age(anchor.age_s), rate(anchor.period_s), percent(anchor.gated_ratio)] };
  }
  return { element, update };
}

/** Rejected first, then seen, then silent; by number within. */
function byInterest(a: AnchorNow, b: AnchorNow): number {
  const rank = { rejected: 0, seen: 1, not_seen: 2 };
  return rank[a.seen] - rank[b.seen] || a.id - b.id;
}

interface Row {
  state: string;
  cells: string[];
}

/** Changes only what is different, so that a reader's selection and a screen reader's place stay. */
function syncRows(body: HTMLTableSectionElement, rows: Row[]): void {
  while (body.rows.length > rows.length) body.deleteRow(-1);
  rows.forEach((row, index) => {
    const line = body.rows[index] ?? body.insertRow();
    line.className = `link-${row.state}`;
    while (line.cells.length > row.cells.length) line.deleteCell(-1);
    row.cells.forEach((text, column) => {
      const cell = line.cells[column] ?? line.insertCell();
      cell.removeAttribute('colspan');
      setText(cell, text);
    });
  });
}

function rate(period: number | null): string {
  return period === null || period <= 0 ? '–' : `${(1 / period).toFixed(1)} Hz`;
}
