/** The viewing half of the page: plan, charts, timeline, and the cards beside them. */

import { chartsPanel } from '../charts/charts_panel';
import type { Context } from '../model/context';
import type { KeyBinding } from '../ui/keys';
import { h } from '../ui/dom';
import { estimatorsPanel } from './estimators_panel';
import { eventsPanel } from './events_panel';
import { linksPanel } from './links_panel';
import { modelsPanel } from './models_panel';
import { planPanel } from './plan_panel';
import { positionPanel } from './position_panel';
import { recordingPanel } from './recording_panel';
import { timelinePanel } from './timeline_panel';

export interface View {
  element: HTMLElement;
  keys: KeyBinding[];
  /** Ends what the view listens to. */
  close(): void;
}

export function viewer(context: Context): View {
  const { session, options } = context;
  const timeline = timelinePanel(context);
  const plan = planPanel(context);
  const charts = chartsPanel(context, timeline.seek);
  const events = eventsPanel(context, timeline.seek);
  const cards = [positionPanel(context), modelsPanel(context), estimatorsPanel(context), recordingPanel(context), linksPanel(context), events];
  const side = h('div', { class: 'side' }, ...cards.map((card) => card.element));
  const left = h('div', { class: 'left' }, plan.element, charts.element);
  const element = h('div', { class: 'viewer' }, left, side, timeline.element);

  const panels = [plan, charts, timeline, ...cards];
  const inFrame = oncePerFrame(() => panels.forEach((panel) => panel.update()));
  let fitted = session.tracks.size > 0;
  const endings = [
    session.on('state', inFrame),
    options.on(() => (inFrame(), charts.refresh())),
    session.on('tracks', () => {
      if (!fitted && session.tracks.size > 0) plan.view.showAll();
      fitted = true;
      inFrame();
      charts.refresh();
    }),
    session.on('events', () => (inFrame(), timeline.showEvents())),
  ];
  inFrame();
  requestAnimationFrame(() => (plan.view.showAll(), charts.refresh(), timeline.showEvents()));

  const keys: KeyBinding[] = [
    { keys: [' ', 'k'], shown: 'Space', text: 'keyPlay', run: () => timeline.toggle() },
    {
      keys: ['ArrowLeft', 'ArrowRight'],
      shown: '← →',
      text: 'keyStep',
      run: (event) => timeline.step((event.key === 'ArrowLeft' ? -1 : 1) * (event.shiftKey ? 10 : 1)),
    },
    { keys: [',', '.'], shown: ', .', text: 'keySpeed', run: (event) => timeline.faster(event.key === ',' ? -1 : 1) },
    { keys: ['f'], shown: 'F', text: 'keyFollow', run: () => options.set({ follow: !options.now.follow }) },
    { keys: ['0', 'Home'], shown: '0', text: 'keyFit', run: () => plan.fit() },
    { keys: ['+', '='], shown: '+', text: 'zoomIn', run: () => plan.zoom(1.6) },
    { keys: ['-'], shown: '−', text: 'zoomOut', run: () => plan.zoom(1 / 1.6) },
  ];
  return {
    element,
    keys,
    close: () => {
      endings.forEach((end) => end());
      plan.view.map.setTarget();
    },
  };
}

/** States may come faster than the screen shows them: the newest is shown. */
function oncePerFrame(draw: () => void): () => void {
  let asked = false;
  return () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      draw();
    });
  };
}
