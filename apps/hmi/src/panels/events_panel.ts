/** The latest events, newest first; pressing one goes to its moment. */

import type { Context, Panel } from '../model/context';
import { clock } from '../model/words';
import { h, replaceChildren } from '../ui/dom';
import { eventWords, isTrouble } from './event_words';

const kShown = 200;

export function eventsPanel(context: Context, seek: (stamp: number) => void): Panel {
  const { t, session } = context;
  const list = h('ol', { class: 'events', 'data-testid': 'events' });
  const scroll = h('div', { class: 'scroll', tabindex: 0, role: 'group', 'aria-label': t('events') }, list);
  const element = h('section', { class: 'card', 'aria-label': t('events') }, h('h2', {}, t('events')), scroll);
  let shown = -1;

  function update(): void {
    if (session.events.length === shown) return;
    shown = session.events.length;
    const origin = session.state?.first_s ?? session.feed.info.first_s ?? 0;
    const latest = session.events.slice(-kShown).reverse();
    const items = latest.map((event) => {
      const stamp = event.stamp_s;
      const moment = stamp === null ? null : h('button', { type: 'button', onclick: () => seek(stamp) }, clock(stamp - origin));
      const words = `${isTrouble(event) ? '⚠ ' : ''}${event.estimator ? `${event.estimator}: ` : ''}${eventWords(t, event)}`;
      return h('li', { class: isTrouble(event) ? 'trouble' : '', title: event.detail }, moment, h('span', {}, words));
    });
    replaceChildren(list, ...(items.length > 0 ? items : [h('li', {}, t('noEvents'))]));
  }
  return { element, update };
}
